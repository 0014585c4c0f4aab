//! Files that a command writes: all of them are written beside their targets first, and only then
//! renamed into place, so that a failure leaves none. Nothing is overwritten without leave, an
//! input never, and no link is followed.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::Mutex;

use tempfile::NamedTempFile;

use crate::failure::{Answer, Failure};

/// What to do about an output that exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Existing {
    /// Leave it and say so.
    Refuse,
    /// `--force-overwrite`.
    Replace,
    /// The demo may run twice: a file with the very same bytes is left as it is.
    KeepSame,
}

/// A target that has been found writable, with its temporary file.
struct Claimed {
    what: &'static str,
    target: PathBuf,
    file: NamedTempFile,
    identical: bool,
}

impl Claimed {
    fn refused(&self, error: &std::io::Error) -> Failure {
        Failure::input(format!(
            "the {} cannot be written to '{}': {}; no output was changed",
            self.what,
            self.target.display(),
            in_words(error)
        ))
    }
}

/// The outputs of one command.
pub(crate) struct Outputs {
    existing: Existing,
    inputs: Vec<PathBuf>,
    claimed: Vec<Claimed>,
}

/// Temporary files of this process, for a second Ctrl-C that does not wait.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes what an impatient end would leave.
pub(crate) fn remove_temporary() {
    if let Ok(list) = TEMPORARY.try_lock() {
        for path in list.iter() {
            let _ = fs::remove_file(path);
        }
    }
}

impl Outputs {
    pub(crate) fn new(existing: Existing, inputs: Vec<PathBuf>) -> Self {
        Self {
            existing,
            inputs,
            claimed: Vec::new(),
        }
    }

