//! Another program in which a command runs: it takes what is printed, hears of progress and may stop the work.
//!
//! A host belongs to the thread that runs the command, and is handed to the threads that work for it. Without one the
//! command prints to the standard streams, shows progress on a terminal and looks for Ctrl-C.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

use kinetostat_machining::Watch;

/// Stream of the text for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    Out,
    Err,
}

thread_local! {
    static CURRENT: RefCell<Option<Arc<Host>>> = const { RefCell::new(None) };
}

/// The program around a command.
pub(crate) struct Host {
    watch: Arc<dyn Watch + Send + Sync>,
    out: Mutex<Vec<u8>>,
    err: Mutex<Vec<u8>>,
}

impl Host {
    pub(crate) fn new(watch: Arc<dyn Watch + Send + Sync>) -> Self {
        Self {
            watch,
            out: Mutex::default(),
            err: Mutex::default(),
        }
    }

    /// Takes what a command prints.
    pub(crate) fn take(&self, stream: Stream, bytes: &[u8]) {
        let to = match stream {
            Stream::Out => &self.out,
            Stream::Err => &self.err,
        };
        let mut to = to.lock().unwrap_or_else(PoisonError::into_inner);
        to.extend_from_slice(bytes);
    }

    /// True if something was printed to the standard output.
    pub(crate) fn has_printed(&self) -> bool {
        let out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        !out.is_empty()
    }

    /// Takes the text printed to the standard output and to the standard error.
    pub(crate) fn printed(&self) -> (Vec<u8>, Vec<u8>) {
        let all = |from: &Mutex<Vec<u8>>| {
            std::mem::take(&mut *from.lock().unwrap_or_else(PoisonError::into_inner))
        };
        (all(&self.out), all(&self.err))
    }

    pub(crate) fn watch(&self) -> &dyn Watch {
        self.watch.as_ref()
    }
}

/// The host of the command that runs on this thread.
pub(crate) fn current() -> Option<Arc<Host>> {
    CURRENT.with(|current| current.borrow().clone())
}

/// Does a part of a command's work on this thread, which may be another than the one that it was started on.
pub(crate) fn working_for<R>(host: Option<Arc<Host>>, work: impl FnOnce() -> R) -> R {
    let before = CURRENT.with(|current| current.replace(host));
    let done = work();
    CURRENT.with(|current| current.replace(before));
    done
}
