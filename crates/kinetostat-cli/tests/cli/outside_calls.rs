//! Calls of what is in none of the files of a robot's program: an assumption, or refused where the user says that they move the tool.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::run;

/// A cut of two lines, with these instructions between motions.
fn program(between: &str) -> String {
    let position = |number: usize, x: f64, z: f64| {
        format!(
            "P[{number}]{{\n   GP1:\n    UF : 1, UT : 1,        CONFIG : 'N U T, 0, 0, 0',\n   X  = {x:.3}  mm,   Y  = 0.000  mm,   Z  = {z:.3}  mm,\n   W  = 180.000 deg,   P  = 0.000 deg,   R  = 0.000 deg\n}};\n"
        )
    };
    let places = [(0.0, 50.0), (0.0, 0.0), (60.0, 0.0)];
    let places = places.iter().enumerate();
    let places: String = places
        .map(|(at, (x, z))| position(at + 1, *x, *z))
        .collect();
    format!(
        "/PROG MILLX\n/ATTR\n/MN\n 1:UFRAME_NUM=1 ;\n 1:UTOOL_NUM=1 ;\n 1:J P[1] 10% FINE ;\n{between} 1:L P[2] 20mm/sec FINE ;\n{between} 1:L P[3] 20mm/sec FINE ;\n/POS\n{places}/END\n"
    )
}

const JOB: &str = "schema = 1\nmodel = \"fanuc_r2000ic_like\"\nprogram = \"mill.ls\"\n[load]\nweight = \"all\"\nmilling = { radial_n = 200, tangential_n = -50, axial_n = -30 }\n[robot.frames]\n\"UT:1\" = { position_mm = [0, 0, 250] }\n\"UF:1\" = { position_mm = [1500, 0, 700] }\n";

const CALL: &str = " 1:CALL SPINDLE_ON ;\n";
const TAKEN: &str = "taken not to move the tool and not to change speed, tool or frame";

fn put(here: &Path, between: &str, more: &str) {
    std::fs::write(here.join("mill.ls"), program(between)).unwrap();
    std::fs::write(here.join("job.toml"), JOB.to_owned() + more).unwrap();
}

/// The positions of the program that is written.
fn positions(here: &Path, out: &str) -> String {
    let said = run(here, &["compensate", "job.toml", "--out", out]);
    assert!(said.code == 0 || said.code == 4, "{said:?}");
    let text = std::fs::read_to_string(here.join(out)).unwrap();
    text[text.find("/POS").unwrap()..].to_owned()
}

#[test]
fn a_call_of_what_is_nowhere_is_an_assumption_of_all_commands() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(here, "", "");
    let without = positions(here, "without.ls");
    put(here, CALL, "");
    assert_eq!(positions(here, "with.ls"), without);
    for line in [
        "deflect job.toml",
        "check job.toml",
        "verify with.ls --job job.toml",
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let said = run(here, &words);
        let all = said.out.clone() + &said.err;
        let all: String = all.split_whitespace().collect::<Vec<_>>().join(" ");
        let note = format!("`SPINDLE_ON` is in none of the files: {TAKEN}");
        assert!(all.contains(&note), "{line}: {all}");
        let assumed = format!("The call of SPINDLE_ON (line 7), in none of the files, is {TAKEN}.");
        assert!(
            line.starts_with("check") || all.contains(&assumed),
            "{line}: {all}"
        );
    }
    let said = run(here, &["deflect", "job.toml", "--json"]).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let assumptions = found["assessment"]["assumptions"].as_array().unwrap();
    let kinds: Vec<&str> = (assumptions.iter())
        .map(|assumed| assumed["kind"].as_str().unwrap())
        .collect();
    assert!(kinds.contains(&"outside_calls"), "{kinds:?}");
}

