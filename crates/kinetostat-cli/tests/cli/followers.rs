//! Loads without a potential and damping under load: columns whose figures were computed by a program of its own (Euler and
//! Bernoulli's beam in 40 Hermite elements, numpy; EI 14700 N m^2, 4.71 kg/m, 1 m).

use crate::common::{Said, run, workplace};
use serde_json::Value;
use std::path::Path;

/// A clamped column in eight segments that hardly stretches; a load at its tip follows it.
const COLUMN: &str = r#"schema = 1
[mechanism]
name = "column"
gravity_m_per_s2 = [0, 0, 0]
[section.R]
rigidities = { axial_n = 1.26e13, bending_y_n_m2 = 1e9, bending_z_n_m2 = 14700, torsion_n_m2 = 7200 }
[chain.c]
elements = [
  { actuator = "revolute", name = "brake", axis = "z", rigid_drive = true },
  { link = "R", name = "beam", length_m = 1.0, segments = 8, mass_kg_per_m = 4.71 },
]
[[platform]]
name = "tip"
home = { position_m = [1.0, 0, 0] }
[[limb]]
name = "l"
from = "base"
to = "tip"
chain = "c"
"#;

const EI: f64 = 14700.0;

/// The column under a follower of so many EI/L^2.
fn pushed(by: f64) -> String {
    format!(
        "{COLUMN}[[limb.load]]\nwrench = \"f\"\nnode = \"tip\"\naxes = \"node\"\nforce_n = [{}, 0, 0]\n",
        -by * EI
    )
}

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn near(found: f64, expected: f64, share: f64) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{found} {expected}"
    );
}

#[test]
fn modes_under_followers_are_the_complex_pairs() {
    let here = workplace();
    // Frequency and growth of the two lowest pairs in the plane; what becomes of the column.
    type Pairs = [(f64, f64); 2];
    let cases: [(f64, &str, Pairs, &str); 7] = [
        (5.0, "", [(37.500_88, 0.0), (181.700_57, 0.0)], "stable"),
        (12.0, "", [(50.441_01, 0.0), (157.705_63, 0.0)], "stable"),
        (20.0, "", [(93.616_44, 0.0), (102.345_34, 0.0)], "stable"),
        (
            25.0,
            "",
            [(94.408_5, 274.694), (94.408_5, -274.694)],
            "flutter",
        ),
        (
            5.0,
            " --damping 0.01",
            [(37.499_01, -2.356_25), (181.691_48, -11.416_58)],
            "stable",
        ),
        (
            12.0,
            " --damping 0.01",
            [(50.438_49, -3.169_30), (157.697_75, -9.908_94)],
            "stable",
        ),
        // Damping of the material shakes what was quiet [Ziegler 1952].
        (
            12.0,
            " --rayleigh 0 1e-5",
            [(50.440_76, 0.073_966), (157.701_48, -7.877_126)],
            "flutter",
        ),
    ];
    for (k, (by, damping, expected, verdict)) in cases.into_iter().enumerate() {
        let file = format!("f{k}.toml");
        std::fs::write(here.path().join(&file), pushed(by)).expect("written");
        let answer = json(
            &said(
                here.path(),
                &format!("modes {file} --modes 2 --json{damping}"),
            )
            .answered(),
        );
        let modes = answer["modes"].as_array().expect("modes");
        for (mode, (hz, growth)) in modes.iter().zip(expected) {
            // Eight segments are 1.5e-4 from the continuum in the second pair; two pairs about to meet are as far apart as
            // the root of the distance.
            let share = if by < 15.0 { 2.5e-4 } else { 2e-3 };
            near(number(&mode["frequency_hz"]), hz, share);
            near(
                number(&mode["growth_per_s"]),
                growth,
                if by < 15.0 { 2e-3 } else { 5e-3 },
            );
        }
        assert_eq!(answer["circulatory"]["verdict"], verdict, "{by}{damping}");
        assert_eq!(answer["stable"], verdict == "stable");
        let unstable = number(&answer["directions"]["unstable"]);
        assert_eq!(unstable > 0.0, verdict == "flutter");
        // Text, table and picture say the same.
        let line = format!("modes {file} --modes 2 --csv m{k}.csv --plot m{k}.svg{damping}");
        let text = said(here.path(), &line).answered().out;
        let first = number(&modes[0]["frequency_hz"]);
        assert!(text.contains(&format!("{first:.3}")), "{text}");
        for word in ["UNSTABLE", "NOT stable", "FLUTTERS", "GROW"] {
            assert!(
                verdict == "flutter" || !text.contains(word),
                "{word}: {text}"
            );
        }
        let table = std::fs::read_to_string(here.path().join(format!("m{k}.csv"))).expect("CSV");
        let cell = table.lines().nth(1).and_then(|row| row.split(',').nth(2));
        near(
            cell.expect("a cell").parse().expect("a number"),
            first,
            1e-12,
        );
        let picture = std::fs::read_to_string(here.path().join(format!("m{k}.svg"))).expect("SVG");
        assert!(picture.contains(&format!("{first:.2} Hz")), "{picture}");
    }
}

