//! `modes`, `frf`, `lobes`: the arm of the reference values (`shared/theory/dynamics-reference-values.md`, D3, D5), files
//! and refusals.

use crate::common::{Said, run, workplace};
use kinetostat_testing::Worst;
use serde_json::Value;
use std::path::Path;

const ARM6: &str = include_str!("vibration_models/arm6.toml");

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(said: &Said) -> Value {
    serde_json::from_str(&said.out).expect("JSON")
}

fn numbers(list: &Value) -> Vec<f64> {
    let list = list.as_array().expect("a list");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn arm6() -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("arm6.toml"), ARM6).expect("written");
    here
}

fn agree(found: &[f64], expected: &[f64], most: f64) {
    let mut worst = Worst::new();
    for (found, expected) in found.iter().zip(expected) {
        worst.add((found / expected - 1.0).abs());
    }
    assert_eq!(found.len(), expected.len());
    assert!(worst.of(expected.len()) < most, "{found:?} {expected:?}");
}

#[test]
fn frequencies_of_the_arm_are_those_of_the_reference_values() {
    let here = arm6();
    let weightless = ARM6.replace("[0, 0, -9.81]", "[0, 0, 0]");
    assert_ne!(weightless, ARM6);
    std::fs::write(here.path().join("weightless.toml"), weightless).expect("written");
    for (line, expected) in [
        (
            "modes arm6.toml --json",
            [
                9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171,
            ],
        ),
        (
            "modes weightless.toml --json",
            [
                9.98843848, 11.548195, 23.2094663, 49.0171568, 53.7168814, 126.524245,
            ],
        ),
        (
            "modes arm6.toml --force 0 0 -9000 --json",
            [
                10.0068189, 11.523062, 23.1889537, 49.2481057, 53.8574826, 126.550804,
            ],
        ),
    ] {
        let answer = json(&said(here.path(), line).answered());
        let modes = answer["modes"].as_array().expect("modes");
        let found: Vec<f64> = modes
            .iter()
            .map(|m| m["frequency_hz"].as_f64().expect("a frequency"))
            .collect();
        agree(&found, &expected, 1e-8);
        assert_eq!(answer["directions"]["vibrating"], 6);
        assert_eq!(answer["stable"], true);
        assert_eq!(answer["total_mass_kg"], 835.0);
        for mode in modes {
            for energy in ["kinetic_energy", "elastic_energy"] {
                let shares = mode[energy].as_array().expect("shares");
                let sum: f64 = shares
                    .iter()
                    .map(|s| s["share"].as_f64().expect("a share"))
                    .sum();
                assert!((sum - 1.0).abs() < 1e-12, "{energy} {sum}");
            }
        }
    }
}

#[test]
fn modes_are_written_and_drawn_in_two_phases() {
    let here = arm6();
    let line =
        "modes arm6.toml --modes 3 --damping 0.03 0.02 --csv m.csv --plot m.svg --json m.json";
    let text = said(here.path(), line).answered();
    assert!(text.out.contains("9.9875"), "{}", text.out);
    let file = std::fs::read_to_string(here.path().join("m.json")).expect("JSON");
    let answer: Value = serde_json::from_str(&file).expect("JSON");
    let ratio = |k: usize| answer["modes"][k]["damping_ratio"].as_f64();
    assert_eq!([ratio(0), ratio(1), ratio(2)], [0.03, 0.02, 0.02].map(Some));
    let picture = std::fs::read_to_string(here.path().join("m.svg")).expect("SVG");
    assert_eq!(picture.matches("<svg").count(), 7);
    assert!(picture.contains("phase 270 deg"));
    let table = std::fs::read_to_string(here.path().join("m.csv")).expect("CSV");
    assert_eq!(table.lines().count(), 1 + 3 * 12);
}

