//! Advice to expand a program that is refused in its present form.

use std::path::Path;

use kinetostat_machining::number::counted;
use kinetostat_program::{Dialect, ExpandOptions, Expanded, ProgramError, ReadOptions, expand};

use crate::job::expansion::folders::Folders;

/// Blocks of the program that is tried.
const MOST_BLOCKS: usize = 500_000;

/// Remedy.
const ADD: &str = "add --expand (in a job file: a table [expand])";

/// Advice before the faults of a refused program, if its expansion passes them.
pub(crate) fn advice(
    bytes: &[u8],
    program: &Path,
    reading: &ReadOptions,
    faults: &[ProgramError],
) -> Option<String> {
    let first = faults.first()?;
    let mut options = ExpandOptions::default();
    options.reading = reading.clone();
    options.most_blocks = MOST_BLOCKS;
    let folders = Folders::new(program, &[]);
    let undecided = match expand(bytes, &options, &folders) {
        Ok(expanded) => return follows(ADD, &expanded),
        Err(error) => error,
    };
    let dialects = [("fanuc", Dialect::Fanuc), ("linuxcnc", Dialect::LinuxCnc)];
    let tried = dialects.into_iter().filter_map(|(name, dialect)| {
        options.dialect = dialect;
        Some((name, expand(bytes, &options, &folders).ok()?))
    });
    let taken: Vec<(&str, Expanded)> = tried.collect();
    if let Some((_, expanded)) = taken.first() {
        let names: Vec<&str> = taken.iter().map(|(name, _)| *name).collect();
        let add = format!(
            "add --expand and --dialect {}, as the control of the machine is (in a job file: a table [expand] with dialect)",
            names.join(" or ")
        );
        return follows(&add, expanded);
    }
    // A fault that remains after the expansion is no reason for one.
    if known(faults, &undecided) || undecided.line <= first.line {
        return None;
    }
    Some(format!(
        "{ADD}; what is wrong then is in line {}: `{}`: {}; {}. As it stands: ",
        undecided.line, undecided.found, undecided.reason, undecided.remedy
    ))
}

/// Absent if the expanded program has no motion, either.
fn follows(add: &str, expanded: &Expanded) -> Option<String> {
    (!expanded.path.moves.is_empty()).then(|| {
        format!(
            "{add}: run once and written flat, it is {} that can be followed. As it stands: ",
            counted(expanded.program.block_count(), "block")
        )
    })
}

fn known(faults: &[ProgramError], error: &ProgramError) -> bool {
    faults
        .iter()
        .any(|fault| fault.line == error.line && fault.reason == error.reason)
}
