//! The imported model moves and weighs as the URDF says: against the oracle, and against Pinocchio
//! where it is installed.

use std::collections::BTreeMap;
use std::io::Write;
use std::process::{Command, Stdio};

use kinetostat::{MotionKind, model::Kinematics};
use kinetostat_import::{Imported, JointStiffness};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{Matrix4, Vector3};
use serde_json::{Value, json};

use crate::oracle::Oracle;
use crate::{Random, import};

/// Random values of the model's actuators, within limits of at most a turn.
pub fn postures(imported: &Imported, count: usize) -> Vec<Vec<f64>> {
    let mut random = Random::new(7);
    let actuators: Vec<_> = imported
        .model
        .mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators())
        .collect();
    (0..count)
        .map(|_| {
            actuators
                .iter()
                .map(|a| {
                    let (low, high) = a.limits.unwrap_or((-3.0, 3.0));
                    0.5 * (low + high) + 0.5 * (high - low) * random.number()
                })
                .collect()
        })
        .collect()
}

/// Tip in the base and torques that hold the actuators, by the core's own kinematics. Half of every
/// elastic drive's motion is deflection: coupled motions must follow both.
fn computed(imported: &Imported, commands: &[f64]) -> (Matrix4<f64>, Vec<f64>) {
    let mechanism = &imported.model.mechanism;
    let [limb] = mechanism.limbs() else {
        panic!("one limb expected");
    };
    let chain = &limb.nominal;
    let mut coordinates = chain.home_coordinates();
    let mut commands = commands.to_vec();
    for (command, actuator) in commands.iter_mut().zip(chain.actuators()) {
        if let Some(c) = actuator.coordinate {
            coordinates[c] = 0.5 * *command;
            *command *= 0.5;
        }
    }
    let base = mechanism.platforms()[0].home;
    let k = Kinematics::new(chain, &base, &coordinates, &commands);
    let tip = k.tip_pose() * limb.platform_from_tip.inverse();
    let n = chain.coordinate_count();
    let mut torques = vec![0.0; commands.len()];
    for body in chain.bodies() {
        let jacobian = k.jacobian(body.node);
        let weight = mechanism.gravity() * body.mass;
        for (i, torque) in torques.iter_mut().enumerate() {
            let column: Vector3<f64> = jacobian.fixed_view::<3, 1>(0, n + i).into_owned();
            *torque -= column.dot(&weight);
        }
    }
    (tip.to_homogeneous(), torques)
}

/// Largest differences of poses (m or 1) and of torques relative to the largest torque.
pub struct Difference {
    pub pose: f64,
    pub torque: f64,
}

fn compare(
    imported: &Imported,
    postures: &[Vec<f64>],
    other: impl Fn(usize) -> (Matrix4<f64>, Vec<f64>),
) -> Difference {
    let (mut worst, mut worst_torque) = (Worst::new(), Worst::new());
    let mut largest = Worst::new();
    largest.add(1e-3);
    for (i, commands) in postures.iter().enumerate() {
        let (pose, torques) = computed(imported, commands);
        let (other_pose, other_torques) = other(i);
        worst.add((pose - other_pose).largest_entry());
        assert_eq!(torques.len(), other_torques.len());
        for (a, b) in torques.iter().zip(&other_torques) {
            worst_torque.add(a - b);
            largest.add(b.abs());
        }
    }
    Difference {
        pose: worst.of(postures.len()),
        torque: worst_torque.value() / largest.value(),
    }
}

/// Largest difference of the frames of side branches (nodes named like their links), m or 1.
pub fn side_branches(urdf: &str, imported: &Imported, count: usize) -> (usize, f64) {
    let oracle = Oracle::new(urdf);
    let chain = &imported.model.mechanism.limbs()[0].nominal;
    let nodes: Vec<usize> = (0..chain.nodes().len() - 1)
        .filter(|n| chain.bodies().iter().all(|b| b.node != *n))
        .collect();
    let mut worst = Worst::new();
    for commands in postures(imported, count) {
        let values: BTreeMap<&str, f64> = imported
            .actuators
            .iter()
            .map(String::as_str)
            .zip(commands.iter().copied())
            .collect();
        let coordinates = chain.home_coordinates();
        let base = kinetostat::Pose::identity();
        let k = Kinematics::new(chain, &base, &coordinates, &commands);
        for &n in &nodes {
            let wanted = oracle.pose(&imported.base, &chain.nodes()[n], &values);
            worst.add((k.node_pose(n).to_homogeneous() - wanted).largest_entry());
        }
    }
    (nodes.len(), worst.value())
}

