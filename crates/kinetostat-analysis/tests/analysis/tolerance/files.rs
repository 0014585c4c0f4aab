//! Files of uncertainties, and what is refused in them.

use kinetostat::Wrench;
use kinetostat::nalgebra::Vector3;
use kinetostat_analysis::tolerance::{Distribution, UncertaintyFile};
use kinetostat_model::Model;

fn read(text: &str) -> Result<UncertaintyFile, String> {
    let model = Model::preset("orthoglide").expect("a preset");
    let load = Wrench::new(Vector3::new(100.0, 0.0, -20.0), Vector3::zeros());
    UncertaintyFile::read(text, "spread.toml", &model, &load).map_err(|e| e.to_string())
}

fn refused(text: &str, words: &[&str]) {
    let said = read(text).expect_err("a refusal");
    for word in words {
        assert!(said.contains(word), "'{word}' is missing in:\n{said}");
    }
}

#[test]
fn units_and_percents_are_those_of_the_parameter() {
    let file = read(
        r#"schema = 1
[[uncertain]]
parameter = "chain.leg.q2.length_mm"
uniform = 0.05
source = "drawing, tolerance m"
[[uncertain]]
parameter = "chain.leg.slider.stiffness_n_per_mm"
normal_percent = 5
[[uncertain]]
load = "force_n.z"
triangular_percent = 10
[[uncertain]]
load = "factor"
normal = 0.1
[[correlation]]
between = ["chain.leg.q2.length_mm", "factor"]
coefficient = 0.5
"#,
    )
    .expect("a file");
    let each: Vec<_> = file
        .uncertainties
        .each()
        .iter()
        .map(|u| (u.value, u.unit.as_str(), u.distribution))
        .collect();
    assert_eq!(each[0], (310.0, "mm", Distribution::Uniform(0.05)));
    assert_eq!(each[1], (1e6, "N/mm", Distribution::Normal(5e4)));
    assert_eq!(each[2], (-20.0, "N", Distribution::Triangular(2.0)));
    assert_eq!(each[3], (1.0, "", Distribution::Normal(0.1)));
    assert!(file.uncertainties.is_correlated());
}

#[test]
fn what_is_wrong_is_refused_by_name_and_line() {
    let one = |rest: &str| {
        format!(
            "schema = 1\n[[uncertain]]\nparameter = \"chain.leg.slider.stiffness_n_per_mm\"\n{rest}"
        )
    };
    refused(&one("normal = -1"), &["spread.toml:4", "a spread of -1"]);
    refused(&one("normal = nan"), &["spread.toml:4", "NaN"]);
    refused(
        &one("normal_percent = 30"),
        &["spread.toml:4", "stiffness", "-200000"],
    );
    refused(
        &one("uniform = 2e6"),
        &["spread.toml:4", "chain.leg.slider.stiffness_n_per_mm"],
    );
    refused(&one("normal = 1\nuniform = 2"), &["2 spreads are given"]);
    refused(&one(""), &["0 spreads are given"]);
    refused(&one("gaussian = 1"), &["gaussian"]);
    refused(&one("normal = \"x\""), &["spread.toml:4"]);
    refused(
        "schema = 2\n[[uncertain]]\nload = \"factor\"\nnormal = 0.1",
        &["schema 1"],
    );
    refused("schema = 1", &["nothing is uncertain"]);
    refused(
        "schema = 1\n[[uncertain]]\nparameter = \"chain.leg.q2.lenght_mm\"\nnormal = 1",
        &[
            "spread.toml:3",
            "chain.leg.q2.lenght_mm",
            "'chain.leg.q2.length_mm'",
        ],
    );
    refused(
        "schema = 1\n[[uncertain]]\nload = \"force.x\"\nnormal = 1",
        &["spread.toml:3", "force_n.x"],
    );
    refused(
        "schema = 1\n[[uncertain]]\nload = \"force_n.y\"\nnormal_percent = 1",
        &["zero"],
    );
    let pair = |c: &str| {
        format!(
            "schema = 1\n[[uncertain]]\nload = \"force_n.x\"\nnormal = 1\n[[uncertain]]\nload = \"force_n.z\"\nnormal = 1\n\
             [[uncertain]]\nload = \"factor\"\nnormal = 0.1\n{c}"
        )
    };
    refused(
        &pair("[[correlation]]\nbetween = [\"force_n.x\", \"force_n.q\"]\ncoefficient = 0.5"),
        &["force_n.q", "spread.toml:12"],
    );
    refused(
        &pair("[[correlation]]\nbetween = [\"force_n.x\", \"force_n.z\"]\ncoefficient = 1.5"),
        &["between -1 and 1"],
    );
    refused(
        &pair("[[correlation]]\nbetween = [\"force_n.x\", \"force_n.x\"]\ncoefficient = 0.5"),
        &["twice"],
    );
    refused(
        &pair(
            "[[correlation]]\nbetween = [\"force_n.x\", \"force_n.z\"]\ncoefficient = 0.9\n[[correlation]]\nbetween = [\"force_n.z\", \"factor\"]\ncoefficient = 0.9\n[[correlation]]\nbetween = [\"force_n.x\", \"factor\"]\ncoefficient = -0.9",
        ),
        &["contradict", "eigenvalue"],
    );
    let twice = format!(
        "{}\n[[uncertain]]\nload = \"factor\"\nnormal = 0.1",
        pair("")
    );
    refused(&twice, &["'load factor' is given twice"]);
}
