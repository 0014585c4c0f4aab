//! Lines of a text that is read as it is needed.

use std::io::{BufRead, Error as IoError};

use thiserror::Error;

use crate::error::ProgramError;
use crate::text::program::MAX_READ_LINE_BYTES;

/// Reason for which a part of a program cannot be read.
#[derive(Debug, Error)]
pub enum PartError {
    /// The file cannot be read.
    #[error("{0}")]
    File(#[from] IoError),
    /// The program cannot be followed.
    #[error("{0}")]
    Program(#[from] ProgramError),
    /// The lines are not those that were surveyed.
    #[error("the program was changed since it was surveyed")]
    Changed,
}

/// Lines of a text, each with its line ending.
pub(crate) struct Lines<R> {
    from: R,
}

impl<R: BufRead> Lines<R> {
    pub fn new(from: R) -> Self {
        Self { from }
    }

    /// Appends the next line to `to`; returns false at the end. Only the beginning of a line that is longer than any block
    /// is read, which the reader refuses.
    pub fn next(&mut self, to: &mut Vec<u8>) -> Result<bool, IoError> {
        let start = to.len();
        loop {
            let found = self.from.fill_buf()?;
            if found.is_empty() {
                return Ok(to.len() > start);
            }
            let Some(end) = memchr::memchr2(b'\n', b'\r', found) else {
                let count = found.len();
                to.extend_from_slice(found);
                self.from.consume(count);
                if to.len() - start > 2 * MAX_READ_LINE_BYTES {
                    return Ok(true);
                }
                continue;
            };
            let carriage_return = found[end] == b'\r';
            to.extend_from_slice(&found[..=end]);
            self.from.consume(end + 1);
            if carriage_return && self.from.fill_buf()?.first() == Some(&b'\n') {
                to.push(b'\n');
                self.from.consume(1);
            }
            return Ok(true);
        }
    }
}
