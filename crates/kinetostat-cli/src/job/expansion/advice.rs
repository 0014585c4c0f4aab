//! Whether an expansion would help a program that is refused as it stands.

use std::path::Path;

use kinetostat_machining::number::counted;
use kinetostat_program::{ExpandOptions, ProgramError, ReadOptions, expand};

use crate::job::expansion::folders::Folders;

/// Blocks of the program that is tried.
const MOST_BLOCKS: usize = 500_000;

/// What is to be done.
const ADD: &str = "add --expand (in a job file: a table [expand])";

/// What to say first of a refused program, if its expansion gets past what is refused.
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
    match expand(bytes, &options, &Folders::new(program, &[])) {
        // Nothing moves with an expansion, either.
        Ok(expanded) if expanded.path.moves.is_empty() => None,
        Ok(expanded) => Some(format!(
            "{ADD}: run once and written flat, it is {} that can be followed. As it stands: ",
            counted(expanded.program.block_count(), "block")
        )),
        // What is wrong with or without an expansion is no reason for one.
        Err(error) if known(faults, &error) || error.line <= first.line => None,
        Err(error) => Some(format!(
            "{ADD}; what is wrong then is in line {}: `{}`: {}; {}. As it stands: ",
            error.line, error.found, error.reason, error.remedy
        )),
    }
}

fn known(faults: &[ProgramError], error: &ProgramError) -> bool {
    faults
        .iter()
        .any(|fault| fault.line == error.line && fault.reason == error.reason)
}
