//! Programs that are run once and written flat: SINUMERIK, Heidenhain, RAPID and KRL, and APT with its cycles.

use kinetostat_formats::{FlatText, expand};
use kinetostat_machining::FlatProgram;
use kinetostat_program::Warning;

use crate::job::robot::read_program::refused;
use crate::job::robot::source::RobotSource;
use crate::ui::failure::{Answer, Failure};

/// The flat program, and where its lines came from; `comments`: its blocks say it, too.
pub(crate) fn flat_text(source: &RobotSource, comments: bool) -> Answer<(FlatText, FlatProgram)> {
    let files = source.files.clone();
    let names: Vec<String> = files.iter().map(|file| file.name().to_owned()).collect();
    let done = expand(source.language, files, &source.settings.reading)
        .map_err(|all| refused(&all, |fault| fault.reason.as_str()).of_program())?;
    let Some(text) = done else {
        return Err(Failure::input(
            "--expand and [expand] are for G-code, SINUMERIK, Heidenhain, RAPID, KRL and the cycles of APT; a program of another robot is read as it stands, with its routines: leave them out",
        ));
    };
    let text = match comments {
        true => text.with_origins(source.language, &names),
        false => text,
    };
    let index = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let origins = text.origins.iter();
    let origins = origins.map(|(file, line)| (index(*file), index(*line)));
    let flat = FlatProgram::new(names, text.origins.len(), origins.collect());
    Ok((text, flat))
}

/// Assumptions of the run at uncertain source lines, at the first flat line of each.
pub(crate) fn notes_of(text: &FlatText) -> Vec<Warning> {
    let notes = text.findings.iter().map(|finding| {
        let of_it = |origin: &(usize, usize)| *origin == (finding.file, finding.line);
        let line = text.origins.iter().position(of_it);
        Warning {
            line: line.map_or(1, |index| index + 1),
            text: finding.message.clone(),
        }
    });
    notes.collect()
}
