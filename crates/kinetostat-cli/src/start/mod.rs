//! `kinetostat start`: some questions, and a job with its first result.
//!
//! It takes answers line by line and writes model, cell and job; then the job is compensated.

mod answers;
mod ask;
mod draft;
mod facts;
mod question;
mod reading;
mod robot;

use std::io::{BufRead, IsTerminal};
use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;

use crate::check::job::as_far_as_known;
use crate::compensate::{self, arguments::CompensateArgs};
use crate::files::made_folder::in_folder;
use crate::files::outputs::{self, Existing, Outputs};
use crate::options::EXIT_CODES;
use crate::start::answers::Answers;
use crate::start::question::Question;
use crate::start::reading::wrong;
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
    let existing = Existing::forced(force_overwrite);
    let job = folder.join(draft::JOB);
    let mut answers = Answers {
        folder: folder.to_owned(),
        ..Answers::default()
    };
    claimed(&answers, existing)?;
    interview(&mut answers, existing)?;
    let mut outputs = claimed(&answers, existing)?;
    for (index, (_, _, text)) in draft::files(&answers).into_iter().enumerate() {
        outputs.fill(index, text.as_bytes())?;
    }
    let paths = outputs.commit()?;
    screen::print(Stream::Out, &format!("{}\n", outputs::written(&paths)))?;
    Ok(job)
}

/// The files that the answers make so far: nobody goes through all questions to hear that one is there already.
fn claimed(answers: &Answers, existing: Existing) -> Answer<Outputs> {
    let mut outputs = Outputs::new(existing, Vec::new());
    for (what, path, _) in draft::files(answers) {
        outputs.claim(what, &path)?;
    }
    Ok(outputs)
}

/// Asks until all is known.
fn interview(answers: &mut Answers, existing: Existing) -> Answer<()> {
    let mut before: Vec<Answers> = Vec::new();
    let mut lines = std::io::stdin().lock().lines();
    let is_person = std::io::stdin().is_terminal();
    while let Some(ask) = answers.next() {
        let question = Question::of(ask, answers);
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
        let given = match (line.trim(), question.usual) {
            ("?", _) | ("", None) => {
                screen::print(Stream::Out, &wrapped(&question.help, 2))?;
                continue;
            }
            ("<", _) => {
                if let Some(earlier) = before.pop() {
                    *answers = earlier;
                }
                continue;
            }
            ("", Some(usual)) => usual,
            (given, _) => given,
        };
        let mut next = answers.clone();
        match next.take(ask, given).and_then(|said| {
            claimed(&next, existing)?;
            checked(&next, existing).map(|()| said)
        }) {
            Ok(said) => {
                for line in said.iter().flat_map(|said| said.lines()) {
                    screen::print(Stream::Out, &wrapped(line, 2))?;
                }
                before.push(std::mem::replace(answers, next));
            }
            // A script cannot answer again.
            Err(failure) if !is_person => return Err(failure),
            Err(failure) => screen::print(Stream::Out, &wrapped(&failure.plain, 2))?,
        }
    }
    Ok(())
}

/// Looks at the job as far as it is known: its values, its outputs, and whether the machine reaches the program. What else may be
/// wrong the first run says, with the files there to be changed.
fn checked(answers: &Answers, existing: Existing) -> Answer<()> {
    if !answers.can_be_checked() {
        return Ok(());
    }
    let job = answers.folder.join(draft::JOB);
    let found = as_far_as_known(&draft::in_memory(answers), &job)?;
    if let (Existing::Refuse, Some(path)) = (existing, found.existing.first()) {
        return Err(ErrorCode::Output.failure(format!(
            "the result would be written to '{path}', which exists already: start with another --out, or with --force-overwrite"
        )));
    }
    match found.unreached.as_slice() {
        [] => Ok(()),
        [first, rest @ ..] => Err(wrong(&match rest.len() {
            0 => first.clone(),
            n => format!("{first} (and {n} more of its ends)"),
        })),
    }
}