/// Against the oracle.
pub fn with_oracle(urdf: &str, imported: &Imported, count: usize) -> Difference {
    let oracle = Oracle::new(urdf);
    let postures = postures(imported, count);
    let names: Vec<&str> = imported.actuators.iter().map(String::as_str).collect();
    compare(imported, &postures, |i| {
        let values: BTreeMap<&str, f64> = names
            .iter()
            .copied()
            .zip(postures[i].iter().copied())
            .collect();
        (
            oracle.pose(&imported.base, &imported.tip, &values),
            oracle.holding(&names, &values),
        )
    })
}

/// What Pinocchio says of these postures; `None` where it is not installed.
pub fn ask_pinocchio(urdf: &str, imported: &Imported, postures: &[Vec<f64>]) -> Option<Value> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.urdf");
    std::fs::write(&path, urdf).unwrap();
    let request = json!({
        "urdf": path, "base": imported.base, "tip": imported.tip,
        "joints": imported.actuators, "values": postures,
    });
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../validation/scripts/urdf_pinocchio.py"
    );
    let started = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut process) = started else {
        println!("SKIPPED: python3 is not installed");
        return None;
    };
    process
        .stdin
        .take()
        .unwrap()
        .write_all(request.to_string().as_bytes())
        .ok();
    let output = process.wait_with_output().unwrap();
    if output.status.code() == Some(3) {
        println!("SKIPPED: Pinocchio is not installed (pip install pin)");
        return None;
    }
    assert!(output.status.success(), "the script failed");
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// Numbers of a list; NaN where there is none.
pub fn list(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().unwrap();
    (numbers.iter())
        .map(|x| x.as_f64().unwrap_or(f64::NAN))
        .collect()
}

/// Against Pinocchio; `None` where it is not installed.
pub fn with_pinocchio(urdf: &str, imported: &Imported, count: usize) -> Option<Difference> {
    let postures = postures(imported, count);
    let found = ask_pinocchio(urdf, imported, &postures)?;
    Some(compare(imported, &postures, |i| {
        let rows = list(&found["poses"][i]);
        let mut pose = Matrix4::identity();
        for (k, x) in rows.iter().enumerate() {
            pose[(k / 4, k % 4)] = *x;
        }
        (pose, list(&found["torques"][i]))
    }))
}

/// Everything at once: a tree that leans, prismatic and turning joints off all axes, weights on fixed
/// and on mimic side branches (one of them attached before the joint that it follows), mimics of
/// mimics, a mimic joint on the way, and a base inside the tree.
pub const TREE: &str = r#"<robot name="tree">
  <link name="floor"/>
  <link name="foot"><inertial><mass value="300"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="post"><inertial><origin xyz="0.05 -0.02 0.4" rpy="0.3 0.1 -0.7"/><mass value="120"/>
    <inertia ixx="4" ixy="0.3" ixz="-0.2" iyy="5" iyz="0.1" izz="3"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0.3 0.1 0.05"/><mass value="60"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial></link>
  <link name="carriage"><inertial><origin xyz="0 0.2 0.1"/><mass value="25"/><inertia ixx="1" ixy="0" ixz="0" iyy="1.1" iyz="0" izz="1.2"/></inertial></link>
  <link name="wrist"><inertial><origin xyz="0 0 0.1"/><mass value="9"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <link name="hand"/>
  <link name="motor"><inertial><origin xyz="0.1 0 0" rpy="1 0 0"/><mass value="14"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.4"/></inertial></link>
  <link name="weight"><inertial><origin xyz="-0.6 0 0.05"/><mass value="80"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2"/></inertial></link>
  <link name="piston"><inertial><origin xyz="0 0.1 0"/><mass value="11"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
  <link name="rod"><inertial><origin xyz="0.2 0 0"/><mass value="7"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
  <link name="plate"><inertial><origin xyz="0 0.3 0"/><mass value="5"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
  <joint name="ground" type="fixed"><origin xyz="1 2 0.5" rpy="0.4 -0.3 1.1"/><parent link="floor"/><child link="foot"/></joint>
  <joint name="turn" type="continuous"><origin xyz="0 0.1 0.6" rpy="0 0.2 0"/><parent link="foot"/><child link="post"/><axis xyz="0.1 -0.2 0.9"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0.3 0 0.2" rpy="-0.2 0 0.4"/><parent link="post"/><child link="arm"/><axis xyz="0 1 0"/><limit lower="-1.2" upper="1.5" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><origin xyz="0.4 0.1 0"/><parent link="arm"/><child link="carriage"/><axis xyz="1 0.2 0"/><limit lower="0.1" upper="0.9" effort="1" velocity="1"/></joint>
  <joint name="level" type="revolute"><origin xyz="0.1 0.05 0.2" rpy="0.1 0.2 0.3"/><parent link="carriage"/><child link="wrist"/><axis xyz="0 -1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="lift" multiplier="0.8" offset="0.15"/></joint>
  <joint name="grip" type="fixed"><origin xyz="0 0 0.2" rpy="0 1 0"/><parent link="wrist"/><child link="hand"/></joint>
  <joint name="bolts" type="fixed"><origin xyz="-0.2 0.1 0" rpy="0.5 0 0"/><parent link="arm"/><child link="motor"/></joint>
  <joint name="hinge" type="continuous"><origin xyz="-0.3 0.2 0.5" rpy="0 0 0.3"/><parent link="post"/><child link="weight"/><axis xyz="0 1 0.3"/><mimic joint="lift" multiplier="-0.6" offset="-0.2"/></joint>
  <joint name="stroke" type="prismatic"><origin xyz="0.2 0 0.1" rpy="0 0.5 0"/><parent link="weight"/><child link="piston"/><axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="slide" multiplier="0.5"/></joint>
  <joint name="twist" type="continuous"><origin xyz="0 0 0.3"/><parent link="piston"/><child link="rod"/><axis xyz="1 0 0"/><mimic joint="hinge" multiplier="2" offset="0.4"/></joint>
  <joint name="tacks" type="fixed"><origin xyz="0 0.1 0.1" rpy="0.2 0.2 0.2"/><parent link="rod"/><child link="plate"/></joint>
