//! `kinetostat force`: reference values, mirror images, warnings, refusals.

use std::path::Path;

use serde_json::Value;

use crate::common::chains::{json, number};
use crate::common::checks::{flat, warnings};
use crate::common::{contents, run};

/// First row of the reference values of `shared/theory/cutting.md`.
const CLIMB: &str = "force --material linear_aluminium --tool flat --diameter-mm 12 --teeth 4 --helix-deg 38 --width-mm 3.97 --depth-mm 1.58 --climb --feed-per-tooth-mm 0.191";

/// A shorter cut for what is refused and warned of.
const SHORT: &str = "force --material C45 --tool flat --diameter-mm 10 --teeth 2 --width-mm 2 --depth-mm 4 --part left --feed-per-tooth-mm 0.1";

fn words(line: &str) -> Vec<String> {
    let word = |word: &str| word.replace("linear_aluminium", "linear aluminium");
    line.split(' ').map(word).collect()
}

#[track_caller]
fn answer(here: &Path, line: &str) -> Value {
    let words = words(line);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    json(here, &words)
}

fn triple(of: &Value) -> [f64; 3] {
    [0, 1, 2].map(|k| number(&of[k]))
}

/// A number that is none fails, too.
#[track_caller]
fn close(found: f64, expected: f64, most: f64, what: &str) {
    let apart = (found - expected).abs();
    assert!(apart <= most, "{what}: {found} instead of {expected}");
}

fn directory() -> tempfile::TempDir {
    tempfile::tempdir().expect("a directory")
}

#[test]
fn a_climb_cut_has_the_reference_forces() {
    let here = directory();
    let a = answer(here.path(), &format!("{CLIMB} --rpm 8000"));
    let mean = triple(&a["mean"]["force_n"]);
    for (k, expected) in [58.79, 131.25, 29.95].into_iter().enumerate() {
        close(mean[k], expected, 1e-4 * expected + 0.005, "mean force");
    }
    close(
        number(&a["mean"]["torque_n_mm"]),
        812.01,
        0.09,
        "mean torque",
    );
    let peak = &a["peak"];
    close(number(&peak["across_tool_n"]), 276.01, 0.56, "peak");
    close(number(&peak["torque_n_mm"]), 1559.24, 3.2, "peak torque");
    // 812.01 N mm at 8000 turns per minute.
    close(number(&a["mean"]["power_w"]), 680.27, 0.1, "power");
    let cut = &a["cut"];
    close(
        number(&cut["cutting_speed_m_per_min"]),
        301.593,
        1e-3,
        "speed",
    );
    close(number(&cut["feed_mm_per_min"]), 6112.0, 1e-9, "feed");
    // The arc ends at pi and begins acos(1 - ae/r) before.
    close(number(&cut["arc_to_deg"]), 180.0, 1e-9, "exit");
    close(number(&cut["arc_from_deg"]), 109.7754, 1e-3, "entry");
    // The chip is thickest where the tooth comes in: 0.191 mm times the sine of the angle.
    close(number(&cut["largest_chip_mm"]), 0.179736, 1e-5, "chip");
    let tooth = &a["harmonics"][0];
    assert_eq!(tooth["per_revolution"], 4);
    close(number(&tooth["frequency_hz"]), 533.333, 1e-3, "frequency");
    // As load of a job: radial to the right of the feed.
    let load = &a["mean"]["job_load"];
    close(number(&load["radial_n"]), -mean[1], 1e-12, "radial");
    close(number(&load["tangential_n"]), mean[0], 1e-12, "tangential");
    assert_eq!(a["warnings"].as_array().map(Vec::len), Some(0));
    assert_eq!(a["schema"], 1);
}

