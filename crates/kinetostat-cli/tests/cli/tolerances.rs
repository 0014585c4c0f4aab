//! A job's tolerance: where it comes from, how a missed one is reported, and the repeatability it is taken from.

use crate::absurd::{ARM_JOB, arm, compensated};
use crate::common::{run, workplace};
use serde_json::Value;

/// A program that never states Z: what is corrected there is left out.
#[test]
fn a_missed_tolerance_is_said_first_with_line_and_reason_and_has_its_own_code() {
    let here = workplace();
    std::fs::write(
        here.path().join("part.ngc"),
        "G21 G90\nG0 X0 Y0\nG1 X20 F600\nG1 Y20\nM2\n",
    )
    .expect("a program");
    let job = ARM_JOB
        .replace("below_z_mm = 1.0\n", "")
        .replace("path_um = 20", "path_um = 1")
        .replace("chord_um = 16", "chord_um = 1");
    let (said, _) = compensated(here.path(), &job, &arm(), &[]);
    assert_eq!(said.code, 3, "{said:?}");
    let second_line = said.out.lines().nth(2).unwrap_or_default();
    assert!(
        second_line
            .trim_start()
            .starts_with("THE TOLERANCE IS MISSED at line"),
        "{said:?}"
    );
    assert!(said.err.contains("never states"), "{said:?}");
    let text = std::fs::read(here.path().join("r.json")).expect("the result");
    let result: Value = serde_json::from_slice(&text).expect("JSON");
    let reported = &result["tolerance"];
    assert_eq!(reported["held"], false);
    assert!(
        reported["missed"]["line"].as_u64().is_some_and(|l| l >= 2),
        "{reported}"
    );
    let off = reported["missed"]["error_mm"].as_f64().expect("a number");
    assert!(
        off > reported["allowed_mm"].as_f64().expect("a number"),
        "{reported}"
    );
    assert_eq!(
        result["summary"]["max_position_error_after_mm"].as_f64(),
        Some(off)
    );
}

/// What is asked for on the command line holds for all that keeps the tool off: pieces, chords and rounding.
#[test]
fn a_stated_tolerance_is_the_verdict() {
    let here = workplace();
    let text = "G21 G90\nG0 X-12 Y-9 Z5\nG0 Z0\nG1 X21 Y-4 F600\nG1 X25 Y13\nG3 X7 Y29 I-13.8 J2.6\nG1 X-11 Y17 Z-1\nG0 Z5\nM2\n";
    std::fs::write(here.path().join("part.ngc"), text).expect("a program");
    let cases = [
        (&["--tolerance-um", "1"][..], 4, 1e-3),
        // Four decimals cannot hold it.
        (&["--tolerance-um", "0.1"], 3, 1e-4),
        (&["--tolerance-um", "0.1", "--decimals", "6"], 4, 1e-4),
    ];
    for parts in [&[][..], &["--part-lines", "4"]] {
        for (words, code, asked_mm) in cases {
            let command = [
                "compensate",
                "job.toml",
                "--json",
                "r.json",
                "--force-overwrite",
            ];
            let said = run(here.path(), &[&command[..], words, parts].concat());
            assert_eq!(said.code, code, "{words:?}: {said:?}");
            let text = std::fs::read(here.path().join("r.json")).expect("the result");
            let result: Value = serde_json::from_slice(&text).expect("JSON");
            let after = result["summary"]["max_position_error_after_mm"].as_f64();
            let after = after.expect("a number");
            assert_eq!(after > asked_mm, code == 3, "{words:?}: {after}");
            assert_eq!(result["tolerance"]["allowed_mm"], asked_mm, "{words:?}");
            if code == 3 {
                let said = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(
                    said.contains("rounding to 4 decimals alone leaves up to"),
                    "{said}"
                );
            }
        }
    }
}

#[test]
fn the_tolerance_is_in_proportion_to_the_machine() {
    let here = workplace();
    let job = ARM_JOB.replace("path_um = 20\nchord_um = 16\n", "");
    let none = arm().replace("repeatability_mm = 0.06\n", "");
    let fine = arm().replace("repeatability_mm = 0.06", "repeatability_mm = 0.03");
    for (model, path, from) in [
        (arm(), 0.02, "repeatability, 0.06 mm"),
        (none, 0.02, "usual for an arm"),
        (fine, 0.01, "repeatability, 0.03 mm"),
    ] {
        let (said, _) = compensated(here.path(), &job, &model, &[]);
        assert_eq!(said.code, 4, "{said:?}");
        let text = std::fs::read(here.path().join("r.json")).expect("the result");
        let result: Value = serde_json::from_slice(&text).expect("JSON");
        let inputs = &result["question"];
        let reported = inputs["tolerance_mm"].as_f64().expect("a number");
        assert!((reported - path).abs() < 1e-12, "{inputs}");
        let chord = inputs["chord_tolerance_mm"].as_f64().expect("a number");
        assert!((chord - 0.8 * path).abs() < 1e-12, "{inputs}");
        let words = inputs["tolerance_from"].as_str().expect("words");
        assert!(words.contains(from), "{words}");
    }
}

#[test]
fn the_exit_code_of_a_missed_tolerance_is_in_every_help() {
    let here = workplace();
    for words in [
        &["--help"][..],
        &["compensate", "--help"],
        &["demo", "--help"],
        &["compensate", "-h"],
        &["man"],
    ] {
        let said = run(here.path(), words).answered();
        assert!(
            said.out.contains("the tolerance is missed"),
            "{words:?}: {}",
            said.out
        );
    }
}

/// Whatever a model states of its repeatability, a message speaks of that key with its line, never of a
/// tolerance that nobody wrote.
#[test]
fn a_repeatability_is_refused_by_its_own_name_and_line() {
    let here = workplace();
    let job = ARM_JOB.replace("path_um = 20\nchord_um = 16\n", "");
    let line = 1 + arm()
        .lines()
        .position(|line| line.starts_with("repeatability_mm"))
        .expect("stated");
    for (value, taken) in [
        ("-60", false),
        ("0", false),
        ("1e-300", false),
        ("1e-7", false),
        ("9e-6", false),
        ("0.06", true),
        ("9.9", true),
        ("10", true),
        ("10.1", false),
        ("29", false),
        ("60", false),
        ("1e300", false),
    ] {
        let model = arm().replace(
            "repeatability_mm = 0.06",
            &format!("repeatability_mm = {value}"),
        );
        let (said, _) = compensated(here.path(), &job, &model, &[]);
        let is_taken = matches!(said.code, 0 | 4);
        assert!(
            is_taken == taken && (taken || said.code == 1),
            "{value}: {said:?}"
        );
        if !taken {
            assert!(
                said.err.contains("the repeatability is "),
                "{value}: {said:?}"
            );
            assert!(
                said.err.contains(&format!(".toml:{line}")),
                "{value}: {said:?}"
            );
            assert!(!said.err.contains("tolerance"), "{value}: {said:?}");
        }
    }
}
