//! Lines that became longer than a controller takes.

use std::collections::BTreeSet;

use crate::error::WriteError;
use crate::options::WriteOptions;
use crate::text::source::SourceFile;

/// No line that changed is longer than allowed.
pub(crate) fn check_lines(
    file: &SourceFile,
    written: &[u8],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let Some(limit) = options.max_line_bytes else {
        return Ok(());
    };
    let old = file.bytes().split(|byte| *byte == b'\n');
    let old: BTreeSet<&[u8]> = old.filter(|line| line.len() > limit).collect();
    for (index, line) in written.split(|byte| *byte == b'\n').enumerate() {
        let bytes = line.strip_suffix(b"\r").unwrap_or(line).len();
        if bytes > limit && !old.contains(line) {
            return Err(WriteError::LineTooLong {
                file: file.name().to_owned(),
                line: index + 1,
                bytes,
                limit,
            });
        }
    }
    Ok(())
}
