//! Programs without a motion on which a correction could be needed: three commands say the same.

use crate::common::{JOB, run, workplace};
use serde_json::Value;

#[test]
fn check_deflect_and_compensate_agree_on_programs_without_motion() {
    let here = workplace();
    std::fs::write(here.path().join("job.toml"), JOB).expect("a job");
    let unknown = "no motion whose place is known: state X, Y and Z";
    for (program, reason) in [
        ("M3\n", "the program has no motion"),
        ("G0 X0\n", unknown),
        ("G0 X10\n", unknown),
    ] {
        let text = format!("G21 G90\n{program}");
        std::fs::write(here.path().join("part.ngc"), text).expect("a program");
        let checked = run(here.path(), &["check", "job.toml", "--json"]);
        assert_eq!(checked.code, 1, "{program:?}: {checked:?}");
        let found: Value = serde_json::from_str(&checked.out).expect("JSON");
        let warnings = found["warnings"].as_array().expect("a list");
        let said = warnings.iter().any(|w| {
            w["code"] == "program" && w["message"].as_str().is_some_and(|m| m.contains(reason))
        });
        assert!(said, "{program:?}: {warnings:?}");
        let refused = ["deflect", "compensate"].map(|verb| run(here.path(), &[verb, "job.toml"]));
        for said in &refused {
            assert_eq!(said.code, 1, "{program:?}: {said:?}");
            assert!(said.err.contains(reason), "{program:?}: {said:?}");
        }
        assert_eq!(refused[0].err, refused[1].err, "{program:?}");
    }
}

/// A known place counts, wherever it lies and whatever leads there.
#[test]
fn the_end_of_a_motion_from_an_unknown_place_is_corrected() {
    let here = workplace();
    std::fs::write(here.path().join("job.toml"), JOB).expect("a job");
    for program in [
        "G1 X0 Y0 Z0 F100",
        "G1 X10 Y0 Z0 F100",
        "G0 X0 Y0 Z0\nG0 X10",
        "G0 X0 Y0 Z0",
        "G0 X5 Y0 Z0",
        "G0 X0 Y0 Z0\nG1 X0 F5",
        "G94 G17\nG0 X0 Y0 Z0\nG1 X0.00000000001 F5",
    ] {
        let text = format!("G21 G90\n{program}\n");
        std::fs::write(here.path().join("part.ngc"), text).expect("a program");
        for verb in ["check", "deflect"] {
            run(here.path(), &[verb, "job.toml"]).answered();
        }
        run(
            here.path(),
            &["compensate", "job.toml", "--force-overwrite"],
        )
        .answered();
    }
}
