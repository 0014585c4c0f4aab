//! `kinetostat start`: some questions, and a job with its first result.
//!
//! It takes answers line by line and writes model, cell and job; then the job is compensated.

mod answers;
mod ask;
mod draft;
mod facts;
pub(crate) mod interview;
pub(crate) mod question;
mod reading;
mod robot;
#[cfg(feature = "view")]
mod shown;

use std::io::{BufRead, IsTerminal};
use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;

use crate::compensate::{self, arguments::CompensateArgs};
use crate::files::made_folder::in_folder;
use crate::files::outputs::{self, Existing};
use crate::options::EXIT_CODES;
use crate::start::interview::Interview;
use crate::ui::failure::{Answer, Failing};
use crate::ui::given::Given;
use crate::ui::host;
use crate::ui::layout::{listed, wrapped};
use crate::ui::safe_text::safe;
use crate::ui::screen::{self, Stream};

/// Begin with your robot and your program: some questions, the files, and the first result
///
/// Asks for robot, program, tool, place of the part and what cuts; writes a job with what belongs to it, and compensates. An empty
/// answer takes what stands in brackets, `?` says more, `<` goes back.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct StartArgs {
    /// Folder of the files; it is made if it does not exist
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(crate) out: PathBuf,
    /// Overwrite files of the same names in it
    #[arg(long)]
    pub(crate) force_overwrite: bool,
}

pub(crate) fn run(args: &StartArgs) -> Answer<()> {
    if host::current().is_some() {
        return Err(
            ErrorCode::NotBuiltIn.failure("start asks on the command line only: kinetostat start")
        );
    }
    // Files of this folder are named without a dot.
    let folder = args.out.strip_prefix(".").unwrap_or(&args.out);
    let job = match folder.as_os_str().is_empty() {
        true => written(folder, args.force_overwrite),
        false => in_folder(folder, || written(folder, args.force_overwrite)),
    }?;
    let result = compensate::run(
        CompensateArgs::of_job(job.clone(), args.force_overwrite),
        &Given::default(),
    );
    let job = safe(&job.display().to_string());
    let next = [
        (
            format!("kinetostat view {job}"),
            "the machine in 3-D along the program",
        ),
        (
            format!("kinetostat check {job}"),
            "what the job says, in words",
        ),
        (
            format!("kinetostat compensate {job} --force-overwrite"),
            "again, after a change",
        ),
    ];
    let rows = next.map(|(command, what)| vec![command, what.to_owned()]);
    screen::print(Stream::Out, &format!("\nNext\n{}", listed(&rows, 2)))?;
    result
}

/// Asks, and writes the files; gives that of the job.
fn written(folder: &Path, force_overwrite: bool) -> Answer<PathBuf> {
    let mut interview = Interview::new(folder, Existing::forced(force_overwrite))?;
    ask_all(&mut interview)?;
    let (job, paths) = interview.write()?;
    screen::print(Stream::Out, &format!("{}\n", outputs::written(&paths)))?;
    Ok(job)
}

/// Asks on the terminal until all is known.
fn ask_all(interview: &mut Interview) -> Answer<()> {
    let mut lines = std::io::stdin().lock().lines();
    let is_person = std::io::stdin().is_terminal();
    while let Some(question) = interview.question() {
        let usual = question
            .usual
            .map_or_else(String::new, |usual| format!(" [{usual}]"));
        screen::print(
            Stream::Out,
            &format!("{}> ", wrapped(&format!("{}{usual}", question.words), 0)),
        )?;
        let Some(Ok(line)) = lines.next() else {
            return Err(ErrorCode::Missing.failure(format!(
                "the answers end before this question: {}; nothing was written",
                question.words
            )));
        };
        if !is_person {
            screen::print(Stream::Out, &format!("{line}\n"))?;
        }
        match (line.trim(), question.usual) {
            ("?", _) | ("", None) => {
                screen::print(Stream::Out, &wrapped(&question.help, 2))?;
                continue;
            }
            ("<", _) => {
                interview.back();
                continue;
            }
            _ => (),
        }
        match interview.take(&line) {
            Ok(said) => {
                for line in said {
                    screen::print(Stream::Out, &wrapped(&line, 2))?;
                }
            }
            // A script cannot answer again.
            Err(failure) if !is_person => return Err(failure),
            Err(failure) => screen::print(Stream::Out, &wrapped(&failure.plain, 2))?,
        }
    }
    Ok(())
}
