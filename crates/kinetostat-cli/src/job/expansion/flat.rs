//! The expansion itself: the flat program, the files that it was made of, and refusals that name file and line.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{FileRead, FlatProgram};
use kinetostat_program::{Expanded, ProgramError, expand_or_faults};

use crate::job::expansion::folders::{Folders, SubprogramFile};
use crate::job::expansion::settings::ExpandSettings;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::fault_list::failure_of;

/// A program that was run once and written flat.
pub(crate) struct Flattened {
    pub(crate) expanded: Expanded,
    /// Origin of its lines.
    pub(crate) flat: FlatProgram,
    /// Files of subprograms that were read, with their hashes.
    pub(crate) read: Vec<FileRead>,
    /// Their places: they are never overwritten.
    pub(crate) paths: Vec<PathBuf>,
}

/// Runs a program once; `name` is that of messages.
pub(crate) fn flattened(
    bytes: Vec<u8>,
    program: &Path,
    name: &str,
    settings: &ExpandSettings,
) -> Answer<Flattened> {
    let folders = Folders::new(program, &settings.folders);
    let done = expand_or_faults(bytes, &settings.options, &folders);
    let files = folders.into_read();
    let expanded = done.map_err(|all| {
        let failure = match all.as_slice() {
            [] => ErrorCode::ProgramRefused
                .failure("the program is refused")
                .within(name),
            [only] => refused(only, name, &files),
            [first, ..] => failure_of(ErrorCode::ProgramRefused, "lines", first, &all).within(name),
        };
        failure.of_program()
    })?;
    let index = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let sources = expanded.origins.iter();
    let sources = sources.map(|origin| (index(origin.file), index(origin.line)));
    let names = expanded.files.iter().map(|of| file_name(of, name, &files));
    let blocks = expanded.program.block_count();
    let mut flat = FlatProgram::new(names.collect(), blocks, sources.collect());
    flat.settings.clone_from(&settings.words);
    Ok(Flattened {
        flat,
        expanded,
        paths: files.iter().map(|file| file.path.clone()).collect(),
        read: files.into_iter().map(|file| file.read).collect(),
    })
}

/// The name of a file of the expansion, in which the program has none and subprograms have no ending.
fn file_name(of: &str, program: &str, files: &[SubprogramFile]) -> String {
    let known = files.iter().find(|file| file.name == of);
    match (of, known) {
        ("", _) => program.to_owned(),
        (_, Some(file)) => file.read.name.clone(),
        (of, None) => of.to_owned(),
    }
}

/// Failure of an expansion: with the file of the line if it is in a subprogram.
fn refused(error: &ProgramError, program: &str, files: &[SubprogramFile]) -> Failure {
    let within = error.reason.strip_prefix("in the subprogram '");
    match within.and_then(|text| text.split_once("': ")) {
        Some((name, reason)) => {
            let file = file_name(name, program, files);
            let mut own = error.clone();
            reason.clone_into(&mut own.reason);
            ErrorCode::ProgramRefused
                .failure(own)
                .within(&file)
                .within(&format!("{program}, in the subprogram"))
        }
        None => ErrorCode::ProgramRefused.failure(error).within(program),
    }
}
