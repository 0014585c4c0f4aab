//! Recovery after an abrupt end (kill -9, a power cut): files left in a directory, and their treatment by the next run.
//!
//! A run that writes keeps one journal in each directory that it writes to, locked as long as the
//! run lives; its unfinished files carry the journal's name. Before the first file is put in place
//! the journal gets a list of all of them with their contents as length and check number. The next
//! run in that directory removes the unfinished files of runs that are dead, and where only some of
//! the listed files have their new contents, it names them: they do not belong together.

use std::fs;
use std::fs::{File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use tempfile::{NamedTempFile, TempPath};

use crate::files::hash::{FNV1A, fnv1a};
use crate::files::paths::{parent_of, same_place};
use crate::ui::safe_text::safe;

/// Beginning of the names of all files that are not outputs.
const OURS: &str = ".kinetostat-";

const JOURNAL: &str = ".journal";

const PART: &str = ".part";

const KEPT: &str = ".kept";

/// Largest journal that is read.
const MOST_BYTES: u64 = 1 << 20;

/// Files of this process that are no outputs, for a second Ctrl-C that does not wait.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes what an impatient end would leave.
pub(crate) fn remove_temporary() {
    if let Ok(list) = TEMPORARY.try_lock() {
        for path in list.iter() {
            let _ = fs::remove_file(path);
        }
    }
}

fn remember(path: &Path) {
    if let Ok(mut list) = TEMPORARY.lock() {
        list.push(path.to_owned());
    }
}

/// Length and FNV-1a check number of the bytes so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Contents {
    pub(crate) bytes: u64,
    pub(crate) fnv1a: u64,
}

impl Default for Contents {
    fn default() -> Self {
        Self {
            bytes: 0,
            fnv1a: FNV1A,
        }
    }
}

impl Contents {
    pub(crate) fn append(&mut self, bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        self.fnv1a = fnv1a(self.fnv1a, bytes);
    }

    /// True if a file has exactly these bytes.
    pub(crate) fn are_in(self, path: &Path) -> bool {
        let same_length =
            fs::symlink_metadata(path).is_ok_and(|m| m.is_file() && m.len() == self.bytes);
        let Some(mut file) = same_length.then(|| File::open(path).ok()).flatten() else {
            return false;
        };
        let mut found = Self::default();
        let mut block = vec![0; 1 << 16];
        loop {
            match file.read(&mut block) {
                Ok(0) => return found == self,
                Ok(count) => found.append(&block[..count]),
                Err(_) => return false,
            }
        }
    }
}

/// An output that is about to be put in place.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Entry {
    /// File name if it is in the journal's directory, else the whole path.
    #[serde(with = "any_path")]
    pub(crate) path: PathBuf,
    pub(crate) contents: Contents,
}

/// Paths as text; those that are no UTF-8, which a disk may have and JSON has not, as their bytes.
mod any_path {
    use std::path::{Path, PathBuf};

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum Written {
        Text(String),
        Bytes(Vec<u8>),
    }

    pub(super) fn serialize<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
        let written = match path.to_str() {
            Some(text) => Written::Text(text.to_owned()),
            None => Written::Bytes(path.as_os_str().as_encoded_bytes().to_vec()),
        };
        written.serialize(to)
    }

    pub(super) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<PathBuf, D::Error> {
        Ok(match Written::deserialize(from)? {
            Written::Text(text) => text.into(),
            #[cfg(unix)]
            Written::Bytes(bytes) => {
                use std::os::unix::ffi::OsStringExt;
                std::ffi::OsString::from_vec(bytes).into()
            }
            #[cfg(not(unix))]
            Written::Bytes(bytes) => String::from_utf8_lossy(&bytes).into_owned().into(),
        })
    }
}

impl Entry {
    pub(crate) fn new(target: &Path, contents: Contents) -> Self {
        Self {
            path: target.to_owned(),
            contents,
        }
    }

    /// True if it is this file, with exactly these contents.
    pub(crate) fn is_in_place(&self, target: &Path) -> bool {
        same_place(&self.path, target) && self.contents.are_in(target)
    }

    /// Returns the entry as seen from a directory.
    pub(crate) fn seen_from(&self, directory: &Path) -> Self {
        let whole = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let parent = whole(&parent_of(&self.path));
        let path = match self.path.file_name() {
            Some(name) if parent == whole(directory) => PathBuf::from(name),
            Some(name) => parent.join(name),
            None => self.path.clone(),
        };
        Self {
            path,
            contents: self.contents,
        }
    }
}

/// The journal of this run in one directory.
pub(crate) struct Journal {
    pub(crate) directory: PathBuf,
    pub(crate) file: NamedTempFile,
    pub(crate) name: String,
    pub(crate) count: usize,
}

