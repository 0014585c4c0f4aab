//! Arms and hybrids: geometry against URDFs and closed forms, inverse kinematics there and back.

use kinetostat::{Error, Pose, Posture, PostureRequest, Twist, model::Kinematics, spatial::moved};
use kinetostat_testing::{LargestEntry, Worst, largest};
use nalgebra::{Translation3, UnitQuaternion, Vector3, vector};
use serde_json::json;

use crate::library::{Random, figure, machine, preset, urdf};

/// Difference of two poses, m and rad.
fn apart(a: &Pose, b: &Pose) -> f64 {
    let shift = (a.translation.vector - b.translation.vector).largest_entry();
    largest([shift, a.rotation.angle_to(&b.rotation)])
}

/// Where the nominal, unloaded chain of a machine of one limb puts its tool.
fn forward(mechanism: &kinetostat::Mechanism, commands: &[f64]) -> Pose {
    let [limb] = mechanism.limbs() else {
        panic!("one limb expected");
    };
    let rest = limb.nominal.home_coordinates();
    let base = Pose::identity();
    let k = Kinematics::new(&limb.nominal, &base, &rest, commands);
    k.tip_pose() * limb.platform_from_tip.inverse()
}

/// Random commands about home, `share` of the way to the nearer limit and at most 45 degrees.
fn commands(mechanism: &kinetostat::Mechanism, random: &mut Random, share: f64) -> Vec<f64> {
    let limbs = mechanism.limbs().iter();
    limbs
        .flat_map(|l| l.nominal.actuators())
        .map(|a| {
            let (low, high) = a.limits.expect("limits");
            let room = (high - a.home).min(a.home - low).min(45f64.to_radians());
            a.home + share * room * random.number()
        })
        .collect()
}

/// Two arms have a URDF in ../shared/data, the parallelogram has one that mimics it.
#[test]
fn arms_stand_where_their_urdfs_say() {
    let mut worst = Worst::new();
    let mut count = 0;
    for (name, file) in [
        ("abb_irb6640_like", "abb_irb6640_185_280"),
        ("kuka_kr270_like", "kuka_kr120r2500pro"),
    ] {
        let Some(mut robot) = urdf::open(file) else {
            return;
        };
        if name == "kuka_kr270_like" {
            // The KR 270 R2700 has the KR 120's arm with a forearm of 1200 instead of 1000 mm.
            robot.shift("joint_a4", vector![0.2, 0.0, 0.0]);
        }
        let model = preset(name);
        let mut random = Random(3);
        for _ in 0..200 {
            let q = commands(&model.mechanism, &mut random, 1.0);
            worst.add(apart(&forward(&model.mechanism, &q), &robot.tool(&q)));
            count += 1;
        }
    }
    let Some(robot) = urdf::open("fanuc_m900ib700") else {
        return;
    };
    let model = preset("fanuc_m900ib_like");
    let mechanism = &model.mechanism;
    let mut random = Random(4);
    for _ in 0..50 {
        let q = commands(mechanism, &mut random, 0.5);
        // The crank's angle is the controller's J3: joint 3 of the URDF less joint 2.
        let target = robot.tool(&[q[0], q[1], q[2] + q[1], q[3], q[4], q[5]]);
        let found = mechanism.posture(&target).expect("reachable").commands();
        for (a, b) in found.iter().zip(&q) {
            worst.add((a - b).abs());
        }
        count += 1;
    }
    let worst = worst.value();
    figure(
        &format!("Library: arms against the joints of their URDFs at {count} postures"),
        json!(worst),
        "at most 1e-10",
        "m and rad",
        worst <= 1e-10,
    );
}

