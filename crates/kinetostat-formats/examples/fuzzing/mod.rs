//! The loop of every fuzz: random cases for a stated time, or one of them again.

use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Runs `check` as the words of the command say (`MINUTES SEED`, or `case SEED`); `what` are the cases, in words.
pub fn run(what: &str, check: impl Fn(u64) -> Result<bool, String>) -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize| words.get(index).and_then(|word| word.parse::<f64>().ok());
    if words.first().is_some_and(|word| word == "case") {
        let seed = words.get(1).and_then(|word| word.parse().ok());
        println!("{:?}", check(seed.unwrap_or(1)));
        return ExitCode::SUCCESS;
    }
    let end = Instant::now() + Duration::from_secs_f64(60.0 * number(0).unwrap_or(1.0));
    let first = number(1).unwrap_or(1.0) as u64;
    let (mut cases, mut read, mut failed) = (0_u64, 0, 0);
    while Instant::now() < end {
        match check(first.wrapping_mul(1_000_003).wrapping_add(cases)) {
            Ok(taken) => read += usize::from(taken),
            Err(what) => {
                failed += 1;
                println!("FAULT {what}");
            }
        }
        cases += 1;
    }
    println!("{cases} {what}, {read} read, {failed} faults");
    match failed {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