    /// Checks a target before the long work begins: it may be written, and it is no input.
    pub(crate) fn claim(&mut self, what: &'static str, target: &Path) -> Answer<usize> {
        let refuse = |reason: &str| {
            Failure::input(format!(
                "the {what} cannot be written to '{}': {reason}",
                target.display()
            ))
        };
        let Some(name) = target.file_name() else {
            return Err(refuse("this is no file name; name a file"));
        };
        let parent = parent_of(target);
        match fs::metadata(&parent) {
            Ok(found) if !found.is_dir() => {
                return Err(refuse(&format!(
                    "'{}' is a file, not a directory",
                    parent.display()
                )));
            }
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(refuse(&format!(
                    "the directory '{}' does not exist; create it first",
                    parent.display()
                )));
            }
            Err(error) => {
                return Err(refuse(&format!(
                    "the directory '{}' cannot be looked at: {}",
                    parent.display(),
                    in_words(&error)
                )));
            }
        }
        for input in &self.inputs {
            if same_file(input, target) {
                return Err(refuse(&format!(
                    "it is the same file as the input '{}'; inputs are never overwritten, choose another name",
                    input.display()
                )));
            }
        }
        if let Some(other) = self
            .claimed
            .iter()
            .find(|c| same_file(&c.target, target) || same_place(&c.target, target))
        {
            return Err(refuse(&format!(
                "the {} goes there too; choose different names",
                other.what
            )));
        }
        match fs::symlink_metadata(target) {
            Ok(found) if found.file_type().is_symlink() => {
                return Err(refuse(
                    "it is a symbolic link, and outputs do not follow links; name the file itself or remove the link",
                ));
            }
            Ok(found) if found.is_dir() => {
                return Err(refuse("it is a directory; name a file in it"));
            }
            Ok(found) if !found.is_file() => {
                return Err(refuse("it is a device or a pipe, not a file"));
            }
            Ok(_) if self.existing == Existing::Refuse => {
                return Err(refuse(
                    "it exists already; choose another name, or allow it with --force-overwrite",
                ));
            }
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(refuse(&in_words(&error))),
        }
        let file = temporary(&parent, name).map_err(|error| refuse(&in_words(&error)))?;
        self.claimed.push(Claimed {
            what,
            target: target.to_owned(),
            file,
            identical: false,
        });
        Ok(self.claimed.len() - 1)
    }

    /// Writes the bytes of a claimed output beside its target.
    pub(crate) fn fill(&mut self, index: usize, bytes: &[u8]) -> Answer<()> {
        self.append(index, bytes)?;
        self.complete(index)
    }

    /// Writes the next bytes of a claimed output beside its target; [`Self::complete`] follows the
    /// last ones.
    pub(crate) fn append(&mut self, index: usize, bytes: &[u8]) -> Answer<()> {
        let claimed = &mut self.claimed[index];
        let written = claimed.file.as_file_mut().write_all(bytes);
        written.map_err(|error| claimed.refused(&error))
    }

    /// All bytes of a claimed output are there.
    pub(crate) fn complete(&mut self, index: usize) -> Answer<()> {
        let existing = self.existing;
        let claimed = &mut self.claimed[index];
        let kept = claimed.file.as_file_mut().sync_all();
        kept.map_err(|error| claimed.refused(&error))?;
        if existing == Existing::KeepSame
            && let Some(same) = same_bytes(claimed.file.path(), &claimed.target)
        {
            claimed.identical = same;
            if !same {
                return Err(Failure::input(format!(
                    "'{}' exists already and differs from what would be written; choose another directory with --out, or allow it with --force-overwrite",
                    claimed.target.display()
                )));
            }
        }
        Ok(())
    }

    /// Renames all outputs into place. If one cannot be, those before it are taken back.
    pub(crate) fn commit(self) -> Answer<Vec<PathBuf>> {
        let replace = self.existing == Existing::Replace;
        let mut done: Vec<(PathBuf, Option<tempfile::TempPath>)> = Vec::new();
        for claimed in self.claimed {
            if claimed.identical {
                done.push((claimed.target, None));
                continue;
            }
            let (target, what) = (claimed.target, claimed.what);
            // The old file stays reachable under a second name until all is done.
            let kept = match fs::symlink_metadata(&target) {
                Ok(found) if replace && found.is_file() => keep(&target).map(Some),
                _ => Ok(None),
            };
            let (kept, ready) = match kept {
                Ok(kept) => (kept, Ok(())),
                Err(error) => (None, Err(error)),
            };
            let result = if ready.is_err() {
                ready
            } else if replace {
                // Between the first look and now the name may have become a link.
                match fs::symlink_metadata(&target) {
                    Ok(found) if !found.is_file() => Err(std::io::Error::other(
                        "something else has taken its name meanwhile",
                    )),
                    _ => claimed.file.persist(&target).map(drop).map_err(|e| e.error),
                }
            } else {
                claimed
                    .file
                    .persist_noclobber(&target)
                    .map(drop)
                    .map_err(|e| e.error)
            };
            if let Err(error) = result {
                for (path, kept) in done.into_iter().rev() {
                    match kept {
                        Some(kept) => drop(kept.persist(&path)),
                        None => drop(fs::remove_file(&path)),
                    }
                }
                return Err(Failure::input(format!(
                    "the {what} cannot be put in place as '{}': {}; no output was changed",
                    target.display(),
                    in_words(&error)
                )));
            }
            done.push((target, kept));
        }
        let paths: Vec<PathBuf> = done.into_iter().map(|(path, _)| path).collect();
        for path in &paths {
            // A rename is on disk once its directory is.
            if let Ok(directory) = fs::File::open(parent_of(path)) {
                let _ = directory.sync_all();
            }
        }
        if let Ok(mut list) = TEMPORARY.lock() {
            list.clear();
        }
        Ok(paths)
    }
}

/// Whether two files hold the same, if both can be read.
fn same_bytes(one: &Path, other: &Path) -> Option<bool> {
    Some(fs::read(one).ok()? == fs::read(other).ok()?)
}

fn parent_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn temporary(parent: &Path, name: &std::ffi::OsStr) -> std::io::Result<NamedTempFile> {
    let prefix = format!(".{}.", name.to_string_lossy());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any file that a program makes: the umask decides.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(parent)?;
    if let Ok(mut list) = TEMPORARY.lock() {
        list.push(file.path().to_owned());
    }
    Ok(file)
}

/// A second name of the file as it is now; a copy where the disk knows no second names.
fn keep(target: &Path) -> std::io::Result<tempfile::TempPath> {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let path = parent_of(target).join(format!(".{name}.{}.kept", std::process::id()));
    if fs::hard_link(target, &path).is_err() {
        fs::copy(target, &path)?;
    }
    tempfile::TempPath::try_from_path(path)
}

/// The same file under two names: links of either kind included.
pub(crate) fn same_file(one: &Path, other: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        if let (Ok(a), Ok(b)) = (fs::metadata(one), fs::metadata(other)) {
            return a.dev() == b.dev() && a.ino() == b.ino();
        }
    }
    same_place(one, other)
}

