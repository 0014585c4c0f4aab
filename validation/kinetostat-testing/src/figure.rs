//! Lines that `cargo xtask figures` reads from what tests and examples print, and the time they took.

#![allow(clippy::print_stdout, reason = "these lines are what was asked for")]

use std::time::Instant;

/// Prints a number that may be at most as large; true where it holds. NaN does not.
pub fn at_most(name: &str, measured: f64, most: f64, unit: &str) -> bool {
    line(
        name,
        measured,
        &format!("at most {most}"),
        unit,
        measured <= most,
    )
}

/// Prints a number that must be at least as large; true where it holds. NaN does not.
pub fn at_least(name: &str, measured: f64, least: f64, unit: &str) -> bool {
    line(
        name,
        measured,
        &format!("at least {least}"),
        unit,
        measured >= least,
    )
}

fn line(name: &str, measured: f64, asked: &str, unit: &str, holds: bool) -> bool {
    let name = name.replace(['"', '\\'], "'");
    // JSON has no NaN.
    let measured = match measured.is_finite() {
        true => format!("{measured:e}"),
        false => "null".to_owned(),
    };
    println!(
        r#"figure {{"name":"{name}","measured":{measured},"asked":"{asked}","unit":"{unit}","holds":{holds}}}"#
    );
    holds
}

/// Time that this thread has computed, s, to be subtracted from another: unlike the clock on the wall it does not count
/// what other programs do meanwhile. Systems that do not tell are timed by the wall from `start`.
#[must_use]
pub fn computed_s(start: Instant) -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok())
        .map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Largest resident memory of this process so far, MB, where the system tells.
#[must_use]
pub fn peak_memory_mb() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}
