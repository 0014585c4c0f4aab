//! Models that are checked, and what is said of them.

use serde_json::Value;

use super::{Said, run, workplace};

/// Writes a model and checks it, with JSON.
pub fn checked(text: &str, more: &[&str]) -> (Value, String) {
    let here = workplace();
    std::fs::write(here.path().join("own.toml"), text).expect("a file");
    let mut words = vec!["check", "own.toml", "--json"];
    words.extend(more);
    of(run(here.path(), &words))
}

pub fn preset(name: &str, more: &[&str]) -> (Value, String) {
    let here = workplace();
    let mut words = vec!["check", name, "--json"];
    words.extend(more);
    of(run(here.path(), &words))
}

pub fn of(said: Said) -> (Value, String) {
    let said = said.answered();
    let found = serde_json::from_str(&said.out).expect("JSON");
    (found, said.err)
}

/// Text without line breaks, as it is meant.
pub fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

pub fn edited(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in the model");
        text.replacen(from, to, 1)
    })
}

/// The warnings of an answer, as `FILE:LINE: message` where they speak of a file. All have one form.
pub fn warnings(answer: &Value) -> Vec<String> {
    let list = answer["warnings"].as_array().expect("a list");
    let reported = |warning: &Value| {
        let names: Vec<&String> = warning.as_object().expect("an object").keys().collect();
        assert_eq!(names, ["code", "file", "line", "message"], "{warning}");
        let code = warning["code"].as_str().expect("a word");
        let plain = |c: char| c.is_ascii_lowercase() || c == '_';
        assert!(!code.is_empty() && code.chars().all(plain), "{code}");
        let message = warning["message"].as_str().expect("a text");
        match (warning["file"].as_str(), warning["line"].as_u64()) {
            (Some(file), Some(line)) => format!("{file}:{line}: {message}"),
            (Some(file), None) => format!("{file}: {message}"),
            (None, line) => {
                // A line of a program, which only runs have.
                assert!(line.is_none_or(|line| line >= 1), "{warning}");
                message.to_owned()
            }
        }
    };
    list.iter().map(reported).collect()
}

pub fn texts(list: &Value) -> Vec<String> {
    let list = list.as_array().expect("a list");
    list.iter()
        .map(|v| v.as_str().expect("a text").to_owned())
        .collect()
}

/// A planar arm of two turning joints, 500 and 300 mm, with weights.
pub const ARM: &str = r#"schema = 1

[mechanism]
name = "planar arm"
gravity_m_per_s2 = [0, 0, -9.81]

[[platform]]
name = "tool"
home = { position_mm = [500, 300, 200], rotation_vector_deg = [0, 0, 90] }
mass_kg = 5

[section.tube]
tube = { outer_diameter_mm = 120, inner_diameter_mm = 100 }
material = "steel"

[chain.arm]
elements = [
  { rigid = { translation_mm = [0, 0, 200] }, name = "foot" },
  { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 4e5, limits_deg = [-90, 90] },
  { body = "upper mass", mass_kg = 20, centre_of_mass_mm = [250, 0, 0], inertia_kg_m2 = [[0.1, 0, 0], [0, 0.5, 0], [0, 0, 0.5]] },
  { link = "tube", name = "upper arm", length_mm = 500 },
  { actuator = "revolute", name = "elbow", axis = "z", stiffness_n_m_per_rad = 3e5, home_deg = 90, limits_deg = [40, 150] },
  { body = "fore mass", mass_kg = 10, centre_of_mass_mm = [150, 0, 0] },
  { link = "tube", name = "forearm", length_mm = 300 },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

/// An upright arm: pitch, pitch, pitch in a vertical plane, stretched forward, with a turning foot.
pub const HEAVY: &str = r#"schema = 1

[mechanism]
name = "heavy arm"
gravity_m_per_s2 = [0, 0, -9.81]

[[platform]]
name = "tool"
home = { position_mm = [1700, 0, 600] }
mass_kg = 80

[stiffness.joint]
diagonal_n_m_rad = [2e8, 2e8, 2e8, 3e6, 3e6, 3e6]

[chain.arm]
elements = [
  { actuator = "revolute", name = "a1", axis = "z", stiffness_n_m_per_rad = 4e6, limits_deg = [-170, 170] },
  { rigid = { translation_mm = [0, 0, 600] } },
  { actuator = "revolute", name = "a2", axis = "y", stiffness_n_m_per_rad = 5e6, limits_deg = [-90, 60] },
  { body = "upper", mass_kg = 200, centre_of_mass_mm = [400, 0, 0] },
  { rigid = { translation_mm = [900, 0, 0] }, name = "upper arm" },
  { spring6 = "joint", name = "bearing" },
  { actuator = "revolute", name = "a3", axis = "y", stiffness_n_m_per_rad = 3e6, limits_deg = [-120, 120] },
  { body = "fore", mass_kg = 120, centre_of_mass_mm = [300, 0, 0] },
  { rigid = { translation_mm = [800, 0, 0] }, name = "forearm" },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

/// A bar between two spherical joints.
pub const BAR: &str = r#"schema = 1
[mechanism]
name = "bar"
[[platform]]
name = "tool"
home = { position_mm = [400, 0, 0] }
[chain.strut]
elements = [
  { passive = "spherical", name = "near" },
  { actuator = "prismatic", name = "ram", axis = "x", stiffness_n_per_mm = 2e4, home_mm = 400, limits_mm = [300, 500] },
  { passive = "spherical", name = "far" },
]
[[limb]]
name = "strut"
from = "base"
to = "tool"
chain = "strut"
"#;

/// A slender bar pinned at its foot; its head slides along x and is pinned, too.
pub const COLUMN: &str = r#"schema = 1
[mechanism]
name = "column"
[[platform]]
name = "head"
home = { position_mm = [1000, 0, 0] }
[section.rod]
round = { diameter_mm = 10 }
material = "steel"
[chain.rod]
elements = [
  { passive = "revolute", name = "foot pin", axis = "z" },
  { link = "rod", name = "rod", length_mm = 1000, segments = 4 },
  { passive = "revolute", name = "head pin", axis = "z" },
]
[chain.guide]
elements = [
  { rigid = { translation_mm = [1000, 0, 0] } },
  { passive = "prismatic", name = "slide", axis = "x" },
]
[[limb]]
name = "rod"
from = "base"
to = "head"
chain = "rod"
[[limb]]
name = "guide"
from = "base"
to = "head"
chain = "guide"
"#;