/// The arm of the R-2000iC class has no URDF at hand: its joints multiplied out by hand.
#[test]
fn the_r2000ic_stands_where_its_data_sheet_says() {
    let model = preset("fanuc_r2000ic_like");
    let mut random = Random(5);
    for _ in 0..200 {
        let q = commands(&model.mechanism, &mut random, 1.0);
        let mut pose = Pose::identity();
        for (i, (axis, before)) in [
            (Vector3::z(), [0.0, 0.0, 0.670]),
            (Vector3::y(), [0.312, 0.0, 0.0]),
            (-Vector3::y(), [0.0, 0.0, 1.075]),
            (-Vector3::x(), [0.0, 0.0, 0.225]),
            (-Vector3::y(), [1.280, 0.0, 0.0]),
            (-Vector3::x(), [0.215, 0.0, 0.0]),
        ]
        .into_iter()
        .enumerate()
        {
            pose *= Translation3::from(Vector3::from(before));
            pose *= UnitQuaternion::from_scaled_axis(axis * q[i]);
        }
        // Tool frame of the URDF: rpy (pi, -pi/2, 0).
        let pi = std::f64::consts::PI;
        pose *= UnitQuaternion::from_euler_angles(pi, -0.5 * pi, 0.0);
        let found = forward(&model.mechanism, &q);
        assert!(apart(&found, &pose) < 1e-12, "{found} {pose}");
    }
}

/// Arms of one chain: commands, the pose that they lead to, and the commands for that pose.
#[test]
fn commands_of_arms_come_back() {
    let mut worst = Worst::new();
    let mut count = 0;
    for name in [
        "heavy_6r",
        "kuka_kr270_like",
        "abb_irb6640_like",
        "fanuc_r2000ic_like",
        "scara",
    ] {
        let model = preset(name);
        let mut random = Random(6);
        for _ in 0..50 {
            let q = commands(&model.mechanism, &mut random, 0.8);
            let target = forward(&model.mechanism, &q);
            let posture = model.mechanism.posture(&target).expect("reachable");
            for (a, b) in posture.commands().iter().zip(&q) {
                worst.add((a - b).abs());
            }
            count += 1;
        }
    }
    let worst = worst.value();
    figure(
        &format!("Library: commands of arms to pose to commands at {count} places"),
        json!(worst),
        "at most 1e-9",
        "rad and m",
        worst <= 1e-9,
    );
}

/// Machines of several limbs: a pose, its commands from home, where the file leads them, and the same
/// commands again when the search starts elsewhere.
#[test]
fn commands_of_hybrids_come_back() {
    let (mut closure_residual, mut twice, mut count) = (Worst::new(), Worst::new(), 0);
    for (name, shift, turn) in [
        ("fanuc_m900ib_like", 0.25, 0.3),
        ("counterweight_arm", 0.25, 0.25),
        ("gantry", 0.4, 0.0),
        ("gantry_with_tripod", 0.15, 0.15),
        ("parallel_wrist", 0.0, 0.35),
        ("tricept_like", 0.15, 0.25),
        ("arm_with_parallel_wrist", 0.15, 0.25),
    ] {
        let model = preset(name);
        let mechanism = &model.mechanism;
        let home = mechanism.platforms()[mechanism.tool()].home;
        let free = mechanism.posture(&home).expect("home").mobility().ncols();
        let mut last: Option<Posture> = None;
        let mut random = Random(8);
        for _ in 0..50 {
            let expected = moved(
                &home,
                &Twist::new(random.vector() * shift, random.vector() * turn),
            );
            // A machine of fewer than six degrees of freedom takes the nearest place.
            let posture = match mechanism.posture(&expected) {
                Err(Error::Unreachable { nearest, .. }) if free == 5 => {
                    mechanism.posture(&*nearest)
                }
                other => other,
            }
            .unwrap_or_else(|e| panic!("{name} at {expected}: {e}"));
            assert!(
                posture.limit_violations().is_empty(),
                "{name} at {expected}"
            );
            closure_residual.add(machine::structure(&model, &posture).closure_residual);
            if let Some(last) = &last {
                let again = mechanism
                    .posture(PostureRequest::pose(posture.target()).near(last))
                    .unwrap_or_else(|e| panic!("{name} again: {e}"));
                for (a, b) in again.commands().iter().zip(posture.commands()) {
                    twice.add((a - b).abs());
                }
            }
            last = Some(posture);
            count += 1;
        }
    }
    let (closure_residual, twice) = (closure_residual.of(count), twice.value());
    figure(
        &format!("Library: commands of hybrids to pose, off the pose asked for, at {count} places"),
        json!(closure_residual),
        "at most 1e-9",
        "m",
        closure_residual <= 1e-9,
    );
    figure(
        "Library: commands of hybrids from home minus those from the last place",
        json!(twice),
        "at most 1e-8",
        "rad and m",
        twice <= 1e-8,
    );
}
