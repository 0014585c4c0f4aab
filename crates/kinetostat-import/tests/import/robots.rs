//! The eight robots of ../shared/data/urdf.

use kinetostat::PostureRequest;
use kinetostat_import::{Imported, JointStiffness, UrdfOptions, import_urdf, read_text};
use kinetostat_model::Model;
use kinetostat_model::schema::AxisName;
use kinetostat_testing::Worst;

use crate::agreement::{side_branches, with_oracle, with_pinocchio};
use crate::{data, figure_at_most, notices};

pub const ROBOTS: [(&str, usize); 8] = [
    ("abb_irb6640", 6),
    ("abb_irb6640_185_280", 6),
    ("fanuc_m900ib700", 6),
    ("fanuc_r1000ia80f", 6),
    ("kuka_kr120r2500pro", 6),
    ("kuka_kr150r3100_2", 6),
    ("kuka_kr210l150", 6),
    ("kuka_lbr_iiwa_14_r820", 7),
];

pub fn robot(name: &str, options: UrdfOptions) -> Option<(String, Imported)> {
    let path = data()?.join(format!("{name}.urdf"));
    let text = read_text("URDF file", &path).unwrap_or_else(|e| panic!("{e}"));
    let options = {
        let mut options = options;
        options.base = Some("base_link".into());
        options.tip = Some("tool0".into());
        options
    };
    let imported = import_urdf(&text, name, &options).unwrap_or_else(|e| panic!("{e}"));
    Some((text, imported))
}

#[test]
fn all_of_them_import_and_load_again() {
    for (name, actuators) in ROBOTS {
        let Some((_, imported)) = robot(name, UrdfOptions::default()) else {
            return;
        };
        assert_eq!(imported.actuators.len(), actuators, "{name}");
        assert_eq!(imported.rigid_drives, imported.actuators, "{name}");
        let model = Model::from_toml(&imported.toml, "again.toml").unwrap();
        assert_eq!(model.mechanism.actuator_names(), imported.actuators);
        // At home the chain ends where the platform is said to stand, and limits are there.
        // Beside that it bends nowhere, is singular at its zero posture, and may have masses that were never meant.
        let known = [
            "singular at home",
            "has no spring",
            "the bodies weigh",
            "have the same mass",
        ];
        let is_known = |w: &kinetostat_model::Problem| known.iter().any(|k| w.message.contains(k));
        assert!(
            model.warnings.iter().all(is_known),
            "{name}: {:?}",
            model.warnings
        );
        for a in model.mechanism.limbs()[0].nominal.actuators() {
            assert!(a.limits.is_some(), "{name}: {}", a.name);
        }
        // What was written can be written again by the model crate, and says the same.
        let again = Model::from_toml(&model.to_toml().unwrap(), "twice.toml").unwrap();
        assert_eq!(again.document, model.document, "{name}");
    }
}

/// x of `flange` and z of `tool0` point out in ROS: with its axis named, the flange is the tool frame of `tool0`.
#[test]
fn a_flange_whose_x_axis_points_out_becomes_the_frame_of_tool0() {
    for name in ["fanuc_m900ib700", "fanuc_r1000ia80f", "kuka_kr150r3100_2"] {
        let Some((text, by_tool0)) = robot(name, UrdfOptions::default()) else {
            return;
        };
        assert!(!notices(&by_tool0).contains("--flange-z"), "{name}");
        let of_flange = |axis: Option<AxisName>| {
            let mut options = UrdfOptions::default();
            options.base = Some("base_link".into());
            options.tip = Some("flange".into());
            options.flange_z = axis;
            import_urdf(&text, name, &options).unwrap_or_else(|e| panic!("{e}"))
        };
        let tool = |imported: &Imported| {
            let joints = PostureRequest::commands(&[0.1, -0.2, 0.3, 0.4, 0.5, 0.6]);
            *imported.model.mechanism.posture(joints).unwrap().target()
        };
        let plain = of_flange(None);
        assert!(notices(&plain).contains("--flange-z x"), "{name}");
        let turned = of_flange(Some(AxisName::X));
        assert!(!notices(&turned).contains("--flange-z"), "{name}");
        // FANUC's tool0 is turned about z.
        let between = tool(&by_tool0).inverse() * tool(&turned);
        let z = between.rotation * nalgebra::Vector3::z();
        let same = name.starts_with("fanuc") || between.rotation.angle() < 1e-9;
        assert!(same && (z.z - 1.0).abs() < 1e-12, "{name}: {between}");
        assert!(
            between.translation.vector.norm() < 1e-9,
            "{name}: {between}"
        );
        // z is the frame of the link as it is; every other axis becomes z.
        let named = of_flange(Some(AxisName::Z));
        assert_eq!(named.toml, plain.toml);
        let unit = nalgebra::Vector3::ith;
        for (axis, own) in [
            (AxisName::Y, unit(1, 1.0)),
            (AxisName::MinusX, unit(0, -1.0)),
            (AxisName::MinusY, unit(1, -1.0)),
            (AxisName::MinusZ, unit(2, -1.0)),
        ] {
            let z = tool(&of_flange(Some(axis))).rotation * unit(2, 1.0);
            assert!(
                (z - tool(&plain).rotation * own).norm() < 1e-9,
                "{name} {axis:?}"
            );
        }
    }
}

