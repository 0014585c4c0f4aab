//! Deviations as people write them, against the same thing written as a motion or as another drawing.

use kinetostat::{Pose, Posture, Wrench};
use kinetostat_model::Model;
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

/// A bent arm that leaves no axis alone: `length_mm` of the slanted link, `axis` of the elbow.
fn arm(link: &str, axis: &str, deviation: &str) -> Model {
    let text = format!(
        r#"schema = 1
[mechanism]
name = "arm"
[[platform]]
name = "tool"
home = {{ position_mm = [900, 100, 300] }}
[section.tube]
tube = {{ outer_diameter_mm = 60, inner_diameter_mm = 50 }}
youngs_modulus_gpa = 70
shear_modulus_gpa = 26
[chain.arm]
elements = [
  {{ name = "post", rigid = {{ translation_mm = [30, 40, 0], rotation_vector_deg = [10, 0, 20] }} }},
  {{ name = "turn", actuator = "revolute", axis = "z", stiffness_n_m_per_rad = 2e5 }},
  {{ name = "beam", link = "tube", {link} }},
  {{ name = "elbow", actuator = "revolute", axis = {axis}, stiffness_n_m_per_rad = 1e5 }},
  {{ name = "forearm", link = "tube", length_mm = 300 }},
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
{deviation}
"#
    );
    Model::from_toml(&text, "arm.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// Tip of the actual, unloaded chain in a posture.
fn tip(model: &Model, commands: [f64; 2]) -> Pose {
    let limb = &model.mechanism.limbs()[0];
    kinetostat::model::unloaded_tip(
        &limb.actual,
        &Pose::identity(),
        &vec![0.0; limb.actual.coordinate_count()],
        &commands,
    )
}

fn apart(a: &Pose, b: &Pose) -> f64 {
    kinetostat::spatial::pose_residual(a, b).0.norm()
}

const LINKS: [(&str, f64); 4] = [
    ("vector_mm = [200, 100, -50]", 229.128_784_747_792),
    (
        "vector_mm = [200, 100, -50], segments = 3",
        229.128_784_747_792,
    ),
    ("length_mm = 250", 250.0),
    (
        "vector_mm = [200, 100, -50], convention = \"translations_first\"",
        229.128_784_747_792,
    ),
];

#[test]
fn a_longer_link_is_a_link_that_was_drawn_longer() {
    for (link, length) in LINKS {
        let deviation = "[[deviation]]\nlimb = \"arm\"\nat = \"beam\"\nlonger_by_mm = 0.7";
        let actual = arm(link, "[0.1, 1, 0.3]", deviation);
        let longer = match link.split_once("vector_mm = [200, 100, -50]") {
            Some((_, rest)) => {
                let v = Vector3::new(200.0, 100.0, -50.0) * (1.0 + 0.7 / length);
                format!("vector_mm = [{}, {}, {}]{rest}", v.x, v.y, v.z)
            }
            None => "length_mm = 250.7".to_owned(),
        };
        let drawn = arm(&longer, "[0.1, 1, 0.3]", "");
        for commands in [[0.0, 0.0], [0.7, -1.1]] {
            let d = apart(&tip(&actual, commands), &tip(&drawn, commands));
            assert!(d < 1e-15, "{link}: {d:e}");
        }
        // The controller knows nothing of it.
        let nominal = arm(link, "[0.1, 1, 0.3]", "");
        let limbs = |m: &Model| m.mechanism.limbs()[0].nominal.clone();
        assert_eq!(limbs(&nominal), limbs(&actual), "{link}");
    }
}

#[test]
fn a_longer_parallelogram_and_a_longer_offset() {
    let orthoglide = Model::preset("orthoglide").expect("preset");
    let with = |at: &str, by: f64| {
        let text = format!(
            "{}\n[[deviation]]\nlimb = \"leg y\"\nat = \"{at}\"\nlonger_by_mm = {by}\n",
            orthoglide.text
        );
        Model::from_toml(&text, "longer.toml").unwrap_or_else(|e| panic!("{e}"))
    };
    // All bars of leg y are shorter by 1 mm: as the slide moved by -1 mm at the place where they lie
    // along it.
    let posture_of = |m: &Model, f: &dyn Fn(&Posture)| {
        let posture = m.mechanism.posture(&Pose::identity()).expect("posture");
        f(&posture);
    };
    let name = orthoglide.document.chain.values().flat_map(|c| &c.elements);
    let name = name
        .filter(|e| e.word() == "parallelogram")
        .find_map(|e| e.name().map(str::to_owned))
        .expect("bars with a name");
    posture_of(&with(&name, -1.0), &|p| {
        let errors = p.assembly_errors();
        assert!(
            (errors[1].linear() - Vector3::new(0.0, -1e-3, 0.0)).norm() < 1e-12,
            "{:?}",
            errors[1]
        );
        assert!(errors[0].0.norm() < 1e-15);
    });
}

proptest! {
    /// A joint with a tilted axis is that joint drawn with that axis; anything else tilts what follows.
    #[test]
    fn a_tilted_axis_is_an_axis_that_was_drawn_so(
        angle in -5.0..5.0_f64,
        about in prop::array::uniform3(-1.0..1.0_f64),
        commands in prop::array::uniform2(-1.5..1.5_f64),
    ) {
        let about = Vector3::from(about);
        prop_assume!(about.norm() > 0.1);
        let turn = UnitQuaternion::from_scaled_axis(about.normalize() * angle.to_radians());
        let tilt = |at: &str| format!(
            "[[deviation]]\nlimb = \"arm\"\nat = \"{at}\"\ntilted_by_deg = {angle}\nabout = [{}, {}, {}]",
            about.x, about.y, about.z
        );
        let link = LINKS[0].0;
        let actual = arm(link, "[0.1, 1, 0.3]", &tilt("elbow"));
        let axis = turn * Vector3::new(0.1, 1.0, 0.3);
        let drawn = arm(link, &format!("[{}, {}, {}]", axis.x, axis.y, axis.z), "");
        prop_assert!(apart(&tip(&actual, commands), &tip(&drawn, commands)) < 1e-14);
        let nominal = arm(link, "[0.1, 1, 0.3]", "");
        prop_assert!(apart(&tip(&actual, [commands[0], 0.0]), &tip(&nominal, [commands[0], 0.0])) < 1e-15);

        let v = turn.scaled_axis();
        let moved = format!(
            "[[deviation]]\nlimb = \"arm\"\nat = \"beam\"\nmoved_by = {{ rotation_vector_rad = [{}, {}, {}] }}",
            v.x, v.y, v.z
        );
        let one = arm(link, "\"y\"", &tilt("beam"));
        let other = arm(link, "\"y\"", &moved);
        prop_assert!(apart(&tip(&one, commands), &tip(&other, commands)) < 1e-14);
    }
}

#[test]
fn what_a_deviation_cannot_be_is_said() {
    for (deviation, needle) in [
        ("at = \"beam\"", "does not say what is wrong"),
        (
            "at = \"beam\"\nlonger_by_mm = 1\ntilted_by_deg = 1\nabout = \"x\"",
            "in two ways",
        ),
        (
            "at = \"beam\"\ntilted_by_deg = 1",
            "axis of the tilt is missing",
        ),
        (
            "at = \"beam\"\nlonger_by_mm = 1\nabout = \"x\"",
            "without 'tilted_by_deg'",
        ),
        ("at = \"start\"\nlonger_by_mm = 1", "no length"),
        (
            "at = \"elbow\"\nlonger_by_mm = 1",
            "not possible at 'elbow'",
        ),
        (
            "at = \"elbow\"\nmoved_by = { translation_mm = [1, 0, 0] }",
            "write tilted_by_deg",
        ),
        (
            "at = \"elbwo\"\ntilted_by_deg = 1\nabout = \"x\"",
            "did you mean 'elbow'?",
        ),
        ("at = \"beam\"\nlonger_by_mm = nan", "finite"),
        (
            "at = \"beam\"\ntilted_by_deg = 1\nabout = [0, 0, 0]",
            "no direction",
        ),
    ] {
        let text = arm("length_mm = 250", "\"y\"", "").text
            + &format!("[[deviation]]\nlimb = \"arm\"\n{deviation}\n");
        let error = Model::from_toml(&text, "arm.toml").expect_err(deviation);
        assert!(error.to_string().contains(needle), "{deviation}: {error}");
    }
}

#[test]
fn deviation_descriptions() {
    let model = arm("length_mm = 250", "\"y\"", "");
    for (deviation, words) in [
        (
            "at = \"beam\"\nlonger_by_mm = -0.2",
            "limb 'arm': 'beam' is 0.2 mm shorter",
        ),
        (
            "at = \"elbow\"\ntilted_by_deg = 0.5\nabout = \"x\"",
            "limb 'arm': 'elbow' is tilted by 0.5 deg about x",
        ),
        (
            "at = \"end\"\ntilted_by_deg = 1\nabout = [0, 3, 4]",
            "limb 'arm' is tilted by 1 deg about (0, 0.6, 0.8) at its end",
        ),
        (
            "at = \"post\"\nmoved_by = { translation_mm = [1, 0, 0] }",
            "limb 'arm' is shifted by (1, 0, 0) mm behind 'post'",
        ),
    ] {
        let text = format!("{}[[deviation]]\nlimb = \"arm\"\n{deviation}\n", model.text);
        let own = Model::from_toml(&text, "arm.toml").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(own.document.deviation[0].description(), words);
        let again = Model::from_toml(&own.to_toml().expect("text"), "again").expect("reads");
        assert_eq!(again.mechanism, own.mechanism);
        // It can be computed with.
        let posture = own
            .mechanism
            .posture(&tip(&model, [0.3, 0.4]))
            .expect("posture");
        posture.deflected_by(&Wrench::zero()).expect("equilibrium");
    }
}
