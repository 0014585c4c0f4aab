//! Controller coordinates: what the controller shows of the model's joints, and back.

use kinetostat_model::{Model, ModelError};
use kinetostat_testing::largest_size;

/// A six-axis arm on a track, joints named as in a model.
fn arm(controller: &str) -> String {
    let mut elements = String::from(
        "  { actuator = \"prismatic\", name = \"rail\", axis = \"y\", rigid_drive = true },\n",
    );
    for (i, axis) in ["z", "y", "y", "x", "y", "x"].iter().enumerate() {
        elements.push_str(&format!(
            "  {{ actuator = \"revolute\", name = \"joint_{}\", axis = \"{axis}\", stiffness_n_m_per_rad = 1e6 }},\n  {{ rigid = {{ translation_mm = [300, 0, 100] }} }},\n",
            i + 1
        ));
    }
    format!(
        r#"schema = 1
[mechanism]
name = "arm"
[[platform]]
name = "tool"
home = {{ position_mm = [1800, 0, 600] }}
[chain.arm]
elements = [
{elements}]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
{controller}"#
    )
}

const FANUC: &str = r#"
[controller]
name = "FANUC R-30iB"
axis = [
  { name = "J1", joint = "joint_1" },
  { name = "J2", joint = "joint_2" },
  { name = "J3", joint = "joint_3", coupled = [{ joint = "joint_2", ratio = -1 }] },
  { name = "J4", joint = "joint_4", reversed = true },
  { name = "J5", joint = "joint_5" },
  { name = "J6", joint = "joint_6", reversed = true, zero_offset_deg = 180 },
  { name = "E1", joint = "rail" },
]
"#;

fn read(controller: &str) -> Result<Model, ModelError> {
    Model::from_toml(&arm(controller), "arm.toml")
}

fn refused(controller: &str) -> String {
    read(controller).expect_err("refused").to_string()
}

/// ros-industrial/fanuc_experimental#17: J2 31.324 and J3 -2.018 deg of the model are J3 -33.342 deg
/// on the controller.
#[test]
fn a_fanuc_shows_the_difference_of_its_third_and_second_joint() {
    let model = read(FANUC).unwrap_or_else(|e| panic!("{e}"));
    let controller = model.controller.expect("a controller");
    let deg = f64::to_radians;
    // In the order of the chain: the track first, m.
    let joints = [
        1.25,
        deg(10.0),
        deg(31.324),
        deg(-2.018),
        deg(5.0),
        deg(-7.0),
        deg(20.0),
    ];
    let shown = controller.coordinates(&joints).expect("seven values");
    let expected = [10.0, 31.324, -33.342, -5.0, -7.0, 160.0, 1250.0];
    for (found, expected) in shown.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-11, "{shown:?}");
    }
    let back = controller.joints(&shown).expect("seven axes");
    for (found, expected) in back.iter().zip(joints) {
        assert!((found - expected).abs() < 1e-14, "{back:?}");
    }
    assert!(controller.coordinates(&joints[1..]).is_none());
    assert!(controller.joints(&shown[1..]).is_none());
    let names = model.mechanism.actuator_names();
    assert_eq!(controller.description(2, &names), "joint_3 - joint_2");
    assert_eq!(controller.description(5, &names), "-joint_6 + 180 deg");
    assert_eq!(controller.axes()[6].unit.word(), "mm");
}

/// For `cargo xtask figures`.
#[test]
fn figures_of_controller_coordinates() {
    let controller = read(FANUC).expect("a model").controller.expect("declared");
    let mut joints = [0.0; 7];
    (joints[2], joints[3]) = (31.324_f64.to_radians(), -2.018_f64.to_radians());
    let shown = controller.coordinates(&joints).expect("seven values");
    let apart = (shown[2] + 33.342).abs();
    let back = controller.joints(&shown).expect("seven axes");
    assert_eq!(back.len(), joints.len());
    let there_and_back = largest_size(back.iter().zip(joints).map(|(a, b)| a - b));
    for (name, measured, most, unit) in [
        (
            "FANUC: model J2 31.324, J3 -2.018 deg, pendant J3 minus -33.342 deg",
            apart,
            1e-12,
            "deg",
        ),
        ("Pendant's values and back", there_and_back, 1e-14, "m, rad"),
    ] {
        let holds = measured <= most;
        let figure = serde_json::json!({
            "name": name, "measured": measured, "asked": format!("at most {most}"),
            "unit": unit, "holds": holds,
        });
        println!("figure {figure}");
        assert!(holds, "{figure}");
    }
}