#[test]
fn figure_robots_move_and_weigh_as_their_files_say() {
    let (mut pose, mut torque) = (Worst::new(), Worst::new());
    for (name, _) in ROBOTS {
        let Some((text, imported)) = robot(name, UrdfOptions::default()) else {
            return;
        };
        let d = with_oracle(&text, &imported, 1000);
        pose.add(d.pose);
        torque.add(d.torque);
        if !imported.bodies.is_empty() {
            println!(
                "{name}: gravity torques differ by {:.1e} of the largest",
                d.torque
            );
        }
    }
    figure_at_most(
        "URDF of 8 robots: poses at 1000 postures",
        pose.of(ROBOTS.len()),
        1e-10,
        "m and 1",
    );
    figure_at_most(
        "URDF of 8 robots: gravity torques at 1000 postures",
        torque.of(ROBOTS.len()),
        1e-10,
        "of the largest",
    );
}

#[test]
fn figure_robots_agree_with_pinocchio() {
    let (mut pose, mut torque) = (Worst::new(), Worst::new());
    for (name, _) in ROBOTS {
        let Some((text, imported)) = robot(name, UrdfOptions::default()) else {
            return;
        };
        let Some(d) = with_pinocchio(&text, &imported, 1000) else {
            return;
        };
        pose.add(d.pose);
        torque.add(d.torque);
    }
    figure_at_most(
        "URDF of 8 robots, Pinocchio: poses",
        pose.of(ROBOTS.len()),
        1e-10,
        "m and 1",
    );
    figure_at_most(
        "URDF of 8 robots, Pinocchio: gravity torques",
        torque.of(ROBOTS.len()),
        1e-10,
        "of the largest",
    );
}

#[test]
fn figure_balancers_and_bars_follow_their_joints() {
    for (name, coupled) in [("fanuc_m900ib700", 6), ("abb_irb6640_185_280", 2)] {
        let Some((text, imported)) = robot(name, UrdfOptions::default()) else {
            return;
        };
        assert_eq!(imported.coupled_joints.len(), coupled, "{name}");
        let (count, worst) = side_branches(&text, &imported, 1000);
        assert_eq!(count, coupled);
        figure_at_most(
            &format!("URDF {name}: poses of {count} links on mimic joints"),
            worst,
            1e-10,
            "m and 1",
        );
    }
}

#[test]
fn placeholders_of_real_files_are_noticed() {
    let Some((_, heavy)) = robot("kuka_kr210l150", UrdfOptions::default()) else {
        return;
    };
    assert!(
        // 4879 kg with its base.
        notices(&heavy).contains("the bodies weigh 3306"),
        "{}",
        notices(&heavy)
    );
    let (_, light) = robot("kuka_kr120r2500pro", UrdfOptions::default()).unwrap();
    let said = notices(&light);
    assert!(
        said.contains("all 6 bodies of this limb have the same mass, 2 kg"),
        "{said}"
    );
    assert!(said.contains("little for an arm"), "{said}");
    assert!(said.contains("the arm is singular at home"), "{said}");
    let (_, none) = robot("kuka_lbr_iiwa_14_r820", UrdfOptions::default()).unwrap();
    assert!(notices(&none).contains("no moving link has a mass"));
    // Meshes stay as references.
    assert!(
        none.toml
            .contains("# mesh of link_1: package://kuka_lbr_iiwa_support/meshes/")
    );
}

#[test]
fn a_robot_with_stiffnesses_bends() {
    let options = {
        let mut options = UrdfOptions::default();
        options.stiffness = JointStiffness::All(2e6);
        options.home = [(
            "joint_5".to_owned(),
            (kinetostat::MotionKind::Revolute, 0.6),
        )]
        .into();
        options
    };
    let Some((_, imported)) = robot("fanuc_m900ib700", options) else {
        return;
    };
    assert!(imported.rigid_drives.is_empty());
    assert!(
        !notices(&imported).contains("singular"),
        "{}",
        notices(&imported)
    );
    let mechanism = &imported.model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let posture = mechanism.posture(&home).unwrap();
    let k_c = posture.stiffness().unwrap();
    assert_eq!(k_c.rank(), 6);
    // Along y at home only joint 1 and the wrist give way; the arm of joint 1 is the tool's x.
    let compliance = k_c.cartesian.compliance().unwrap();
    assert!(compliance[(1, 1)] >= home.translation.vector.x.powi(2) / 2e6);
}
