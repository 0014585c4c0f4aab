//! Tables of joint values: compensated with a model, and written as joint values again.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use kinetostat_testing::Worst;
use serde_json::Value;

use crate::common::checks::flat;
use crate::common::run;

/// A straight cut in rows near to each other: the joints of heavy_6r turn evenly.
fn table(unit: &str) -> String {
    let mut text = format!(
        "note,A1_{unit},A2_{unit},A3_{unit},A4_{unit},A5_{unit},A6_{unit},speed_mm_per_s\n"
    );
    let [from, to] = [
        [2.0, 7.0, 29.0, 2.4, 48.0, -15.0],
        [3.0, 7.4, 28.6, 2.9, 48.5, -14.0],
    ];
    for row in 0..=6 {
        let share = f64::from(row) / 6.0;
        text.push_str(&format!("row {row}"));
        for (a, b) in from.iter().zip(to) {
            let degrees: f64 = a + share * (b - a);
            match unit {
                "deg" => text.push_str(&format!(",{degrees:.5}")),
                _ => text.push_str(&format!(",{:.7}", degrees.to_radians())),
            }
        }
        text.push_str(",20\n");
    }
    text
}

const RUN: &str = "compensate --model heavy_6r --weight all --program q.csv --tool-length-mm 180 --force 300 -200 500 --correct pose";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn place(text: &str) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("q.csv"), text).unwrap();
    here
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

/// Joint values of the rows, deg, and what stands beside them.
fn rows(text: &str, unit: &str) -> Vec<(String, Vec<f64>)> {
    let lines = text.lines().filter(|line| line.starts_with("row "));
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let joints = cells[1..7].iter().map(|cell| {
                let value: f64 = cell.parse().unwrap();
                match unit {
                    "deg" => value,
                    _ => value.to_degrees(),
                }
            });
            (cells[0].to_owned(), joints.collect())
        })
        .collect()
}

/// Joint values that the table of points says are commanded, by line of the program.
fn commands(points: &str) -> Vec<(usize, Vec<f64>)> {
    let mut lines = points.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let of: Vec<usize> = (1..=6)
        .map(|joint| {
            let name = format!("joint_{joint}_command_deg");
            names.iter().position(|found| *found == name).unwrap()
        })
        .collect();
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let joints = of.iter().map(|cell| cells[*cell].parse().unwrap());
            (cells[0].parse().unwrap(), joints.collect())
        })
        .collect()
}

#[test]
fn a_table_of_joint_values_is_compensated_and_is_one_again() {
    for (unit, way) in [("deg", "joint"), ("rad", "linear")] {
        let text = table(unit);
        let here = place(&text);
        let here = here.path();
        // The analysis commands what is written.
        let line = format!(
            "deflect heavy_6r --weight all --program q.csv --tool-length-mm 180 --force 0 0 100 --joint-rows {way} --points p.csv --all-points"
        );
        run(here, &words(&line)).answered();
        let commanded = commands(&read(here, "p.csv"));
        let mut worst = Worst::new();
        let own = rows(&text, unit);
        for (row, (_, joints)) in own.iter().enumerate() {
            // The line of names comes first; the last point of a line is its end.
            let last = commanded.iter().rev().find(|(line, _)| *line == row + 2);
            let (_, found) = last.unwrap();
            for (a, b) in joints.iter().zip(found) {
                worst.add(a - b);
            }
        }
        // The digits of the two tables.
        assert!(worst.of(42) < 1.1e-5, "{}", worst.value());
        let line = format!("{RUN} --joint-rows {way} --json out.json --tolerance-um 10");
        run(here, &words(&line)).answered();
        let out: Value = serde_json::from_str(&read(here, "out.json")).unwrap();
        let figure = |name: &str| out["summary"][name].as_f64().unwrap();
        assert!(figure("max_position_error_before_mm") > 0.3, "{out}");
        assert!(figure("max_position_error_after_mm") < 0.011, "{out}");
        let written = read(here, "q-compensated.csv");
        let corrected = rows(&written, unit);
        assert!(corrected.len() >= own.len());
        for (name, joints) in &own {
            // The last row of a name is the end of the motion: near to the old one, and not the same.
            let (_, found) = corrected.iter().rev().find(|(own, _)| own == name).unwrap();
            let mut off = Worst::new();
            for (a, b) in joints.iter().zip(found) {
                off.add(a - b);
            }
            assert!((1e-3..0.2).contains(&off.of(6)), "{name}: {}", off.value());
        }
        assert!(written.lines().all(|line| !line.contains("NaN")));
    }
}

#[test]
fn what_a_table_of_joint_values_does_not_say_is_asked_for() {
    let text = table("deg");
    let here = place(&text);
    let here = here.path();
    let deflect = "deflect heavy_6r --weight all --program q.csv --force 0 0 1";
    for (line, expected) in [
        (deflect.to_owned(), "--joint-rows"),
        (
            format!("{deflect} --joint-rows joint"),
            "where the tip of the tool is in the flange is not stated",
        ),
        (
            "deflect orthoglide --program q.csv --force 0 0 1 --tool-length-mm 9 --joint-rows joint"
                .to_owned(),
            "no arm of six turning joints",
        ),
    ] {
        let said = run(here, &words(&line));
        assert_eq!(said.code, 1, "{said:?}");
        assert!(flat(&said.err).contains(expected), "{expected}: {said:?}");
        assert!(flat(&said.err).contains("line 2:"), "{said:?}");
    }
    let full = format!("{deflect} --joint-rows joint --tool-length-mm 180");
    run(here, &words(&full)).answered();
    // Rows so far apart that the tool goes a bow between them; a way in air may.
    let wide = format!("{}row 9,60.0,7.4,28.6,2.9,48.5,-14.0,20\n", table("deg"));
    std::fs::write(here.join("q.csv"), wide).unwrap();
    let said = run(here, &words(&full));
    assert_eq!(said.code, 1, "{said:?}");
    let shown = flat(&said.err);
    assert!(shown.contains("leaves the straight way"), "{shown}");
    assert!(shown.contains("line 9"), "{shown}");
    let linear = full.replace("--joint-rows joint", "--joint-rows linear");
    run(here, &words(&linear)).answered();
    // Five joints are those of another arm.
    let five: String = text
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            format!("{}\n", cells[..6].join(","))
        })
        .collect();
    std::fs::write(here.join("q.csv"), five).unwrap();
    let said = run(here, &words(&full));
    assert_eq!(said.code, 1);
    assert!(
        flat(&said.err).contains("the table has 5 joints, the arm 6"),
        "{said:?}"
    );
}