#[test]
fn responses_of_the_arm_are_those_of_the_reference_values() {
    let here = arm6();
    let line = "frf arm6.toml --damping 0.03 --frequencies 10 25 2 --from x,z --to x,y,z --json --csv f.csv --plot f.svg";
    let told = said(here.path(), line).answered();
    let drawn = std::fs::read_to_string(here.path().join("f.svg")).expect("SVG");
    assert!(drawn.contains("receptance, \u{b5}m/N"));
    assert!(
        told.err.contains(" um/N ") && !told.err.contains(" m/N "),
        "{}",
        told.err
    );
    let answer = json(&told);
    let expected = [
        ("x", "x", 0, 1.038_451_45e-6, -8.419_249_25e-8),
        ("y", "x", 0, -8.644_044_13e-7, 1.666_911_64e-7),
        ("z", "z", 0, -5.898_510_87e-7, -1.657_196e-5),
        ("z", "x", 1, -9.408_316_92e-7, -3.179_316_84e-7),
        ("y", "z", 1, -1.782_707_26e-7, -7.954_187_59e-8),
    ];
    let curves = answer["curves"].as_array().expect("curves");
    for (to, from, at, re, im) in expected {
        let curve = curves.iter().find(|c| c["to"] == to && c["from"] == from);
        let curve = curve.expect("the entry");
        assert_eq!(curve["unit"], "m/N");
        let found = [
            numbers(&curve["real"])[at],
            numbers(&curve["imaginary"])[at],
        ];
        agree(&found, &[re, im], 1e-7);
    }
    let table = std::fs::read_to_string(here.path().join("f.csv")).expect("CSV");
    assert!(
        table.starts_with("frequency_hz,x_by_x_real_m_per_n,"),
        "{table}"
    );
    let picture = std::fs::read_to_string(here.path().join("f.svg")).expect("SVG");
    assert!(picture.contains("x by force along x"));
}

/// A linear law has the same slope at every chip; one with a power the slope that differences say.
#[test]
fn lobes_of_a_material_are_those_of_its_slope() {
    let here = arm6();
    let cut =
        "--damping 0.03 --teeth 2 --immersion 0.5 --up --tool-axis 0 0 1 --rpm 600 6000 4 --json";
    let of = |cut_by: &str| {
        let line = format!("lobes arm6.toml {cut} {cut_by}").replace(' ', ";");
        let line = line.replace("linear;aluminium", "linear aluminium");
        let words: Vec<&str> = line.split(';').collect();
        json(&crate::common::run(here.path(), &words).answered())
    };
    let limits = |answer: &Value| -> Vec<f64> {
        let points = answer["points"].as_array().expect("points").iter();
        points
            .map(|p| p["limit_mm"].as_f64().expect("a limit"))
            .collect()
    };
    let by_material = of("--material linear aluminium --feed-per-tooth-mm 0.1");
    assert_eq!(by_material["material"], "linear aluminium");
    let stated = of("--coefficients-n-per-mm2 796 168 222");
    assert!(stated["material"].is_null());
    agree(&limits(&by_material), &limits(&stated), 1e-8);
    // Coefficients as the answer states them give the same lobes.
    let by_material = of("--material C45 --feed-per-tooth-mm 0.1");
    let chip_mm = by_material["chip_mm"].as_f64().expect("a chip");
    // Half a slot from the side: the mean of the sine over a quarter of a turn is 2/pi.
    assert!((chip_mm - 0.1 * 2.0 / std::f64::consts::PI).abs() < 1e-12);
    let found = by_material["coefficients_n_per_mm2"]
        .as_array()
        .expect("three");
    let stated = found
        .iter()
        .map(|x| x.as_f64().expect("a number").to_string());
    let stated = of(&format!(
        "--coefficients-n-per-mm2 {}",
        stated.collect::<Vec<_>>().join(" ")
    ));
    agree(&limits(&by_material), &limits(&stated), 1e-8);
    // A thicker chip gives way to a smaller slope (Kienzle), and the cut is stable to a greater depth.
    let thicker = of("--material C45 --feed-per-tooth-mm 0.3");
    for (thin, thick) in limits(&by_material).iter().zip(limits(&thicker)) {
        assert!(thick > *thin, "{thick} {thin}");
    }
    // A file of materials is an input: never written over.
    let own = here.path().join("own.toml");
    std::fs::write(&own, crate::force::OWN).expect("a file");
    let line = format!(
        "lobes arm6.toml {cut} --material wax --materials own.toml --feed-per-tooth-mm 0.1"
    );
    said(here.path(), &line).answered();
    let over = said(
        here.path(),
        &format!("{line} --csv own.toml --force-overwrite"),
    );
    assert_eq!(over.code, 1, "{over:?}");
    assert!(over.err.contains("own.toml"), "{over:?}");
    assert_eq!(
        std::fs::read_to_string(own).expect("a file"),
        crate::force::OWN
    );
}

