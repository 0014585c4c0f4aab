//! `kinetostat engagement`: closed forms of a slot, what `force` says of the same cut, files, refusals; and the same
//! figures in the result of a run, with the spread of the force through to the errors.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use serde_json::Value;

use crate::common::chains::{json, number};
use crate::common::checks::flat;
use crate::common::{contents, run};

/// A slot of 6 mm, 2 mm deep, through a block of 40 mm, and back above it.
const SLOT: &str = "G21 G90 G94\nS10000 M3\nG0 X-10 Y0 Z5\nG1 Z-2 F2000\nG1 X50 F600\nG0 Z5\nM2\n";

/// Coefficients without an edge force: the torque of a slot is `K_tc depth feed teeth diameter / (2 pi)`.
const WAX: &str = r#"[[material]]
name = "wax"
group = "other"
spread_percent = 20
source = "our dynamometer"
measured_in = { process = "milling" }
[material.law.linear]
cutting_n_per_mm2 = [800, 200, 100]
edge_n_per_mm = [0, 0, 0]
"#;

const JOB: &str = r#"schema = 1
program = "slot.ngc"
[tool]
cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }
[material]
name = "wax"
file = "wax.toml"
[stock]
block_mm = [[0, -20, -10], [40, 20, 0]]
[spindle]
power_w = 100
base_rpm = 10000
most_rpm = 20000
"#;

fn place(job: &str, program: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    for (name, text) in [("slot.ngc", program), ("wax.toml", WAX), ("job.toml", job)] {
        std::fs::write(directory.path().join(name), text).unwrap();
    }
    directory
}

#[track_caller]
fn close(found: f64, expected: f64, share: f64) {
    let apart = (found - expected).abs();
    assert!(apart <= share * expected.abs(), "{found}, not {expected}");
}

fn answer(here: &Path) -> Value {
    json(here, &["engagement", "job.toml"])
}

#[test]
fn a_slot_has_its_volume_torque_and_power() {
    let here = place(JOB, SLOT);
    let a = answer(here.path());
    close(number(&a["stock"]["volume_mm3"]), 40.0 * 40.0 * 10.0, 1e-5);
    close(number(&a["stock"]["removed_mm3"]), 6.0 * 2.0 * 40.0, 5e-3);
    close(
        number(&a["stock"]["removed_percent"]),
        100.0 * 480.0 / 16_000.0,
        5e-3,
    );
    let cutting = &a["cutting"];
    let torque = 1e-3 * 800.0 * 2.0 * 0.03 * 2.0 * 6.0 / std::f64::consts::TAU;
    close(
        number(&cutting["largest_torque"]["torque_n_m"]),
        torque,
        1e-3,
    );
    let turn_rate = std::f64::consts::TAU * 10_000.0 / 60.0;
    close(
        number(&cutting["largest_power"]["power_w"]),
        torque * turn_rate,
        1e-3,
    );
    close(number(&cutting["largest_chip"]["chip_mm"]), 0.03, 1e-6);
    let near = &cutting["nearest_to_spindle"];
    close(number(&near["spindle_torque_n_m"]), 100.0 / turn_rate, 1e-9);
    // From the first touch to where the tool has left: the block and a radius before it.
    close(number(&cutting["cut_length_mm"]), 43.0, 0.02);
    close(number(&a["feed_length_mm"]), 67.0, 1e-9);
    assert_eq!(cutting["worst_lines"].as_array().unwrap().len(), 1);
    assert_eq!(cutting["worst_lines"][0]["line"], 5);
    close(number(&cutting["largest_force"]["arc_deg"]), 180.0, 0.01);
    close(number(&cutting["spread_percent"]), 20.0, 1e-9);
}

/// The stated engagement of a straight cut is what `force` computes for it, direction by direction.
#[test]
fn a_straight_cut_has_the_force_of_the_command_for_one_cut() {
    let job = JOB.replace(
        "[stock]\nblock_mm = [[0, -20, -10], [40, 20, 0]]",
        "[engagement]\nwidth_mm = 2\ndepth_mm = 3\npart = \"right\"",
    );
    let here = place(&job, SLOT);
    let a = answer(here.path());
    assert!(a["stock"].is_null());
    let line = "force --material wax --materials wax.toml --tool flat --diameter-mm 6 --teeth 2 --helix-deg 30 --width-mm 2 --depth-mm 3 --part right --feed-per-tooth-mm 0.03 --rpm 10000";
    let words: Vec<&str> = line.split(' ').collect();
    let one = json(here.path(), &words);
    let places = a["cutting"]["places"].as_array().unwrap();
    let along = places
        .iter()
        .filter(|p| p["line"] == 5 && p["kind"] == "feed");
    let mut compared = 0;
    for place in along {
        for (k, name) in ["force_along_feed_n", "force_left_n", "force_up_n"]
            .into_iter()
            .enumerate()
        {
            close(
                number(&place[name]),
                number(&one["mean"]["force_n"][k]),
                1e-6,
            );
        }
        close(
            1e3 * number(&place["torque_n_m"]),
            number(&one["mean"]["torque_n_mm"]),
            1e-6,
        );
        compared += 1;
    }
    assert_eq!(compared, 2);
    // Without a stock there is no map, and that is said.
    let said = run(
        here.path(),
        &["engagement", "job.toml", "--plot", "cut.svg"],
    )
    .answered();
    assert!(
        flat(&said.out).contains("the picture has no map"),
        "{}",
        said.out
    );
    let svg = std::fs::read_to_string(here.path().join("cut.svg")).unwrap();
    assert!(!svg.contains("mm deep") && svg.contains("Force on the tool"));
}