/// The load that is printed for a job has force and moment in axes of the feed, and a job takes it as it stands.
#[test]
fn the_mean_is_a_load_with_its_moment() {
    let here = crate::common::workplace();
    let a = answer(here.path(), CLIMB);
    let (mean, load) = (&a["mean"], &a["mean"]["job_load"]);
    let moment = triple(&load["moment_n_m"]);
    for (k, of_tip) in triple(&mean["moment_n_mm"]).into_iter().enumerate() {
        close(moment[k], 1e-3 * of_tip, 1e-12, "moment");
    }
    // The torque of the reference values is the moment about the tool, N mm.
    close(moment[2].abs(), 0.81201, 1e-4, "torque");
    let words = words(CLIMB);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let said = run(here.path(), &words).answered().out;
    let lines = said.lines().map(str::trim);
    let lines: Vec<&str> = lines
        .skip_while(|line| !line.starts_with("force_n = ["))
        .take(3)
        .collect();
    assert!(lines[1].starts_with("moment_n_m = [") && lines[2] == "axes = \"feed\"");
    let milling = "milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }";
    let job = crate::common::JOB.replace(milling, &lines.join("\n"));
    assert!(job.contains("moment_n_m"));
    std::fs::write(here.path().join("job.toml"), job).expect("a file");
    run(here.path(), &["compensate", "job.toml"]).answered();
}

/// `shared/theory/cutting.md`, "The force that prints into the wall": five heights and the mean.
#[test]
fn the_force_that_makes_the_wall_is_the_reference() {
    let here = directory();
    let line = "force --material linear_aluminium --tool flat --diameter-mm 12 --teeth 4 --helix-deg 38 --width-mm 4 --depth-mm 8 --feed-per-tooth-mm 0.1";
    let down = [
        [255.185, 542.841, 95.636],
        [214.629, 346.223, 57.840],
        [144.087, 341.935, 58.160],
        [105.269, 426.358, 76.518],
        [108.550, 508.889, 97.890],
    ];
    let up = [
        [-465.456, 219.846, 97.890],
        [-379.061, 136.224, 76.518],
        [-334.532, 21.292, 58.160],
        [-388.107, -50.885, 57.840],
        [-567.659, 38.308, 95.636],
    ];
    for (way, side, table, mean) in [
        ("--climb", "right", down, [169.391, 465.775, 84.152]),
        ("--conventional", "left", up, [-456.980, 93.943, 84.153]),
    ] {
        let a = answer(here.path(), &format!("{line} {way}"));
        let walls = a["walls"].as_array().expect("walls");
        assert_eq!(walls.len(), 1);
        assert_eq!(walls[0]["wall"], side);
        let heights = walls[0]["heights"].as_array().expect("heights");
        assert_eq!(heights.len(), table.len());
        for (k, (at, expected)) in heights.iter().zip(table).enumerate() {
            close(number(&at["above_tip_mm"]), 2.0 * k as f64, 1e-12, "height");
            for (found, expected) in triple(&at["force_n"]).into_iter().zip(expected) {
                close(found, expected, 0.1, &format!("{way} at {} mm", 2 * k));
            }
        }
        for (found, expected) in triple(&a["mean"]["force_n"]).into_iter().zip(mean) {
            close(found, expected, 0.05, way);
        }
    }
    // Both walls of a slot.
    let slot = answer(here.path(), &line.replace("--width-mm 4", "--width-mm 12"));
    assert_eq!(slot["walls"].as_array().map(Vec::len), Some(2));
    assert_eq!(slot["cut"]["milling"], "slot");
}

