//! A bar that bends by itself, with its mass along it and with its mass at its end: `modes` says which frequency is none.

use serde_json::Value;

use crate::common::{run, workplace};

/// A bar of 1 m between two hinges, 10 mm thick.
fn between_hinges(mass: &str, body: &str) -> String {
    format!(
        r#"schema = 1

[mechanism]
name = "bar between hinges"
gravity_m_per_s2 = [0, 0, 0]

[[platform]]
name = "tool"
home = {{ position_mm = [1000, 0, 0] }}

[section."bar"]
tube = {{ outer_diameter_mm = 10, inner_diameter_mm = 5 }}
youngs_modulus_gpa = 210
poissons_ratio = 0.3

[chain.line]
elements = [
  {{ passive = "revolute", name = "near", axis = "y" }},
  {{ link = "bar", name = "bar", length_mm = 1000{mass} }},
{body}  {{ passive = "revolute", name = "far", axis = "y" }},
]

[[limb]]
name = "line"
from = "base"
to = "tool"
chain = "line"
"#
    )
}

#[test]
fn a_bar_that_bends_under_its_mass_at_its_end_is_said() {
    const DENSITY: f64 = 7850.0;
    let (outer, inner) = (0.010_f64, 0.005_f64);
    let pi = std::f64::consts::PI;
    let mass = DENSITY * pi / 4.0 * (outer.powi(2) - inner.powi(2));
    let stiffness = 2.1e11 * pi / 64.0 * (outer.powi(4) - inner.powi(4));
    let unit = (stiffness / mass).sqrt() / (2.0 * pi); // Hz, for a bar of 1 m
    let here = workplace();
    let first = |name: &str, text: String| {
        std::fs::write(here.path().join(name), text).expect("written");
        let line = ["modes", name, "--hold", "x,y,z,rx,ry,rz", "--json"];
        let said = run(here.path(), &line).answered().out;
        let found: Value = serde_json::from_str(&said).expect("JSON");
        let hz = found["modes"][0]["frequency_hz"].as_f64().expect("Hz");
        (hz / unit, found["warnings"].to_string())
    };
    // All of the mass half the length before the end that turns by the moment 3 EI / L: sqrt(12).
    let body = format!(
        "  {{ body = \"bar mass\", mass_kg = {mass}, centre_of_mass_mm = [-500, 0, 0] }},\n"
    );
    let (lumped, warned) = first("lumped.toml", between_hinges("", &body));
    assert!((lumped / 12.0_f64.sqrt() - 1.0).abs() < 5e-4, "{lumped}");
    assert!(
        warned.contains("'line.bar mass' behind 'line.bar'")
            || warned.contains("'bar mass' behind 'bar'"),
        "{warned}"
    );
    // Along the bar: pi^2, and one segment is 11 % above it.
    let (spread, warned) = first(
        "spread.toml",
        between_hinges(", density_kg_m3 = 7850, segments = 4", ""),
    );
    assert!((spread / pi.powi(2) - 1.0).abs() < 2e-3, "{spread}");
    assert_eq!(warned, "[]");
    // A body elsewhere is not the bar's.
    let (_, warned) = first(
        "behind.toml",
        between_hinges("", &body.replace("-500", "300")),
    );
    assert!(!warned.contains("own masses"), "{warned}");
}
