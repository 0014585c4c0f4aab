//! An output that grows part by part, and is cut back to what is known to be whole.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::PathBuf;

use kinetostat_diagnostic::ErrorCode;

use crate::files::journal::Contents;
use crate::long::checkpoint::not_kept;
use crate::ui::failure::{Answer, Failing};

/// An output that grows part by part.
pub(crate) struct Partial {
    path: PathBuf,
    file: File,
    contents: Contents,
}

impl Partial {
    /// An empty one.
    pub(crate) fn create(path: PathBuf) -> Answer<Self> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(true)
            .open(&path)
            .map_err(|error| not_kept(&path, &error))?;
        Ok(Self {
            path,
            file,
            contents: Contents::default(),
        })
    }

    /// Opens a file that begins with these contents, and cuts off the rest; `None` if it does not.
    pub(crate) fn reopen(path: PathBuf, contents: Contents) -> Option<Self> {
        let mut file = OpenOptions::new().read(true).write(true).open(&path).ok()?;
        let mut found = Contents::default();
        let mut rest = contents.bytes;
        let mut block = vec![0; 1 << 16];
        while rest > 0 {
            let most = block.len().min(usize::try_from(rest).unwrap_or(usize::MAX));
            let count = file.read(&mut block[..most]).ok()?;
            if count == 0 {
                return None;
            }
            found.append(&block[..count]);
            rest -= count as u64;
        }
        if found != contents {
            return None;
        }
        file.set_len(contents.bytes).ok()?;
        file.seek(SeekFrom::End(0)).ok()?;
        Some(Self {
            path,
            file,
            contents,
        })
    }

    /// Contents so far.
    pub(crate) fn contents(&self) -> Contents {
        self.contents
    }

    pub(crate) fn append(&mut self, bytes: &[u8]) -> Answer<()> {
        let written = self.file.write_all(bytes);
        written.map_err(|error| not_kept(&self.path, &error))?;
        self.contents.append(bytes);
        Ok(())
    }

    /// All that was appended is on the disk.
    pub(crate) fn sync(&self) -> Answer<()> {
        let done = self.file.sync_data();
        done.map_err(|error| not_kept(&self.path, &error))
    }

    /// Reader of the bytes from the beginning.
    pub(crate) fn reader(&self) -> Answer<BufReader<File>> {
        let file = File::open(&self.path);
        Ok(BufReader::new(
            file.map_err(|error| not_kept(&self.path, &error))?,
        ))
    }

    /// Reader that compares the bytes with those written.
    pub(crate) fn watched(&self) -> Answer<Watched> {
        Ok(Watched {
            from: self.reader()?,
            found: Contents::default(),
            written: self.contents,
        })
    }
}

/// Reads a partial output to its end, and knows whether these were the bytes that had been written.
pub(crate) struct Watched {
    from: BufReader<File>,
    found: Contents,
    written: Contents,
}

impl Read for Watched {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let count = self.from.read(to)?;
        self.found.append(&to[..count]);
        Ok(count)
    }
}

impl Watched {
    /// Refuses bytes that had not been written, once they are read to the end: something else may have written there.
    pub(crate) fn refuse_if_changed(&self) -> Answer<()> {
        match self.found == self.written {
            true => Ok(()),
            false => Err(ErrorCode::Checkpoint.failure("what was kept of the run was changed by something else: give --restart to begin anew",
            )),
        }
    }
}