/// With M4 and the part on the other side a cut is its mirror image.
#[test]
fn counter_clockwise_is_the_mirror_image() {
    let here = directory();
    let a = answer(here.path(), CLIMB);
    let b = answer(here.path(), &format!("{CLIMB} --counter-clockwise"));
    assert_eq!(a["cut"]["part"], "right");
    assert_eq!(b["cut"]["part"], "left");
    assert_eq!(b["cut"]["milling"], "climb");
    for of in ["mean", "peak"] {
        let (one, other) = (triple(&a[of]["force_n"]), triple(&b[of]["force_n"]));
        for (k, sign) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            close(other[k], sign * one[k], 1e-9 * one[k].abs(), of);
        }
    }
    let (one, other) = (&a["walls"][0], &b["walls"][0]);
    assert_eq!(other["wall"], "left");
    let away = number(&one["away_from_wall_n"]);
    close(
        number(&other["away_from_wall_n"]),
        away,
        1e-9 * away.abs(),
        "wall",
    );
    // The side by its place is the same question.
    let c = answer(
        here.path(),
        &format!("{CLIMB} --counter-clockwise").replace("--climb", "--part left"),
    );
    assert_eq!(c["mean"], b["mean"]);
}

#[test]
fn a_feed_per_minute_is_a_feed_per_tooth() {
    let here = directory();
    let a = answer(here.path(), &format!("{CLIMB} --rpm 8000"));
    let per_min = CLIMB.replace("--feed-per-tooth-mm 0.191", "--feed-mm-per-min 6112");
    let b = answer(here.path(), &format!("{per_min} --rpm 8000"));
    let (one, other) = (
        number(&a["peak"]["across_tool_n"]),
        number(&b["peak"]["across_tool_n"]),
    );
    close(other, one, 1e-9 * one, "peak");
}

/// Wear of 1.4 on coefficients of turning tests (1.3): 1.82 times the force of the law.
#[test]
fn factors_multiply_and_are_said() {
    let here = directory();
    let plain = answer(here.path(), &format!("{SHORT} --process-factor 1"));
    let worn = answer(
        here.path(),
        &format!("{SHORT} --wear 1.4 --coolant emulsion"),
    );
    let ratio = number(&worn["mean"]["torque_n_mm"]) / number(&plain["mean"]["torque_n_mm"]);
    close(ratio, 1.3 * 1.4 * 0.9, 1e-9, "factor");
    let symbols: Vec<&Value> = worn["material"]["factors"]
        .as_array()
        .expect("factors")
        .iter()
        .map(|f| &f["symbol"])
        .collect();
    assert_eq!(symbols, ["K_PRO", "K_TW", "K_CL"]);
    // A spread of 20 % and that of K_PRO, 0.1 of 1.3.
    let spread = 100.0 * 0.2_f64.hypot(0.1 / 1.3);
    close(
        number(&worn["material"]["spread_percent"]),
        spread,
        1e-9,
        "spread",
    );
    let said = run(
        here.path(),
        &words(&format!("{SHORT} --wear 1.4"))
            .iter()
            .map(String::as_str)
            .collect::<Vec<_>>(),
    );
    let text = flat(&said.answered().out);
    for needle in [
        "K_TW = 1.400: wear of the edge",
        "Roehm",
        "bends the machine",
        "prints into the wall",
    ] {
        assert!(text.contains(needle), "{needle}: {text}");
    }
}

#[test]
fn what_tool_and_spindle_cannot_bear_is_a_warning() {
    let here = directory();
    for (more, code, needle) in [
        (
            "--max-chip-mm 0.05",
            "chip_over_limit",
            "0.1 mm per tooth is more than",
        ),
        (
            "--flute-length-mm 3",
            "tool_too_short",
            "edges are 3 mm long",
        ),
        ("--stick-out-mm 3.5", "tool_too_short", "stands 3.5 mm out"),
        (
            "--rpm 3000 --spindle-power-w 50 --spindle-base-rpm 6000 --spindle-most-rpm 9000",
            "spindle_exceeded",
            "the spindle gives",
        ),
        (
            "--rpm 9500 --spindle-power-w 5000 --spindle-base-rpm 6000 --spindle-most-rpm 9000",
            "spindle_exceeded",
            "turns up to 9000",
        ),
        // C45 was measured from 0.113 to 1.131 mm.
        ("--rpm 3000", "chips_outside_measured", "0.113 to 1.131"),
    ] {
        let a = answer(here.path(), &format!("{SHORT} {more}"));
        let list = a["warnings"].as_array().expect("a list");
        let own = list.iter().find(|w| w["code"] == code);
        let own = own.unwrap_or_else(|| panic!("{more}: {list:?}"));
        let message = own["message"].as_str().expect("a text");
        assert!(message.contains(needle), "{more}: {message}");
        assert_eq!(warnings(&a).len(), list.len());
    }
}