impl Journal {
    /// Begins a journal and locks it.
    pub(crate) fn begin(directory: &Path) -> std::io::Result<Self> {
        // Another run may take the new file for one of a dead run before it is locked.
        for _ in 0..20 {
            let file = tempfile::Builder::new()
                .prefix(OURS)
                .suffix(JOURNAL)
                .tempfile_in(directory)?;
            match file.as_file().try_lock() {
                Err(TryLockError::WouldBlock) => continue,
                // A disk without locks: the files of runs that were killed stay there.
                Err(TryLockError::Error(_)) | Ok(()) => {}
            }
            if !still_there(&file) {
                continue;
            }
            remember(file.path());
            let name = file.path().file_name().unwrap_or_default();
            let name = name.to_string_lossy();
            return Ok(Self {
                directory: directory.to_owned(),
                name: name.strip_suffix(JOURNAL).unwrap_or(&name).to_owned(),
                file,
                count: 0,
            });
        }
        Err(std::io::Error::other(
            "another program removes the files that are made there",
        ))
    }

    pub(crate) fn next(&mut self, ending: &str) -> PathBuf {
        self.count += 1;
        self.directory
            .join(format!("{}-{}{ending}", self.name, self.count))
    }

    /// A file that becomes an output.
    pub(crate) fn part(&mut self) -> std::io::Result<NamedTempFile> {
        let path = self.next(PART);
        let mut options = File::options();
        options.read(true).write(true).create_new(true);
        // The mode is left to the umask, as for any file of a program.
        let file = options.open(&path)?;
        remember(&path);
        Ok(NamedTempFile::from_parts(
            file,
            TempPath::try_from_path(path)?,
        ))
    }

    /// A second name of the file as it is now; a copy where the disk knows no second names.
    pub(crate) fn keep(&mut self, target: &Path) -> std::io::Result<TempPath> {
        let path = self.next(KEPT);
        if fs::hard_link(target, &path).is_err() {
            fs::copy(target, &path)?;
        }
        remember(&path);
        TempPath::try_from_path(path)
    }

    /// Writes what is about to be put in place, before the first of it is.
    pub(crate) fn list(&mut self, outputs: &[Entry]) -> std::io::Result<()> {
        let seen: Vec<Entry> = outputs
            .iter()
            .map(|entry| entry.seen_from(&self.directory))
            .collect();
        let text = serde_json::to_vec_pretty(&seen).map_err(std::io::Error::other)?;
        let file = self.file.as_file_mut();
        file.write_all(&text)?;
        file.sync_all()
    }
}

/// Forgets the temporary files: those left are outputs.
pub(crate) fn done() {
    if let Ok(mut list) = TEMPORARY.lock() {
        list.clear();
    }
}

/// True if an open file still has its name.
fn still_there(file: &NamedTempFile) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        match (file.as_file().metadata(), fs::symlink_metadata(file.path())) {
            (Ok(open), Ok(named)) => open.dev() == named.dev() && open.ino() == named.ino(),
            _ => false,
        }
    }
    #[cfg(not(unix))]
    file.path().exists()
}

/// The journal's name, without its ending, of a file that a run made beside its outputs.
fn run_of(name: &str) -> Option<&str> {
    let rest = name.strip_prefix(OURS)?;
    if let Some(run) = rest.strip_suffix(JOURNAL) {
        return plain(run).then(|| &name[..OURS.len() + run.len()]);
    }
    let rest = [PART, KEPT].iter().find_map(|e| rest.strip_suffix(e))?;
    let (run, count) = rest.split_once('-')?;
    let counted = !count.is_empty() && count.bytes().all(|b| b.is_ascii_digit());
    (plain(run) && counted).then(|| &name[..OURS.len() + run.len()])
}

fn plain(run: &str) -> bool {
    !run.is_empty() && run.bytes().all(|b| b.is_ascii_alphanumeric())
}

/// Removes what dead runs left in a directory; what is said of files that do not belong together.
pub(crate) fn tidy(directory: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(directory) else {
        return Vec::new();
    };
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| run_of(name).is_some())
        .collect();
    names.sort();
    let mut runs: Vec<String> = names
        .iter()
        .filter_map(|name| run_of(name).map(str::to_owned))
        .collect();
    runs.dedup();
    let mut notes = Vec::new();
    for run in runs {
        let path = directory.join(format!("{run}{JOURNAL}"));
        // Opened by its name now: a run that lives had its journal before any other file.
        let journal = match File::open(&path) {
            Ok(file) => match file.try_lock() {
                Ok(()) => Some(file),
                // The owner is alive, or the disk has no locks.
                Err(_) => continue,
            },
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(_) => continue,
        };
        for name in names.iter().filter(|n| run_of(n) == Some(&run)) {
            if !name.ends_with(JOURNAL) {
                let _ = fs::remove_file(directory.join(name));
            }
        }
        let Some(journal) = journal else { continue };
        match apart(directory, journal) {
            Some(reported) => notes.push(format!(
                "{reported} (this is said until it is settled; '{}' can be removed then)",
                safe(&path.display().to_string())
            )),
            None => drop(fs::remove_file(&path)),
        }
    }
    notes
}

