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

use std::process::ExitCode;
use std::time::{Duration, Instant};

use harness::Kind;

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
        match harness::case(seed.wrapping_mul(1_000_003).wrapping_add(cases), kind()) {
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