#[test]
fn limits_of_the_arm_are_those_of_the_reference_values() {
    let here = arm6();
    let cut = "--damping 0.03 --teeth 2 --immersion 0.5 --up --coefficients-n-per-mm2 800 240 0 --tool-axis 0 0 1";
    let line = format!("lobes arm6.toml {cut} --rpm 600 6000 7 --json --csv l.csv --plot l.svg");
    let answer = json(&said(here.path(), &line).answered());
    let points = answer["points"].as_array().expect("points");
    let of = |key: &str, k: usize| points[k][key].as_f64().expect("a limit");
    let exact = [0, 1, 6].map(|k| of("limit_mm", k));
    agree(&exact, &[0.792_692, 0.705_773, 2.190_751], 1e-4);
    let zeroth = [0, 1, 6].map(|k| of("zeroth_order_mm", k));
    agree(&zeroth, &[1.303_056, 2.622_993, 2.189_935], 1e-4);
    let line = format!("lobes arm6.toml {cut} --rpm 3000 3600 2 --json");
    let answer = json(&said(here.path(), &line).answered());
    let point = &answer["points"][0];
    agree(
        &[point["limit_mm"].as_f64().expect("a limit")],
        &[0.642_480],
        1e-4,
    );
    assert_eq!(point["kind"], "flip");
}

#[test]
fn questions_without_an_answer_are_refused_by_name() {
    let here = arm6();
    for (line, words) in [
        ("modes stewart_gough_a", "mass_kg"),
        ("modes arm6.toml --modes 0", "--modes"),
        ("modes arm6.toml --damping 3", "critical"),
        ("modes arm6.toml --damping -0.1", "below zero"),
        ("modes arm6.toml --hold w", "'w'"),
        ("modes arm6.toml --viscous q9=3", "q6"),
        ("frf arm6.toml --frequencies -1 10 5", "--frequencies"),
        ("frf arm6.toml --frequencies 1 10 1.5", "whole"),
        (
            "lobes arm6.toml --teeth 2 --coefficients-n-per-mm2 800 240 0 --rpm 1000 2000 3",
            "damping",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --coefficients-n-per-mm2 800 0.3 0 --rpm 1000 2000 3",
            "ratio",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --coefficients-n-per-mm2 800 240 0 --rpm 2000 1000 3",
            "spindle speed",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --coefficients-n-per-mm2 800 240 0 --rpm 1000 2000 3 --tool-axis 1 0 0",
            "feed",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --rpm 1000 2000 3",
            "--coefficients-n-per-mm2",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --material C45 --rpm 1000 2000 3",
            "--feed-per-tooth-mm",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --material C45 --feed-per-tooth-mm 50 --rpm 1000 2000 3",
            "0.0001 to 10",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --material cheese --feed-per-tooth-mm 0.1 --rpm 1000 2000 3",
            "cheese",
        ),
        (
            "lobes arm6.toml --damping 0.03 --teeth 2 --material C45 --correct-speed --feed-per-tooth-mm 0.1 --rpm 1000 2000 3",
            "--correct-speed",
        ),
        (
            "lobes arm6.toml --damping 0.03 --coefficients-n-per-mm2 800 240 0 --rpm 1000 2000 3",
            "--teeth",
        ),
    ] {
        let said = said(here.path(), line);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains(words), "{line}: {}", said.err);
    }
}

#[test]
fn what_is_held_does_not_vibrate() {
    let here = arm6();
    let held = json(&said(here.path(), "modes arm6.toml --hold x,y,z --json").answered());
    assert_eq!(held["directions"]["vibrating"], 3);
    let first = held["modes"][0]["frequency_hz"]
        .as_f64()
        .expect("a frequency");
    assert!(first > 9.98746752, "{first}");
}

