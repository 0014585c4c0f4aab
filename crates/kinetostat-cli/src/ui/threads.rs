//! Work on a stated number of threads.

use std::error::Error;

use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::host;

/// Threads for each core, at most: more bring nothing, and each takes address space that its start may lack, which ends the process.
const MOST_PER_CORE: usize = 4;

/// Threads that are started on any machine where they are asked for.
const ALWAYS: usize = 16;

/// Runs `work` on a number of threads, or on as many as the machine has a use for: the result is the same.
pub(crate) fn in_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Answer<R> {
    let Some(count) = threads else {
        // Threads of all cores are started with the first work for them, which panics where they cannot be. That they are there
        // already is no error.
        let started = rayon::ThreadPoolBuilder::new().build_global();
        return match started.as_ref().map_err(|error| (error, error.source())) {
            Err((_, Some(cause))) => Err(ErrorCode::System.failure(format!(
                "threads for all cores cannot be started: {cause}; --threads 1 needs one"
            ))),
            _ => Ok(work()),
        };
    };
    if !(1..=1024).contains(&count) {
        return Err(
            ErrorCode::Value.failure(format!("--threads {count}: 1 to 1024 threads can be used"))
        );
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let count = count.min((MOST_PER_CORE * cores).max(ALWAYS));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| not_started(count, &error))?;
    let host = host::current();
    Ok(pool.install(|| host::working_for(host, work)))
}

/// Threads that the system does not give.
pub(crate) fn not_started(count: usize, error: &dyn Error) -> Failure {
    ErrorCode::System.failure(format!("{count} threads cannot be started: {error}"))
}
