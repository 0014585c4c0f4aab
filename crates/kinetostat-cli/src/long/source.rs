//! The file of a long program while it is read again and again: it must stay the one that was surveyed.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use crate::files::hash::hex;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failure};

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
        Failure::input(format!(
            "the program '{}' cannot be read: {error}",
            path.display()
        ))
    })
}

/// The file that was surveyed.
pub(crate) struct Surveyed<'a> {
    setting: &'a Setting,
    /// Length and time of it when its contents were last known to be those.
    stamp: Option<(u64, SystemTime)>,
}

impl<'a> Surveyed<'a> {
    pub(crate) fn new(setting: &'a Setting) -> Self {
        Self {
            setting,
            stamp: stamp(&setting.program_path),
        }
    }

    /// Refuses a file that has other contents now. They are read only where its length or its time is another one.
    pub(crate) fn refuse_if_touched(&mut self) -> Answer<()> {
        let now = stamp(&self.setting.program_path);
        if now.is_some() && now == self.stamp {
            return Ok(());
        }
        let mut hashed = Hashed::new(open(self.setting)?);
        let read = std::io::copy(&mut hashed, &mut std::io::sink());
        read.map_err(|error| Failure::input(format!("the program cannot be read: {error}")))?;
        self.refuse_if_other(&hashed.sha256())?;
        self.stamp = now;
        Ok(())
    }

    /// Refuses contents of another hash than that of the survey.
    pub(crate) fn refuse_if_other(&self, sha256: &str) -> Answer<()> {
        let known = self.setting.program_files.first();
        if known.is_none_or(|file| file.sha256 == sha256) {
            return Ok(());
        }
        Err(self.setting.within(Failure::input(
            "the program is another one than when the run began: its file was changed meanwhile, and nothing is written; give --restart to begin anew with the new program",
        )))
    }
}

fn stamp(path: &Path) -> Option<(u64, SystemTime)> {
    let found = std::fs::metadata(path).ok()?;
    Some((found.len(), found.modified().ok()?))
}