#[test]
fn an_inertia_that_no_body_has_is_refused_by_file_line_and_name() {
    let here = arm6();
    let wrong = ARM6.replace(
        "[[4.0, 0, 0], [0, 14.0, 0], [0, 0, 13.0]]",
        "[[4.0, 0, 0], [0, 14.0, 6.0], [0, 6.0, 13.0]]",
    );
    assert_ne!(wrong, ARM6);
    std::fs::write(here.path().join("wrong.toml"), &wrong).expect("written");
    let line = wrong.lines().position(|l| l.contains("[0, 14.0, 6.0]"));
    let place = format!("wrong.toml, line {}: ", line.expect("a line") + 1);
    for command in ["modes wrong.toml", "frf wrong.toml --frequencies 1 10 2"] {
        let said = said(here.path(), command);
        assert_eq!(said.code, 1, "{said:?}");
        let whole = said.err.replace('\n', " ");
        assert!(
            whole.contains(&place) && whole.contains("link 3"),
            "{whole}"
        );
    }
    // Statics does not use it.
    let warned = said(here.path(), "deflect wrong.toml --force 0 0 -100 --json").answered();
    assert!(warned.out.contains("is that of no body"), "{}", warned.out);
}

/// All masses were deleted and the inertias kept: frequencies came out, and nothing was said.
#[test]
fn an_inertia_without_a_mass_is_named_by_file_and_line() {
    let here = arm6();
    let lines = ARM6
        .lines()
        .map(|line| match line.split_once("mass_kg = ") {
            Some((before, after)) => {
                let rest = after.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
                format!("{before}mass_kg = 0{rest}\n")
            }
            None => format!("{line}\n"),
        });
    let wrong: String = lines.collect();
    std::fs::write(here.path().join("wrong.toml"), &wrong).expect("written");
    let said = said(here.path(), "modes wrong.toml").answered();
    let whole = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        whole.contains("wrong.toml, line ") && whole.contains("has an inertia and no mass"),
        "{whole}"
    );
}

/// Beside `modes` of the same place, and refused where there is no mass.
#[test]
fn maps_have_the_first_frequencies() {
    let here = arm6();
    let line = "map arm6.toml --x 1750 1850 3 --y 400 --z 1100 1200 2 --force 150 -100 -400 --show f1 --plot f1.svg --variables f2,natural_frequencies --csv map.csv --json";
    let answer = json(&said(here.path(), line).answered());
    let figures = answer["figures"].as_array().expect("figures");
    let own = figures.iter().find(|f| f["name"] == "f1").expect("f1");
    assert_eq!(own["unit"], "Hz");
    let table = std::fs::read_to_string(here.path().join("map.csv")).expect("the table");
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("a column");
    for row in lines {
        let cells: Vec<&str> = row.split(',').collect();
        let at = format!(
            "modes arm6.toml --at {} {} {} --force 150 -100 -400 --json",
            cells[0], cells[1], cells[2]
        );
        let there = json(&said(here.path(), &at).answered());
        let expected: Vec<f64> = (there["modes"].as_array().expect("modes").iter())
            .map(|m| m["frequency_hz"].as_f64().expect("a frequency"))
            .collect();
        let names = [
            "f1_hz",
            "f2_hz",
            "natural_frequencies_1_hz",
            "natural_frequencies_6_hz",
        ];
        for (name, k) in names.into_iter().zip([0, 1, 0, 5]) {
            let found: f64 = cells[column(name)].parse().expect("a number");
            assert!(
                (found / expected[k] - 1.0).abs() < 1e-7,
                "{name} {row} {expected:?}"
            );
        }
    }
    let drawing = std::fs::read_to_string(here.path().join("f1.svg")).expect("a drawing");
    assert!(drawing.contains("Hz"));
    for (line, words) in [
        (
            "map stewart_gough_a --x 0 --force 0 0 0 --variables f1",
            "preset stewart_gough_a: 'f1': ",
        ),
        ("map arm6.toml --x 1750 --variables f1", "'f1' needs a load"),
        ("modes stewart_gough_a", "preset stewart_gough_a: "),
    ] {
        let said = said(here.path(), line);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains(words), "{line}: {}", said.err);
    }
}

