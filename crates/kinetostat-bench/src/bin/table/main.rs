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

/// What this thread has computed so far, s, where the system tells: in steps of some milliseconds.
fn computed() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// Time of one posture, us: the shortest of several passes, since what disturbs only makes it longer.
/// A pass that is too long to be left alone by other programs is timed by what it computes itself.
fn shortest(task: &Task, block: usize) -> Result<f64> {
    let start = Instant::now();
    let mut results = Results::default();
    let mut best = f64::INFINITY;
    let mut passes = 0;
    while passes < 3 || (start.elapsed().as_secs_f64() < 0.3 && passes < 300) {
        let before = computed();
        let wall = pass(task, block, &mut results)?;
        let own = computed().zip(before).map(|(after, before)| after - before);
        best = best.min(own.filter(|_| wall > 0.1).unwrap_or(wall));
        passes += 1;
    }
    Ok(best / task.len() as f64 * 1e6)
}

/// A line that `cargo xtask figures` reads; with `--figures` only.
fn figure(name: &str, measured: f64, asked: &str, unit: &str, holds: bool) {
    if !std::env::args().any(|word| word == "--figures") {
        return;
    }
    let name = name.replace('"', "'");
    println!(
        r#"figure {{"name":"{name}","measured":{measured:e},"asked":"{asked}","unit":"{unit}","holds":{holds}}}"#
    );
}

fn at_most(name: &str, measured: f64, most: f64, unit: &str) {
    let asked = format!("at most {most}");
    figure(name, measured, &asked, unit, measured <= most);
}

fn at_least(name: &str, measured: f64, least: f64, unit: &str) {
    let asked = format!("at least {least}");
    figure(name, measured, &asked, unit, measured >= least);
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
    if std::env::args().nth(1).as_deref() == Some("million") {
        return memory::stream();
    }
    shapes::table()?;
    threads::single()?;
    threads::two()?;
    growth::springs()?;
    growth::limbs()?;
    growth::postures()?;
    memory::table()
}