/// The same name in the same directory, whether or not there is a file.
fn same_place(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let parent = fs::canonicalize(parent_of(path)).ok()?;
        Some(parent.join(path.file_name()?))
    };
    match (place(one), place(other)) {
        (Some(a), Some(b)) => a == b,
        _ => false,
    }
}

/// An output named by a job file: below the job's own directory and nowhere else.
pub(crate) fn inside(root: &Path, written: &str) -> Result<PathBuf, String> {
    let path = Path::new(written);
    let plain = path
        .components()
        .all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    // A drive letter or a backslash means a place elsewhere on another system.
    if !plain || written.contains('\\') || written.contains(':') || written.trim().is_empty() {
        return Err(
            "a job file writes only into its own directory and below: use a relative path without '..'; an option on the command line may name any place"
                .into(),
        );
    }
    let target = root.join(path);
    let (Ok(root), Ok(parent)) = (fs::canonicalize(root), fs::canonicalize(parent_of(&target)))
    else {
        // A missing directory is told when the output is claimed.
        return Ok(target);
    };
    if !parent.starts_with(&root) {
        return Err(format!(
            "a link leads out of the job's directory to '{}'",
            parent.display()
        ));
    }
    Ok(target)
}

/// An error of the system as a person would say it.
pub(crate) fn in_words(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file or directory".into(),
        ErrorKind::PermissionDenied => "you may not write there; choose another place".into(),
        ErrorKind::AlreadyExists => {
            "it exists already; choose another name, or allow it with --force-overwrite".into()
        }
        ErrorKind::StorageFull => "the disk is full; free some space or choose another disk".into(),
        ErrorKind::QuotaExceeded => "your share of the disk is used up".into(),
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only; choose another place".into(),
        ErrorKind::FileTooLarge => "the file would be larger than is allowed here".into(),
        ErrorKind::NotADirectory => "a part of the path is a file, not a directory".into(),
        ErrorKind::IsADirectory => "it is a directory; name a file".into(),
        ErrorKind::InvalidFilename => "the name is too long or not allowed here".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two outputs, the second of which cannot be put in place any more.
    fn fails_at_the_second(existing: Existing, before: Option<&str>) -> Option<String> {
        let here = tempfile::tempdir().unwrap();
        let (one, two) = (here.path().join("one"), here.path().join("two"));
        if let Some(text) = before {
            fs::write(&one, text).unwrap();
        }
        let mut outputs = Outputs::new(existing, Vec::new());
        for path in [&one, &two] {
            let index = outputs.claim("output", path).unwrap();
            outputs.fill(index, b"new").unwrap();
        }
        fs::create_dir(&two).unwrap();
        let failure = outputs.commit().unwrap_err();
        assert!(failure.plain.contains("no output was changed"));
        let left = fs::read_dir(here.path()).unwrap().count();
        assert_eq!(left, 1 + usize::from(before.is_some()));
        fs::read_to_string(&one).ok()
    }

    #[test]
    fn what_was_put_in_place_is_taken_back() {
        assert_eq!(fails_at_the_second(Existing::Refuse, None), None);
        assert_eq!(fails_at_the_second(Existing::Replace, None), None);
        let old = fails_at_the_second(Existing::Replace, Some("old"));
        assert_eq!(old.as_deref(), Some("old"));
    }

    #[test]
    fn outputs_dropped_unused_leave_nothing() {
        let here = tempfile::tempdir().unwrap();
        let mut outputs = Outputs::new(Existing::Refuse, Vec::new());
        let index = outputs.claim("output", &here.path().join("a")).unwrap();
        outputs.fill(index, b"text").unwrap();
        drop(outputs);
        assert_eq!(fs::read_dir(here.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_job_stays_in_its_directory() {
        let here = tempfile::tempdir().unwrap();
        for good in ["a.ngc", "./a.ngc", "sub/a.ngc", "a b.ngc", "größer.ngc"] {
            assert!(inside(here.path(), good).is_ok(), "{good}");
        }
        for bad in [
            "../a",
            "/a",
            "sub/../../a",
            "",
            " ",
            "C:\\a",
            "\\\\server\\a",
            "NUL:",
        ] {
            assert!(inside(here.path(), bad).is_err(), "{bad}");
        }
    }
}
