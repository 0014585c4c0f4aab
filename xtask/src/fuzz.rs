//! `cargo xtask fuzz`: random chains under random loads through every query, struts, stiffness ratios and
//! stiff links with known answers, random programs under ridged tables of corrections, and random options and jobs over all
//! commands, for a stated time.

use anyhow::{Context, Result, bail};

use crate::{cargo, step};

/// Runs a program of rounds, optimised and with panics that can be caught.
fn example(what: &str, package: &str, words: &[&str]) -> Result<()> {
    let (name, words) = words.split_first().context("no example")?;
    let mut command = cargo();
    command.args(["run", "--quiet", "--profile", "fuzz", "--package", package]);
    command.args(["--example", name, "--"]).args(words);
    step(what, &mut command)
}

/// Fuzz of thousands of cases in a second, by package and words of its example: a twelfth of the time each. One case is repeated with
/// `cargo run --package kinetostat-program --example fuzz_codes -- case SEED`, and so of the others.
const QUICK: [(&str, &str, &[&str]); 12] = [
    ("codes", "kinetostat-program", &["fuzz_codes"]),
    (
        "programs with macros",
        "kinetostat-program",
        &["fuzz_expand"],
    ),
    ("errors in pairs", "kinetostat-model", &["fuzz_errors"]),
    ("RAPID programs", FORMATS, &["fuzz_programs", "rapid"]),
    ("TP programs", FORMATS, &["fuzz_programs", "ls"]),
    ("APT files", FORMATS, &["fuzz_programs", "apt"]),
    ("KRL programs", FORMATS, &["fuzz_programs", "krl"]),
    ("lists of poses", FORMATS, &["fuzz_programs", "poses"]),
    ("URScript programs", FORMATS, &["fuzz_programs", "urscript"]),
    ("VAL3 programs", FORMATS, &["fuzz_programs", "val3"]),
    ("SINUMERIK programs", FORMATS, &["fuzz_programs", "siemens"]),
    (
        "Heidenhain programs",
        FORMATS,
        &["fuzz_programs", "heidenhain"],
    ),
];

/// The package whose programs are those of robots and controls.
const FORMATS: &str = "kinetostat-formats";

/// `--minutes M` (10 if not given), `--seed N` (1), or `--case N` to repeat one.
pub fn run(options: &[&str]) -> Result<()> {
    let (mut minutes, mut seed, mut case) = ("10", "1", None);
    let mut words = options.iter();
    while let Some(word) = words.next() {
        let value = words
            .next()
            .with_context(|| format!("{word} needs a number"))?;
        value
            .parse::<f64>()
            .with_context(|| format!("{word} {value}: a number is needed"))?;
        match *word {
            "--minutes" => minutes = value,
            "--seed" => seed = value,
            "--case" => case = Some(*value),
            _ => bail!("{word} is unknown; there are --minutes, --seed and --case"),
        }
    }
    if let Some(case) = case {
        return chains(&["case", case]);
    }
    let time: f64 = minutes.parse()?;
    let twelfth = (time / 12.0).to_string();
    for (what, package, words) in QUICK {
        let words = [words, &[&twelfth, seed]].concat();
        example(&format!("fuzz of {what}"), package, &words)?;
    }
    // Programs are many more cases in a minute: a sixth of the time does.
    maps(&[&(time / 6.0).to_string(), seed])?;
    chains(&[&(time * 5.0 / 6.0).to_string(), seed])?;
    absurd_units()?;
    // Whole commands are slow: a twelfth of the time each.
    for (what, test) in [
        ("fuzz of options", "every_option::random"),
        ("fuzz of jobs over commands", "jobs_over_commands::"),
    ] {
        commands(what, test, time / 12.0, seed)?;
    }
    Ok(())
}

/// Random command lines and jobs, in the tests of the command line. One run is repeated with its seed.
fn commands(what: &str, test: &str, minutes: f64, seed: &str) -> Result<()> {
    let mut command = cargo();
    command.args(["test", "--quiet", "--profile", "fuzz"]);
    command.args(["--package", "kinetostat-cli", "--test", "cli", test]);
    command.env("KINETOSTAT_FUZZ_SECONDS", format!("{:.0}", 60.0 * minutes));
    command.env("KINETOSTAT_FUZZ_SEED", seed);
    step(what, &mut command)
}

/// Chains under loads, through every query.
fn chains(words: &[&str]) -> Result<()> {
    let words = [&["fuzz_chains"], words].concat();
    example("fuzz of chains", "kinetostat", &words)
}

/// One figure of a good job or model at a time, in every wrong unit.
fn absurd_units() -> Result<()> {
    let mut command = cargo();
    command.args([
        "test",
        "--quiet",
        "--profile",
        "fuzz",
        "--package",
        "kinetostat-cli",
    ]);
    command.args(["--test", "cli", "absurd::"]);
    command.env("KINETOSTAT_ABSURD", "all");
    step("absurd units", &mut command)
}

/// Programs under ridged tables, looked at in random places. One case is repeated with
/// `cargo run --package kinetostat-program --example fuzz_maps -- case SEED`.
fn maps(words: &[&str]) -> Result<()> {
    let words = [&["fuzz_maps"], words].concat();
    example(
        "fuzz of programs under tables",
        "kinetostat-program",
        &words,
    )
}
