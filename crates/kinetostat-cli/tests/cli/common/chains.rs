//! The report's chains of three links as model files, and answers read as JSON.

use std::path::Path;

use serde_json::Value;

use super::run;

/// A Z of three unit links (springs at rest at -30 and 30 degrees) and the straight chain.
pub fn chain(rest_deg: f64, q_deg: f64, x_mm: f64) -> String {
    format!(
        r#"schema = 1

[mechanism]
name = "three links"

[[platform]]
name = "tool"
home = {{ position_mm = [{x_mm:?}, 0, 0] }}

[chain.arm]
elements = [
  {{ passive = "revolute", name = "q", axis = "z", home_deg = {q_deg:?} }},
  {{ rigid = {{ translation_mm = [1000, 0, 0] }} }},
  {{ node = "first" }},
  {{ actuator = "revolute", name = "th1", axis = "z", stiffness_n_m_per_rad = 1.0, home_deg = {first:?} }},
  {{ rigid = {{ translation_mm = [1000, 0, 0] }} }},
  {{ node = "second" }},
  {{ actuator = "revolute", name = "th2", axis = "z", stiffness_n_m_per_rad = 1.0, home_deg = {rest_deg:?} }},
  {{ rigid = {{ translation_mm = [1000, 0, 0] }} }},
  {{ passive = "revolute", name = "e", axis = "z", home_deg = {back:?} }},
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#,
        first = -rest_deg,
        back = -q_deg,
    )
}

pub fn workplace() -> tempfile::TempDir {
    let here = tempfile::tempdir().expect("a directory");
    let reach = (5.0 + 4.0 * 30_f64.to_radians().cos()).sqrt();
    // Of the Z at rest: the first link's angle to the line between the ends.
    let (x, y) = (2.0 + 30_f64.to_radians().cos(), -30_f64.to_radians().sin());
    assert!((x.hypot(y) - reach).abs() < 1e-12);
    let q = (-y).atan2(x).to_degrees();
    for (name, text) in [
        ("z.toml", chain(30.0, q, 1e3 * reach)),
        ("s.toml", chain(0.0, 0.0, 3e3)),
    ] {
        std::fs::write(here.path().join(name), text).expect("a file");
    }
    here
}

#[track_caller]
pub fn json(here: &Path, arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let said = run(here, &all).answered();
    serde_json::from_str(&said.out).expect("JSON")
}

/// The words of a `kinetostat curve`: a model pushed along a direction of the base from one displacement to
/// another, mm, and further options.
pub fn curve_along<'w>(
    model: &'w str,
    direction: [&'w str; 3],
    [from, to]: [&'w str; 2],
    more: &[&'w str],
) -> Vec<&'w str> {
    let mut words = vec!["curve", model, "--direction"];
    words.extend(direction);
    words.extend(["--displacement-mm", from, to]);
    words.extend(more);
    words
}

pub fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or(f64::NAN)
}

/// Read by `cargo xtask figures`.
#[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
pub fn figure(name: &str, measured: f64, most: f64, unit: &str) -> bool {
    let holds = measured <= most;
    println!(
        "figure {{\"name\":\"{name}\",\"measured\":{measured:e},\"asked\":\"at most {most:e}\",\"unit\":\"{unit}\",\"holds\":{holds}}}"
    );
    holds
}

pub fn named<'v>(answer: &'v Value, kind: &str) -> Vec<&'v Value> {
    let list = answer["named_points"].as_array().expect("named points");
    list.iter().filter(|p| p["kind"] == kind).collect()
}