/// D3: the arm of a URDF with its own inertias, springs at rest at the posture, gravity.
#[test]
fn an_arm_of_a_urdf_vibrates_as_the_reference_values_say() {
    let urdf =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/urdf/kuka_kr210l150.urdf");
    if !urdf.is_file() {
        println!("SKIPPED: ../shared/data/urdf/kuka_kr210l150.urdf is not there");
        return;
    }
    let here = workplace();
    let stiffness = [4.2e6, 3.9e6, 2.6e6, 7.5e5, 6e5, 3.5e5];
    let home = [0.3, -0.6, 0.9, 0.2, 0.5, -0.4];
    let mut table = "name,value,unit\n".to_owned();
    let mut joints = Vec::new();
    for (i, (stiffness, q)) in stiffness.iter().zip(home).enumerate() {
        table.push_str(&format!("joint_a{},{stiffness},N m/rad\n", i + 1));
        joints.push(format!("joint_a{}={q}rad", i + 1));
    }
    std::fs::write(here.path().join("stiffness.csv"), table).expect("written");
    let import = "import urdf --base base_link --tip tool0 --joint-stiffness stiffness.csv -o arm.toml --home";
    let mut words: Vec<&str> = import.split(' ').collect();
    let (joints, urdf) = (joints.join(","), urdf.display().to_string());
    words.extend([joints.as_str(), urdf.as_str()]);
    run(here.path(), &words).answered();
    let answer = json(&said(here.path(), "modes arm.toml --json").answered());
    let found: Vec<f64> = (answer["modes"].as_array().expect("modes").iter())
        .map(|m| m["frequency_hz"].as_f64().expect("a frequency"))
        .collect();
    agree(
        &found,
        &[
            8.1345364, 10.740038, 13.005259, 88.523295, 126.69357, 531.26101,
        ],
        5e-8,
    );
}

