//! The band of a program's errors over machines that are not exactly as drawn: `--uncertain`, `[uncertain]`.

use std::path::Path;

use serde_json::Value;

use crate::common::{Said, run};

/// Three slides, the one along y soft: 400 N/mm.
const MODEL: &str = r#"schema = 1
[mechanism]
name = "slides"
[[platform]]
name = "tool"
home = { position_mm = [0, 0, 0] }
[chain.slides]
elements = [
  { actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = 1e9 },
  { actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = 400 },
  { actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = 1e9 },
]
[[limb]]
name = "slides"
from = "base"
to = "tool"
chain = "slides"
"#;

const PROGRAM: &str = "G21 G90 G94\nS10000 M3\nG0 X0 Y0 Z0\nG1 X40 F600\nG0 Z50\nM2\n";

/// 100 N to the right of the feed: 0.25 mm on the soft slide.
const MILLING: &str = "[load]\nmilling = { radial_n = 100, tangential_n = 0, axial_n = 0 }\n";

const WAX: &str = r#"[[material]]
name = "wax"
group = "other"
spread_percent = 20
source = "made up"
measured_in = { process = "milling" }
[material.law.linear]
cutting_n_per_mm2 = [800, RADIAL_CUT, 100]
edge_n_per_mm = [10, RADIAL_EDGE, 1]
"#;

const CUT: &str = r#"[tool]
cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }
[material]
name = "wax"
file = "wax.toml"
[engagement]
width_mm = 3
depth_mm = 2
part = "right"
"#;

fn job(load: &str) -> String {
    format!("schema = 1\nmodel = \"slides.toml\"\nprogram = \"line.ngc\"\n{load}")
}

fn place(load: &str, spread: &str) -> tempfile::TempDir {
    let here = tempfile::tempdir().expect("a directory");
    let spread = format!("schema = 1\n{spread}");
    for (name, text) in [
        ("slides.toml", MODEL),
        ("line.ngc", PROGRAM),
        ("job.toml", &job(load)),
        ("spread.toml", &spread),
    ] {
        std::fs::write(here.path().join(name), text).expect("a file");
    }
    here
}

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn band(here: &Path, command: &str) -> Value {
    let line = format!("{command} job.toml --uncertain spread.toml --machines 4096 --json");
    let all: Value = serde_json::from_str(&said(here, &line).answered().out).expect("JSON");
    all["uncertainty"].clone()
}

fn close(found: &Value, exact: f64, relative: f64) {
    let found = found.as_f64().expect("a number");
    let off = (found / exact - 1.0).abs();
    assert!(off < relative, "{found} instead of {exact}");
}

const RADIAL: &str = "[[uncertain]]\nload = \"radial\"\nuniform_percent = 20\n";

/// Before, the error is 0.25 mm times a factor of 0.8 to 1.2; after, 0.25 mm times its distance from 1.
#[test]
fn a_factor_on_the_force_gives_the_closed_form_before_and_after() {
    let here = place(MILLING, RADIAL);
    let found = band(here.path(), "compensate --out out.ngc");
    let root = 3_f64.sqrt();
    close(&found["before"]["as_drawn_mm"], 0.25, 1e-6);
    close(&found["before"]["mean_mm"], 0.25, 1e-3);
    close(&found["before"]["deviation_mm"], 0.05 / root, 0.01);
    close(&found["before"]["deviation_by_line_mm"], 0.05 / root, 1e-6);
    close(&found["before"]["low_mm"], 0.205, 5e-3);
    close(&found["before"]["high_mm"], 0.295, 5e-3);
    assert_eq!(found["before"]["linear_is_enough"], true);
    // What is left is the size of a number that scatters about zero: no line.
    close(&found["after"]["mean_mm"], 0.025, 0.02);
    close(&found["after"]["deviation_mm"], 0.025 / root, 0.02);
    close(&found["after"]["high_mm"], 0.0475, 0.02);
    assert_eq!(found["after"]["linear_is_enough"], false);
    assert!(found["after"]["as_drawn_mm"].as_f64().expect("a number") < 2e-3);
    let places = found["places"].as_array().expect("places");
    assert!(places.len() >= 10);
    for place in places.iter().filter(|p| p["path_mm"].as_f64() > Some(1.0)) {
        close(&place["before_mm"][1], 0.25, 0.01);
        close(&place["after_mm"][2], 0.0475, 0.03);
    }
}

