//! Paths: directories, the same file under two names, and places inside a directory.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::files::file_names::file_name;

/// True if two files have equal bytes; none if one cannot be read.
pub(crate) fn same_bytes(one: &Path, other: &Path) -> Option<bool> {
    Some(fs::read(one).ok()? == fs::read(other).ok()?)
}

/// The directory of a file.
pub(crate) fn parent_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Folder of compensated programs that keep the names of their sources.
pub(crate) const COMPENSATED: &str = "compensated";

/// Folder of flat programs that keep them.
pub(crate) const FLAT: &str = "flat";

/// True of a folder that is made where it is missing.
pub(crate) fn is_own_folder(path: &Path) -> bool {
    let name = path.file_name();
    name.is_some_and(|name| name == COMPENSATED || name == FLAT)
}

/// The name of a file, with that of its folder where that is one of these two.
pub(crate) fn named_with_own_folder(path: &Path) -> String {
    let folder = path.parent().filter(|folder| is_own_folder(folder));
    let folder = folder.map_or_else(String::new, |folder| file_name(folder) + "/");
    folder + &file_name(path)
}

/// True if both paths lead to one file, hard and symbolic links included.
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

/// True for one name in one directory, even if there is no file.
pub(crate) fn same_place(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let parent = fs::canonicalize(parent_of(path)).ok()?;
        Some(parent.join(path.file_name()?))
    };
    match (place(one), place(other)) {
        (Some(a), Some(b)) => a == b,
        _ => false,
    }
}

/// A file as seen from a folder, which may not exist yet: from it down or over its parents.
pub(crate) fn seen_from(folder: &Path, file: &Path) -> String {
    let full = |path: &Path| {
        // The empty path is the current folder.
        let path =
            std::path::absolute(Path::new(".").join(path)).unwrap_or_else(|_| path.to_owned());
        fs::canonicalize(&path).unwrap_or(path)
    };
    let (folder, file) = (full(folder), full(file));
    let shared = folder.components().zip(file.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(file.components().skip(shared)).collect();
    path.to_string_lossy().replace('\\', "/")
}

/// Reason for which a job file may not write to a path.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Outside {
    #[error(
        "a job file writes only into its own directory and below: use a relative path without '..'; an option on the command line may name any place"
    )]
    Written,
    #[error("a link leads out of the job's directory to '{}'", .0.display())]
    Link(PathBuf),
}

/// An output named by a job file: below the job's own directory and nowhere else.
pub(crate) fn inside(root: &Path, written: &str) -> Result<PathBuf, Outside> {
    let path = Path::new(written);
    let plain = path
        .components()
        .all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    // A drive letter or a backslash means a place elsewhere on another system.
    if !plain || written.contains('\\') || written.contains(':') || written.trim().is_empty() {
        return Err(Outside::Written);
    }
    let target = root.join(path);
    let (Ok(root), Ok(parent)) = (fs::canonicalize(root), fs::canonicalize(parent_of(&target)))
    else {
        // A missing directory is reported when the output is claimed.
        return Ok(target);
    };
    if !parent.starts_with(&root) {
        return Err(Outside::Link(parent));
    }
    Ok(target)
}

#[cfg(test)]
mod tests {
    use super::*;

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
