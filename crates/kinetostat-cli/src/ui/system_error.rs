//! Errors of the operating system in a person's words.

use std::io::ErrorKind;

/// An error of the system as a person would say it.
pub(crate) fn description(error: &std::io::Error) -> String {
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