const TABLE: &str = r#"[[tool]]
number = 3
name = "two-flute"
shape = "flat"
diameter_mm = 10
teeth = 2
helix_deg = 30
rake_deg = 12
run_out_um = 15
flute_length_mm = 20
"#;

pub const OWN: &str = r#"[[material]]
name = "wax"
group = "other"
spread_percent = 10
source = "our dynamometer"
measured_in = { process = "milling" }
[material.law.linear]
cutting_n_per_mm2 = [20, 5, 2]
edge_n_per_mm = [1, 1, 0]
"#;

#[test]
fn tools_and_materials_come_from_files() {
    let here = directory();
    std::fs::write(here.path().join("tools.toml"), TABLE).expect("a table");
    std::fs::write(here.path().join("own.toml"), OWN).expect("materials");
    let line = "force --material wax --materials own.toml --tool-table tools.toml --tool-number 3 --width-mm 10 --depth-mm 2 --feed-per-tooth-mm 0.1";
    let a = answer(here.path(), line);
    assert_eq!(a["tool"]["name"], "two-flute");
    assert_eq!(a["material"]["source"], "our dynamometer");
    // The rake of the table counts: 1.09 - 0.012 * 12.
    close(number(&a["material"]["factor"]), 0.946, 1e-9, "rake");
    // Run-out: the spindle's own frequency is among the harmonics.
    assert_eq!(a["harmonics"][0]["per_revolution"], 1);
    // A mistake is named with file and line, and an output may not be an input.
    std::fs::write(here.path().join("bad.toml"), TABLE.replace("teeth", "teth")).expect("a table");
    std::fs::write(
        here.path().join("wrong.toml"),
        OWN.replace("20, 5", "-20, 5"),
    )
    .expect("a file");
    for (from, to, needle) in [
        ("tools.toml", "bad.toml", "bad.toml:6: "),
        ("own.toml", "wrong.toml", "wrong.toml:"),
        ("tools.toml", "none.toml", "'none.toml' does not exist"),
        ("--tool-number 3", "--tool-number 4", "it has 3"),
        (
            "--width-mm 10",
            "--width-mm 10 --csv tools.toml --force-overwrite",
            "tools.toml",
        ),
    ] {
        refused(here.path(), &line.replace(from, to), needle);
    }
}

#[track_caller]
fn refused(here: &Path, line: &str, needle: &str) {
    let before = contents(here);
    let words = words(line);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let said = run(here, &words);
    assert_eq!(said.code, 1, "{line}: {said:?}");
    assert!(said.out.is_empty(), "{line}: {said:?}");
    let text = flat(&said.err);
    assert!(text.contains(needle), "{line}: {needle}: {text}");
    assert_eq!(contents(here), before, "{line}: nothing is written");
}

