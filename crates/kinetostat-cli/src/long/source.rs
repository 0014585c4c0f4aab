//! The file of a long program.

use std::fs::File;
use std::io::Read;

use kinetostat_diagnostic::ErrorCode;
use sha2::{Digest, Sha256};

use crate::files::hash::hex;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};

/// Reads and counts what it reads.
pub(crate) struct Hashed<R> {
    from: R,
    hash: Sha256,
}

impl<R: Read> Hashed<R> {
    pub(crate) fn new(from: R) -> Self {
        Self {
            from,
            hash: Sha256::new(),
        }
    }

    /// The hash of all that was read.
    pub(crate) fn sha256(self) -> String {
        hex(&self.hash.finalize())
    }
}

impl<R: Read> Read for Hashed<R> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let count = self.from.read(to)?;
        self.hash.update(&to[..count]);
        Ok(count)
    }
}

/// The file of a program.
pub(crate) fn open(setting: &Setting) -> Answer<File> {
    let path = &setting.program_path;
    File::open(path).map_err(|error| {
        ErrorCode::FileNotRead.failure(format!(
            "the program '{}' cannot be read: {error}",
            path.display()
        ))
    })
}
