//! Wrong model files.

use crate::common::MODEL;
use crate::refusals::{Case, case, changed};

const CHECK: [&str; 2] = ["check", "bad.toml"];

pub fn models() -> Vec<Case> {
    let m = |from: &str, to: &str| vec![("bad.toml", changed(MODEL, from, to))];
    vec![
        case(
            "model: no unit",
            m("length_mm = 800", "length = 800"),
            &CHECK,
            1,
            &["bad.toml:20", "no unit", "length_mm"],
        ),
        case(
            "model: wrong unit",
            m("stiffness_n_m_per_rad", "stiffness_n_m_per_deg"),
            &CHECK,
            1,
            &["bad.toml:19", "stiffness_n_m_per_rad"],
        ),
        case(
            "model: unit of another kind",
            m("stiffness_n_m_per_rad", "stiffness_n_per_mm"),
            &CHECK,
            1,
            &["bad.toml:19"],
        ),
        case(
            "model: not a number",
            m("mass_kg = 2", "mass_kg = nan"),
            &CHECK,
            1,
            &["bad.toml:10", "finite"],
        ),
        case(
            "model: infinite",
            m("length_mm = 800", "length_mm = inf"),
            &CHECK,
            1,
            &["bad.toml:20", "finite"],
        ),
        case(
            "model: negative stiffness",
            m("= 2e5", "= -2e5"),
            &CHECK,
            1,
            &["bad.toml:19", "-200000", "above zero"],
        ),
        case(
            "model: negative mass",
            m("mass_kg = 2", "mass_kg = -2"),
            &CHECK,
            1,
            &["bad.toml:10", "mass"],
        ),
        case(
            "model: slip of the pen",
            m("youngs_modulus_gpa", "youngs_modulos_gpa"),
            &CHECK,
            1,
            &["bad.toml:14", "did you mean 'youngs_modulus_gpa'?"],
        ),
        case(
            "model: text for a number",
            m("mass_kg = 2", "mass_kg = \"2\""),
            &CHECK,
            1,
            &["bad.toml:10", "number"],
        ),
        case(
            "model: unknown chain",
            m("chain = \"arm\"", "chain = \"arn\""),
            &CHECK,
            1,
            &["bad.toml", "arn", "arm"],
        ),
        case(
            "model: weight without gravity",
            m("gravity_m_per_s2 = [0, 0, -9.81]", ""),
            &CHECK,
            1,
            &["bad.toml", "gravity_m_per_s2"],
        ),
        case(
            "model: no TOML",
            m("schema = 1", "schema : 1"),
            &CHECK,
            1,
            &["bad.toml:1", "TOML"],
        ),
        case(
            "model: another version",
            m("schema = 1", "schema = 7"),
            &CHECK,
            1,
            &["bad.toml:1", "version 7", "version 1"],
        ),
        case(
            "model: unnamed rotation",
            m(
                "position_mm = [800, 0, 0]",
                "position_mm = [800, 0, 0], rpy_deg = [0, 0, 0]",
            ),
            &CHECK,
            1,
            &["bad.toml:9", "convention"],
        ),
        case(
            "model: missing",
            vec![],
            &["check", "missing.toml"],
            1,
            &["missing.toml", "no such file"],
        ),
        case(
            "model: directory",
            vec![],
            &["check", "."],
            1,
            &["directory"],
        ),
        case(
            "model: nothing in it",
            vec![("bad.toml", vec![])],
            &CHECK,
            1,
            &["bad.toml", "empty"],
        ),
        case(
            "model: binary",
            vec![("bad.toml", vec![0, 159, 146, 150, 0])],
            &CHECK,
            1,
            &["bad.toml", "binary"],
        ),
        case(
            "model: UTF-16",
            vec![("bad.toml", vec![0xff, 0xfe, b's', 0])],
            &CHECK,
            1,
            &["bad.toml", "UTF-16", "UTF-8"],
        ),
        case(
            "model: Latin-1",
            vec![("bad.toml", b"schema = 1\n# Gr\xf6\xdfe\n".to_vec())],
            &CHECK,
            1,
            &["bad.toml", "line 2", "UTF-8"],
        ),
        case(
            "model: unknown preset",
            vec![],
            &["check", "ortoglide"],
            1,
            &["ortoglide", "did you mean 'orthoglide'?"],
        ),
        case(
            "model: preset to show",
            vec![],
            &["model", "show", "stewart"],
            1,
            &["stewart", "stewart_gough_a"],
        ),
        case(
            "model: a repeatability in micrometres",
            m(
                "name = \"arm\"\ng",
                "name = \"arm\"\nrepeatability_mm = 60\ng",
            ),
            &["compensate", "job.toml", "--model", "bad.toml"],
            1,
            &["bad.toml:5", "repeatability is 60 mm", "0.00001 to 10 mm"],
        ),
        case(
            "model: escape codes in a name",
            m("name = \"shoulder\"", "nam\u{7}e = \"\u{1b}[31mshoulder\""),
            &CHECK,
            1,
            &["bad.toml"],
        ),
    ]
}
