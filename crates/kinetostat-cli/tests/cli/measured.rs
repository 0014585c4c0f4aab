//! Loads that were measured: the same answer as for the force typed in, what is refused, what is named.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::fmt::Write;
use std::path::Path;

use kinetostat_testing::Worst;

use crate::common::{Said, contents, run};
use crate::cut::{PASS, written_y_at};

const JOB: &str = r#"schema = 1
model = "orthoglide"
program = "pass.ngc"
[placement]
part_origin_mm = [0, 0, 100]
[tool]
length_mm = 0
[measured]
file = "log.csv"
acts_on = "part"
[output]
program = "out.ngc"
report = "report.html"
json = "result.json"
"#;

const FORCE: [f64; 3] = [20.0, 40.0, -15.0];

const TYPED: &str = "[load]\nforce_n = [20, 40, -15]\naxes = \"base\"\n";

fn typed() -> String {
    JOB.replace(
        "[measured]\nfile = \"log.csv\"\nacts_on = \"part\"\n",
        TYPED,
    )
}

/// The program is a plunge of 1.4 s and a pass of 6 s, without rapids between them. At 2 kHz, the first cut at 0.8 s: the force on the part, opposite to that on the tool, with drift of 3 N, noise of 1 N.
fn log() -> String {
    let mut text = "# dynamometer under the part\ntime_s,fx_n,fy_n,fz_n\n".to_owned();
    let mut state = 1_u32;
    for row in 0..20_000 {
        let t = f64::from(row) / 2000.0;
        write!(text, "{t}").unwrap();
        for force in FORCE {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = 2.0 * f64::from(state) / f64::from(u32::MAX) - 1.0;
            let cut = if (0.8..8.2).contains(&t) { -force } else { 0.0 };
            write!(text, ",{:.3}", cut + 3.0 + noise).unwrap();
        }
        text.push('\n');
    }
    text
}

fn along(length_mm: f64) -> String {
    let mut text = "along_mm;fx_n;fy_n;fz_n\n".to_owned();
    for at in [0.0, 20.0, length_mm] {
        let [x, y, z] = FORCE;
        writeln!(text, "{at};{x};{y};{z}").unwrap();
    }
    text
}

fn place(job: &str, program: &str, log: &str) -> tempfile::TempDir {
    let directory = crate::cut::place(job, program);
    std::fs::write(directory.path().join("log.csv"), log).unwrap();
    directory
}

fn result(here: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(here.join("result.json")).unwrap()).unwrap()
}

fn words(result: &serde_json::Value) -> Vec<String> {
    let words = result["question"]["cut"].as_array().unwrap();
    words
        .iter()
        .map(|w| w.as_str().unwrap().to_owned())
        .collect()
}

fn codes(result: &serde_json::Value) -> Vec<String> {
    let list = result["warnings"].as_array().unwrap();
    list.iter()
        .map(|w| w["code"].as_str().unwrap().to_owned())
        .collect()
}

/// By length along the path, without noise: the same program as with the force typed in, to within twice the tolerance of the
/// path (0.5 um).
#[test]
fn a_log_along_the_path_is_a_force_typed_in() {
    let job = JOB.replace("\"part\"", "\"tool\"\nsmooth_mm = 0");
    let measured = place(&job, PASS, &along(67.0));
    run(measured.path(), &["compensate", "job.toml"]).answered();
    let stated = place(&typed(), PASS, "");
    run(stated.path(), &["compensate", "job.toml"]).answered();
    let mut worst = Worst::new();
    for step in 0..=120 {
        let x = -30.0 + 0.5 * f64::from(step).clamp(0.01, 119.99);
        let stated_y = written_y_at(stated.path(), x);
        assert!(
            x.abs() > 29.9 || stated_y.abs() > 5e-3,
            "nothing is corrected at {x}"
        );
        worst.add(written_y_at(measured.path(), x) - stated_y);
    }
    assert!(worst.value() < 1e-3, "{worst:?}");
    let found = result(measured.path());
    assert!(
        found["question"]["load"]
            .as_str()
            .unwrap()
            .contains("measured along the program; at most 47.2 N")
    );
    assert!(
        words(&found)
            .iter()
            .any(|w| w.contains("by the length along the feed moves"))
    );
    assert_eq!(codes(&found), codes(&result(stated.path())));
}

