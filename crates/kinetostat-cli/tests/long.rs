//! Long programs: run part by part, killed at any moment and gone on with, and what is said of other questions.
//!
//! The parts are short here (`--part-lines`), so that a small program has many of them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failing test may panic"
)]

#[path = "cli/common/mod.rs"]
mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

use common::command;

/// A wavy surface in zigzag.
fn surface(rows: usize) -> String {
    let mut text = String::from("G21 G90 G17\nG0 X-10 Y-8 Z5\n");
    for row in 0..rows {
        let y = -8.0 + 16.0 * row as f64 / rows as f64;
        text.push_str(&format!("G0 Y{y:.3}\nG1 Z-1 F300\n"));
        for i in 0..=50 {
            let x = -10.0 + 0.4 * f64::from(if row % 2 == 0 { i } else { 50 - i });
            let z = -1.0 + 0.3 * (0.4 * x).sin() * (0.5 * y).cos();
            text.push_str(&format!("G1 X{x:.3} Z{z:.4} F800\n"));
        }
        text.push_str("G0 Z5\n");
    }
    text.push_str("M2\n");
    text
}

fn place(rows: usize) -> tempfile::TempDir {
    let here = tempfile::tempdir().expect("a directory");
    fs::write(here.path().join("part.ngc"), surface(rows)).expect("written");
    fs::write(here.path().join("job.toml"), common::JOB).expect("written");
    here
}

fn start(here: &Path, more: &[&str]) -> Child {
    command(here)
        .args([
            "compensate",
            "job.toml",
            "--part-lines",
            "150",
            "--points",
            "points.csv",
        ])
        .args([
            "--json",
            "result.json",
            "--report",
            "report.html",
            "--all-points",
        ])
        .args(more)
        .env("SOURCE_DATE_EPOCH", "1764000000")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts")
}

fn ended(here: &Path, more: &[&str]) -> (Option<i32>, String) {
    let done = start(here, more).wait_with_output().expect("it ends");
    (
        done.status.code(),
        String::from_utf8_lossy(&done.stderr).into_owned(),
    )
}

fn outputs(here: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    let names = ["out.ngc", "points.csv", "result.json", "report.html"];
    let read = names.map(|name| (name, fs::read(here.join(name)).expect(name)));
    read.into_iter().collect()
}

fn folder(here: &Path) -> std::path::PathBuf {
    here.join("out.ngc.kinetostat-part")
}

#[test]
fn a_killed_run_goes_on_and_ends_with_the_same_bytes() {
    let whole = place(20);
    let (code, said) = ended(whole.path(), &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(!folder(whole.path()).exists());
    let wanted = outputs(whole.path());
    let here = place(20);
    let mut kills = 0;
    // Later and later, so that it ends in any case.
    for round in 0_u64.. {
        let mut child = start(here.path(), &[]);
        std::thread::sleep(Duration::from_millis(150 + 137 * round % 400 + 60 * round));
        if child.try_wait().expect("asked").is_none() {
            child.kill().expect("killed");
            kills += 1;
        }
        let status = child.wait().expect("ends");
        if status.success() {
            break;
        }
    }
    assert!(kills > 0);
    let found = outputs(here.path());
    for (name, bytes) in &wanted {
        assert!(bytes == &found[name], "{name} differs after {kills} kills");
    }
    assert!(!folder(here.path()).exists());
}

#[test]
fn another_question_is_refused_by_the_field_that_differs() {
    let here = place(12);
    let mut child = start(here.path(), &[]);
    while !folder(here.path()).join("state.json").exists() {
        std::thread::sleep(Duration::from_millis(5));
        assert!(
            child.try_wait().expect("asked").is_none(),
            "it ended before it kept anything"
        );
    }
    child.kill().expect("killed");
    child.wait().expect("ends");
    let (code, said) = ended(here.path(), &["--decimals", "5"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("how the program is written is another one now"),
        "{said}"
    );
    assert!(said.contains("--restart"), "{said}");
    // A damaged state is that before it, or begun anew.
    let state = folder(here.path()).join("state.json");
    let bytes = fs::read(&state).expect("a state");
    fs::write(&state, &bytes[..bytes.len() / 3]).expect("damaged");
    let (code, said) = ended(here.path(), &[]);
    assert_eq!(code, Some(0), "{said}");
    let whole = place(12);
    assert_eq!(ended(whole.path(), &[]).0, Some(0));
    assert!(outputs(here.path()) == outputs(whole.path()));
}