</robot>"#;

fn tree(base: &str, stiffness: JointStiffness) -> Imported {
    let options = {
        let mut options = crate::between(base, "hand");
        options.stiffness = stiffness;
        options
    };
    import(TREE, &options)
}

#[test]
fn figure_a_tree_with_everything_moves_and_weighs_as_written() {
    for (name, base, stiffness) in [
        ("rigid drives", "foot", JointStiffness::Unknown),
        ("elastic drives", "floor", JointStiffness::All(1e6)),
    ] {
        let imported = tree(base, stiffness);
        assert_eq!(imported.actuators, ["turn", "lift", "slide"]);
        assert_eq!(imported.bodies.len(), 9, "{:?}", imported.bodies);
        let d = with_oracle(TREE, &imported, 1000);
        let name = format!("URDF tree with mimic branches, {name}");
        crate::figure_at_most(&format!("{name}: poses"), d.pose, 1e-10, "m and 1");
        crate::figure_at_most(
            &format!("{name}: gravity torques"),
            d.torque,
            1e-10,
            "of the largest",
        );
    }
}

#[test]
fn figure_a_tree_with_everything_agrees_with_pinocchio() {
    let imported = tree("foot", JointStiffness::Unknown);
    if let Some(d) = with_pinocchio(TREE, &imported, 1000) {
        let name = "URDF tree with mimic branches, Pinocchio";
        crate::figure_at_most(&format!("{name}: poses"), d.pose, 1e-10, "m and 1");
        crate::figure_at_most(
            &format!("{name}: gravity torques"),
            d.torque,
            1e-10,
            "of the largest",
        );
    }
}

/// URDF to model to text to model: the same document, and forward kinematics of the URDF again.
#[test]
fn figure_round_trip_of_a_tree_with_everything() {
    let imported = tree("foot", JointStiffness::All(1e6));
    let written = imported.model.to_toml().unwrap();
    let again = kinetostat_model::Model::from_toml(&written, "again.toml").unwrap();
    assert_eq!(again.document, imported.model.document);
    assert_eq!(again.mechanism, imported.model.mechanism);
    let second = Imported {
        model: again,
        toml: written,
        ..imported
    };
    let d = with_oracle(TREE, &second, 1000);
    crate::figure_at_most(
        "URDF round trip (import, write, read): poses",
        d.pose,
        1e-10,
        "m and 1",
    );
}

#[test]
fn the_oracle_is_no_copy_of_the_import() {
    // A hand calculation: one arm of 2 m with 10 kg at 1.5 m, at 30 degrees below the horizon.
    let urdf = r#"<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="1.5 0 0"/><mass value="10"/>
      <inertia ixx="1" iyy="1" izz="1"/></inertial></link><link name="c"/>
      <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint>
      <joint name="f" type="fixed"><origin xyz="2 0 0"/><parent link="b"/><child link="c"/></joint></robot>"#;
    let oracle = Oracle::new(urdf);
    let angle = 30_f64.to_radians();
    let values = BTreeMap::from([("j", angle)]);
    let tip = oracle.pose("a", "c", &values);
    assert!((tip[(0, 3)] - 2.0 * angle.cos()).abs() < 1e-12);
    assert!((tip[(2, 3)] + 1.0).abs() < 1e-12);
    // About +y a positive angle sinks; the torque that holds it is negative.
    let torque = oracle.holding(&["j"], &values)[0];
    assert!((torque + 10.0 * 9.81 * 1.5 * angle.cos()).abs() < 1e-10);
    let imported = import(urdf, &crate::between("a", "c"));
    let (_, held) = computed(&imported, &[angle]);
    assert!((held[0] - torque).abs() < 1e-10);
    assert_eq!(
        imported.model.mechanism.limbs()[0].nominal.actuators()[0].kind,
        MotionKind::Revolute
    );
}
