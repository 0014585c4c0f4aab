//! Which programs are run in parts.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use kinetostat_program::{PartLength, Survey};
use kinetostat_report::Language;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::machine::MachineSetup;
use crate::job::setting::Setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::ui::language::LanguageWord;

/// Programs of more bytes are long. To be 1 MB, beyond which a whole program takes some hundred megabytes of memory, once
/// `tests/long.rs` and `cargo xtask long` have passed: until then only `--part-lines` asks for parts.
const LONG_BYTES: Option<u64> = None;

/// Most bytes of the first lines.
const FIRST_BYTES: usize = 1 << 20;

/// Lines of a long program by which its language and settings are recognised.
const FIRST_LINES: usize = 400;

/// How long parts are: `--part-lines` is for tests, and has a program of any length run in parts.
pub(crate) fn part_length(flags: &ProgramArgs) -> PartLength {
    match flags.part_lines {
        Some(own) => PartLength {
            own,
            ..PartLength::default()
        },
        None => PartLength::default(),
    }
}

/// The files of a run with the first lines of its program in place of it, where that is long.
pub(crate) fn with_first_lines(
    files: &InputFiles,
    path: &Path,
    flags: &ProgramArgs,
) -> Option<InputFiles> {
    let length = std::fs::metadata(path).ok()?.len();
    let is_long = LONG_BYTES.is_some_and(|most| length > most);
    if !is_long && flags.part_lines.is_none() {
        return None;
    }
    let mut from = BufReader::new(File::open(path).ok()?);
    let mut first = Vec::new();
    for _ in 0..FIRST_LINES {
        if first.len() > FIRST_BYTES || from.read_until(b'\n', &mut first).ok()? == 0 {
            break;
        }
    }
    let mut files = files.clone();
    files.insert(path.to_owned(), first);
    Some(files)
}

/// Why a program is run as a whole, however long it is; `None` where it can be run in parts.
pub(crate) fn only_as_a_whole(
    setting: &Setting,
    machine: &MachineSetup,
    flags: &ProgramArgs,
) -> Option<&'static str> {
    let cases = [
        (setting.robot.is_some(), "it is a program of a robot"),
        (setting.flat.is_some(), "it is expanded"),
        (machine.cut.is_some(), "forces are computed from the cut"),
        (machine.measured.is_some(), "forces were measured"),
        (setting.forces.is_some(), "forces are given along it"),
        (!machine.tools.is_empty(), "several tools are named"),
        (setting.uncertain.is_some(), "its scatter is asked for"),
        (!setting.features.is_empty(), "features are named"),
        (
            setting.free_turn != FreeTurnWord::AsStated,
            "the turn of the tool is chosen",
        ),
        (setting.targets.pdf.is_some(), "a paper is asked for"),
        (
            LanguageWord::language(flags.language) != Language::English,
            "a paper is asked for",
        ),
        (
            machine.placement.orientation_follows,
            "the orientation of the tool follows from place to place",
        ),
    ];
    let found = cases.into_iter().find(|(holds, _)| *holds);
    found
        .map(|(_, why)| why)
        .or_else(|| Survey::only_as_a_whole(&setting.reading))
}