/// What decides the way of a RAPID program is asked for by line, and stated by option or job.
#[test]
fn values_that_only_the_controller_knows_are_stated() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let to = |x: u32| {
        format!(
            "MoveL [[{x},0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,T1\\WObj:=W1;\n"
        )
    };
    let text = format!(
        "MODULE M\nPERS tooldata T1:=[TRUE,[[0,0,250],[1,0,0,0]],[5,[0,0,100],[1,0,0,0],0,0,0]];\n\
         PERS wobjdata W1:=[FALSE,TRUE,\"\",[[1500,0,700],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\nPROC main()\n{}{}IF di1=1 THEN\n{}ELSE\n{}ENDIF\nENDPROC\nENDMODULE\n",
        to(0),
        to(10),
        to(40),
        to(60)
    );
    std::fs::write(here.join("m.mod"), text).unwrap();
    let job = "schema = 1\nmodel = \"abb_irb6640_like\"\nprogram = \"m.mod\"\n[load]\nweight = \"none\"\nforce_n = [0, 0, -100]\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let said = run(here, &["deflect", "job.toml"]);
    let flat: String = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("line 7: `di1=1`") && flat.contains("--set NAME=VALUE"),
        "{flat}"
    );
    let length = |words: &[&str]| {
        let said = run(here, words).answered();
        let found: Value = serde_json::from_str(&said.out).unwrap();
        let said = found["warnings"].to_string();
        assert!(said.contains("as is stated"), "{said}");
        found["program"]["feed_length_mm"].as_f64().unwrap()
    };
    let check = ["check", "job.toml", "--json"];
    std::fs::write(
        here.join("job.toml"),
        job.to_owned() + "[values]\ndi1 = 1\n",
    )
    .unwrap();
    assert!((length(&check) - 40.0).abs() < 1e-9);
    std::fs::write(
        here.join("job.toml"),
        job.to_owned() + "[values]\ndi1 = 0\n",
    )
    .unwrap();
    assert!((length(&check) - 60.0).abs() < 1e-9);
    // The option goes over the job; what nothing asks for is no value of this program.
    let said = run(here, &["deflect", "job.toml", "--set", "DI1=1"]).answered();
    assert!(said.out.contains("40"), "{said:?}");
    let said = run(here, &["deflect", "job.toml", "--set", "di2=1"]).answered();
    let flat: String = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("`di2` is stated, and the run does not ask for it"),
        "{flat}"
    );
    let said = run(here, &["deflect", "job.toml", "--set", "di2"]);
    assert!(said.err.contains("NAME=VALUE"), "{said:?}");
}

#[test]
fn a_call_that_is_stated_to_move_is_refused_by_line() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(here, CALL, "[calls]\nSPINDLE_ON = \"moves\"\n");
    let said = run(here, &["compensate", "job.toml"]);
    assert_eq!(said.code, 1);
    let flat: String = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("`SPINDLE_ON` moves the tool, as is stated"),
        "{flat}"
    );
    put(here, CALL, "");
    let said = run(here, &["deflect", "job.toml", "--call", "spindle_on=moves"]);
    assert_eq!(said.code, 1);
    let flat: String = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("line 7"), "{flat}");
    let said = run(here, &["deflect", "job.toml", "--call", "SPINDLE_ON"]);
    assert!(said.err.contains("NAME=moves"), "{said:?}");
    // The subprograms of G-code have numbers.
    std::fs::write(here.join("a.nc"), "G21 G90 F100\nG1 X5\n").unwrap();
    let said = run(
        here,
        &[
            "deflect",
            "heavy_6r",
            "--program",
            "a.nc",
            "--call",
            "X=moves",
        ],
    );
    assert!(
        said.err.contains("a subprogram of G-code has a number"),
        "{said:?}"
    );
    let job = JOB
        .replace("mill.ls", "a.nc")
        .split("[robot.frames]")
        .next()
        .unwrap()
        .to_owned();
    std::fs::write(here.join("job.toml"), job + "[calls]\nX = \"moves\"\n").unwrap();
    let said = run(here, &["deflect", "job.toml"]);
    assert!(
        said.err.contains("a subprogram of G-code has a number"),
        "{said:?}"
    );
    let said = run(here, &["expand", "a.nc", "--set", "A=1"]);
    assert!(said.err.contains("--set is for programs"), "{said:?}");
    // For Fanuc's controllers the call of one that is not there stays, unless it moves the tool.
    std::fs::write(
        here.join("a.nc"),
        "G21 G90 G0 X0 Y0 Z5\nM98 P9000\nG1 X5 F100\nM30\n",
    )
    .unwrap();
    let expand = ["expand", "a.nc", "--dialect", "fanuc", "--no-comments"];
    let said = run(here, &expand);
    assert!(said.out.contains("\nM98 P9000\n"), "{said:?}");
    let said = run(here, &[&expand[..], &["--call", "O9000=moves"]].concat());
    assert!(
        said.err.contains("O9000 moves the tool, as is stated"),
        "{said:?}"
    );
    // A program in blocks that calls a file of its folder is run with it, not read past it.
    std::fs::write(
        here.join("main.mpf"),
        "G90 G0 X0 Y0 Z5\nHOLE\nG1 X5 F100\nM30\n",
    )
    .unwrap();
    std::fs::write(here.join("HOLE.SPF"), "G1 Z-5 F100\nG0 Z5\nRET\n").unwrap();
    let deflect = [
        "deflect",
        "heavy_6r",
        "--program",
        "main.mpf",
        "--force",
        "0",
        "0",
        "9",
    ];
    let said = run(here, &deflect);
    assert_eq!(said.code, 1);
    let flat: String = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("calls HOLE.SPF, which lies in its folder"),
        "{flat}"
    );
    std::fs::remove_file(here.join("HOLE.SPF")).unwrap();
    let said = run(here, &["expand", "main.mpf"]);
    assert!(said.err.contains("in none of the files"), "{said:?}");
    let said = run(here, &["expand", "main.mpf", "--call", "hole=moves"]);
    assert_eq!(said.code, 1);
    assert!(said.err.contains("`hole` moves the tool"), "{said:?}");
}

