//! Files of subprograms, in the folder of the program and in others; which of them were read.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use kinetostat_machining::FileRead;
use kinetostat_program::Subprograms;

use crate::files::origin;

/// Endings of files of subprograms.
const ENDINGS: [&str; 4] = [".ngc", ".nc", ".gcode", ""];

/// Largest file that is read.
const MOST_BYTES: u64 = 16 << 20;

/// A file that was read for a subprogram.
pub(crate) struct SubprogramFile {
    /// The subprogram's name.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    pub(crate) read: FileRead,
}

/// Folders that are searched in their order.
pub(crate) struct Folders {
    folders: Vec<PathBuf>,
    read: RefCell<Vec<SubprogramFile>>,
}

impl Folders {
    /// Searches the folder of the program, then the others.
    pub(crate) fn new(program: &Path, others: &[PathBuf]) -> Self {
        let own = program.parent().map(Path::to_owned);
        Self {
            folders: own.into_iter().chain(others.iter().cloned()).collect(),
            read: RefCell::default(),
        }
    }

    /// Files that were read.
    pub(crate) fn into_read(self) -> Vec<SubprogramFile> {
        self.read.into_inner()
    }
}

impl Subprograms for Folders {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        // A name is no way to another folder.
        if name.contains(['/', '\\', ':']) || name.starts_with('.') {
            return None;
        }
        let files = self
            .folders
            .iter()
            .flat_map(|folder| ENDINGS.map(|ending| folder.join(format!("{name}{ending}"))));
        let mut known = files.filter(|file| {
            std::fs::metadata(file).is_ok_and(|data| data.is_file() && data.len() <= MOST_BYTES)
        });
        let path = known.next()?;
        let bytes = std::fs::read(&path).ok()?;
        let mut all = self.read.borrow_mut();
        if !all.iter().any(|file| file.path == path) {
            all.push(SubprogramFile {
                name: name.to_owned(),
                read: origin::file("subprogram", &path, &bytes),
                path,
            });
        }
        Some(bytes)
    }
}