/// One joint with a body of 2 kg m^2 about it: all in closed form.
const PENDULUM: &str = r#"schema = 1
[mechanism]
name = "pendulum"
gravity_m_per_s2 = [0, 0, 0]
[[platform]]
name = "tool"
home = { position_m = [0.5, 0, 0] }
[chain.arm]
elements = [
  { actuator = "revolute", name = "drive", axis = "z", stiffness_n_m_per_rad = 1e5 },
  { body = "arm", mass_kg = 8, centre_of_mass_m = [0.5, 0, 0] },
  { rigid = { translation_m = [0.5, 0, 0] } },
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

#[test]
fn damping_and_rotors_of_the_model_count() {
    let here = workplace();
    let write =
        |name: &str, text: String| std::fs::write(here.path().join(name), text).expect("written");
    let modes = |line: &str| {
        let answer = json(&said(here.path(), line).answered());
        let list = answer["modes"].as_array().expect("modes").clone();
        let of = |name: &str| {
            list.iter()
                .map(|m| m[name].as_f64().expect("a number"))
                .collect()
        };
        let both: [Vec<f64>; 2] = [of("frequency_hz"), of("damping_ratio")];
        both
    };
    let hz = |squared: f64| squared.sqrt() / std::f64::consts::TAU;
    write(
        "damper.toml",
        PENDULUM.replace("1e5 }", "1e5, damping_n_m_s_per_rad = 40 }"),
    );
    let [frequencies, ratios] = modes("modes damper.toml --json");
    agree(&frequencies, &[hz(1e5 / 2.0)], 1e-9);
    agree(&ratios, &[40.0 / (2.0 * (1e5_f64 * 2.0).sqrt())], 1e-9);
    // An option goes before the model.
    let [_, ratios] = modes("modes damper.toml --damping 0.02 --json");
    agree(&ratios, &[0.02], 1e-12);
    let rotor =
        "1e5, rotor = { inertia_kg_m2 = 1e-3, ratio = 100, servo_stiffness_n_m_per_rad = 3e5 } }";
    let law = "[damping]\nratio = 0.03\n";
    write("rotor.toml", PENDULUM.replace("1e5 }", rotor) + law);
    let [frequencies, ratios] = modes("modes rotor.toml --json");
    // Servo 3e5 and gear 1.5e5 in series; the rotor weighs 100^2 * 1e-3 kg m^2 on the joint's side.
    let (trace, determinant) = (
        1.5e5 / 2.0 + 4.5e5 / 10.0,
        (1.5e5 * 4.5e5 - 1.5e5 * 1.5e5) / 20.0,
    );
    let root = f64::sqrt(0.25 * trace * trace - determinant);
    agree(
        &frequencies,
        &[hz(0.5 * trace - root), hz(0.5 * trace + root)],
        1e-9,
    );
    agree(&ratios, &[0.03, 0.03], 1e-12);
    // At rest nothing changes: 0.5 m about a joint of 1e5 N m/rad.
    let answer = json(
        &said(
            here.path(),
            "frf rotor.toml --frequencies 0.001 0.002 2 --to y --from y --json",
        )
        .answered(),
    );
    let first = answer["curves"][0]["real"][0].as_f64().expect("a number");
    agree(&[first], &[0.25 / 1e5], 1e-6);
}

/// Responses by a force along x of an arm with softer and stiffer drives, as a table of measurements.
fn measured_of_another_arm(here: &Path) {
    let other = ARM6
        .replace("= 3900000.0", "= 2730000.0")
        .replace("= 2600000.0", "= 3120000.0");
    assert_ne!(other, ARM6);
    std::fs::write(here.join("other.toml"), other).expect("written");
    let line = "frf other.toml --damping 0.02 --frequencies 5 40 700 --from x --to x,y,z --json";
    let answer = json(&said(here, line).answered());
    let mut table = String::from(
        "frequency_hz,xx_re_m_per_n,xx_im_m_per_n,yx_re_m_per_n,yx_im_m_per_n,zx_re_m_per_n,zx_im_m_per_n\n",
    );
    let curves: Vec<[Vec<f64>; 2]> = (answer["curves"].as_array().expect("curves").iter())
        .map(|curve| [numbers(&curve["real"]), numbers(&curve["imaginary"])])
        .collect();
    for (i, hz) in numbers(&answer["frequencies_hz"]).iter().enumerate() {
        let values = curves.iter().flatten().map(|list| list[i].to_string());
        let row: Vec<String> = std::iter::once(hz.to_string()).chain(values).collect();
        table += &(row.join(",") + "\n");
    }
    std::fs::write(here.join("tap.csv"), table).expect("written");
}

#[test]
fn measured_modes_stand_beside_those_of_the_model_and_scale_it() {
    let here = arm6();
    measured_of_another_arm(here.path());
    let other = json(&said(here.path(), "modes other.toml --modes 3 --json").answered());
    let expected: Vec<f64> = (other["modes"].as_array().expect("modes").iter())
        .map(|mode| mode["frequency_hz"].as_f64().expect("a number"))
        .collect();
    let line = "frf arm6.toml --measured tap.csv --fit 3 --damping 0.03 --frequencies 5 40 700 --json f.json \
        --scale chain.arm.q2.stiffness_n_m_per_rad chain.arm.q3.stiffness_n_m_per_rad";
    let text = said(here.path(), line).answered().out;
    assert!(text.contains("Measured modes"), "{text}");
    let file = std::fs::read_to_string(here.path().join("f.json")).expect("JSON");
    let answer: Value = serde_json::from_str(&file).expect("JSON");
    let modes = answer["fit"]["modes"].as_array().expect("modes");
    let of = |name: &str| -> Vec<f64> {
        let list = modes
            .iter()
            .map(|mode| mode[name].as_f64().expect("a number"));
        list.collect()
    };
    // Modes above the band, the nearest at 49 Hz, are polynomials of the fit.
    agree(&of("frequency_hz"), &expected, 2e-4);
    agree(&of("damping_ratio"), &[0.02; 3], 1e-2);
    agree(&of("model_damping_ratio"), &[0.03; 3], 1e-12);
    agree(&of("model_mode"), &[1.0, 2.0, 3.0], 1e-12);
    assert!(
        of("modal_assurance")
            .iter()
            .all(|mac| (0.5..=1.0 + 1e-12).contains(mac)),
        "{text}"
    );
    let scaled = &answer["fit"]["scaled"];
    let list = scaled["parameters"].as_array().expect("parameters");
    let values: Vec<f64> = list
        .iter()
        .map(|p| p["value"].as_f64().expect("a number"))
        .collect();
    agree(&values, &[2.73e6, 3.12e6], 2e-3);
    assert!(
        list.iter()
            .all(|p| p["deviation"].as_f64().is_some_and(|d| d < 0.2)),
        "{scaled}"
    );
    assert_eq!(scaled["not_told"], serde_json::json!([]));
}

#[test]
fn what_the_measurement_does_not_tell_is_said() {
    let here = arm6();
    measured_of_another_arm(here.path());
    // One frequency tells one combination of two drives.
    let line = "frf arm6.toml --measured tap.csv --fit 1 --frequencies 5 9.5 700 \
        --scale chain.arm.q2.stiffness_n_m_per_rad chain.arm.q3.stiffness_n_m_per_rad";
    let text = said(here.path(), line).answered().out;
    assert!(text.contains("does not tell:"), "{text}");
    assert!(text.contains("not told"), "{text}");
    for (line, words) in [
        ("frf arm6.toml --fit 3", "--measured"),
        ("frf arm6.toml --measured tap.csv --fit 0", "1 to 30"),
        (
            "frf arm6.toml --measured tap.csv --fit 3 --frequencies 39.5 40 50",
            "frequencies in the band",
        ),
        (
            "frf arm6.toml --measured tap.csv --fit 1 --frequencies 5 40 50 --scale chain.arm.q9.stiffness_n_m_per_rad",
            "q9",
        ),
        (
            "frf arm6.toml --measured tap.csv --fit 1 --frequencies 5 40 50 --scale chain.arm.q2.stiffness_n_m_per_rad --scale-within 0.5",
            "--scale-within",
        ),
        (
            "frf arm6.toml --measured tap.csv --fit 1 --frequencies 5 40 50 --scale chain.arm.q2.stiffness_n_m_per_rad --frequencies-known-to 0",
            "--frequencies-known-to",
        ),
    ] {
        let said = said(here.path(), line);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains(words), "{line}: {}", said.err);
    }
}

