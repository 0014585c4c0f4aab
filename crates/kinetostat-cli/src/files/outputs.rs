//! Files that a command writes: all of them are written beside their targets first, and only then
//! renamed into place, so that a failure leaves none. Nothing is overwritten without leave, an
//! input never, and no link is followed. What a killed run left there is removed or named (see
//! `journal`).

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use tempfile::NamedTempFile;

use crate::files::journal::{self, Contents, Entry, Journal};
use crate::files::paths::{is_own_folder, parent_of, same_bytes, same_file, same_place};
use crate::files::standard_input;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::progress::still_wanted;
use crate::ui::safe_text::safe;
use crate::ui::system_error::description;
use crate::ui::{layout, screen};

/// Policy for an output that exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Existing {
    /// Leave it and say so.
    Refuse,
    /// `--force-overwrite`.
    Replace,
    /// The demo may run twice: a file with the very same bytes is left as it is.
    KeepSame,
}

impl Existing {
    /// Policy by the option `--force-overwrite`.
    pub(crate) fn forced(force_overwrite: bool) -> Self {
        match force_overwrite {
            true => Self::Replace,
            false => Self::Refuse,
        }
    }
}

/// A target that has been found writable, with its temporary file.
struct Claimed {
    what: &'static str,
    target: PathBuf,
    file: NamedTempFile,
    contents: Contents,
    identical: bool,
    /// Index of the journal of its directory.
    journal: usize,
    /// Policy if the target exists.
    existing: Existing,
}

impl Claimed {
    fn refused(&self, error: &std::io::Error) -> Failure {
        ErrorCode::Output.failure(format!(
            "the {} cannot be written to '{}': {}; no output was changed",
            self.what,
            self.target.display(),
            description(error)
        ))
    }
}

fn refused(what: &str, target: &Path, reason: &str) -> Failure {
    ErrorCode::Output.failure(format!(
        "the {what} cannot be written to '{}': {reason}",
        target.display()
    ))
}

