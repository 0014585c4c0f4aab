//! Places of machines that turn their tool as they move: by position only, in every command.

use crate::common::{Said, run, workplace};
use kinetostat_testing::Worst;
use nalgebra::Vector3;
use serde_json::Value;
use std::path::Path;

/// Turn about z, lift, reach; the tool beside the axis of the reach by 80 mm.
const ARM: &str = r#"schema = 1

[mechanism]
name = "rpp"

[[platform]]
name = "tool"
home = { position_mm = [500, 80, 0] }

[chain.arm]
elements = [
  { actuator = "revolute", name = "turn", axis = "z", stiffness_n_m_per_rad = 2e5 },
  { actuator = "prismatic", name = "lift", axis = "z", stiffness_n_per_mm = 4000 },
  { actuator = "prismatic", name = "reach", axis = "x", stiffness_n_per_mm = 3000 },
  { rigid = { translation_mm = [500, 80, 0] } },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

fn ask(here: &Path, line: &str) -> Said {
    let words: Vec<&str> = line.split(' ').collect();
    run(here, &words)
}

fn json(here: &Path, line: &str) -> Value {
    let said = ask(here, line).answered();
    serde_json::from_str(&said.out).expect("JSON")
}

fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Bearing at which the tool of the arm stands, deg.
fn bearing(x: f64, y: f64) -> f64 {
    (y.atan2(x) - (80.0 / x.hypot(y)).asin()).to_degrees()
}

#[test]
fn every_command_takes_a_position() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("rpp.toml"), ARM).expect("a model");
    let closed = bearing(300.0, 450.0);
    for line in [
        "stiffness rpp.toml --at 300 450 20 --json",
        "stiffness rpp.toml --at 300 450 20 --force 10 20 30 --json",
        "deflect rpp.toml --at 300 450 20 --force 10 20 30 --json",
        "deflect rpp.toml --at 300 450 20 --rotation follows --json",
        "assemble rpp.toml --at 300 450 20 --json",
    ] {
        let answer = json(here, line);
        let place = &answer["place"];
        let turn = place["tool_turn_deg"].as_f64().expect("a figure");
        assert!((turn - closed).abs() < 1e-8, "{line}: {turn} {closed}");
        let vector = place["rotation_vector_deg"][2].as_f64().expect("a number");
        assert!((vector - closed).abs() < 1e-8, "{line}: {vector}");
        let requested = line.contains("follows");
        let warnings = flat(&answer["warnings"].to_string());
        assert_eq!(
            warnings.contains("cannot hold an orientation"),
            !requested,
            "{warnings}"
        );
        assert!(warnings.contains("the tool turns by"), "{warnings}");
    }
    for line in [
        "equilibria rpp.toml --at 300 450 20",
        "curve rpp.toml --at 300 450 20 --force 0 0 100 --factor 0 1",
        "model draw rpp.toml --at 300 450 20 --out there.svg",
        "assemble rpp.toml --along 300 450 20 450 -300 40 --points 5",
    ] {
        let said = ask(here, line);
        let wrong = said.err.contains("cannot be reached");
        assert!(!wrong && said.code == 0, "{line}: {said:?}");
    }
    // An orientation that was requested is held, or refused.
    let held = ask(
        here,
        "deflect rpp.toml --at 300 450 20 --rotation rotation_vector_deg=0,0,0",
    );
    assert_eq!(held.code, 2, "{held:?}");
    let text =
        format!("deflect rpp.toml --at 300 450 20 --rotation rotation_vector_deg=0,0,{closed}");
    ask(here, &text).answered();
    // Machines that hold their orientation are not required to turn.
    let answer = json(here, "deflect orthoglide --at 20 10 30 --json");
    assert!(answer["place"].get("tool_turn_deg").is_none());
}

