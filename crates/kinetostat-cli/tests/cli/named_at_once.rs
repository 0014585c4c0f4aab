//! All that is wrong with a program is named in one run, by line, with what to do.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::{Said, run};

fn put(here: &Path, name: &str, text: &str) {
    std::fs::write(here.join(name), text).unwrap();
}

fn ask(here: &Path, line: &str) -> Said {
    run(here, &line.split_whitespace().collect::<Vec<_>>())
}

/// Lines that a list of faults names, in its order.
fn lines_named(text: &str) -> Vec<usize> {
    let lines = text
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix("line "));
    lines
        .filter_map(|rest| rest.split(':').next()?.parse().ok())
        .collect()
}

#[test]
fn what_an_expansion_refuses_is_one_list() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = "G21 G90\n#1 = 3\nG0 X0 Y0 Z5\nG38.2 Z-10\nM98 P77\nO<nix> call\nG1 X[#1 / 0] F100\nG1 X5 X6\nG1 X7\nM2\n";
    put(here, "part.ngc", text);
    for line in [
        "expand part.ngc --out flat.ngc",
        "compensate --expand --model orthoglide --program part.ngc --force 0 0 100",
    ] {
        let said = ask(here, line);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("5 lines are refused"), "{said:?}");
        assert_eq!(lines_named(&said.err), [4, 5, 6, 7, 8], "{said:?}");
    }
    assert!(!here.join("flat.ngc").exists());
}

#[test]
fn an_empty_file_is_not_sent_to_the_expansion() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(here, "part.ngc", "");
    let said = ask(
        here,
        "compensate --model orthoglide --program part.ngc --force 0 0 100",
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("the file is empty"), "{said:?}");
    assert!(!said.err.contains("--expand"), "{said:?}");
}

/// The main program of a long one in TP has no motion: with --expand those that it calls are (KRL and RAPID need no option).
#[test]
fn a_main_program_is_read_with_the_parts_that_it_calls() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(
        here,
        "part.ngc",
        "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nX20\nY20\nX0\nG0 Z5\nM2\n",
    );
    put(
        here,
        "cell.toml",
        "schema = 1\nmost_points = 3\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\npose = { position_mm = [1800, 0, 900] }\n[tool]\npose = { position_mm = [0, 0, 180] }\nmass_kg = 5\n",
    );
    let made = "convert part.ngc --to ls --out part.ls --template cell.toml";
    ask(here, made).answered();
    let question = "compensate --model heavy_6r --weight all --program part.ls --force 60 20 100 --rapid-from-mm-per-s 100";
    let said = ask(here, question);
    assert_eq!(said.code, 1, "{said:?}");
    for expected in [
        "part_2.ls, line 12: motions stand in this file and in part_1.ls",
        "--expand",
        "one by one",
    ] {
        assert!(said.err.contains(expected), "{expected}: {said:?}");
    }
    put(
        here,
        "job.toml",
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ls\"\n[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n[robot.frames]\n\"UT:1\" = { position_mm = [0, 0, 180] }\n\"UF:1\" = { position_mm = [1800, 0, 900] }\n",
    );
    let said = ask(
        here,
        "compensate job.toml --expand --out flat.ls --rapid-from-mm-per-s 100",
    );
    assert!(said.code == 0 || said.code == 4, "{said:?}");
}

#[test]
fn coordinates_that_no_machine_reaches_are_named_before_anything_is_solved() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let target = |x: &str| format!("[[{x},0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    let text = format!(
        "MODULE m\nPERS tooldata t:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\nPROC main()\nMoveJ {},v100,fine,t;\nMoveL {},v10,fine,t;\nMoveL {},[0,500,0,0],fine,t;\nENDPROC\nENDMODULE\n",
        target("1800"),
        target("1E30"),
        target("1810"),
    );
    put(here, "far.mod", &text);
    let said = ask(
        here,
        "compensate --model heavy_6r --weight all --program far.mod --force 0 0 100 --rapid-from-mm-per-s 50",
    );
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("2 lines are refused"), "{said:?}");
    let [far, slow] = [
        "far.mod, line 5: it leads to",
        "far.mod, line 6: its speed is 0",
    ]
    .map(|words| said.err.find(words));
    assert!(far.is_some() && far < slow, "{said:?}");
}

/// How far the tip yields at most, um/N.
fn compliance(text: &str) -> Option<f64> {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, rest) = text.split_once("the tip yields at most ")?;
    rest.split(' ').next()?.parse().ok()
}

#[test]
fn a_turn_that_is_to_be_stiff_says_how_stiff_it_is() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    put(
        here,
        "part.ngc",
        "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nX200\nG0 Z5\nM2\n",
    );
    put(
        here,
        "cell.toml",
        "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\npose = { position_mm = [1300, 0, 800] }\n[tool]\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\nmass_kg = 5\n",
    );
    let line = "convert part.ngc --to krl --out part.src --template cell.toml --force-overwrite";
    let said = ask(here, &format!("{line} --free-turn heavy_6r"));
    assert_eq!(compliance(&said.answered().out), None);
    let free = std::fs::read(here.join("part.src")).unwrap();
    let said = ask(here, &format!("{line} --free-turn heavy_6r --stiff-turn")).answered();
    assert!(
        compliance(&said.out).is_some_and(|most| most > 0.0),
        "{said:?}"
    );
    assert_ne!(std::fs::read(here.join("part.src")).unwrap(), free);
    // It says how a turn is chosen, and needs one.
    for line in [
        line.to_owned() + " --stiff-turn",
        "compensate --model heavy_6r --weight all --program part.ngc --force 0 0 9 --to krl --template cell.toml --stiff-turn".to_owned(),
    ] {
        let said = ask(here, &line);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("--free-turn"), "{said:?}");
    }
}
