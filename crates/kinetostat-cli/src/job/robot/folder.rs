//! Folders as controls see them.

use std::path::{Path, PathBuf};

/// Upper limit of the names of a folder that are searched.
const MOST_NAMES: usize = 100_000;

/// A folder with the names of its files: controls do not tell capitals from small letters.
pub(super) struct Folder {
    path: PathBuf,
    names: Vec<String>,
}

impl Folder {
    pub(super) fn of(path: &Path) -> Self {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.take(MOST_NAMES).collect();
        names.sort();
        Self {
            path: path.to_owned(),
            names,
        }
    }

    /// The file of a name: as it is written, else in other letters.
    pub(super) fn file(&self, name: &str) -> Option<PathBuf> {
        self.named(name).filter(|found| found.is_file())
    }

    /// The folder of a name in it: as it is written, else in other letters.
    pub(super) fn folder(&self, name: &str) -> Option<Self> {
        let found = self.named(name).filter(|found| found.is_dir())?;
        Some(Self::of(&found))
    }

    fn named(&self, name: &str) -> Option<PathBuf> {
        let same = self.names.iter().find(|own| *own == name);
        let alike = || self.names.iter().find(|own| own.eq_ignore_ascii_case(name));
        Some(self.path.join(same.or_else(alike)?))
    }
}