#[test]
fn the_files_hold_what_the_answer_says() {
    let here = place(JOB, SLOT);
    let line = [
        "engagement",
        "job.toml",
        "--plot",
        "cut.svg",
        "--csv",
        "cut.csv",
        "--json",
        "cut.json",
    ];
    let said = run(here.path(), &line).answered();
    let text = flat(&said.out);
    for part in [
        "takes 4",
        "mm3 off the stock",
        "line 5",
        "20 % more",
        "our dynamometer",
        "height field",
        "play no part",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let a: Value =
        serde_json::from_slice(&std::fs::read(here.path().join("cut.json")).unwrap()).unwrap();
    let csv = std::fs::read_to_string(here.path().join("cut.csv")).unwrap();
    let mut rows = csv.lines();
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    assert_eq!(
        rows.len() as u64,
        a["cutting"]["stations"].as_u64().unwrap()
    );
    let value = |row: &Vec<&str>, name: &str| row[column(name)].parse::<f64>().unwrap();
    let mut inside = 0;
    for row in &rows {
        let size = ["force_along_feed_n", "force_left_n", "force_up_n"]
            .map(|name| value(row, name).powi(2))
            .iter()
            .sum::<f64>()
            .sqrt();
        assert!((value(row, "force_n") - size).abs() <= 1e-9 * (1.0 + size));
        // In the block, well behind its edge, the slot is full; before it nothing is cut.
        let x = value(row, "x_mm");
        if row[column("line")] == "5" && x > 4.0 && x < 36.5 {
            close(value(row, "depth_mm"), 2.0, 1e-4);
            close(value(row, "arc_deg"), 180.0, 0.01);
            close(value(row, "rpm"), 10_000.0, 1e-12);
            inside += 1;
        }
        if x < -4.0 {
            assert!(value(row, "force_n") == 0.0, "{row:?}");
        }
    }
    assert!(inside > 10, "{inside}");
    let svg = std::fs::read_to_string(here.path().join("cut.svg")).unwrap();
    for part in [
        "taken off, mm deep",
        "x, mm",
        "y, mm",
        "force, N",
        "torque, N m",
        "not cut",
        "line 5",
        "length of the path, mm",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    // What exists is not overwritten, and an input never.
    let before = contents(here.path());
    for target in [
        &["--csv", "cut.csv"][..],
        &["--plot", "wax.toml", "--force-overwrite"],
    ] {
        let line: Vec<&str> = ["engagement", "job.toml"]
            .iter()
            .chain(target)
            .copied()
            .collect();
        assert_eq!(run(here.path(), &line).code, 1);
        assert_eq!(contents(here.path()), before);
    }
}

/// Model and placement of a job play no part; another program may be named.
#[test]
fn a_job_with_a_machine_gives_the_same() {
    let whole = JOB.replace(
        "[tool]\n",
        "model = \"orthoglide\"\n[placement]\npart_origin_mm = [0, 0, 100]\nscale = 1.5\n[tool]\nlength_mm = 60\n",
    );
    let a = answer(place(JOB, SLOT).path());
    let b = answer(place(&whole, SLOT).path());
    assert_eq!(a["cutting"], b["cutting"]);
    let here = place(JOB, SLOT);
    std::fs::write(here.path().join("half.ngc"), SLOT.replace("X50", "X20")).unwrap();
    let c = json(
        here.path(),
        &["engagement", "job.toml", "--program", "half.ngc"],
    );
    // A slot that ends in the block: the half circle before the axis comes to it.
    let expected = 2.0 * (6.0 * 20.0 + 0.5 * std::f64::consts::PI * 9.0);
    close(number(&c["stock"]["removed_mm3"]), expected, 5e-3);
    let air = JOB.replace(
        "[[0, -20, -10], [40, 20, 0]]",
        "[[0, -20, -10], [40, 20, -4]]",
    );
    let here = place(&air, SLOT);
    let said = run(
        here.path(),
        &["engagement", "job.toml", "--plot", "cut.svg"],
    )
    .answered();
    assert!(said.out.contains("cuts nothing"), "{}", said.out);
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let refused = |job: &str, program: &str, words: &[&str]| {
        let here = place(job, program);
        let before = contents(here.path());
        let said = run(here.path(), &["engagement", "job.toml", "--csv", "cut.csv"]);
        assert_eq!(said.code, 1, "{said:?}");
        let text = flat(&said.err);
        for word in words {
            assert!(text.contains(word), "{word}: {text}");
        }
        assert_eq!(contents(here.path()), before, "something was written");
    };
    let without = |from: &str, to: &str| JOB.replace(from, to);
    let material = "[material]\nname = \"wax\"\nfile = \"wax.toml\"\n";
    refused(&without(material, ""), SLOT, &["job.toml:5", "no material"]);
    let bare = "schema = 1\nprogram = \"slot.ngc\"\n";
    refused(bare, SLOT, &["job.toml", "names no material", "[material]"]);
    refused(
        &without("\"wax\"", "\"vax\""),
        SLOT,
        &["job.toml:6:8", "wax"],
    );
    refused(&without("teeth = 2", "teeth = 0"), SLOT, &["job.toml:4"]);
    refused(
        JOB,
        &SLOT.replace("S10000 ", ""),
        &["slot.ngc", "line 5", "speed"],
    );
    refused(JOB, &SLOT.replace("X50", "X5O"), &["slot.ngc", "line 5"]);
    refused(
        &without("program = \"slot.ngc\"\n", ""),
        SLOT,
        &["names no program"],
    );
}

/// The run of a job says the same of its cut, and how far its coefficients go.
#[test]
fn the_result_of_a_run_holds_cut_and_band() {
    let whole = JOB.replace(
        "[tool]\n",
        "model = \"orthoglide\"\n[placement]\npart_origin_mm = [-20, 0, 100]\n[output]\nprogram = \"out.ngc\"\nreport = \"report.html\"\njson = \"result.json\"\n[tool]\nlength_mm = 0\n",
    );
    let here = place(&whole, SLOT);
    let said = run(here.path(), &["compensate", "job.toml"]).answered();
    let result: Value =
        serde_json::from_slice(&std::fs::read(here.path().join("result.json")).unwrap()).unwrap();
    assert_eq!(result["cutting"], answer(here.path())["cutting"]);
    let band = &result["force_band"];
    let before = number(&result["summary"]["max_position_error_before_mm"]);
    let after = number(&result["summary"]["max_position_error_after_mm"]);
    // No weight in the model: what is left is a fifth of what was corrected, and what was left before.
    for name in ["max_error_if_larger_mm", "max_error_if_smaller_mm"] {
        let found = number(&band[name]);
        assert!(
            (found - 0.2 * before).abs() <= after + 1e-3 * before,
            "{name}: {found}"
        );
    }
    assert!(
        flat(&said.out).contains("20 % larger or smaller"),
        "{}",
        said.out
    );
    let report = std::fs::read_to_string(here.path().join("report.html")).unwrap();
    for part in [
        "What the cut asks along the path",
        "20 % larger or smaller",
        "Arc in the material",
        "class=\"area\"",
    ] {
        assert!(report.contains(part), "{part}");
    }
}

/// On a machine with weight: the band is what a force that is so much larger gives, and its weight is not counted twice.
#[test]
fn the_band_is_what_a_larger_force_gives() {
    let job = |factor: f64| {
        JOB.replace(
            "[tool]\n",
            "model = \"heavy_6r\"\n[placement]\npart_origin_mm = [1100, 0, 900]\n[load]\nweight = \"all\"\n[tool]\nlength_mm = 100\n",
        )
        .replace("[stock]", &format!("wear_factor = {factor:?}\n[stock]"))
    };
    let run_of = |factor: f64| {
        let here = place(&job(factor), SLOT);
        json(here.path(), &["deflect", "job.toml"])
    };
    let one = run_of(1.0);
    for (factor, name) in [
        (1.2, "max_error_if_larger_mm"),
        (0.8, "max_error_if_smaller_mm"),
    ] {
        let expected = number(&run_of(factor)["summary"]["max_position_error_before_mm"]);
        close(number(&one["force_band"][name]), expected, 1e-6);
    }
    let own = number(&one["summary"]["max_error_by_own_weight_mm"]);
    assert!(own > 1e-3, "{own}");
}