/// Message if a dead run has put only some of its files in place.
fn apart(directory: &Path, journal: File) -> Option<String> {
    let mut text = String::new();
    journal.take(MOST_BYTES).read_to_string(&mut text).ok()?;
    // A journal without a whole list: nothing had been put in place.
    let outputs: Vec<Entry> = serde_json::from_str(&text).ok()?;
    let (new, old): (Vec<&Entry>, Vec<&Entry>) = outputs
        .iter()
        .partition(|entry| entry.contents.are_in(&directory.join(&entry.path)));
    if new.is_empty() || old.is_empty() {
        return None;
    }
    let list = |entries: &[&Entry]| {
        let names: Vec<String> = entries
            .iter()
            .map(|entry| {
                let path = directory.join(&entry.path);
                let missing = match path.exists() {
                    true => "",
                    false => " (missing)",
                };
                format!("'{}'{missing}", safe(&path.display().to_string()))
            })
            .collect();
        names.join(", ")
    };
    Some(format!(
        "an earlier run was killed while it put its files in place, and they do not belong together: new are {}; from another time are {}. Run it again with --force-overwrite, or remove them",
        list(&new),
        list(&old),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_not_ours_are_left() {
        for ours in [
            ".kinetostat-a1B2c3.journal",
            ".kinetostat-a1B2c3-1.part",
            ".kinetostat-a1B2c3-12.kept",
        ] {
            assert_eq!(run_of(ours), Some(".kinetostat-a1B2c3"), "{ours}");
        }
        for other in [
            "a.part",
            ".a.ngc.x1.part",
            ".kinetostat.part",
            ".kinetostat-.journal",
            ".kinetostat-notes.txt",
            ".kinetostat-a1-b.part",
            ".kinetostat-a1-.part",
            ".kinetostat-a 1-2.part",
            "kinetostat-a1-2.part",
        ] {
            assert_eq!(run_of(other), None, "{other}");
        }
    }

    #[test]
    fn a_living_run_keeps_its_files_and_a_dead_one_does_not() {
        let here = tempfile::tempdir().unwrap();
        let count = || fs::read_dir(here.path()).unwrap().count();
        let mut living = Journal::begin(here.path()).unwrap();
        let part = living.part().unwrap();
        fs::write(here.path().join("old"), "old").unwrap();
        let kept = living.keep(&here.path().join("old")).unwrap();
        assert_eq!(count(), 4);
        assert!(tidy(here.path()).is_empty());
        assert_eq!(count(), 4);
        // The files remain without a lock, as after kill -9.
        let (_, part) = part.keep().unwrap();
        let kept = kept.keep().unwrap();
        let (file, journal) = living.file.keep().unwrap();
        drop(file);
        assert!(part.exists() && kept.exists() && journal.exists());
        assert!(tidy(here.path()).is_empty());
        assert_eq!(count(), 1, "only the file called old");
    }

    /// A disk has names that are no text.
    #[test]
    #[cfg(unix)]
    fn any_name_is_listed_and_read_again() {
        use std::os::unix::ffi::OsStringExt;
        for name in [
            &b"part.ngc"[..],
            b"geh\xe4use.ngc",
            "geh\u{e4}use".as_bytes(),
        ] {
            let path = PathBuf::from(std::ffi::OsString::from_vec(name.to_vec()));
            let text = serde_json::to_string(&Entry::new(&path, Contents::default())).unwrap();
            let read: Entry = serde_json::from_str(&text).unwrap();
            assert_eq!(read.path, path, "{text}");
        }
    }

    /// Every state that a kill between renames can leave is named until it is settled.
    #[test]
    fn files_that_do_not_belong_together_are_named() {
        let outputs = ["a.ngc", "b.html", "c.json"];
        for in_place in 0..=outputs.len() {
            for before in [true, false] {
                let here = tempfile::tempdir().unwrap();
                let mut entries = Vec::new();
                for name in outputs {
                    let mut contents = Contents::default();
                    contents.append(b"new ");
                    contents.append(name.as_bytes());
                    let path = here.path().join(name);
                    if before {
                        fs::write(&path, format!("old {name}")).unwrap();
                    }
                    entries.push(Entry::new(&path, contents));
                }
                let mut journal = Journal::begin(here.path()).unwrap();
                journal.list(&entries).unwrap();
                for name in &outputs[..in_place] {
                    fs::write(here.path().join(name), format!("new {name}")).unwrap();
                }
                drop(journal.file.keep().unwrap());
                let mixed = in_place > 0 && in_place < outputs.len();
                for _ in 0..2 {
                    let notes = tidy(here.path());
                    assert_eq!(notes.len(), usize::from(mixed), "{notes:?}");
                    for (i, name) in outputs.iter().enumerate() {
                        let at = |text: &str| notes.first().and_then(|n| n.find(text));
                        let Some(old) = at("from another time") else {
                            continue;
                        };
                        assert_eq!(at(name).unwrap() < old, i < in_place, "{notes:?}");
                    }
                }
                for name in outputs {
                    fs::write(here.path().join(name), format!("later {name}")).unwrap();
                }
                assert!(tidy(here.path()).is_empty());
                assert_eq!(fs::read_dir(here.path()).unwrap().count(), outputs.len());
            }
        }
    }
}