/// KUKA shows A2 and A3 with other zeros and A1, A4 and A6 with other signs: the same rows in its numbers are the same program.
#[test]
fn joint_values_are_those_that_the_controller_shows_where_the_model_says_how() {
    let model = include_str!("../../../kinetostat-model/models/heavy_6r.toml");
    let shown: &[(&str, f64, f64)] = &[
        ("joint 1", -1.0, 0.0),
        ("joint 2", 1.0, -90.0),
        ("joint 3", 1.0, 90.0),
        ("joint 4", -1.0, 0.0),
        ("joint 5", 1.0, 0.0),
        ("joint 6", -1.0, 0.0),
    ];
    let own = table("deg");
    let text: String = own
        .lines()
        .map(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if line.starts_with("row ") {
                for (cell, (_, sign, offset)) in cells[1..7].iter_mut().zip(shown) {
                    *cell = format!("{:.5}", sign * cell.parse::<f64>().unwrap() + offset);
                }
            }
            format!("{}\n", cells.join(","))
        })
        .collect();
    let here = place(&text);
    let here = here.path();
    let mut with = format!("{model}\n[controller]\nname = \"KR C4\"\naxis = [\n");
    for (number, (joint, sign, offset)) in shown.iter().enumerate() {
        let reversed = *sign < 0.0;
        with.push_str(&format!(
            "  {{ name = \"A{}\", joint = \"{joint}\", reversed = {reversed}, zero_offset_deg = {offset:?} }},\n",
            number + 1
        ));
    }
    with.push_str("]\n");
    std::fs::write(here.join("arm.toml"), with).unwrap();
    let line = RUN.replace("heavy_6r", "arm.toml");
    let said = run(here, &words(&format!("{line} --joint-rows linear"))).answered();
    assert!(
        flat(&said.out).contains("as the controller shows them"),
        "{said:?}"
    );
    let found = rows(&read(here, "q-compensated.csv"), "deg");
    std::fs::write(here.join("q.csv"), own).unwrap();
    let line = RUN.replace("--program", "--out own.csv --program");
    let said = run(here, &words(&format!("{line} --joint-rows linear"))).answered();
    assert!(flat(&said.out).contains("zeros and directions"), "{said:?}");
    let wanted = rows(&read(here, "own.csv"), "deg");
    assert_eq!(found.len(), wanted.len());
    for ((_, found), (_, wanted)) in found.iter().zip(&wanted) {
        for ((found, wanted), (_, sign, offset)) in found.iter().zip(wanted).zip(shown) {
            assert!(
                (found - (sign * wanted + offset)).abs() < 2e-6,
                "{found} {wanted}"
            );
        }
    }
}

/// Rows beyond a limit of the model are said with value, limit and what to do, and the program is written.
#[test]
fn rows_beyond_the_limits_of_the_arm_are_said() {
    // heavy_6r turns joint 6 by 350 deg, and joint 2 down to -65 deg.
    let mut text = String::new();
    for (row, line) in table("deg").lines().enumerate() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let (3.., Ok(turn)) = (row, cells[6].parse::<f64>()) {
            cells[6] = format!("{:.5}", turn - 400.0);
        }
        if row == 5 {
            cells[2] = "-66".to_owned();
        }
        text.push_str(&(cells.join(",") + "\n"));
    }
    let here = place(&text);
    let here = here.path();
    std::fs::write(
        here.join("cell.toml"),
        "schema = 1\n[tool]\npose = { position_mm = [0, 0, 180] }\n",
    )
    .unwrap();
    let line = "convert q.csv --to csv --model heavy_6r --joint-rows linear --template cell.toml --out p.csv";
    let said = flat(&run(here, &words(line)).answered().out);
    for needle in [
        "line 4: joint 6 is at -414.6667 deg (and beyond it up to line 8), and its limit in the model is -350 deg",
        "where -54.6667 deg is the same place",
        "line 6: joint 2 is at -66 deg, and its limit in the model is -65 deg",
    ] {
        assert!(said.contains(needle), "{needle}: {said}");
    }
    assert!(here.join("p.csv").exists());
    let within = table("deg");
    std::fs::write(here.join("q.csv"), within).unwrap();
    let said = run(here, &words(&format!("{line} --force-overwrite"))).answered();
    assert!(!said.out.contains("limit"), "{said:?}");
    // A run over the table says it, too.
    std::fs::write(here.join("q.csv"), text.replace("-66", "7")).unwrap();
    let line = "deflect heavy_6r --weight all --program q.csv --tool-length-mm 180 --force 0 0 100 --joint-rows linear";
    let said = flat(&run(here, &words(line)).answered().out);
    assert!(
        said.contains("line 4: joint 6 is at -414.6667 deg"),
        "{said}"
    );
}
