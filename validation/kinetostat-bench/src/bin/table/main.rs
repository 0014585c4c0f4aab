//! Tables of what many postures cost: machines of different shapes, one posture at a time, two threads,
//! growth with springs, limbs and postures, memory. With `--figures`, what `cargo xtask figures` shows
//! follows each.
//!
//! ```sh
//! cargo run --release -p kinetostat-bench --bin table
//! ```

#![allow(
    clippy::print_stdout,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "tables are what was asked for; nobody has 2^52 postures"
)]

mod growth;
mod memory;
mod shapes;
mod threads;

use std::time::Instant;

use anyhow::Result;
use kinetostat_bench::{Results, Task};

/// Postures in one call: the results then stay in the cache of a core.
const BLOCK: usize = 256;

/// Wall time of one pass, s.
fn pass(task: &Task, block: usize, results: &mut Results) -> Result<f64> {
    let start = Instant::now();
    task.run(block, results)?;
    Ok(start.elapsed().as_secs_f64())
}

/// Processor time of all threads so far, s: unlike the wall clock it does not count other programs.
#[cfg(unix)]
fn computed(_start: Instant) -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Systems that do not tell are timed by the wall.
#[cfg(not(unix))]
fn computed(start: Instant) -> f64 {
    start.elapsed().as_secs_f64()
}

/// Time of one posture, us: the median of several passes.
fn median(task: &Task, block: usize) -> Result<f64> {
    let start = Instant::now();
    let mut results = Results::default();
    let mut times = Vec::new();
    task.run(block, &mut results)?;
    while times.len() < 3 || (start.elapsed().as_secs_f64() < 0.4 && times.len() < 301) {
        let before = computed(start);
        task.run(block, &mut results)?;
        times.push(computed(start) - before);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2] / task.len() as f64 * 1e6)
}

/// Exponent of growth between the first and the last of several sizes and times.
fn exponent(rows: &[(usize, f64)]) -> f64 {
    match (rows.first(), rows.last()) {
        (Some(first), Some(last)) => {
            (last.1 / first.1).ln() / (last.0 as f64 / first.0 as f64).ln()
        }
        _ => f64::NAN,
    }
}

fn main() -> Result<()> {
    match std::env::args().nth(1).as_deref() {
        Some("million") => return memory::stream(),
        Some("threads") => return threads::two(),
        Some("single") => return threads::single(),
        _ => (),
    }
    shapes::table()?;
    threads::single()?;
    threads::two()?;
    growth::springs()?;
    growth::limbs()?;
    growth::postures()?;
    memory::table()
}
