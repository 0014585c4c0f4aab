//! `kinetostat check`: plausibility checks that find a wrong unit, with the line to which it points.
#![allow(clippy::print_stdout)] // figures

use crate::common::MODEL;
use crate::common::checks::{ARM, BAR, COLUMN, HEAVY, checked, edited, flat, warnings};

const HEAVY_6R: &str = include_str!("../../../kinetostat-model/models/heavy_6r.toml");

const KUKA: &str = include_str!("../../../kinetostat-model/models/kuka_kr270_like.toml");

/// An implausible figure: model, edits, what is said, and the line's text to which it points.
type PlausibilityCase<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a str, &'a str);

#[test]
fn figure_wrong_units_are_implausible_and_the_line_is_named() {
    let list: &[PlausibilityCase<'_>] = &[
        (
            ARM,
            &[("[0, 0, -9.81]", "[0, 0, -9810]")],
            "gravity is 9810 m/s^2",
            "gravity_m",
        ),
        (
            ARM,
            &[("[0, 0, -9.81]", "[0, 0, -1.0]")],
            "gravity is 1 m/s^2",
            "gravity_m",
        ),
        (
            ARM,
            &[("[0, 0, -9.81]", "[0, 0, 9.81]")],
            "gravity points up",
            "gravity_m",
        ),
        (
            MODEL,
            &[("youngs_modulus_gpa = 70", "youngs_modulus_pa = 70")],
            "a Young's modulus of 70 Pa is no usual solid",
            "youngs_modulus_pa",
        ),
        (
            MODEL,
            &[("youngs_modulus_gpa = 70", "youngs_modulus_mpa = 210")],
            "a Young's modulus of 210e6 Pa is no usual solid",
            "youngs_modulus_mpa",
        ),
        (
            COLUMN,
            &[(
                "round = { diameter_mm = 10 }",
                "values = { area_mm2 = 1000, second_moment_y_m4 = 1e2, second_moment_z_mm4 = 1e6, torsion_constant_mm4 = 2e6 }",
            )],
            "a second moment of 100 m^4",
            "second_moment_y_m4",
        ),
        (
            HEAVY_6R,
            &[(
                "stiffness_n_m_per_rad = 6.6e6",
                "stiffness_n_m_per_rad = 1.15e5",
            )],
            "the drive 'joint 2' is 34 times softer than 'joint 3' behind it",
            "joint 2",
        ),
        (
            HEAVY_6R,
            &[("mass_kg = 35,", "mass_kg = 343.35,")],
            "the body 'wrist mass' weighs 343 kg",
            "mass_kg = 343.35",
        ),
        (
            HEAVY_6R,
            &[("mass_kg = 90,", "mass_kg = 882.9,")],
            "the body 'forearm mass' weighs 883 kg, and 'elbow mass', which carries it, 190 kg",
            "mass_kg = 882.9",
        ),
        (
            HEAVY_6R,
            &[("mass_kg = 190,", "mass_kg = 1863.9,")],
            "the body 'elbow mass' weighs 1864 kg",
            "mass_kg = 1863.9",
        ),
        (
            HEAVY_6R,
            &[("mass_kg = 25,", "mass_kg = 245.25,")],
            "the body 'flange mass' weighs 245 kg",
            "mass_kg = 245.25",
        ),
        (
            HEAVY_6R,
            &[("mass_kg = 35,", "mass_kg = 0.035,")],
            "the body 'wrist mass' weighs 0.035 kg",
            "mass_kg = 0.035",
        ),
        (
            KUKA,
            &[("free_length_mm = 458", "free_length_mm = 0.458")],
            "a spring with a free length of 0.458 mm, in a machine of 3.33 m",
            "free_length_mm",
        ),
        (
            KUKA,
            &[("free_length_mm = 458", "free_length_mm = 11600")],
            "a spring with a free length of 11600 mm, in a machine of 3.33 m",
            "free_length_mm",
        ),
        (
            ARM,
            &[("length_mm = 500", "length_m = 500")],
            "a length of 500 m",
            "length_m = 500",
        ),
        (
            ARM,
            &[("length_mm = 300", "length_mm = 0.3")],
            "the length is 0.3 mm",
            "length_mm = 0.3",
        ),
        (
            ARM,
            &[("length_mm = 500", "length_m = 1000")],
            "reaches over 1000",
            "[[limb]]",
        ),
        (
            ARM,
            &[(
                "outer_diameter_mm = 120, inner_diameter_mm = 100",
                "outer_diameter_mm = 0.02, inner_diameter_mm = 0.01",
            )],
            "the inner diameter is 0.01 mm",
            "inner_diameter",
        ),
        (
            ARM,
            &[("home_deg = 90, limits_deg = [40, 150]", "home_rad = 90")],
            "90 rad are 14 turns",
            "home_rad",
        ),
        (
            ARM,
            &[(
                "home_deg = 90, limits_deg = [40, 150]",
                "home_deg = 1.5708, limits_deg = [-90, 150]",
            )],
            "1.5708 degrees are exactly 90 degrees in radians",
            "home_deg",
        ),
        (
            ARM,
            &[("limits_deg = [-90, 90]", "limits_deg = [-1.6, 1.6]")],
            "the joint turns by only 3.2 degrees in all",
            "limits_deg = [-1.6",
        ),
        (
            ARM,
            &[("mass_kg = 10,", "mass_kg = 5000,")],
            "the body 'fore mass' weighs 5000 kg",
            "mass_kg = 5000",
        ),
        (
            HEAVY,
            &[("stiffness_n_m_per_rad = 5e6", "stiffness_n_m_per_rad = 50")],
            "the joint 'a2' turns by",
            "stiffness_n_m_per_rad = 50",
        ),
        (
            HEAVY,
            &[(
                "stiffness_n_m_per_rad = 4e6",
                "stiffness_n_mm_per_rad = 4e6",
            )],
            "the drive 'a1' is 1250 times softer than the other drives",
            "stiffness_n_mm_per_rad",
        ),
        (
            HEAVY,
            &[("stiffness_n_m_per_rad = 3e6", "stiffness_n_m_per_rad = 3e9")],
            "times stiffer than the other drives",
            "stiffness_n_m_per_rad = 3e9",
        ),
        (
            HEAVY,
            &[(
                "stiffness_n_m_per_rad = 3e6",
                "stiffness_n_m_per_rad = 3e12",
            )],
            "stiffer than any machine's",
            "stiffness_n_m_per_rad = 3e12",
        ),
        (
            BAR,
            &[("stiffness_n_per_mm = 2e4", "stiffness_n_per_m = 2e3")],
            "the drive 'ram' has 2000 N/m, softer than any machine's",
            "stiffness_n_per_m",
        ),
        (
            HEAVY,
            &[(
                "diagonal_n_m_rad = [2e8, 2e8, 2e8, 3e6, 3e6, 3e6]",
                "diagonal_n_m_rad = [2e5, 2e5, 2e5, 3e9, 3e9, 3e9]",
            )],
            "belong to a part of 122",
            "spring6",
        ),
        (
            ARM,
            &[(
                "[[0.1, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]",
                "[[1e5, 0, 0], [0, 5e5, 0], [0, 0, 5e5]]",
            )],
            "the inertia of the body 'upper mass' is that of a part of",
            "inertia_kg_m2",
        ),
        (
            ARM,
            &[(
                "[[0.1, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]",
                "[[0.1, 0, 0], [0, 0.5, 0.3], [0, 0.3, 0.5]]",
            )],
            "its principal moments are 0.1, 0.2 and 0.8 kg m^2",
            "inertia_kg_m2",
        ),
        (
            ARM,
            &[(
                "centre_of_mass_mm = [250, 0, 0]",
                "centre_of_mass_m = [25, 0, 0]",
            )],
            "the centre of mass of the body 'upper mass' is",
            "centre_of_mass_m",
        ),
        (
            ARM,
            &[
                ("mass_kg = 20,", "mass_kg = 0.02,"),
                ("mass_kg = 10,", "mass_kg = 0.01,"),
            ],
            "links of that stiffness weigh about",
            "mass_kg = 0.02",
        ),
        (
            ARM,
            &[(
                "[section.tube]",
                "[workspace]\ncorner_m = [-300, -300, 0]\nopposite_corner_m = [300, 300, 400]\n[section.tube]",
            )],
            "a length of 300 m",
            "corner_m",
        ),
        (
            ARM,
            &[(
                "[section.tube]",
                "[workspace]\ncorner_mm = [-0.3, -0.3, 0]\nopposite_corner_mm = [0.3, 0.3, 0.4]\n[section.tube]",
            )],
            "the workspace is 0.0009",
            "[workspace]",
        ),
        (
            ARM,
            &[(
                "[[limb]]",
                "[[deviation]]\nlimb = \"arm\"\nat = \"foot\"\nmoved_by = { rotation_vector_deg = [0, 0, 57.3] }\n[[limb]]",
            )],
            "an error of assembly of 0 mm and 57.3 degrees",
            "moved_by",
        ),
        (
            ARM,
            &[(
                "position_mm = [500, 300, 200]",
                "position_mm = [500, 200, 200]",
            )],
            "away from the platform 'tool'",
            "[[limb]]",
        ),
    ];
    let mut named = 0;
    for (base, changes, said, at) in list {
        let text = edited(base, changes);
        let (found, words) = checked(&text, &[]);
        let warnings = warnings(&found);
        let Some(own) = warnings.iter().find(|w| w.contains(said)) else {
            panic!("{said}: {warnings:?}");
        };
        let place = own.strip_prefix("own.toml:").expect("the file");
        let (line, rest) = place.split_once(": ").expect("a line");
        let line: usize = line.parse().expect("a number");
        let shown = text.lines().nth(line - 1).unwrap_or_default();
        assert!(shown.contains(at), "{own}: line {line} is '{shown}'");
        // Digits that mean something.
        for word in rest.split([' ', ',', ';', '(', ')']) {
            let figures: String = word.chars().filter(char::is_ascii_digit).collect();
            let digits = figures.trim_start_matches('0').len();
            let number = word.parse::<f64>().is_ok();
            let whole = !word.contains('.');
            assert!(
                !number || digits <= if whole { 7 } else { 5 },
                "{word}: {own}"
            );
        }
        // What is wrong, then what to do.
        assert!(rest.contains("; "), "{own}");
        assert!(flat(&words).contains("warning") || flat(&words).contains("Warning"));
        named += 1;
    }
    figure(
        "Wrong units: broken models named with their line",
        named,
        15,
    );
}

/// Prints a figure and holds it.
fn figure(name: &str, measured: usize, least: usize) {
    let figure = serde_json::json!({
        "name": name,
        "measured": measured,
        "asked": format!("at least {least}"),
        "unit": "models",
        "holds": measured >= least,
    });
    println!("figure {figure}");
    assert!(measured >= least, "{figure}");
}