/// Over time, with drift and noise, the shift found: the same to within what the noise allows. The mean over a revolution, 10
/// rows, has a deviation of 0.18 N; four times that is 1 N on an axis, of 40 N that bend the machine by about 40 um.
#[test]
fn a_log_over_time_is_a_force_typed_in() {
    let job = JOB.replace(
        "\"part\"",
        "\"part\"\nair_s = [[0, 0.7], [8.3, 9.9]]\nsmooth_s = 0.1",
    );
    let measured = place(&job, PASS, &log());
    run(measured.path(), &["compensate", "job.toml"]).answered();
    let stated = place(&typed(), PASS, "");
    run(stated.path(), &["compensate", "job.toml"]).answered();
    let mut worst = Worst::new();
    for step in 0..=116 {
        let x = -29.0 + 0.5 * f64::from(step);
        let stated_y = written_y_at(stated.path(), x);
        worst.add((written_y_at(measured.path(), x) - stated_y) / stated_y);
    }
    assert!(worst.value() < 0.04, "{worst:?}");
    let found = result(measured.path());
    let words = words(&found);
    for part in [
        "measured: 20000 rows, forces on the part, turned round",
        "outliers: none",
        "drift: straight lines through 2 stretches in air",
        "smoothing: mean over 0.1 s",
        "dwells as programmed; accelerations and overrides",
    ] {
        assert!(words.iter().any(|w| w.contains(part)), "{part}: {words:?}");
    }
    let shift = words
        .iter()
        .find_map(|w| w.strip_prefix("shift: the first cut begins at "));
    let shift: f64 = shift.unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((shift - 0.8).abs() < 1.0 / 2000.0, "{shift}");
    let files = found["question"]["files"].as_array().unwrap();
    let of_log = files.iter().find(|file| file["name"] == "log.csv").unwrap();
    assert_eq!(of_log["sha256"].as_str().unwrap().len(), 64);
    let report = std::fs::read_to_string(measured.path().join("report.html")).unwrap();
    assert!(report.contains("Cutting force") && report.contains("shift: the first cut"));
}

/// An outlier, a gap and lines without a force are warned of, on the terminal and in the result, with their codes.
#[test]
fn what_is_implausible_is_warned_of() {
    let text = log();
    // Row 5000 is on line 5003; half a second is missing; the log ends in the pass.
    let lines: Vec<String> = text
        .lines()
        .enumerate()
        .filter(|(i, _)| !(10_000..11_000).contains(i) && *i < 15_000)
        .map(|(i, line)| match i {
            5002 => "2.5,-17,900,18".to_owned(),
            _ => line.to_owned(),
        })
        .collect();
    let job = JOB.replace("\"part\"", "\"part\"\nshift_s = 0.8\nair_s = [[0, 0.7]]");
    let here = place(&job, PASS, &(lines.join("\n") + "\n"));
    let said = run(here.path(), &["check", "job.toml", "--json"]).answered();
    let found: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let list = found["warnings"].as_array().unwrap();
    let message = |code: &str| {
        let warning = list.iter().find(|w| w["code"] == code);
        let warning = warning.unwrap_or_else(|| panic!("{code}: {list:?}"));
        (
            warning["message"].as_str().unwrap().to_owned(),
            warning["line"].clone(),
        )
    };
    let (outlier, _) = message("outliers_in_log");
    assert!(
        outlier.contains("fy_n = 900 N on line 5003, at 2.5 s"),
        "{outlier}"
    );
    let (gap, _) = message("gap_in_log");
    assert!(
        gap.contains("0.5005 s") && gap.contains("4.9985 s"),
        "{gap}"
    );
    let (short, line) = message("not_measured");
    assert!(short.contains("of 60.00 mm"), "{short}");
    assert_eq!(line, 5);
}