#[test]
fn a_map_tells_how_far_the_tool_turns() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("rpp.toml"), ARM).expect("a model");
    let line = "map rpp.toml --x 300 500 5 --y -200 200 5 --z 0 --csv map.csv --json";
    let answer = json(here, line);
    assert_eq!(answer["places"]["regular"], 25);
    let table = std::fs::read_to_string(here.join("map.csv")).expect("a table");
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let column = names
        .iter()
        .position(|n| *n == "tool_turn_deg")
        .expect("it is there");
    // The table has seven digits, and not more than five decimals.
    let alike = |a: f64, b: f64| (a - b).abs() < 5e-7 * b + 5.01e-6;
    let mut most = Worst::new();
    for line in lines {
        let cell = |k: usize| -> f64 {
            let text = line.split(',').nth(k).expect("a cell");
            text.parse().expect("a number")
        };
        let own = bearing(cell(0), cell(1)).abs();
        assert!(alike(cell(column), own), "{line} {own}");
        most.add(own);
    }
    let most = most.value();
    let reported = answer["max_tool_turn_deg"].as_f64().expect("a figure");
    assert!((reported - most).abs() < 1e-8, "{reported} {most}");
}

#[test]
fn the_table_of_points_tells_how_far_the_tool_turns() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("rpp.toml"), ARM).expect("a model");
    let of = |model: &str, origin: [f64; 3]| {
        let [x, y, z] = origin;
        let line = format!(
            "deflect {model} --program part.ngc --part-origin-mm {x} {y} {z} --force 30 -40 -20 --points p.csv --force-overwrite"
        );
        ask(here, &line).answered();
        let table = std::fs::read_to_string(here.join("p.csv")).expect("a table");
        let rows = table
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect());
        rows.collect::<Vec<Vec<String>>>()
    };
    let table = of("rpp.toml", [400.0, 100.0, 0.0]);
    let column = |name: &str| {
        let found = table[0].iter().position(|n| n == name);
        found.unwrap_or_else(|| panic!("{name}: {:?}", table[0]))
    };
    let [turn, x, y] = ["tool_turn_deg", "x_mm", "y_mm"].map(column);
    assert!(table.len() > 100);
    for row in &table[1..] {
        assert_eq!(row.len(), table[0].len(), "{row:?}");
        let number = |k: usize| row[k].parse::<f64>().expect("a number");
        let own = bearing(400.0 + number(x), 100.0 + number(y)).abs();
        // Five decimals, of places that have four.
        assert!((number(turn) - own).abs() < 3e-5, "{row:?} {own}");
    }
    // A machine that holds its orientation has no such column.
    let held = of("orthoglide", [0.0, 0.0, 0.0]);
    assert!(!held[0].contains(&"tool_turn_deg".to_owned()));
}

#[test]
fn a_program_is_corrected_on_an_arm_that_turns() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("rpp.toml"), ARM).expect("a model");
    let job = |placement: &str| {
        let text = format!(
            "schema = 1\nmodel = \"rpp.toml\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [400, 100, 0]\n{placement}\n[load]\nforce_n = [30, -40, -20]\n"
        );
        std::fs::write(here.join("job.toml"), text).expect("a job");
    };
    for placement in ["", "orientation = \"follows\""] {
        job(placement);
        let answer = json(
            here,
            "compensate job.toml --out out.ngc --force-overwrite --json",
        );
        let summary = &answer["summary"];
        let figure = |name: &str| summary[name].as_f64().expect("a figure");
        assert!(figure("max_position_error_before_mm") > 0.01);
        assert!(figure("max_position_error_after_mm") < 0.0015, "{summary}");
        // The program goes through the corners (20, 0), (0, 20) and (-20, 0).
        assert!(
            figure("max_tool_turn_deg") > bearing(400.0, 120.0) - 1e-6,
            "{summary}"
        );
        for point in answer["points"].as_array().expect("points") {
            let number = |name: &str, k: usize| point[name][k].as_f64().expect("a number");
            let own = bearing(
                400.0 + number("position_mm", 0),
                100.0 + number("position_mm", 1),
            );
            let correction = Vector3::from([0, 1, 2].map(|k| number("correction_mm", k))).norm();
            // It stands where it is commanded: off by the correction.
            let off = (number("tool_turn_deg", 2) - own).abs();
            assert!(off < correction / 300.0_f64.to_radians() + 1e-6, "{point}");
        }
    }
    job("orientation = \"held\"");
    let held = ask(here, "compensate job.toml --out out.ngc --force-overwrite");
    assert_eq!(held.code, 2, "{held:?}");
}
