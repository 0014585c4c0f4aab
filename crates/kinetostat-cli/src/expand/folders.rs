//! Files of subprograms, in the folder of the program and in others.

use std::path::{Path, PathBuf};

use kinetostat_program::Subprograms;

/// Endings of files of subprograms.
const ENDINGS: [&str; 4] = [".ngc", ".nc", ".gcode", ""];

/// Largest file that is read.
const MOST_BYTES: u64 = 16 << 20;

pub(super) struct Folders(Vec<PathBuf>);

impl Folders {
    pub(super) fn new(program: &Path, others: &[PathBuf]) -> Self {
        let own = program.parent().map(Path::to_owned);
        Self(own.into_iter().chain(others.iter().cloned()).collect())
    }
}

impl Subprograms for Folders {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        // A name is no way to another folder.
        if name.contains(['/', '\\']) || name.starts_with('.') {
            return None;
        }
        let files = self
            .0
            .iter()
            .flat_map(|folder| ENDINGS.map(|ending| folder.join(format!("{name}{ending}"))));
        let mut known = files.filter(|file| {
            std::fs::metadata(file).is_ok_and(|data| data.is_file() && data.len() <= MOST_BYTES)
        });
        std::fs::read(known.next()?).ok()
    }
}
