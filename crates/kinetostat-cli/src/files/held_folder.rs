//! A folder in which a run keeps what it has done: one run at a time, for two of them would write into one another's files.

use std::fs::{File, TryLockError};
use std::path::Path;

/// The file that is locked.
pub(crate) const LOCK: &str = "lock";

/// Holds a folder until the file is dropped or the run ends, however it ends; `None` where another run holds it. A disk without
/// locks is trusted.
pub(crate) fn hold(folder: &Path) -> std::io::Result<Option<File>> {
    let lock = File::create(folder.join(LOCK))?;
    let held_elsewhere = matches!(lock.try_lock(), Err(TryLockError::WouldBlock));
    Ok((!held_elsewhere).then_some(lock))
}
