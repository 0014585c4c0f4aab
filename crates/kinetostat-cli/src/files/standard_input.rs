//! Standard input in the place of a file.
//!
//! The command line writes [`NAME`] in the place of `-`, so that messages name the file, and a path relative to it starts
//! at the working directory.

use std::cell::RefCell;
use std::io::{Read, Result};
use std::path::Path;

/// Path of standard input, as messages show it.
pub(crate) const NAME: &str = "standard input";

thread_local! {
    /// Bytes read so far; `None` if this command does not read standard input.
    static READ: RefCell<Option<Vec<u8>>> = const { RefCell::new(None) };
}

/// Sets whether the command on this thread reads standard input; nothing is read yet.
pub(crate) fn request(is_read: bool) {
    READ.set(is_read.then(Vec::new));
}

/// True of the path that stands for standard input.
pub(crate) fn is(path: &Path) -> bool {
    path == Path::new(NAME) && READ.with_borrow(Option::is_some)
}

/// True of the name of an output that is made from the name of standard input.
pub(crate) fn is_name_of(output: &Path) -> bool {
    let name = output.file_name().map(|name| name.to_string_lossy());
    name.is_some_and(|name| name.starts_with(NAME)) && READ.with_borrow(Option::is_some)
}

/// Returns its first bytes, at most `most`. They can be asked for again, since they are kept.
pub(crate) fn beginning(most: u64) -> Result<Vec<u8>> {
    READ.with_borrow_mut(|read| {
        let read = read.get_or_insert_default();
        let missing = most.saturating_sub(read.len() as u64);
        std::io::stdin().lock().take(missing).read_to_end(read)?;
        let shown = usize::try_from(most).map_or(read.len(), |most| most.min(read.len()));
        Ok(read[..shown].to_vec())
    })
}
