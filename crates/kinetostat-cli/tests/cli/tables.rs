//! `compensate --map`: assessed and reported as a run with a model is, and never worse than the program as it is.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use crate::common::{Said, command, run, workplace};
use serde_json::Value;
use tempfile::TempDir;

const HEAD: &str = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n";

/// A program corrected by a table; `said` and the result.
fn corrected(here: &TempDir, program: &str, table: &str, more: &[&str]) -> (Said, Value, Vec<u8>) {
    std::fs::write(here.path().join("in.ngc"), program).unwrap();
    std::fs::write(here.path().join("map.csv"), table).unwrap();
    let mut words = vec![
        "compensate",
        "--map",
        "map.csv",
        "--program",
        "in.ngc",
        "--out",
        "out.ngc",
        "--json",
        "r.json",
        "--force-overwrite",
    ];
    words.extend(more);
    let said = run(here.path(), &words);
    let read = |name: &str| std::fs::read(here.path().join(name)).unwrap_or_default();
    let result = serde_json::from_slice(&read("r.json")).unwrap_or(Value::Null);
    (said, result, read("out.ngc"))
}

#[test]
fn an_axis_that_is_never_stated_misses_the_tolerance() {
    let here = workplace();
    let motions = [
        "G0 Y0 Z0\nG1 Y50 Z30\nG1 Y-40",
        "G0 X0 Z0\nG1 X50 Z30\nG1 X-40",
        "G0 X0 Y0\nG1 X50 Y30\nG1 X-40",
    ];
    for (axis, motion) in motions.into_iter().enumerate() {
        for (other, unchanged) in [(0.02, false), (0.0, true)] {
            let mut wanted = [other; 3];
            wanted[axis] = -0.0294;
            let [x, y, z] = wanted;
            let program = format!("G21 G90 F600\n{motion}\nM2\n");
            let table = format!("{HEAD}0,0,0,{x},{y},{z}\n");
            let (said, result, _) = corrected(&here, &program, &table, &[]);
            assert_eq!(said.code, 3, "{said:?}");
            assert!(
                said.err.contains("THE TOLERANCE IS MISSED at line"),
                "{}",
                said.err
            );
            assert!(said.err.contains("never states its axis"), "{}", said.err);
            // First on the terminal, below the title.
            let below = said.out.split_once("\n\n").unwrap().1;
            assert!(
                below.trim_start().starts_with("THE TOLERANCE IS MISSED"),
                "{}",
                said.out
            );
            assert!(!said.out.contains("nothing to correct"), "{}", said.out);
            assert!(!said.out.contains("Nothing was"), "{}", said.out);
            let tolerance = &result["tolerance"];
            assert_eq!(tolerance["held"], false);
            assert_eq!(
                tolerance["allowed_mm"],
                result["max_position_error_allowed_mm"]
            );
            let missed = &tolerance["missed"];
            let error = missed["error_mm"].as_f64().unwrap();
            assert!((0.0294..0.0305).contains(&error), "{error}");
            assert_eq!(missed["error_mm"], result["max_position_error_after_mm"]);
            assert!(missed["line"].as_u64().unwrap() >= 3);
            assert!(missed["position_mm"].is_array() && missed["reason"].is_string());
            assert_eq!(result["unchanged"], unchanged);
        }
    }
    // Stated, the same table is kept.
    let (said, result, _) = corrected(
        &here,
        "G21 G90 F600\nG0 X0 Y0 Z0\nG1 X50 Y30\nM2\n",
        &format!("{HEAD}0,0,0,0.02,0.02,0.03\n"),
        &[],
    );
    assert_eq!(said.code, 0, "{said:?}");
    assert_eq!(result["tolerance"]["held"], true);
    assert_eq!(result["tolerance"]["missed"], Value::Null);
}