#[test]
fn the_response_under_followers_has_the_damping_of_the_pairs() {
    let here = workplace();
    std::fs::write(here.path().join("f12.toml"), pushed(12.0)).expect("written");
    let line = "frf f12.toml --from y --to y --damping 0.01 --frequencies 30 170 15 --json";
    let answer = json(&said(here.path(), line).answered());
    assert_eq!(answer["solution"], "direct");
    let curve = &answer["curves"][0];
    // Beside the second pair (157.7 Hz) what eight segments are off in its frequency counts tenfold.
    for (at, re, im, share) in [
        (0, 6.871_778e-6, -1.073_676e-7, 2e-4),
        (3, -7.214_157e-6, -5.084_507e-7, 1e-3),
        (14, -7.041_229e-6, -9.124_118e-7, 3e-3),
    ] {
        let apart = (number(&curve["real"][at]) - re).hypot(number(&curve["imaginary"][at]) - im);
        assert!(apart < share * re.hypot(im), "{at} {curve}");
    }
    near(
        number(&answer["natural_frequencies_hz"][0]),
        50.441_01,
        1e-4,
    );
    assert_eq!(answer["natural_growth_per_s"][0], 0.0);
    // Structural damping has no part in what grows.
    let text = said(here.path(), "modes f12.toml --loss-factor 0.02").answered();
    assert!(
        text.out.contains("Structural damping is not in the pairs"),
        "{}",
        text.out
    );
    let map = "map f12.toml --x 1000 --y 0 --force 0 0 0 --variables f1";
    let map = said(here.path(), map).answered();
    let whole = map.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(whole.contains("symmetric part of the stiffness"), "{whole}");
}

#[test]
fn a_loss_factor_is_that_of_the_springs_whatever_the_load() {
    let here = workplace();
    std::fs::write(here.path().join("column.toml"), COLUMN).expect("written");
    let line =
        "frf column.toml --from y,rz --to y,rz --frequencies 10 47 2 --loss-factor 0.05 --json";
    // Half of Euler's load, and nine tenths of it.
    let cases = [
        (
            18_135.398_087,
            [
                ("y", 0, 5.507_234e-5, -6.800_978e-6),
                ("y", 1, -1.248_183e-5, -3.962_609e-7),
                ("rz", 0, 1.450_169e-4, -1.683_177e-5),
                ("rz", 1, 5.850_333e-7, -2.189_876e-6),
            ],
        ),
        (
            32_643.716_557,
            [
                ("y", 0, 4.417_25e-5, -4.454_539e-4),
                ("y", 1, -1.036_133e-5, -2.682_193e-7),
                ("rz", 0, 1.205_776e-4, -1.070_893e-3),
                ("rz", 1, 4.167_970e-6, -2.030_329e-6),
            ],
        ),
    ];
    for (force, expected) in cases {
        let answer = json(&said(here.path(), &format!("{line} --force -{force} 0 0")).answered());
        assert_eq!(answer["solution"], "direct");
        for (axis, at, re, im) in expected {
            let curves = answer["curves"].as_array().expect("curves");
            let curve = curves.iter().find(|c| c["to"] == axis && c["from"] == axis);
            let curve = curve.expect("the entry");
            let apart =
                (number(&curve["real"][at]) - re).hypot(number(&curve["imaginary"][at]) - im);
            assert!(apart < 4e-3 * re.hypot(im), "{force} {axis} {at} {apart}");
        }
    }
    // Where no load acts the springs' stiffness is diagonal in the modes.
    assert_eq!(
        json(&said(here.path(), line).answered())["solution"],
        "modes"
    );
}

#[test]
fn a_tool_that_is_held_in_all_directions_does_not_move() {
    let here = workplace();
    let answer = json(&said(here.path(), "modes heavy_6r --hold all --modes 4 --json").answered());
    assert_eq!(answer["directions"]["rigid"], 6);
    for mode in answer["modes"].as_array().expect("modes") {
        for key in [
            "tool_translation_per_sqrt_kg",
            "tool_rotation_rad_per_m_sqrt_kg",
        ] {
            assert_eq!(mode[key], serde_json::json!([0.0, 0.0, 0.0]));
        }
    }
    let text = said(here.path(), "modes heavy_6r --hold all --modes 1").answered();
    assert!(text.out.contains("does not move"), "{}", text.out);
    let frf = "frf heavy_6r --hold all --damping 0.03 --frequencies 1 200 3";
    let answer = json(&said(here.path(), &format!("{frf} --json")).answered());
    for curve in answer["curves"].as_array().expect("curves") {
        assert_eq!(curve["peak"], 0.0);
    }
    let drawn = said(here.path(), &format!("{frf} --plot f.svg"));
    assert_eq!(drawn.code, 1);
    assert!(drawn.err.contains("held"), "{}", drawn.err);
}
