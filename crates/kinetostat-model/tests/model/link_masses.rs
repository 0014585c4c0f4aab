//! Mass along links: what the keys mean, and what is refused with its line.

use kinetostat_model::Model;

const ARM: &str = r#"schema = 1
[mechanism]
name = "a heavy arm"

[[platform]]
name = "tool"
home = { position_mm = [500, 0, 0] }

[section.tube]
tube = { outer_diameter_mm = 60, inner_diameter_mm = 50 }
youngs_modulus_gpa = 70
shear_modulus_gpa = 26

[section.known]
rigidities = { axial_n = 6e7, bending_y_n_m2 = 2e4, bending_z_n_m2 = 2e4, torsion_n_m2 = 1e4 }

[chain.arm]
elements = [
  { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 2.0e5 },
  { link = "tube", name = "boom", length_mm = 500 },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

fn with(more: &str) -> String {
    ARM.replace("length_mm = 500 }", &format!("length_mm = 500, {more} }}"))
}

fn mass(text: &str) -> f64 {
    let model = Model::from_toml(text, "arm.toml").unwrap_or_else(|e| panic!("{e}"));
    let chain = &model.mechanism.limbs()[0].actual;
    let along: f64 = chain.segment_masses().iter().map(|s| s.total()).sum();
    along + chain.bodies().iter().map(|b| b.mass).sum::<f64>()
}

#[test]
fn links_weigh_what_their_material_does() {
    let area = std::f64::consts::FRAC_PI_4 * (0.060_f64.powi(2) - 0.050_f64.powi(2));
    assert_eq!(mass(ARM), 0.0, "files without the keys mean what they meant");
    let expected = 2700.0 * area * 0.5;
    for more in [
        "density_kg_m3 = 2700",
        "density_kg_m3 = 2700, segments = 4",
        "density_kg_m3 = 2700, mass_model = \"halves_at_ends\"",
        "density_kg_m3 = 2700, convention = \"translations_first\"",
    ] {
        assert!((mass(&with(more)) / expected - 1.0).abs() < 1e-12, "{more}");
    }
    assert!((mass(&with("mass_kg_per_m = 3.5")) - 1.75).abs() < 1e-12);
    let known = with("mass_kg_per_m = 3.5").replace("link = \"tube\"", "link = \"known\"");
    assert!((mass(&known) - 1.75).abs() < 1e-12);
    let model = Model::from_toml(&with("density_kg_m3 = 2700"), "arm.toml").expect("read");
    let nodes = model.mechanism.limbs()[0].actual.nodes();
    assert!(nodes.contains(&"boom.near".to_owned()) && nodes.contains(&"boom.far".to_owned()));
}

#[test]
fn masses_that_no_link_has_are_refused_with_their_line() {
    let known = |more: &str| with(more).replace("link = \"tube\"", "link = \"known\"");
    for (text, said) in [
        (with("density_kg_m3 = -7850"), "density"),
        (with("density_kg_m3 = 7.85"), "no solid"),
        (with("density_kg_m3 = 7850, mass_kg_per_m = 3"), "gives the mass already"),
        (with("mass_model = \"halves_at_ends\""), "no mass to put anywhere"),
        (with("mass_kg_per_m = 0"), "mass per length"),
        (known("density_kg_m3 = 7850"), "rigidities have none"),
    ] {
        let error = Model::from_toml(&text, "arm.toml").expect_err("refused").to_string();
        assert!(error.contains(said), "{error}");
        assert!(error.contains("arm.toml:20"), "the line: {error}");
    }
}