fn refused(job: &str, program: &str, log: &str, parts: &[&str]) {
    let here = place(job, program, log);
    let before = contents(here.path());
    let said: Said = run(here.path(), &["compensate", "job.toml"]);
    assert_eq!(said.code, 1, "{said:?}");
    for part in parts {
        assert!(said.err.contains(part), "{part}: {}", said.err);
    }
    assert_eq!(contents(here.path()), before, "something was written");
}

#[test]
fn what_is_wrong_is_named_with_its_file_and_line() {
    let job = |from: &str, to: &str| JOB.replace(from, to);
    let with = |more: &str| {
        job(
            "acts_on = \"part\"\n",
            &format!("acts_on = \"part\"\n{more}\n"),
        )
    };
    let text = log();
    refused(
        &with("[material]\nname = \"AlMg4.5Mn\""),
        PASS,
        &text,
        &["job.toml:8", "twice", "[material]"],
    );
    refused(
        &with(TYPED),
        PASS,
        &text,
        &["job.toml:8", "a force, and measured forces"],
    );
    refused(
        &job("acts_on = \"part\"", ""),
        PASS,
        &text,
        &["job.toml", "acts_on"],
    );
    refused(
        &job("\"part\"", "\"spindle\""),
        PASS,
        &text,
        &["job.toml:10", "spindle"],
    );
    refused(
        &with("smooth = 0.01"),
        PASS,
        &text,
        &["job.toml:11", "smooth_s or smooth_mm"],
    );
    refused(
        &with("smooth_mm = 0.01"),
        PASS,
        &text,
        &["job.toml:11", "time_s", "smooth_s"],
    );
    refused(
        &with("shift_s = 1"),
        PASS,
        &along(67.0),
        &["job.toml:11", "along_mm"],
    );
    refused(&with("smooth_s = -1"), PASS, &text, &["job.toml:11"]);
    refused(&with("rapid_mm_per_min = 0"), PASS, &text, &["job.toml:11"]);
    refused(
        &with("air_s = [[20, 30]]"),
        PASS,
        &text,
        &["log.csv", "20 to 30 s"],
    );
    refused(
        &job("log.csv", "missing.csv"),
        PASS,
        &text,
        &["missing.csv", "does not exist"],
    );
    refused(
        &job("part_origin_mm", "scale = 0.5\npart_origin_mm"),
        PASS,
        &text,
        &["scaled"],
    );
    refused(
        JOB,
        PASS,
        "time_s,fx_n,fy_n,fz_n\n0,1,2,3\n0.1,1,2,3\n0.1,1,2,3\n",
        &["log.csv:4", "time_s"],
    );
    refused(
        JOB,
        PASS,
        "time_s,fx_n,fy_n,fz_n\n0,1,2,x\n",
        &["log.csv:2", "`x`"],
    );
    refused(JOB, PASS, "time_s,fx_n,fy_n\n", &["log.csv:1", "fz_n"]);
    // A force that never changes looks like no program.
    refused(
        JOB,
        PASS,
        "time_s,fx_n,fy_n,fz_n\n0,1,2,3\n5,1,2,3\n9,1,2,3\n",
        &["log.csv", "state the shift"],
    );
    let two = PASS.replace("G0 Z5\nM30", "G0 X0\nG1 X10\nM30");
    refused(
        JOB,
        &two,
        &text,
        &["pass.ngc", "line 6", "rapid_mm_per_min"],
    );
    refused(
        JOB,
        &PASS.replace("S12000 M3\n", "\n"),
        &text,
        &["pass.ngc", "line 4", "smooth_s"],
    );
}

/// The log is an input: never written over.
#[test]
fn the_log_is_never_written_over() {
    let here = place(&JOB.replace("result.json", "log.csv"), PASS, &log());
    let before = contents(here.path());
    let said = run(
        here.path(),
        &["compensate", "job.toml", "--force-overwrite"],
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert_eq!(contents(here.path()), before);
}
