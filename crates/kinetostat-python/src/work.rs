//! Work away from the interpreter: on the threads asked for, with progress, and stopped by Ctrl-C.
//!
//! Threads are our own, never rayon's global ones: after `fork` a child has none of its parent's threads, and would wait
//! for them for ever. A child makes its own with its first question.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use kinetostat_machining::Watch;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{Class, error};

/// Interval of the checks for signals and progress.
const LOOK: Duration = Duration::from_millis(50);

/// Time that the work has to stop by itself after Ctrl-C; then the call returns without it.
const PATIENCE: Duration = Duration::from_millis(300);

/// Pools by their number of threads, 0 for all cores.
static POOLS: Mutex<BTreeMap<usize, Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// Called in a child after `fork`: the threads of the parent are not there.
#[pyfunction]
pub fn forked() {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    // Not dropped: that would wait for threads that do not exist.
    std::mem::forget(std::mem::take(&mut *pools));
}

/// Our own threads, so many, or as many as there are cores.
///
/// # Errors
/// A number of threads that cannot be.
pub fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    let count = threads.unwrap_or(0);
    if threads == Some(0) || count > 1024 {
        return Err(error(
            Class::Argument,
            format!("threads is {count}: 1 to 1024 can be used, or None for all cores"),
        ));
    }
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&count) {
        return Ok(pool.clone());
    }
    let made = ThreadPoolBuilder::new()
        .num_threads(count)
        // A panic ends its call with an error, not the interpreter.
        .panic_handler(|_| ())
        .thread_name(|i| format!("kinetostat {i}"))
        .build()
        .map_err(|e| PyRuntimeError::new_err(format!("threads cannot be started: {e}")))?;
    let pool = Arc::new(made);
    pools.insert(count, pool.clone());
    Ok(pool)
}

/// Progress of the work while it runs.
#[derive(Default)]
pub struct Course {
    stop: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
    stage: Mutex<String>,
}

impl Course {
    /// True if the call was cancelled.
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Adds to the count of items that are done.
    pub fn add(&self, done: usize) {
        self.done.fetch_add(done, Ordering::Relaxed);
    }

    /// Sets the total number of items.
    pub fn of(&self, total: usize) {
        self.total.store(total, Ordering::Relaxed);
    }
}

impl Watch for Course {
    fn stage(&self, name: &str, total: usize) {
        name.clone_into(&mut self.stage.lock().unwrap_or_else(PoisonError::into_inner));
        self.done.store(0, Ordering::Relaxed);
        self.of(total);
    }

    fn advance(&self, done: usize) {
        self.done.store(done, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.stopped()
    }
}

/// Settings of a call: threads and progress.
pub struct Manner<'py> {
    /// Threads, all cores if none are named.
    pub threads: Option<usize>,
    /// Called with what is done, how much there is (0: nobody knows) and the stage's name.
    pub progress: Option<Bound<'py, PyAny>>,
}

/// Does the work on our own threads without the interpreter's lock, while this thread calls back and looks for signals.
///
/// # Errors
/// `KeyboardInterrupt` and what the callback raises: the work is told to stop, and what it still returns is dropped.
pub fn away<R: Send + 'static>(
    py: Python<'_>,
    manner: &Manner<'_>,
    work: impl FnOnce(&Arc<Course>) -> R + Send + 'static,
) -> PyResult<R> {
    let pool = pool(manner.threads)?;
    let course = Arc::new(Course::default());
    let (to, from) = channel();
    let own = course.clone();
    pool.spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = to.send(work(&own));
    });
    let mut from = from;
    let mut shown = (usize::MAX, 0);
    loop {
        let (back, found) = py.detach(move || {
            let found = from.recv_timeout(LOOK);
            (from, found)
        });
        from = back;
        let now = (
            course.done.load(Ordering::Relaxed),
            course.total.load(Ordering::Relaxed),
        );
        let ended = !matches!(found, Err(RecvTimeoutError::Timeout));
        let mut told = Ok(());
        if let Some(progress) = manner.progress.as_ref().filter(|_| now != shown) {
            let stage = course
                .stage
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clone();
            told = progress.call1((now.0, now.1, stage)).map(|_| ());
            shown = now;
        }
        match (found, told.and_then(|()| py.check_signals())) {
            (_, Err(raised)) => {
                course.stop.store(true, Ordering::SeqCst);
                if !ended {
                    let _ = py.detach(move || from.recv_timeout(PATIENCE).map(drop));
                }
                return Err(raised);
            }
            (Ok(answer), Ok(())) => return Ok(answer),
            (Err(RecvTimeoutError::Timeout), Ok(())) => {}
            (Err(RecvTimeoutError::Disconnected), Ok(())) => {
                return Err(PyRuntimeError::new_err(
                    "the work ended by itself, which it never should: please report this call and its model",
                ));
            }
        }
    }
}
