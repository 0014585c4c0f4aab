//! `kinetostat expand`: a program with subprograms, variables, cycles and radius compensation, run once and written flat.
//!
//! It takes a program, folders of subprograms and diameters of tools; it gives plain blocks with the lines that they came from.

use std::path::PathBuf;

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{FileForm, FlatText, Language, SourceFile, language_of, read};
use kinetostat_machining::number::counted;
use nalgebra::Vector3;

use crate::files::input_files::{InputFiles, refuse_beyond_memory};
use crate::files::outputs::{Existing, Outputs, written};
use crate::job::arguments::ReadingArgs;
use crate::job::expansion::arguments::{ExpansionArgs, NO_COMMENTS};
use crate::job::expansion::flat::{Flattened, flattened};
use crate::job::expansion::settings::{folders, settings};
use crate::job::file_endings::{Written, refuse_other_ending};
use crate::job::output_paths::FLAT_PROGRAM;
use crate::job::reading::reading;
use crate::job::robot::called_files::with_called_files;
use crate::job::robot::read_once::Reading;
use crate::job::robot::read_program::{flat_text, notes_of, of_calls, refused};
use crate::job::robot::settings::{moving_subprograms, settings as robot_settings};
use crate::job::robot::source::{RobotSource, slash_blocks};
use crate::job::robot_arguments::{RobotArgs, StatedArgs};
use crate::job::setting::line_count;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{item, wrapped};
use crate::ui::screen::{Stream, print, print_bytes};

pub(crate) fn run(args: &ExpandArgs) -> Answer<()> {
    let bytes = InputFiles::default().bytes("program", &args.program)?;
    refuse_beyond_memory(&args.program, bytes.len(), line_count(&bytes))?;
    let name = args.program.display().to_string();
    let language = language_of(&name, &bytes);
    if let Some(out) = &args.out {
        let written = Written {
            what: FLAT_PROGRAM,
            form: FileForm::of(language, &name, &bytes),
            source: Some(&args.program),
        };
        refuse_other_ending(written, out)?;
    }
    if let Some(language) = language {
        return of_control(args, language, bytes);
    }
    if let Some(option) = args.stated.of_others() {
        return Err(ErrorCode::Unused.failure(format!(
            "{option} is for programs of robots, and '{name}' is read as G-code; leave it out"
        )));
    }
    let mut settings = settings(None, &args.with, &reading(None, &args.reading)?)?;
    settings.options.reading.moving_calls = moving_subprograms(None, &args.stated)?;
    let done = flattened(bytes, &args.program, &name, &settings)?;
    let mut inputs = vec![args.program.clone()];
    inputs.extend(done.paths.iter().cloned());
    let claimed = args.out.as_deref().map(|out| {
        let mut outputs = Outputs::new(Existing::forced(args.force_overwrite), inputs);
        let index = outputs.claim(FLAT_PROGRAM, out)?;
        Answer::Ok((outputs, index))
    });
    let claimed: Option<(Outputs, usize)> = claimed.transpose()?;
    let flat = done.expanded.program.bytes();
    match claimed {
        Some((mut outputs, index)) => {
            outputs.fill(index, flat)?;
            let paths = outputs.commit()?;
            let mut text = summary(&name, &done);
            text.push_str("\nWritten\n");
            for path in paths {
                let path = path.display().to_string();
                text.push_str(&format!("  {}\n", crate::ui::safe_text::safe(&path)));
            }
            print_bytes(text.as_bytes())
        }
        None => print_bytes(flat),
    }
}