/// Arcs become chords where they are corrected: that can be worse than the program as it is.
#[test]
fn no_table_makes_a_program_worse() {
    let here = workplace();
    let programs = [
        "G21 G90\nG0 X25 Y0 Z0\nG2 X25 Y0 I-25 J0 F900\nM2\n",
        "G21 G90\nG0 X0 Y0 Z0\nG1 X33.3333 Y17 F900\nG3 X0 Y0 R30\nM2\n",
        "G20 G90\nG0 X0 Y0 Z0\nG1 X1.33333 Y.7 F90\nM2\n",
    ];
    for program in programs {
        for um in [0.001, 0.06, 0.3, 0.49, 0.6, 0.9, 1.4, 8.0] {
            for vary in [0.0, 0.5] {
                let at = |share: f64| format!("{},0,0", 1e-3 * um * (1.0 - share * vary));
                let table = format!("{HEAD}-99,0,0,{}\n99,0,0,{}\n", at(0.0), at(1.0));
                let (said, result, bytes) = corrected(&here, program, &table, &[]);
                assert_eq!(said.code, 0, "{said:?}");
                let [before, after, allowed] = ["before", "after", "allowed"].map(|when| {
                    result[format!("max_position_error_{when}_mm")]
                        .as_f64()
                        .unwrap()
                });
                let case = format!("{program} {um} um, {vary}: {before} {after} {allowed}");
                assert!(after <= before.max(1e-6) || before > allowed, "{case}");
                assert!(after <= allowed, "{case}");
                assert!(
                    before <= 1.000_001e-3 * um && before >= 0.4e-3 * um,
                    "{case}"
                );
                let same = bytes == program.as_bytes();
                assert_eq!(result["unchanged"], same, "{case}");
                assert!(same || before > 5e-4, "{case}");
                if same {
                    assert_eq!(before, after, "{case}");
                    assert!(
                        said.out.contains("comes back byte for byte"),
                        "{}",
                        said.out
                    );
                }
                assert_eq!(
                    result["within_tolerance_before"] == true,
                    said.out.contains("within the tolerance")
                );
            }
        }
    }
}

#[test]
fn nodes_that_may_be_in_micrometres_are_warned_of() {
    let here = workplace();
    let program = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 Y60 F900\nM2\n";
    for (reach, warned) in [(100.0, false), (4000.0, false), (100_000.0, true)] {
        let mut table = HEAD.to_owned();
        for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            table.push_str(&format!("{},{},0,0.03,0.01,0\n", reach * x, reach * y));
        }
        let (said, result, _) = corrected(&here, program, &table, &[]);
        assert_eq!(said.code, 0, "{said:?}");
        let list = result["warnings"].as_array().unwrap();
        let found = list.iter().any(|w| w["code"] == "wide_table");
        assert_eq!(found, warned, "{reach}: {list:?}");
        assert_eq!(said.out.contains("in micrometres?"), warned, "{}", said.out);
    }
}

/// A disk has names that are no text; several outputs are listed before they are put in place.
#[test]
#[cfg(unix)]
fn names_that_are_no_text_are_written_to() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let here = workplace();
    let name = OsStr::from_bytes(b"geh\xe4use.ngc");
    let Ok(()) = std::fs::write(here.path().join(name), "G21 G90\nG0 X0 Y0 Z0\nG1 X9 F600\n")
    else {
        // This disk has no such names.
        return;
    };
    std::fs::write(
        here.path().join("map.csv"),
        format!("{HEAD}0,0,0,0.01,0,0\n"),
    )
    .unwrap();
    let words = [
        "compensate",
        "--map",
        "map.csv",
        "--json",
        "r.json",
        "--program",
    ];
    let done = command(here.path()).args(words).arg(name).output().unwrap();
    assert!(done.status.success(), "{done:?}");
    let out = OsStr::from_bytes(b"geh\xe4use-compensated.ngc");
    assert!(here.path().join("r.json").exists());
    assert!(
        here.path().join(out).exists(),
        "{:?}",
        crate::common::contents(here.path()).keys()
    );
}

/// A rate that does not exist is no number in the JSON, and none on the terminal.
#[test]
fn a_rate_that_is_not_known_is_null() {
    let here = workplace();
    for (program, known) in [
        (crate::common::PROGRAM, true),
        ("G21 G90 G17\nG0 X20 Y0 Z5\nG0 X0 Y20\nM2\n", false),
    ] {
        std::fs::write(here.path().join("part.ngc"), program).unwrap();
        let words = [
            "compensate",
            "job.toml",
            // Of arcs there would be too few blocks for a rate over 16.
            "--arcs",
            "lines",
            "--force-overwrite",
            "--json",
            "r.json",
        ];
        let said = run(here.path(), &words);
        assert!([0, 3, 4].contains(&said.code), "{said:?}");
        let result: Value =
            serde_json::from_slice(&std::fs::read(here.path().join("r.json")).unwrap()).unwrap();
        let summary = &result["summary"];
        assert_eq!(
            summary["blocks_per_second"],
            summary["peak_blocks_per_second_after"]
        );
        assert_eq!(summary["blocks_per_second"].is_number(), known, "{summary}");
        let row = said
            .out
            .lines()
            .find(|l| l.contains("most of 16 in a row"))
            .unwrap();
        assert_eq!(row.ends_with("not available"), !known, "{row}");
    }
}
