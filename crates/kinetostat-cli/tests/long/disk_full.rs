//! A disk that is full five times while a long program is run: nothing is lost, it is said in words, and with room the same
//! command goes on and ends with the same bytes.
//!
//! The small disk is one in memory (`tmpfs`) in a namespace of its own, which goes with the command that made it; where the system
//! allows none, files that may not grow beyond a limit stand in for it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::common::BINARY;
use crate::place;

/// Rows of the surface: its outputs are large beside what else is kept of a run.
const ROWS: usize = 32;

/// Outputs, all on the small disk.
const OUTPUTS: [&str; 4] = ["out.ngc", "points.csv", "result.json", "report.html"];

/// The command, in parts of 150 lines; what it says and its exit code are kept under the name of the round.
const ROUND: &str = r#"
round() {
  "$K" compensate job.toml --out disk/out.ngc --points disk/points.csv --json disk/result.json \
    --report disk/report.html --all-points --part-lines 150 --threads 1 >/dev/null 2>"said-$1"
  echo $? >"code-$1"
  ls -A disk >"list-$1"
  cp disk/out.ngc.kinetostat-part/state.json "state-$1" 2>/dev/null ||
    cp disk/out.ngc.kinetostat-part/state-before.json "state-$1" 2>/dev/null || true
}
"#;

/// Runs lines of `sh` in a directory after those of [`ROUND`]; `wrapped`: a command that runs `sh`.
fn sh(here: &Path, wrapped: &[&str], lines: &str) -> Output {
    let words: Vec<&str> = wrapped.iter().copied().chain(["sh", "-c"]).collect();
    Command::new(words[0])
        .args(&words[1..])
        .arg(format!("{ROUND}{lines}"))
        .env("K", BINARY)
        .env("SOURCE_DATE_EPOCH", "1764000000")
        .current_dir(here)
        .stdin(Stdio::null())
        .output()
        .expect("sh starts")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All outputs of a directory.
fn outputs(disk: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    let read = |name| (name, fs::read(disk.join(name)).expect(name));
    OUTPUTS.into_iter().map(read).collect()
}

/// What an uninterrupted run writes.
fn uninterrupted() -> BTreeMap<&'static str, Vec<u8>> {
    let here = place(ROWS);
    fs::create_dir(here.path().join("disk")).expect("a directory");
    sh(here.path(), &[], "round whole");
    let said = read(&here.path().join("said-whole"));
    assert_eq!(read(&here.path().join("code-whole")).trim(), "0", "{said}");
    outputs(&here.path().join("disk"))
}

/// How many parts a round has kept.
fn parts_kept(here: &Path, round: usize) -> u64 {
    let Ok(text) = fs::read_to_string(here.join(format!("state-{round}"))) else {
        return 0;
    };
    let (_, json) = text.split_once('\n').expect("a check number");
    let state: serde_json::Value = serde_json::from_str(json).expect("a state");
    state["parts"].as_u64().expect("parts")
}

/// Five rounds that had no room, each with more of it than the one before, and a last one that had enough.
fn assert_gone_on(here: &Path, wanted: &BTreeMap<&str, Vec<u8>>, reason: &str) {
    let mut kept = Vec::new();
    for round in 1..=5 {
        let said = read(&here.join(format!("said-{round}")));
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        let code = read(&here.join(format!("code-{round}")));
        assert_eq!(code.trim(), "1", "round {round}: {said}");
        assert!(said.contains(reason), "round {round}: {said}");
        let parts = parts_kept(here, round);
        let (says, left) = match parts {
            0 => ("the same command begins anew", ""),
            _ => (
                "the same command goes on from there",
                "out.ngc.kinetostat-part",
            ),
        };
        assert!(said.contains(says), "round {round}: {said}");
        // Nothing half beside what is kept.
        let list = read(&here.join(format!("list-{round}")));
        assert_eq!(list.trim(), left, "round {round}");
        kept.push(parts);
    }
    assert!(kept.is_sorted(), "parts were lost: {kept:?}");
    assert!(kept[0] < kept[4] && kept[2] > 0, "parts kept: {kept:?}");
    let said = read(&here.join("said-last"));
    assert_eq!(read(&here.join("code-last")).trim(), "0", "{said}");
    let found = outputs(&here.join("ended"));
    for (name, bytes) in wanted {
        assert!(*bytes == found[name], "{name} differs");
    }
    let list = read(&here.join("list-last"));
    assert!(!list.contains("kinetostat-part"), "left: {list}");
}

#[test]
fn a_disk_that_is_full_at_five_places_loses_nothing() {
    let namespace = ["unshare", "--map-root-user", "--mount"];
    let here = place(ROWS);
    let here = here.path();
    fs::create_dir(here.join("disk")).expect("a directory");
    let mounts = "mount -t tmpfs -o size=64k tmpfs disk && mount -o remount,size=128k tmpfs disk";
    let probe = Command::new(namespace[0])
        .args(&namespace[1..])
        .args(["sh", "-c", mounts])
        .current_dir(here)
        .output();
    if !probe.is_ok_and(|done| done.status.success()) {
        eprintln!("skipped: no small disk can be made here (unshare and mount of a tmpfs)");
        return;
    }
    let wanted = uninterrupted();
    // The files that are kept, and once more while they are put in place.
    let twice = 2 * (wanted["out.ngc"].len() + wanted["points.csv"].len());
    let sizes = [0.07, 0.2, 0.35, 0.6, 0.85].map(|share| share * twice as f64 / 1024.0);
    let mut lines = String::from("mount -t tmpfs -o size=16k tmpfs disk\n");
    for (index, size) in sizes.iter().enumerate() {
        let size = size.ceil();
        let round = index + 1;
        lines.push_str(&format!(
            "mount -o remount,size={size}k tmpfs disk\nround {round}\n"
        ));
    }
    lines.push_str("mount -o remount,size=64m tmpfs disk\nround last\ncp -r disk ended\n");
    let done = sh(here, &namespace, &lines);
    assert!(done.status.success(), "{done:?}");
    assert_gone_on(here, &wanted, "the disk is full");
}

#[test]
fn files_that_may_not_grow_lose_nothing() {
    let wanted = uninterrupted();
    let here = place(ROWS);
    let here = here.path();
    fs::create_dir(here.join("disk")).expect("a directory");
    // Blocks of 512 bytes, as POSIX has them; the signal that comes with it is ignored, so that a program may say what is wrong.
    let blocks = wanted["points.csv"].len() as f64 / 512.0;
    let mut lines = String::from("trap '' XFSZ\n");
    for (index, share) in [0.12, 0.3, 0.5, 0.7, 0.9].into_iter().enumerate() {
        let (limit, round) = ((share * blocks).ceil(), index + 1);
        lines.push_str(&format!("( ulimit -f {limit}; round {round} )\n"));
    }
    lines.push_str("round last\ncp -r disk ended\n");
    let done = sh(here, &[], &lines);
    assert!(done.status.success(), "{done:?}");
    assert_gone_on(here, &wanted, "larger than is allowed here");
}