#[test]
fn wrong_input_names_its_option_and_writes_nothing() {
    let here = directory();
    let files = "--csv a.csv --plot a.svg --json a.json";
    for (from, to, needle) in [
        (
            "--diameter-mm 10",
            "--diameter-mm -10",
            "--diameter-mm: diameter of -10 mm; expected 0.01 to 1000 mm",
        ),
        ("--diameter-mm 10", "--diameter-mm nan", "--diameter-mm"),
        ("--diameter-mm 10", "--diameter-mm -nan", "--diameter-mm"),
        ("--diameter-mm 10 ", "", "the tool needs --diameter-mm"),
        ("--teeth 2", "--teeth 0", "--teeth: teeth of 0"),
        ("--teeth 2", "--teeth 2.5", "--teeth"),
        (
            "--teeth 2",
            "--teeth 2 --helix-deg 89",
            "--helix-deg: helix of 89",
        ),
        (
            "--teeth 2",
            "--teeth 2 --run-out-um 2000",
            "--run-out-um: run-out of 2000 um; expected 0 to 1000 um",
        ),
        (
            "--teeth 2",
            "--teeth 2 --corner-radius-mm 1",
            "--corner-radius-mm belongs to --tool bull",
        ),
        (
            "--tool flat",
            "--tool face",
            "--tool face needs --lead-angle-deg",
        ),
        ("--tool flat ", "", "which tool?"),
        (
            "--width-mm 2",
            "--width-mm 10.5",
            "--width-mm: width of cut of 10.5 mm; expected at most the 10 mm",
        ),
        (
            "--width-mm 2",
            "--width-mm -2",
            "--width-mm: width of cut of -2 mm",
        ),
        (
            "--width-mm 2",
            "--width-mm 0",
            "--width-mm AE 0 cuts nothing",
        ),
        ("--width-mm 2", "--width-mm inf", "--width-mm"),
        (
            "--depth-mm 4",
            "--depth-mm 4000",
            "--depth-mm: depth of cut of 4000 mm; expected 0.000001 to 500 mm",
        ),
        (
            "--depth-mm 4",
            "--depth-mm -4",
            "--depth-mm: depth of cut of -4 mm",
        ),
        ("--depth-mm 4 ", "", "--depth-mm"),
        ("--part left", "--part left --climb", "--climb"),
        ("--part left ", "", "on which side is the part?"),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --feed-mm-per-min 100 --rpm 1000",
            "--feed-mm-per-min",
        ),
        (
            " --feed-per-tooth-mm 0.1",
            "",
            "how fast? Give --feed-per-tooth-mm, or --feed-mm-per-min with --rpm",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-mm-per-min 100",
            "--feed-mm-per-min needs --rpm",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm -0.1",
            "--feed-per-tooth-mm: feed per tooth of -0.1 mm",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --rpm 0",
            "--rpm: speed of the spindle of 0",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --correct-speed",
            "--correct-speed needs --rpm",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --down-feed-per-tooth-mm 0.01",
            "is for slots",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --wear 9",
            "--wear: wear factor of 9",
        ),
        (
            "--feed-per-tooth-mm 0.1",
            "--feed-per-tooth-mm 0.1 --spindle-power-w 100",
            "--spindle-base-rpm",
        ),
        (
            "--material C45",
            "--material Inconell_718",
            "did you mean Inconel 718",
        ),
        ("--material C45", "--material cheese", "--list-materials"),
        ("--material C45 ", "", "what is cut? Give --material NAME"),
    ] {
        let line = SHORT.replacen(from, to, 1);
        assert_ne!(line, SHORT);
        refused(here.path(), &format!("{line} {files}"), needle);
    }
}

#[test]
fn files_and_text_say_the_same() {
    let here = directory();
    let line = format!("{CLIMB} --rpm 8000 --csv a.csv --plot a.svg --json a.json");
    let words = words(&line);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let said = run(here.path(), &words).answered();
    for line in said.out.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    let text = flat(&said.out);
    for needle in [
        "58.79",
        "131.3",
        "29.95",
        "274.7",
        "276.0",
        "812",
        "680",
        "linear law with edge force",
    ] {
        assert!(text.contains(needle), "{needle}: {text}");
    }
    let table = std::fs::read_to_string(here.path().join("a.csv")).expect("the table");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|c| c.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert!(table.starts_with("angle_deg,fx_n,fy_n,fz_n,"), "{table}");
    assert_eq!(rows.len(), 1440);
    // The mean of the table is the mean of the answer.
    for (k, expected) in [58.79, 131.25, 29.95].into_iter().enumerate() {
        let mean = rows.iter().map(|row| row[k + 1]).sum::<f64>() / rows.len() as f64;
        close(mean, expected, 0.02, "mean of the table");
    }
    let svg = std::fs::read_to_string(here.path().join("a.svg")).expect("the drawing");
    for needle in [
        "Fx, along the feed",
        "torque, N m",
        "angle of the spindle, deg",
        "dashed",
    ] {
        assert!(svg.contains(needle), "{needle}");
    }
    assert!(!svg.contains("NaN"));
    let again = run(here.path(), &words);
    assert_eq!(again.code, 1);
    assert!(again.err.contains("--force-overwrite"), "{}", again.err);
}