/// Damping is scaled to the measured ratios, with what it is known to; noise without a mode scales nothing.
#[test]
fn damping_is_scaled_to_what_was_measured() {
    let here = arm6();
    measured_of_another_arm(here.path());
    // The other arm is damped by 2 % in every mode.
    let line = "frf arm6.toml --measured tap.csv --fit 3 --damping 0.03 --frequencies 5 40 700 --json \
        --scale damping.ratio chain.arm.q2.stiffness_n_m_per_rad chain.arm.q3.stiffness_n_m_per_rad";
    let answer = json(&said(here.path(), line).answered());
    let scaled = &answer["fit"]["scaled"];
    let list = scaled["parameters"].as_array().expect("parameters");
    let damping = list.iter().find(|p| p["path"] == "damping.ratio");
    let damping = damping.expect("the damping");
    agree(
        &[damping["value"].as_f64().expect("a number")],
        &[0.02],
        1e-2,
    );
    agree(
        &[damping["before"].as_f64().expect("a number")],
        &[0.03],
        1e-12,
    );
    // Three ratios, each known to a fifth.
    agree(
        &[damping["deviation"].as_f64().expect("told")],
        &[0.2 / 3.0_f64.sqrt() * 0.02 / 0.02],
        0.03,
    );
    agree(&numbers(&scaled["damping_ratios"]), &[0.02; 3], 1e-2);
    let mut noise = String::from("frequency_hz,xx_re_m_per_n,xx_im_m_per_n\n");
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / 2.0_f64.powi(31) - 0.5
    };
    for k in 0..700 {
        let hz = 5.0 + 0.05 * f64::from(k);
        noise += &format!("{hz},{:e},{:e}\n", 1e-7 * random(), 1e-7 * random());
    }
    std::fs::write(here.path().join("noise.csv"), noise).expect("written");
    for (line, words) in [
        (
            "frf arm6.toml --measured tap.csv --fit 3 --frequencies 5 40 700 --scale damping.ratio",
            "first value",
        ),
        (
            "frf arm6.toml --measured tap.csv --fit 3 --frequencies 5 40 700 --damping 0.03 --scale damping.loss_factor",
            "damping.ratio",
        ),
        (
            "frf arm6.toml --measured noise.csv --fit 5 --frequencies 5 40 700 --scale chain.arm.q2.stiffness_n_m_per_rad",
            "modes",
        ),
    ] {
        let said = said(here.path(), line);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains(words), "{line}: {}", said.err);
    }
}