/// A program in G-code without a unit is in millimetres, which stands among the assumptions.
#[test]
fn a_unit_that_no_word_states_is_an_assumption() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let of = |program: &str| {
        std::fs::write(here.join("a.nc"), program).unwrap();
        let line = "deflect orthoglide --program a.nc --force 10 0 0 --json";
        let words: Vec<&str> = line.split_whitespace().collect();
        let said = run(here, &words).answered();
        let found: Value = serde_json::from_str(&said.out).unwrap();
        let all = found["assessment"]["assumptions"].as_array().unwrap();
        let units = all.iter().find(|assumed| assumed["kind"] == "units");
        units.map(|assumed| assumed["text"].as_str().unwrap().to_owned())
    };
    let without = of("G90 F300\nG0 X0 Y0 Z0\nG1 X5\n").unwrap();
    assert!(
        without.contains("millimetres, the first on line 2"),
        "{without}"
    );
    assert_eq!(of("G21 G90 F300\nG0 X0 Y0 Z0\nG1 X5\n"), None);
}

/// A program of that name lies beside: it is what is called.
#[test]
fn what_a_file_beside_holds_is_read() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(here, " 1:CALL GROOVE(2) ;\n", "");
    let groove = program("").replace("MILLX", "GROOVE");
    let (head, places) = groove.split_once("/MN").unwrap();
    let places = places.split_once("/POS").unwrap().1;
    let text = format!("{head}/MN\n 1:L P[AR[1]] 20mm/sec FINE ;\n/POS{places}");
    std::fs::write(here.join("groove.ls"), text).unwrap();
    let said = run(here, &["deflect", "job.toml"]);
    assert!(said.code != 0 && said.err.contains("--expand"), "{said:?}");
    let said = run(here, &["deflect", "job.toml", "--expand"]);
    assert!(said.code == 0 && !said.out.contains(TAKEN), "{said:?}");
    assert!(
        said.out
            .contains("path at feed                         110.00 mm"),
        "{said:?}"
    );
    let said = run(
        here,
        &["compensate", "job.toml", "--expand", "--out", "flat.ls"],
    );
    assert!(said.code == 0 || said.code == 4, "{said:?}");
    let said = run(
        here,
        &["verify", "flat.ls", "--job", "job.toml", "--expand"],
    );
    assert!(said.code == 0 || said.code == 4, "{said:?}");
}

/// A SINUMERIK program without jumps stays as it is under --expand, with its names: their stated values hold there, too.
#[test]
fn stated_values_hold_where_nothing_was_written_flat() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = "G17 G90 G54\nT1 D1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F600\nX=R5\nM30\n";
    std::fs::write(here.join("a.mpf"), text).unwrap();
    for with in [&["--set", "R5=10"][..], &["--set", "R5=10", "--expand"]] {
        let deflect = "deflect heavy_6r --program a.mpf --part-origin-mm 1200 0 900 --force 0 0 9 --weight none --json";
        let words: Vec<&str> = deflect
            .split_whitespace()
            .chain(with.iter().copied())
            .collect();
        let said = run(here, &words);
        assert!(!said.err.contains("has no value"), "{said:?}");
        let told = format!("{}{}", said.out, said.err);
        assert!(told.contains("`R5` is 10, as is stated"), "{said:?}");
    }
}

/// The values of a call that nothing here follows are those of the original, or it is said.
#[test]
fn other_values_of_a_call_are_named() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = "G21 G90 G54\nG0 X0 Y0 Z5\nG65 P9810 Z-5. F50\nG1 Z-1 F100\nG1 X10\nM30\n";
    std::fs::write(here.join("a.nc"), text).unwrap();
    let job = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"a.nc\"\n[expand]\ndialect = \"fanuc\"\n[tool]\nlength_mm = 0\n[load]\nforce_n = [0, 0, 50]\n";
    std::fs::write(here.join("job.toml"), job).unwrap();
    let said = run(here, &["compensate", "job.toml"]);
    assert_eq!(said.code, 0, "{said:?}");
    let written = std::fs::read_to_string(here.join("a-compensated.nc")).unwrap();
    assert!(written.contains("G65 P9810 Z-5. F50"), "{written}");
    let verify = || run(here, &["verify", "--job", "job.toml", "a-compensated.nc"]);
    assert!(!verify().out.contains("is not in the original"));
    std::fs::write(
        here.join("a-compensated.nc"),
        written.replace("Z-5.", "Z-6."),
    )
    .unwrap();
    let said = verify();
    assert!(said.out.contains("G65 P9810 Z-6 F50 at line"), "{said:?}");
}