#[test]
fn all_materials_are_listed_with_law_spread_and_source() {
    let here = directory();
    let said = run(here.path(), &["force", "--list-materials"]).answered();
    for line in said.out.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    let list = json(here.path(), &["force", "--list-materials"]);
    let all = list["materials"].as_array().expect("a list");
    assert!(all.len() >= 30, "{}", all.len());
    for material in all {
        let name = material["name"].as_str().expect("a name");
        assert!(said.out.contains(name), "{name}");
        assert!(number(&material["spread_percent"]) > 0.0, "{name}");
        let source = material["source"].as_str().expect("a source");
        assert!(flat(&said.out).contains(&flat(source)), "{source}");
    }
    assert_eq!(list["schema"], 1);
}

/// A ball, a bull nose, a face mill and a ramp: all answer, with forces that are numbers.
#[test]
fn every_shape_answers() {
    let here = directory();
    for more in [
        "--tool ball --helix-deg 30 --width-mm 3 --depth-mm 1 --climb",
        "--tool bull --corner-radius-mm 2 --width-mm 6 --depth-mm 3 --conventional --rpm 4000",
        "--tool face --lead-angle-deg 45 --width-mm 8 --depth-mm 1 --climb --run-out-um 20",
        "--tool flat --width-mm 10 --depth-mm 1 --down-feed-per-tooth-mm 0.01",
    ] {
        let line = format!(
            "force --material C45 --diameter-mm 10 --teeth 3 --feed-per-tooth-mm 0.1 {more}"
        );
        let a = answer(here.path(), &line);
        assert!(number(&a["mean"]["torque_n_mm"]) > 0.0, "{more}");
        assert!(
            number(&a["peak"]["across_tool_n"]) >= number(&a["mean"]["across_tool_n"]),
            "{more}"
        );
        assert!(
            triple(&a["mean"]["force_n"]).iter().all(|f| f.is_finite()),
            "{more}"
        );
        assert!(!a["walls"].as_array().expect("walls").is_empty(), "{more}");
    }
}

