//! Files that are not read at all.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::text::source::SourceFile;

const MOST_BYTES: usize = 1 << 28;

/// Checks that a file can be read at all; otherwise notes the error and returns false.
pub(crate) fn whole_file(file: &SourceFile, faults: &mut Vec<ProgramError>) -> bool {
    let mut refuse = |span: Range<usize>, reason: &str, remedy: &str| {
        note(faults, || ProgramError::at(file, span, reason, remedy));
        false
    };
    if file.bytes().len() > MOST_BYTES {
        return refuse(0..0, "the file is larger than 256 MiB", "divide it");
    }
    let is_archive = |name: &str| name.to_ascii_lowercase().ends_with(".arc");
    if is_archive(file.name()) {
        return refuse(
            0..0,
            "it is an archive of the control",
            "give the programs (.mpf, .spf) that are in it",
        );
    }
    let heads = (1..=file.line_count())
        .filter(|line| {
            file.line(*line)
                .is_some_and(|line| line.trim_ascii_start().starts_with(b"%"))
        })
        .take(2);
    match heads.collect::<Vec<usize>>().as_slice() {
        [_, second] => {
            let at = file.start_of(*second);
            refuse(
                at..at + 1,
                "a second program begins here",
                "give each program as a file of its own",
            )
        }
        _ => true,
    }
}
