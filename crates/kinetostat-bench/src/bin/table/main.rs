//! Tables of what many postures cost: machines of different shapes, one posture at a time, two threads,
//! growth with springs, limbs and postures, memory. Figures for `cargo xtask figures` follow each.
//!
//! ```sh
//! cargo run --release -p kinetostat-bench --bin table
//! ```

#![allow(
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "tables are what was asked for; nobody has 2^52 postures"
)]

mod growth;
mod machines;
mod memory;
mod shapes;
mod threads;

use std::time::Instant;

use anyhow::Result;
use kinetostat_bench::Task;

/// Postures in one call: the results then stay in the cache of a core.
const BLOCK: usize = 256;

/// Wall time of one pass, s.
fn pass(task: &Task, block: usize) -> Result<f64> {
    let start = Instant::now();
    task.run(block)?;
    Ok(start.elapsed().as_secs_f64())
}

/// Time of one posture, us: the shortest of several passes, since what disturbs only makes it longer.
fn shortest(task: &Task, block: usize) -> Result<f64> {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    let mut passes = 0;
    while passes < 3 || (start.elapsed().as_secs_f64() < 0.3 && passes < 200) {
        best = best.min(pass(task, block)?);
        passes += 1;
    }
    Ok(best / task.len() as f64 * 1e6)
}

/// A line that `cargo xtask figures` reads.
fn figure(name: &str, measured: f64, asked: &str, unit: &str, holds: bool) {
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
