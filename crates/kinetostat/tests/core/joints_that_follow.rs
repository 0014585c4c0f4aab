//! A motion that is coupled to an actuator follows the joint: its command and the deflection of its
//! drive. So mimic joints and levers between joints are written.

use kinetostat::{ActuatorSpec, Chain, MotionKind, Pose, Wrench, model::Kinematics};
use kinetostat_testing::LargestEntry;
use nalgebra::{UnitQuaternion, Vector3, vector};

const RATIO: f64 = -0.7;

/// A turning joint, a sliding one and one more turn that follows the first.
fn chain(stiffness: Option<f64>) -> Chain {
    let mut lead = ActuatorSpec::new(MotionKind::Revolute, vector![0.2, 0.9, -0.3], 1.0);
    lead.stiffness = stiffness;
    let mut slide = ActuatorSpec::new(MotionKind::Prismatic, vector![1.0, 0.0, 0.4], 1.0);
    slide.stiffness = stiffness.map(|k| 3.0 * k);
    Chain::builder("follows")
        .actuator("lead", lead)
        .translation(vector![0.6, 0.1, 0.2])
        .actuator("slide", slide)
        .translation(vector![0.3, -0.2, 0.1])
        .coupled("lead", MotionKind::Revolute, vector![0.1, 1.0, 0.3], RATIO)
        .coupled("slide", MotionKind::Prismatic, vector![0.0, 0.0, 1.0], 0.5)
        .translation(vector![0.5, 0.0, -0.1])
        .build()
        .expect("a chain")
}

/// The same product by hand.
fn by_hand(turn: f64, slide: f64) -> Pose {
    let about =
        |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis.normalize() * angle);
    let along = |v: Vector3<f64>| Pose::translation(v.x, v.y, v.z);
    about(vector![0.2, 0.9, -0.3], turn)
        * along(vector![0.6, 0.1, 0.2])
        * along(vector![1.0, 0.0, 0.4].normalize() * slide)
        * along(vector![0.3, -0.2, 0.1])
        * about(vector![0.1, 1.0, 0.3], RATIO * turn)
        * along(vector![0.0, 0.0, 0.5 * slide])
        * along(vector![0.5, 0.0, -0.1])
}

#[test]
fn commands_move_the_followers_too() {
    let base = Pose::identity();
    let (turn, slide) = (0.4, 0.25);
    let rigid = chain(None);
    let k = Kinematics::new(&rigid, &base, &[], &[turn, slide]);
    let difference = |pose: &Pose| {
        (pose.to_homogeneous() - by_hand(turn, slide).to_homogeneous()).largest_entry()
    };
    assert!(difference(&k.tip_pose()) < 1e-14);
    // Command and deflection add up, whatever their shares.
    let elastic = chain(Some(1e5));
    let k = Kinematics::new(&elastic, &base, &[0.3, -0.05], &[turn - 0.3, slide + 0.05]);
    assert!(difference(&k.tip_pose()) < 1e-14);
    // The Jacobian against differences of the product by hand.
    let jacobian = k.jacobian(elastic.tip());
    let h = 1e-6;
    for (column, d) in [(0, [h, 0.0]), (1, [0.0, h]), (2, [h, 0.0]), (3, [0.0, h])] {
        let ahead = by_hand(turn + d[0], slide + d[1]).translation.vector;
        let behind = by_hand(turn - d[0], slide - d[1]).translation.vector;
        let difference = (ahead - behind) / (2.0 * h);
        for i in 0..3 {
            assert!((jacobian[(i, column)] - difference[i]).abs() < 1e-8);
        }
    }
}

#[test]
fn a_drive_carries_the_loads_of_its_followers() {
    let chain = chain(None);
    let base = Pose::identity();
    let k = Kinematics::new(&chain, &base, &[], &[0.4, 0.25]);
    let wrench = Wrench::new(vector![30.0, -20.0, 50.0], vector![0.0, 0.0, 0.0]);
    let torques = k.jacobian(chain.tip()).transpose() * wrench.0;
    // Virtual work by hand.
    let h = 1e-6;
    let work = |a: Pose, b: Pose| {
        (a.translation.vector - b.translation.vector).dot(&wrench.force()) / (2.0 * h)
    };
    let turn = work(by_hand(0.4 + h, 0.25), by_hand(0.4 - h, 0.25));
    let slide = work(by_hand(0.4, 0.25 + h), by_hand(0.4, 0.25 - h));
    assert!((torques[0] - turn).abs() < 1e-6 && (torques[1] - slide).abs() < 1e-6);
}
