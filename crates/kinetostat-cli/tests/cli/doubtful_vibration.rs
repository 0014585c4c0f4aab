//! Masses, damping and measured responses that are not what they seem: said, with the line where there is one.

use crate::common::{Said, run, workplace};
use serde_json::Value;
use std::path::Path;

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A table of two slides whose axes meet in one point.
const TABLE: &str = r#"schema = 1
[mechanism]
name = "xy"
gravity_m_per_s2 = [0, 0, -9.81]
[[platform]]
name = "tool"
home = { position_mm = [0, 0, 0], x_axis = "x", y_axis = "-y" }
[chain.c]
elements = [
  { actuator = "prismatic", name = "sx", axis = "x", stiffness_n_per_m = 5.0e6, home_mm = 0 },
  { actuator = "prismatic", name = "sy", axis = "y", stiffness_n_per_m = 8.0e6, home_mm = 0 },
  { body = "m", mass_kg = 50, centre_of_mass_mm = [0, 0, 0], inertia_kg_m2 = [[1,0,0],[0,1,0],[0,0,1]] },
]
[[limb]]
name = "l"
from = "base"
to = "tool"
chain = "c"
end = { x_axis = "x", y_axis = "-y" }
"#;

#[test]
fn what_a_machine_without_extent_has_wrong_is_named_by_its_line() {
    let here = workplace();
    let body = TABLE
        .lines()
        .position(|line| line.contains("body ="))
        .expect("a body")
        + 1;
    let limb = TABLE
        .lines()
        .position(|line| line == "[[limb]]")
        .expect("a limb")
        + 1;
    let damped = |law: &str| format!("{TABLE}[damping]\n{law}\n");
    let last = TABLE.lines().count() + 2;
    let write = |name: &str, text: &str| {
        assert_ne!(text, TABLE);
        std::fs::write(here.path().join(name), text).expect("written");
    };
    write("triangle.toml", &TABLE.replace("[0,0,1]]", "[0,0,5]]"));
    write(
        "light.toml",
        &TABLE.replace("mass_kg = 50", "mass_kg = 5e-9"),
    );
    write("none.toml", &TABLE.replace("mass_kg = 50", "mass_kg = 0"));
    write("loss.toml", &damped("loss_factor = 4"));
    write(
        "rayleigh.toml",
        &damped("rayleigh = { mass_per_s = 0, stiffness_s = 1 }"),
    );
    write(
        "damper.toml",
        &TABLE.replace("5.0e6, home_mm", "5.0e6, damping_n_s_per_m = 1e9, home_mm"),
    );
    for (line, code, expected) in [
        (
            "check triangle.toml",
            0,
            vec![format!("line {body}"), "no body".into()],
        ),
        (
            "modes triangle.toml",
            1,
            vec![format!("triangle.toml, line {body}")],
        ),
        (
            "check light.toml",
            0,
            vec![format!("line {body}"), "5.00e-9 kg".into()],
        ),
        (
            "modes none.toml",
            1,
            vec![format!("none.toml, line {limb}"), "no mass".into()],
        ),
        (
            "check loss.toml",
            0,
            vec![format!("line {last}"), "200 % of critical".into()],
        ),
        (
            "modes loss.toml",
            0,
            vec![format!("loss.toml, line {last}: damped beyond critical")],
        ),
        (
            "modes rayleigh.toml",
            0,
            vec![format!("rayleigh.toml, line {last}: damped beyond")],
        ),
        (
            "modes damper.toml",
            0,
            vec![format!("damper.toml, line {}: damped beyond", body - 2)],
        ),
    ] {
        let said = said(here.path(), line);
        assert_eq!(said.code, code, "{line}: {said:?}");
        let whole = one_line(&format!("{} {}", said.out, said.err));
        for words in expected {
            assert!(whole.contains(&words), "{line}: {words}: {whole}");
        }
    }
}

/// A table with its real and imaginary parts times a factor.
fn times(table: &str, factor: f64) -> String {
    let heads: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    let row = |line: &str| {
        let cells = line.split(',').zip(&heads).map(|(cell, head)| {
            match head.contains("_real_") || head.contains("_imaginary_") {
                true => (factor * cell.parse::<f64>().expect("a number")).to_string(),
                false => cell.to_owned(),
            }
        });
        cells.collect::<Vec<_>>().join(",")
    };
    let rows = table.lines().skip(1).map(row);
    std::iter::once(heads.join(","))
        .chain(rows)
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn measured_amplitudes_stand_beside_those_of_the_model() {
    let here = workplace();
    let place = "--at 1300 500 1000 --damping 0.02";
    let line = format!(
        "frf heavy_6r {place} --from x --to x,y,z,rz --frequencies 5 60 1200 --csv right.csv"
    );
    said(here.path(), &line).answered();
    let right = std::fs::read_to_string(here.path().join("right.csv")).expect("CSV");
    let write =
        |name: &str, text: &str| std::fs::write(here.path().join(name), text).expect("written");
    write("thousand.csv", &right.replace("_m_per_n", "_mm_per_n"));
    write("negative.csv", &times(&right, -1.0));
    let fit = |name: &str, more: &str| {
        said(
            here.path(),
            &format!(
                "frf heavy_6r {place} --measured {name} --fit 3 --frequencies 5 40 700 --json{more}"
            ),
        )
    };
    for (name, factor, words) in [
        ("right.csv", 1.0, "rz_by_x"),
        (
            "thousand.csv",
            1e-3,
            "times those of the model: check the units",
        ),
        ("negative.csv", -1.0, "against its own force"),
    ] {
        let answer = json(&fit(name, "").answered());
        let modes = answer["fit"]["modes"].as_array().expect("modes");
        assert_eq!(modes.len(), 3);
        for mode in modes {
            let found = mode["amplitude_by_model"].as_f64().expect("a number");
            assert!((found / factor - 1.0).abs() < 0.02, "{name}: {mode}");
        }
        let warnings = answer["warnings"].to_string();
        assert!(warnings.contains(words), "{name}: {warnings}");
        let doubts = ["times those of the model", "against"];
        let doubted = doubts.iter().any(|doubt| warnings.contains(doubt));
        assert_eq!(doubted, factor != 1.0, "{name}: {warnings}");
    }
    let refused = fit("negative.csv", " --scale damping.ratio");
    assert_eq!(refused.code, 1, "{refused:?}");
    assert!(
        one_line(&refused.err).contains("against its own force"),
        "{}",
        refused.err
    );
}

/// A blank line before the first data set, and a response from 0 Hz on.
#[test]
fn small_matters_of_responses() {
    let here = workplace();
    std::fs::write(here.path().join("xy.toml"), TABLE).expect("written");
    let line = "frf xy.toml --damping 0.02 --frequencies 0 40 5 --plot f.svg --json";
    let answer = json(&said(here.path(), line).answered());
    let rest = answer["curves"][0]["real"][0].as_f64().expect("a number");
    assert!((rest * 5e6 - 1.0).abs() < 1e-12, "{rest}");
    std::fs::write(here.path().join("blank.uff"), "\n    -1\n    58\n").expect("written");
    let line = "frf xy.toml --measured blank.uff --frequencies 1 40 5 --damping 0.02";
    let refused = said(here.path(), line);
    assert!(!refused.err.contains("columns"), "{}", refused.err);
    let lobes = "lobes xy.toml --damping 0.03 --teeth 2 --coefficients-n-per-mm2 800 240 0 --rpm 1000 2000 3 --helix-deg 80 --diameter-mm 10";
    let refused = said(here.path(), lobes);
    assert!(!refused.err.contains("in rad"), "{}", refused.err);
}