/// A program of SINUMERIK or Heidenhain.
fn of_control(args: &ExpandArgs, language: Language, bytes: Vec<u8>) -> Answer<()> {
    let other = args.with.given_for_gcode();
    if let Some(option) = other.filter(|option| *option != NO_COMMENTS) {
        return Err(
            ErrorCode::Unused.failure(format!("{option} is for programs in G-code; leave it out"))
        );
    }
    let folders = folders(&args.with)?;
    let name = args.program.file_name().unwrap_or_default();
    let flags = RobotArgs {
        stated: args.stated.clone(),
        ..RobotArgs::default()
    };
    let mut source = RobotSource {
        language,
        files: vec![SourceFile::new(name.to_string_lossy(), bytes)],
        paths: Vec::new(),
        parquet: None,
        divided: None,
        before: None,
        system_frames: None,
        reading: Reading::new(),
        settings: robot_settings(None, &flags, language, Vector3::z())?,
    };
    let called = with_called_files(&mut source, &args.program, &folders)?;
    source.settings.reading.slash_blocks = slash_blocks(None, &args.reading);
    let (text, flat) = flat_text(&source, !args.with.no_comments)?;
    let assumed = assumed_of_calls(&source, &text)?;
    let Some(out) = &args.out else {
        if let Some(assumed) = &assumed {
            print(Stream::Err, &item(assumed))?;
        }
        return print_bytes(text.file.bytes());
    };
    let called = called.into_iter().map(|(path, _)| path);
    let inputs = std::iter::once(args.program.clone())
        .chain(called)
        .collect();
    let mut outputs = Outputs::new(Existing::forced(args.force_overwrite), inputs);
    let index = outputs.claim(FLAT_PROGRAM, out)?;
    outputs.fill(index, text.file.bytes())?;
    let paths = outputs.commit()?;
    let mut said = wrapped(
        &match text.changed {
            true => format!("{}.", flat.description()),
            false => "Nothing was to be written flat: the program is as it was.".to_owned(),
        },
        0,
    );
    for note in notes_of(&text) {
        let found = format!("line {}: {}", note.line, note.text);
        said.push_str(&item(&flat.with_sources(&found)));
    }
    if let Some(assumed) = &assumed {
        said.push_str(&item(assumed));
    }
    print_bytes((said + &written(&paths)).as_bytes())
}

/// Assumption on calls that none of the files holds. With calls that are stated to move the tool, a program that is refused is refused here,
/// too.
fn assumed_of_calls(source: &RobotSource, text: &FlatText) -> Answer<Option<String>> {
    let reading = &source.settings.reading;
    match read(source.language, vec![text.file.clone()], reading) {
        Ok(program) => Ok(of_calls(&program).map(|assumed| assumed.text)),
        Err(all) if !reading.moving_calls.is_empty() => Err(refused(&all)),
        Err(_) => Ok(None),
    }
}

fn summary(name: &str, done: &Flattened) -> String {
    let expanded = &done.expanded;
    let moves = expanded.path.moves.len();
    let files = match expanded.files.len() {
        0 | 1 => String::new(),
        n => format!(
            ", from {} and {}",
            name,
            counted(n - 1, "file of subprograms")
        ),
    };
    let mut text = wrapped(
        &format!(
            "{name}: {} that are run, {}{files}. Each says the line that it came from.",
            counted(done.flat.blocks, "block"),
            counted(moves, "move"),
        ),
        0,
    );
    for warning in expanded.path.warnings.iter().chain(&expanded.warnings) {
        let found = format!("line {}: {}", warning.line, warning.text);
        text.push_str(&item(&done.flat.with_sources(&found)));
    }
    text
}

/// A program with subprograms, variables and cycles as plain blocks
///
/// Runs the program once and writes what it runs: subprograms, loops and branches as their blocks,
/// expressions as numbers, canned cycles and polar words as moves, G41 and G42 as the way of the
/// tool's centre. The moves are those of LinuxCNC. What is not followed is refused with its line.
#[derive(Debug, Args)]
#[command(after_long_help = HELP)]
pub(crate) struct ExpandArgs {
    /// Program in G-code, of SINUMERIK (.mpf) or Heidenhain (.h), in APT (.apt, .cls), KRL (.src), RAPID (.mod) or FANUC TP (.ls)
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// File for the flat program; without it, it is printed
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) with: ExpansionArgs,
    #[command(flatten)]
    pub(crate) stated: StatedArgs,
    /// Overwrite the output if it exists (never the input)
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

const HELP: &str = "\
Examples:
  kinetostat expand part.ngc --out flat.ngc
  kinetostat expand part.ngc --subprograms macros --tool-diameter-mm 1=6
  kinetostat compensate job.toml --program part.ngc --expand
      the same on the way to another command

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";