/// Speeds at which the QR iteration of the multipliers does not end from its first beginning: their limits lie between those of
/// the speeds beside them.
#[test]
fn speeds_have_limits_whose_multipliers_are_hard_to_find() {
    let here = workplace();
    let limits = |rpm: [f64; 3]| -> Vec<f64> {
        let [low, _, high] = rpm;
        let line = format!(
            "lobes heavy_6r --tool-length-mm 150 --damping 0.03 --teeth 2 --immersion 0.5 --up --coefficients-n-per-mm2 800 240 0 --rpm {low} {high} 3 --json"
        );
        let answer = json(&said(here.path(), &line).answered());
        let points = answer["points"].as_array().expect("points").iter();
        points
            .map(|point| point["limit_mm"].as_f64().expect("a limit"))
            .collect()
    };
    let found = limits([1_900.0, 2_016.949_152_542_372_4, 2_133.898_305_084_744_8]);
    assert!(found.iter().all(|limit| *limit > 0.0), "{found:?}");
    let beside = limits([2_015.949, 2_016.949, 2_017.949]);
    agree(&[found[1]], &[beside[0]], 5e-3);
    agree(&[found[1]], &[beside[2]], 5e-3);
}

/// One speed and one frequency are questions, too.
#[test]
fn one_speed_and_one_frequency() {
    let here = arm6();
    let lobes =
        "lobes arm6.toml --damping 0.03 --teeth 2 --coefficients-n-per-mm2 800 240 0 --json --rpm";
    let points = |rpm: &str| {
        let answer = json(&said(here.path(), &format!("{lobes} {rpm}")).answered());
        answer["points"].as_array().expect("points").clone()
    };
    let (one, several) = (points("1500 1500 1"), points("1000 2000 3"));
    assert_eq!((one.len(), &one[0]), (1, &several[1]));
    let frf = |hz: &str| {
        let line =
            format!("frf arm6.toml --damping 0.03 --from x --to x --json --frequencies {hz}");
        let answer = json(&said(here.path(), &line).answered());
        numbers(&answer["curves"][0]["real"])
    };
    agree(&frf("20 20 1"), &[frf("10 30 3")[1]], 1e-12);
    for line in [
        format!("{lobes} 1500 1500 1 --plot one.svg"),
        format!("{lobes} 1500 1600 1"),
        "frf arm6.toml --frequencies 20 20 1 --plot one.svg".to_owned(),
    ] {
        assert_eq!(said(here.path(), &line).code, 1, "{line}");
    }
}

/// Three taps of a hammer: the curves by the force that is asked for are fitted, and the others are named. They were passed over
/// without a word, whatever `--from` said.
#[test]
fn curves_by_other_forces_are_named() {
    let here = arm6();
    let here = here.path();
    let place = "frf arm6.toml --damping 0.02 --frequencies 5 40 900";
    said(here, &format!("{place} --from x,y --to x,y --csv own.csv")).answered();
    let fitted = |force: &str| {
        let line = format!("{place} --measured own.csv --fit 2 --from {force} --json");
        json(&said(here, &line).answered())
    };
    for force in ["x", "y"] {
        let answer = fitted(force);
        let curves = answer["fit"]["curves"].as_array().expect("curves");
        assert_eq!(curves.len(), 2, "{answer}");
        for curve in curves {
            let name = curve.as_str().expect("a name");
            assert!(name.ends_with(&format!("_by_{force}")), "{force}: {name}");
        }
        let warnings = answer["warnings"].to_string();
        assert!(warnings.contains("2 of 4 measured curves"), "{warnings}");
    }
}
