//! Origin of a result: files with their hashes, and the day.

use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use kinetostat_machining::FileRead;

use crate::files::hash::sha256;

/// A file with its hash; its directory is left out: a report may be passed on.
pub(crate) fn file(what: &str, path: &Path, bytes: &[u8]) -> FileRead {
    hashed(what, path, sha256(bytes))
}

/// Returns the record of a file whose hash is known.
pub(crate) fn hashed(what: &str, path: &Path, sha256: String) -> FileRead {
    let name = path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    );
    FileRead {
        what: what.to_owned(),
        name,
        sha256,
    }
}

/// The day in UTC, as `2026-11-20`. `SOURCE_DATE_EPOCH` (seconds since 1970) states another one, so that
/// a run can be repeated byte for byte on another day; set to nothing, no day is stated.
pub(crate) fn day() -> Option<String> {
    let now = match std::env::var("SOURCE_DATE_EPOCH") {
        Ok(text) => {
            let seconds = text.trim().parse().ok()?;
            UNIX_EPOCH.checked_add(Duration::from_secs(seconds))?
        }
        Err(_) => SystemTime::now(),
    };
    // Four digits of a year are enough; humantime refuses more.
    let latest = UNIX_EPOCH + Duration::from_secs(253_402_300_799);
    let text = (now <= latest).then(|| humantime::format_rfc3339_seconds(now).to_string())?;
    text.split_once('T').map(|(day, _)| day.to_owned())
}
