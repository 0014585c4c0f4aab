//! Random programs of a language, whole and broken, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_programs LANGUAGE MINUTES SEED`, or `fuzz_programs LANGUAGE case SEED` to repeat one case.

#![allow(
    clippy::print_stdout,
    reason = "a tool for developers; modules are shared with the tests"
)]

#[path = "../tests/formats/apt/random.rs"]
mod apt;
#[path = "../tests/formats/chance.rs"]
mod chance;
#[path = "../tests/formats/harness.rs"]
mod harness;
#[path = "../tests/formats/heidenhain/random.rs"]
mod heidenhain;
#[path = "../tests/formats/krl/random.rs"]
mod krl;
#[path = "../tests/formats/ls/random.rs"]
mod ls;
#[path = "../tests/formats/poses/random.rs"]
mod poses;
#[path = "../tests/formats/rapid/random.rs"]
mod rapid;
#[path = "../tests/formats/siemens/random.rs"]
mod siemens;
#[path = "../tests/formats/urscript/random.rs"]
mod urscript;
#[path = "../tests/formats/val3/random.rs"]
mod val3;

use std::panic::{UnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use harness::Kind;
use kinetostat_testing::figure::{computed_s, peak_memory_mb};

/// A language by its folder.
type Named = (&'static str, fn() -> Kind);

const LANGUAGES: [Named; 9] = [
    ("apt", apt::kind),
    ("heidenhain", heidenhain::kind),
    ("krl", krl::kind),
    ("ls", ls::kind),
    ("poses", poses::kind),
    ("rapid", rapid::kind),
    ("siemens", siemens::kind),
    ("urscript", urscript::kind),
    ("val3", val3::kind),
];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |at: usize| words.get(at).map_or("", String::as_str);
    let Some((name, kind)) = LANGUAGES.iter().find(|(name, _)| *name == word(0)) else {
        println!("which language? {:?}", LANGUAGES.map(|(name, _)| name));
        return ExitCode::FAILURE;
    };
    let seed: u64 = word(2).parse().unwrap_or(1);
    if word(1) == "case" {
        println!("{:?}", harness::case(seed, kind()));
        return ExitCode::SUCCESS;
    }
    let minutes: f64 = word(1).parse().unwrap_or(1.0);
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    let (mut cases, mut read, mut failed) = (0_u64, 0, 0);
    while Instant::now() < end {
        let case = seed.wrapping_mul(1_000_003).wrapping_add(cases);
        match within_bounds(case, || harness::case(case, kind())) {
            Ok(taken) => read += usize::from(taken),
            Err(what) => {
                failed += 1;
                println!("FAULT {what}");
            }
        }
        cases += 1;
    }
    println!("{cases} programs of {name}, {read} read, {failed} faults");
    match failed {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

/// Longest time of a case, s.
const MOST_S: f64 = 10.0;

/// Most memory of all cases, MB: programs of some kilobytes take a few, and those in loops have at most 200 000 motions.
const MOST_MB: f64 = 500.0;

/// The answer of a case, or a fault of one that panics, hangs or takes much memory.
fn within_bounds(
    case: u64,
    run: impl FnOnce() -> Result<bool, String> + UnwindSafe,
) -> Result<bool, String> {
    let (wall, before) = (Instant::now(), peak_memory_mb());
    let start = computed_s(wall);
    let found = catch_unwind(run).unwrap_or_else(|_| Err(format!("case {case}: a panic")))?;
    let (computed, after) = (computed_s(wall) - start, peak_memory_mb());
    if computed > MOST_S {
        return Err(format!("case {case}: {computed} s"));
    }
    match after > before && after.is_some_and(|most| most > MOST_MB) {
        true => Err(format!("case {case}: {after:?} MB, {before:?} before it")),
        false => Ok(found),
    }
}