/// Closed forms of drilling and turning with the law of C45 as it stands in the library.
#[test]
fn drills_and_turning_tools_have_their_closed_forms() {
    let here = directory();
    let list = json(here.path(), &["force", "--list-materials"]);
    let all = list["materials"].as_array().expect("a list");
    let steel = all.iter().find(|m| m["name"] == "C45").expect("C45");
    let law = &steel["law"]["kienzle"];
    let specific = number(&law["specific_n_per_mm2"][0]);
    let exponent = number(&law["exponent"][0]);
    // Two lips: torque k_c f d^2/8 with k_c at h = f/2 sin(59 degrees).
    let a = answer(
        here.path(),
        "force --drill --material C45 --diameter-mm 8 --feed-per-turn-mm 0.4 --rpm 1200",
    );
    let chip = 0.2 * 59_f64.to_radians().sin();
    let torque = specific * chip.powf(-exponent) * 0.4 * 64.0 / 8.0;
    close(number(&a["torque_n_mm"]), torque, 1e-9 * torque, "torque");
    let power = 1e-3 * torque * 40.0 * std::f64::consts::PI;
    close(number(&a["power_w"]), power, 1e-9 * power, "power");
    assert_eq!(a["material"]["factors"].as_array().map(Vec::len), Some(0));
    // An edge across the feed: k_c f a_p.
    let a = answer(
        here.path(),
        "force --turning --material C45 --depth-mm 2 --feed-per-turn-mm 0.3 --speed-m-per-min 150",
    );
    let cutting = specific * 0.3_f64.powf(1.0 - exponent) * 2.0;
    close(number(&a["cutting_n"]), cutting, 1e-9 * cutting, "cutting");
    let power = cutting * 2.5;
    close(number(&a["power_w"]), power, 1e-9 * power, "power");
    for (line, needle) in [
        (
            "force --drill --material C45 --feed-per-turn-mm 0.4",
            "--diameter-mm",
        ),
        (
            "force --drill --material C45 --diameter-mm 8",
            "--feed-per-turn-mm",
        ),
        (
            "force --drill --material C45 --diameter-mm 8 --feed-per-turn-mm 0.4 --hole-mm 8",
            "--hole-mm: hole of 8 mm",
        ),
        (
            "force --turning --material C45 --depth-mm -2 --feed-per-turn-mm 0.3",
            "--depth-mm: depth of cut of -2 mm",
        ),
        (
            "force --turning --drill --material C45 --depth-mm 2 --feed-per-turn-mm 0.3",
            "--drill",
        ),
    ] {
        refused(here.path(), line, needle);
    }
}

/// Cuts that nobody makes are computed, and said to be that.
#[test]
fn absurd_cuts_are_warned_of() {
    let here = directory();
    let milling =
        "force --material AlMg4.5Mn --tool flat --diameter-mm 12 --teeth 4 --width-mm 4 --climb";
    for (more, needle) in [
        (
            "--depth-mm 2 --feed-per-tooth-mm 9.9",
            "check feed, speed and number of teeth",
        ),
        (
            "--depth-mm 500 --feed-per-tooth-mm 0.1",
            "times the tool's diameter",
        ),
        (
            "--depth-mm 2 --feed-per-tooth-mm 0.1 --rpm 900000",
            "nothing is cut faster",
        ),
        (
            "--depth-mm 2 --feed-per-tooth-mm 0.1 --run-out-um 1200",
            "no tool is held like that",
        ),
    ] {
        let words: Vec<&str> = milling.split(' ').chain(more.split(' ')).collect();
        let said = run(here.path(), &words);
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(needle), "{needle}: {said:?}");
    }
    for (cut, needle) in [
        (
            "force --drill --material AlMg4.5Mn --diameter-mm 8 --feed-per-turn-mm 99",
            "check feed",
        ),
        (
            "force --turning --material AlMg4.5Mn --depth-mm 1000 --feed-per-turn-mm 9",
            "hardly a lathe",
        ),
    ] {
        let said = run(here.path(), &cut.split(' ').collect::<Vec<_>>());
        let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(needle), "{needle}: {said:?}");
    }
}

/// With run-out the largest harmonics are listed, whichever multiple of the spindle they are: those of the table of angles.
#[test]
fn the_largest_harmonics_are_listed() {
    let here = directory();
    let cut = "force --material AlMg4.5Mn --tool flat --diameter-mm 12 --teeth 4 --helix-deg 38 --width-mm 4 --climb --depth-mm 6 --feed-per-tooth-mm 0.05 --rpm 6000 --run-out-um 40 --run-out-angle-deg 10 --json";
    let said = run(here.path(), &cut.split(' ').collect::<Vec<_>>());
    let answer: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let listed = answer["harmonics"].as_array().unwrap();
    let orders: Vec<u64> = listed
        .iter()
        .map(|h| h["per_revolution"].as_u64().unwrap())
        .collect();
    for order in [1, 2, 3, 4] {
        assert!(orders.contains(&order), "{orders:?}");
    }
    assert!(orders.is_sorted(), "{orders:?}");
}