#[test]
fn a_controller_is_written_and_read_again() {
    let model = read(FANUC).expect("a model");
    let written = model.to_toml().expect("written");
    let again = Model::from_toml(&written, "again.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again.document, model.document);
    assert_eq!(again.controller, model.controller);
    assert_eq!(again.mechanism, model.mechanism);
    assert_eq!(Model::preset("heavy_6r").expect("preset").controller, None);
}

/// A spline shaft: turning the fourth joint lifts the third, in the units of the key.
#[test]
fn couplings_between_slides_and_turns_carry_their_units() {
    let controller = FANUC
        .replace(
            "{ name = \"E1\", joint = \"rail\" }",
            "{ name = \"E1\", joint = \"rail\", ratio = 2, zero_offset_mm = -100, unit = \"m\", coupled = [{ joint = \"joint_4\", ratio_mm_per_deg = 0.5 }] }",
        )
        .replace(
            "{ name = \"J1\", joint = \"joint_1\" }",
            "{ name = \"J1\", joint = \"joint_1\", unit = \"rad\", coupled = [{ joint = \"rail\", ratio_deg_per_mm = -0.25 }] }",
        );
    let model = read(&controller).unwrap_or_else(|e| panic!("{e}"));
    let controller = model.controller.expect("a controller");
    let mut joints = [0.0; 7];
    (joints[0], joints[4]) = (0.4, 30_f64.to_radians());
    let shown = controller.coordinates(&joints).expect("shown");
    // 2 * 400 mm - 100 mm + 15 mm, shown in m; -100 deg shown in rad.
    assert!((shown[6] - 0.715).abs() < 1e-15, "{shown:?}");
    assert!((shown[0] + 100_f64.to_radians()).abs() < 1e-14, "{shown:?}");
    let back = controller.joints(&shown).expect("back");
    assert!(back.iter().zip(joints).all(|(a, b)| (a - b).abs() < 1e-14));
}

#[test]
fn maps_that_hide_a_motion_are_refused_with_the_joints() {
    let said = refused(&FANUC.replace(
        "{ name = \"J2\", joint = \"joint_2\" }",
        "{ name = \"J2\", joint = \"joint_2\", coupled = [{ joint = \"joint_3\", ratio = -1 }] }",
    ));
    assert!(
        said.contains("joint_2 and joint_3 can move together and it shows no change"),
        "{said}"
    );
    // Units of very different size are no reason.
    let fine = FANUC.replace("joint = \"rail\"", "joint = \"rail\", ratio = 1e9");
    assert!(read(&fine).is_ok());
}

#[test]
fn mistakes_are_named_with_their_line() {
    for (from, to, needles) in [
        (
            "joint = \"joint_4\"",
            "joint = \"joint_44\"",
            &[
                "there is no actuator named 'joint_44'",
                "did you mean 'joint_4'?",
            ][..],
        ),
        (
            "{ name = \"J5\", joint = \"joint_5\" },\n",
            "\n",
            &["no axis of the controller belongs to 'joint_5'"],
        ),
        (
            "joint = \"joint_5\"",
            "joint = \"joint_1\"",
            &["the axis 'J1' belongs to 'joint_1' already"],
        ),
        (
            "name = \"J5\"",
            "name = \"J1\"",
            &["the controller has an axis 'J1' already"],
        ),
        (
            "joint = \"joint_5\"",
            "joint = \"joint_5\", ratio = -1",
            &["the ratio is -1", "reversed = true"],
        ),
        (
            "joint = \"joint_5\"",
            "joint = \"joint_5\", zero_offset_mm = 3",
            &["it turns about its axis"],
        ),
        (
            "joint = \"joint_5\"",
            "joint = \"joint_5\", unit = \"mm\"",
            &["'joint_5' turns: its unit cannot be mm"],
        ),
        (
            "ratio = -1 }",
            "ratio_mm_per_deg = -1 }",
            &["axis and joint are of one kind", "write ratio"],
        ),
        ("ratio = -1 }", "ratio = 0 }", &["the share is zero"]),
        (
            "joint = \"joint_2\", ratio = -1",
            "joint = \"joint_3\", ratio = -1",
            &["the share of 'joint_3' in this axis is given twice"],
        ),
        (
            "reversed = true",
            "revresed = true",
            &["did you mean 'reversed'?"],
        ),
        ("axis = [", "axes = [", &["did you mean 'axis'?"]),
    ] {
        let text = FANUC.replacen(from, to, 1);
        assert_ne!(text, FANUC, "{from}");
        let error = read(&text).expect_err(to);
        let said = error.to_string();
        for needle in needles {
            assert!(said.contains(needle), "{to}: {said}");
        }
        assert!(error.problems().iter().all(|p| p.line.is_some()), "{said}");
    }
}

/// In a machine of several limbs the joints are called LIMB.ACTUATOR.
#[test]
fn joints_of_several_limbs_are_called_by_both_names() {
    let text = kinetostat_model::preset_text("puu3").expect("preset");
    let names = Model::preset("puu3")
        .expect("preset")
        .mechanism
        .actuator_names();
    let mut controller = String::from("\n[controller]\naxis = [\n");
    for (name, joint) in ["X", "Y", "Z"].iter().zip(&names) {
        controller.push_str(&format!(
            "  {{ name = \"{name}\", joint = \"{joint}\", zero_offset_mm = 7 }},\n"
        ));
    }
    controller.push_str("]\n");
    let model = Model::from_toml(&format!("{text}{controller}"), "puu3.toml")
        .unwrap_or_else(|e| panic!("{e}"));
    let controller = model.controller.expect("a controller");
    let shown = controller.coordinates(&[0.1, 0.2, 0.3]).expect("three");
    for (found, expected) in shown.iter().zip([107.0, 207.0, 307.0]) {
        assert!((found - expected).abs() < 1e-12, "{shown:?}");
    }
}

#[test]
fn a_screw_is_an_actuator_with_a_lead_and_a_free_end() {
    let track = "{ actuator = \"prismatic\", name = \"rail\", axis = \"y\", rigid_drive = true }";
    let screw = "{ actuator = \"screw\", name = \"rail\", axis = \"y\", lead_mm_per_turn = 5, stiffness_n_per_mm = 4000 }";
    let text = arm("").replace(track, screw);
    let model = Model::from_toml(&text, "screw.toml").unwrap_or_else(|e| panic!("{e}"));
    let chain = &model.mechanism.limbs()[0].nominal;
    let names: Vec<&str> = chain
        .coordinates()
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(names[..2], ["rail", "rail.turn"]);
    // A quarter turn of the far end lengthens by a quarter of the lead.
    let base = kinetostat::Pose::identity();
    let mut x = vec![0.0; chain.coordinate_count()];
    let commands = vec![0.0; 7];
    let before = kinetostat::model::unloaded_tip(chain, &base, &x, &commands);
    x[1] = std::f64::consts::FRAC_PI_2;
    let after = kinetostat::model::unloaded_tip(chain, &base, &x, &commands);
    let rise = after.translation.y - before.translation.y;
    assert!((rise - 1.25e-3).abs() < 1e-15, "{rise}");
    let again = Model::from_toml(&model.to_toml().expect("written"), "again.toml");
    assert_eq!(again.expect("a model").mechanism, model.mechanism);
    for (wrong, needle) in [
        (
            track.replace("axis", "lead_mm_per_turn = 5, axis"),
            "only a screw has a lead",
        ),
        (
            screw.replace("lead_mm_per_turn = 5, ", ""),
            "the lead of the screw is missing",
        ),
        (
            screw.replace("n_per_mm", "n_m_per_rad"),
            "it slides along its axis",
        ),
        (screw.replace("\"screw\"", "\"skrew\""), "screw"),
    ] {
        let said = Model::from_toml(&arm("").replace(track, &wrong), "screw.toml")
            .expect_err(&wrong)
            .to_string();
        assert!(said.contains(needle), "{wrong}: {said}");
    }
}