/// Stiffness and load of the model and the program without compensation: relative variances add.
#[test]
fn stiffness_and_load_scatter_together() {
    let spread = "[[uncertain]]\nparameter = \"chain.slides.y.stiffness_n_per_mm\"\nnormal_percent = 3\n[[uncertain]]\nload = \"factor\"\nnormal_percent = 4\n";
    let here = place(MILLING, spread);
    let found = band(here.path(), "deflect");
    close(&found["before"]["deviation_by_line_mm"], 0.25 * 0.05, 1e-6);
    // The mean of 1 / k is larger than 1 / mean: by 3 % squared.
    close(&found["before"]["mean_mm"], 0.25 * 1.000_9, 1e-3);
    close(&found["before"]["deviation_mm"], 0.25 * 0.05, 0.02);
    assert_eq!(found["before"]["linear_is_enough"], true);
    assert_eq!(found["after"], Value::Null);
}

/// Coefficients of a law: the band is that of runs whose material has them larger and smaller.
#[test]
fn coefficients_of_the_cut_are_those_of_the_material() {
    let here = place(CUT, RADIAL);
    let with = |factor: f64| {
        let wax = WAX
            .replace("RADIAL_CUT", &format!("{:?}", 300.0 * factor))
            .replace("RADIAL_EDGE", &format!("{:?}", 20.0 * factor));
        std::fs::write(here.path().join("wax.toml"), wax).expect("a material");
        let all = said(here.path(), "deflect job.toml --json").answered().out;
        let all: Value = serde_json::from_str(&all).expect("JSON");
        let error = &all["summary"]["max_position_error_before_mm"];
        error.as_f64().expect("an error")
    };
    let [more, less, _] = [with(1.2), with(0.8), with(1.0)];
    assert!((more - less).abs() > 0.01, "{more} {less}");
    let found = band(here.path(), "deflect");
    close(&found["before"]["mean_mm"], 0.5 * (more + less), 2e-3);
    let deviation = 0.5 * (more - less).abs() / 3_f64.sqrt();
    close(&found["before"]["deviation_by_line_mm"], deviation, 1e-4);
    close(&found["before"]["deviation_mm"], deviation, 0.01);
}

#[test]
fn the_band_stands_in_the_text_and_in_the_report_and_the_job_may_ask_for_it() {
    let here = place(
        &format!(
            "{MILLING}[uncertain]\nfile = \"spread.toml\"\nmachines = 256\nseed = 7\n[output]\nprogram = \"out.ngc\"\nreport = \"report.html\"\njson = \"result.json\"\n"
        ),
        RADIAL,
    );
    let said = said(here.path(), "compensate job.toml").answered();
    let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "With the 1 uncertain number of",
        "256 machines drawn",
        "up to 0.250 mm +- 0.029 off its path as programmed",
        "nineteen in twenty machines stay within",
    ] {
        assert!(text.contains(words), "'{words}' is missing in {text}");
    }
    let report = std::fs::read_to_string(here.path().join("report.html")).expect("the report");
    for words in [
        "as they may be built",
        "Machine and force as they may be",
        "load radial = 1",
    ] {
        assert!(report.contains(words), "'{words}' is missing in the report");
    }
    let result = std::fs::read_to_string(here.path().join("result.json")).expect("the result");
    let result: Value = serde_json::from_str(&result).expect("JSON");
    assert_eq!(result["uncertainty"]["seed"], 7);
}

#[test]
fn what_no_band_can_be_made_of_is_refused() {
    let stated = "[load]\nforce_n = [0, -100, 0]\n";
    let component = "[[uncertain]]\nload = \"force_n.x\"\nnormal = 5\n";
    for (load, spread, line, words) in [
        (
            MILLING,
            component,
            "deflect job.toml --uncertain spread.toml",
            "factor, tangential, radial, axial",
        ),
        (
            stated,
            RADIAL,
            "deflect job.toml --uncertain spread.toml",
            "the stated force has no parts of a cut",
        ),
        (
            MILLING,
            RADIAL,
            "deflect job.toml --uncertain spread.toml --machines 10",
            "64 to 1048576",
        ),
        (
            MILLING,
            RADIAL,
            "deflect job.toml --machines 100",
            "--uncertain FILE",
        ),
        (
            "[placement]\npart_origin_mm = [0, 600, 0]\n[load]\nmilling = { radial_n = 10, tangential_n = 0, axial_n = 0 }\n",
            RADIAL,
            "compensate job.toml --model prs3 --weight all --uncertain spread.toml --out out.ngc",
            "turns as it moves",
        ),
    ] {
        let here = place(load, spread);
        let said = said(here.path(), line);
        assert_eq!(said.code, 1, "{line}: {}", said.err);
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(words), "'{words}' is missing in {text}");
    }
}