/// Refuses a target that is an input, another output or a link, or whose directory is missing. The policy for
/// existing files is checked elsewhere.
pub(crate) fn may_be_written(
    what: &str,
    target: &Path,
    inputs: &[PathBuf],
    others: &[(&'static str, &Path)],
) -> Answer<()> {
    let refuse = |reason: &str| refused(what, target, reason);
    if target.file_name().is_none() {
        return Err(refuse("this is no file name; name a file"));
    }
    let parent = parent_of(target);
    match fs::metadata(&parent) {
        Ok(found) if !found.is_dir() => {
            return Err(refuse(&format!(
                "'{}' is a file, not a directory",
                parent.display()
            )));
        }
        Ok(_) => {}
        Err(error)
            if error.kind() == ErrorKind::NotFound
                && is_own_folder(&parent)
                && parent_of(&parent).is_dir() => {}
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
                description(&error)
            )));
        }
    }
    for input in inputs {
        if same_file(input, target) {
            return Err(refuse(&format!(
                "it is the same file as the input '{}'; inputs are never overwritten, choose another name",
                input.display()
            )));
        }
    }
    if let Some((other, _)) = others
        .iter()
        .find(|(_, path)| same_file(path, target) || same_place(path, target))
    {
        return Err(refuse(&format!(
            "the {other} goes there too; choose different names"
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
        Ok(_) => {}
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(refuse(&description(&error))),
    }
    Ok(())
}

/// The outputs of one command.
pub(crate) struct Outputs {
    existing: Existing,
    inputs: Vec<PathBuf>,
    claimed: Vec<Claimed>,
    /// One in each directory that is written to; they end after the files above.
    journals: Vec<Journal>,
    /// Outputs that an earlier run of the same question was putting in place when it ended.
    own: Vec<Entry>,
    /// Folders that were made for outputs.
    made: Vec<MadeFolder>,
}

/// A folder that was made for an output; dropped, it is removed if nothing was put into it.
struct MadeFolder(PathBuf);

impl Drop for MadeFolder {
    fn drop(&mut self) {
        // A folder with files in it stays.
        let _ = fs::remove_dir(&self.0);
    }
}

impl Outputs {
    pub(crate) fn new(existing: Existing, inputs: Vec<PathBuf>) -> Self {
        Self {
            existing,
            inputs,
            claimed: Vec::new(),
            journals: Vec::new(),
            own: Vec::new(),
            made: Vec::new(),
        }
    }

    /// Files that hold just these contents are those of an earlier run that ended while it put them in place: they may be replaced.
    pub(crate) fn going_on_with(self, own: Vec<Entry>) -> Self {
        Self { own, ..self }
    }

    /// Entries that are about to be put in place.
    pub(crate) fn entries(&self) -> Vec<Entry> {
        let all = self.claimed.iter();
        all.map(|c| Entry::new(&c.target, c.contents)).collect()
    }

    /// Checks a target before the long work begins: it may be written, and it is no input.
    pub(crate) fn claim(&mut self, what: &'static str, target: &Path) -> Answer<usize> {
        self.claim_as(what, target, self.existing)
    }

    /// Claims a file that continues from run to run: it is replaced.
    pub(crate) fn claim_to_go_on(&mut self, what: &'static str, target: &Path) -> Answer<usize> {
        self.claim_as(what, target, Existing::Replace)
    }

    fn claim_as(&mut self, what: &'static str, target: &Path, existing: Existing) -> Answer<usize> {
        let others: Vec<(&'static str, &Path)> = self
            .claimed
            .iter()
            .map(|c| (c.what, c.target.as_path()))
            .collect();
        if standard_input::is_name_of(target) {
            return Err(ErrorCode::Missing.failure(format!(
                "the {what} has no name of its own, since the program is read from standard input; name it by its option, such as --out FILE"
            )));
        }
        may_be_written(what, target, &self.inputs, &others)?;
        let refuse = |reason: &str| refused(what, target, reason);
        let is_own = |entry: &Entry| entry.is_in_place(target);
        let existing = match existing {
            Existing::Refuse if self.own.iter().any(is_own) => Existing::Replace,
            existing => existing,
        };
        let parent = parent_of(target);
        if !parent.exists() {
            fs::create_dir(&parent).map_err(|error| refuse(&description(&error)))?;
            self.made.push(MadeFolder(parent.clone()));
        }
        let journal = self.journal(&parent);
        if existing == Existing::Refuse && fs::symlink_metadata(target).is_ok() {
            return Err(refuse(
                "it exists already; choose another name, or allow it with --force-overwrite",
            ));
        }
        let (journal, file) = journal
            .and_then(|index| Ok((index, self.journals[index].part()?)))
            .map_err(|error| refuse(&description(&error)))?;
        self.claimed.push(Claimed {
            what,
            target: target.to_owned(),
            file,
            contents: Contents::default(),
            identical: false,
            journal,
            existing,
        });
        Ok(self.claimed.len() - 1)
    }

    /// The journal of a directory; with the first output there, what dead runs left is put in order.
    pub(crate) fn journal(&mut self, directory: &Path) -> std::io::Result<usize> {
        let known = |j: &Journal| same_file(&j.directory, directory);
        if let Some(index) = self.journals.iter().position(known) {
            return Ok(index);
        }
        for note in journal::tidy(directory) {
            // Text for people beside the answer: it is no reason to end.
            let _ = screen::print(
                screen::Stream::Err,
                &layout::wrapped(&format!("warning: {note}"), 0),
            );
        }
        self.journals.push(Journal::begin(directory)?);
        Ok(self.journals.len() - 1)
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
        claimed.contents.append(bytes);
        written.map_err(|error| claimed.refused(&error))
    }

    /// All bytes of a claimed output are there.
    pub(crate) fn complete(&mut self, index: usize) -> Answer<()> {
        let claimed = &mut self.claimed[index];
        let existing = claimed.existing;
        let kept = claimed.file.as_file_mut().sync_all();
        kept.map_err(|error| claimed.refused(&error))?;
        if existing == Existing::KeepSame
            && let Some(same) = same_bytes(claimed.file.path(), &claimed.target)
        {
            claimed.identical = same;
            if !same {
                return Err(ErrorCode::Output.failure(format!(
                        "'{}' exists already and differs from what would be written; choose another directory with --out, or allow it with --force-overwrite",
                        claimed.target.display()
                    ),
                ));
            }
        }
        Ok(())
    }

    /// Renames all outputs into place. If one cannot be, those before it are taken back.
    pub(crate) fn commit(self) -> Answer<Vec<PathBuf>> {
        still_wanted()?;
        let mut journals = self.journals;
        let entries: Vec<Entry> = self
            .claimed
            .iter()
            .filter(|c| !c.identical)
            .map(|c| Entry::new(&c.target, c.contents))
            .collect();
        // One rename is whole or not at all; with several a kill between them must be seen later.
        if entries.len() > 1 {
            for journal in &mut journals {
                journal.list(&entries).map_err(|error| {
                    ErrorCode::Output.failure(format!(
                        "nothing can be written to '{}': {}; no output was changed",
                        journal.directory.display(),
                        description(&error)
                    ))
                })?;
            }
        }
        let mut done: Vec<(PathBuf, Option<tempfile::TempPath>)> = Vec::new();
        for claimed in self.claimed {
            if claimed.identical {
                done.push((claimed.target, None));
                continue;
            }
            let (target, what) = (claimed.target.clone(), claimed.what);
            let replace = claimed.existing == Existing::Replace;
            match put_in_place(claimed, replace, &mut journals) {
                Ok(kept) => done.push((target, kept)),
                Err(error) => {
                    take_back(done);
                    return Err(ErrorCode::Output.failure(format!(
                        "the {what} cannot be put in place as '{}': {}; no output was changed",
                        target.display(),
                        description(&error)
                    )));
                }
            }
        }
        let paths: Vec<PathBuf> = done.iter().map(|(path, _)| path.clone()).collect();
        for path in &paths {
            // A rename is on disk once its directory is.
            if let Ok(directory) = fs::File::open(parent_of(path)) {
                let _ = directory.sync_all();
            }
        }
        // The old files go before the journals that name them.
        drop(done);
        for journal in journals {
            let directory = journal.directory.clone();
            drop(journal);
            // Outputs that an earlier run left incomplete may be complete now.
            drop(journal::tidy(&directory));
        }
        journal::done();
        Ok(paths)
    }
}

/// Renames one output; the file that it replaces stays reachable under a second name.
fn put_in_place(
    claimed: Claimed,
    replace: bool,
    journals: &mut [Journal],
) -> std::io::Result<Option<tempfile::TempPath>> {
    let target = &claimed.target;
    if !replace {
        claimed
            .file
            .persist_noclobber(target)
            .map_err(|e| e.error)?;
        return Ok(None);
    }
    let kept = match fs::symlink_metadata(target) {
        Ok(found) if found.is_file() => {
            like(&claimed.file, &found);
            Some(journals[claimed.journal].keep(target)?)
        }
        // Between the first look and now the name may have become a link.
        Ok(_) => {
            return Err(std::io::Error::other(
                "something else has taken its name meanwhile",
            ));
        }
        Err(_) => None,
    };
    claimed.file.persist(target).map_err(|e| e.error)?;
    Ok(kept)
}

/// A file that is overwritten keeps who may read and write it.
fn like(file: &NamedTempFile, old: &fs::Metadata) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
        // The group first: a change of it takes rights away. Not everyone may give a file to it.
        let kept = fchown(file.as_file(), None, Some(old.gid())).is_ok();
        let all = old.permissions().mode() & 0o777;
        // Rights of the old group are not for another one.
        let mode = if kept { all } else { all & 0o707 };
        let _ = file
            .as_file()
            .set_permissions(fs::Permissions::from_mode(mode));
    }
    #[cfg(not(unix))]
    let _ = file.as_file().set_permissions(old.permissions());
}

/// Puts the old files back, the last first.
fn take_back(done: Vec<(PathBuf, Option<tempfile::TempPath>)>) {
    for (path, kept) in done.into_iter().rev() {
        match kept {
            Some(kept) => drop(kept.persist(&path)),
            None => drop(fs::remove_file(&path)),
        }
    }
}

/// Files that were written, one a line.
pub(crate) fn written(paths: &[PathBuf]) -> String {
    if paths.is_empty() {
        return String::new();
    }
    let mut out = String::from("\nWritten\n");
    for path in paths {
        out.push_str(&format!("  {}\n", safe(&path.display().to_string())));
    }
    out
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
}
