//! Selection of the programs that are run in parts.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use kinetostat_model::Model;
use kinetostat_program::PartLength;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::machine::MachineSetup;
use crate::job::output_paths::OutputPaths;
use crate::job::setting::Setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::ui::{layout, screen};

/// Programs of more bytes are long: a whole one takes some hundred megabytes of memory beyond that.
const LONG_BYTES: u64 = 1 << 20;

/// Upper limit of the bytes of the first lines.
const FIRST_BYTES: usize = 1 << 20;

/// Lines of a long program by which its language and settings are recognised.
const FIRST_LINES: usize = 400;

/// Lines of a part on a machine with platforms between base and tool, where a place takes some ten times as long as on others: what is
/// done is kept at the end of a part. It follows from the model alone, so that bytes do not depend on how fast a computer is.
const OWN_OF_SEVERAL: usize = 2_000;

/// Length of parts: `--part-lines` is for tests, and has a program of any length run in parts.
pub(crate) fn part_length(flags: &ProgramArgs, model: &Model) -> PartLength {
    let usual = PartLength::default();
    let several = model.mechanism.platforms().len() > 2;
    let own = match several {
        true => OWN_OF_SEVERAL,
        false => usual.own,
    };
    PartLength {
        own: flags.part_lines.unwrap_or(own),
        ..usual
    }
}

/// The size of a program that is to be run in parts, bytes; `None` of a short one, and where there is none.
fn long_bytes(path: &Path, flags: &ProgramArgs) -> Option<u64> {
    let length = std::fs::metadata(path).ok()?.len();
    (length > LONG_BYTES || flags.part_lines.is_some()).then_some(length)
}

/// Says of a long program why it is run as a whole, which takes memory and cannot be gone on with. It is no warning: the answer is
/// the same.
pub(crate) fn say_as_a_whole(path: &Path, flags: &ProgramArgs, reasons: &[&str]) {
    let Some(bytes) = long_bytes(path, flags).filter(|_| !reasons.is_empty()) else {
        return;
    };
    let text = format!(
        "note: the program has {:.1} MB and is run as a whole, for {}: it takes memory in proportion to its length, and a run that is interrupted begins anew",
        bytes as f64 * 1e-6,
        reasons.join(", and ")
    );
    // Text for people beside the answer: it is no reason to end.
    let _ = screen::print(screen::Stream::Err, &layout::wrapped(&text, 0));
}

/// The files of a run with the first lines of its program in place of it, where that is long.
pub(crate) fn with_first_lines(
    files: &InputFiles,
    path: &Path,
    flags: &ProgramArgs,
) -> Option<InputFiles> {
    long_bytes(path, flags)?;
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

/// Reasons against a run in parts before the machine is known; empty if there are none.
pub(crate) fn whole_by_setting(setting: &Setting) -> Vec<&'static str> {
    let cases = [
        (
            setting.robot.is_some(),
            "it is a program of a robot (or of another language than G-code)",
        ),
        (
            setting.flat.is_some(),
            "its loops and subprograms are expanded",
        ),
    ];
    holding(&cases)
}

/// Reasons against a run in parts; empty if there are none.
pub(crate) fn only_as_a_whole(
    setting: &Setting,
    machine: &MachineSetup,
    targets: &OutputPaths,
) -> Vec<&'static str> {
    let cases = [
        (
            machine.cut.is_some(),
            "its forces are computed from the cut",
        ),
        (machine.measured.is_some(), "its forces were measured"),
        (
            setting.forces.is_some(),
            "its forces are given place by place",
        ),
        (
            !machine.tools.is_empty() || setting.reading.tools.is_some(),
            "it has several tools",
        ),
        (
            setting.chatter.is_some(),
            "chatter is judged along it ([chatter])",
        ),
        (
            setting.uncertain.is_some(),
            "its scatter is asked for (--uncertain)",
        ),
        (
            setting.free_turn != FreeTurnWord::AsStated,
            "the turn of the tool is chosen (--free-turn)",
        ),
        (
            targets.vtk.is_some(),
            "its path is written for ParaView (--vtk)",
        ),
        (
            machine.placement.orientation_follows,
            "the orientation of the tool follows from its place",
        ),
        (
            setting.reading.rotary.is_some(),
            "rotary axes turn the tool in the part",
        ),
    ];
    holding(&cases)
}

/// The reasons that hold.
pub(crate) fn holding(cases: &[(bool, &'static str)]) -> Vec<&'static str> {
    let found = cases.iter().filter(|(holds, _)| *holds);
    found.map(|(_, why)| *why).collect()
}
