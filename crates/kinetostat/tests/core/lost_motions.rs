//! How far a posture is from one where a limb loses a motion, against closed forms.

use kinetostat::{
    ActuatorSpec, Chain, Mechanism, MotionKind, Platform, Pose, Posture, PostureRequest,
    machine::{NearSingularity, SingularityKind},
};
use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3, vector};
use proptest::prelude::*;

use crate::graphs::limb;

const R: MotionKind = MotionKind::Revolute;
const P: MotionKind = MotionKind::Prismatic;

enum Part {
    Drive(MotionKind, Vector3<f64>),
    Free(Vector3<f64>),
    Bar(Vector3<f64>),
}
use Part::{Bar, Drive, Free};

/// One limb with its joints at `home`, in a frame of its own.
fn arm(frame: &Pose, parts: &[Part], home: &[f64]) -> Mechanism {
    let mut builder = Chain::builder("arm").rigid(*frame);
    let mut tip = *frame;
    let mut values = home.iter();
    for (k, part) in parts.iter().enumerate() {
        let moved = |kind: MotionKind, axis: &Vector3<f64>, by: f64| match kind {
            MotionKind::Prismatic => {
                Pose::from_parts((axis * by).into(), UnitQuaternion::identity())
            }
            MotionKind::Revolute => {
                Pose::from_parts(Vector3::zeros().into(), UnitQuaternion::new(axis * by))
            }
        };
        let name = format!("j{k}");
        builder = match part {
            Drive(kind, axis) => {
                let mut drive = ActuatorSpec::new(*kind, *axis, 1e5);
                drive.home = *values.next().unwrap();
                tip *= moved(*kind, axis, drive.home);
                builder.actuator(&name, drive)
            }
            Free(axis) => {
                let at = *values.next().unwrap();
                tip *= moved(R, axis, at);
                builder.passive(&name, R, *axis, at)
            }
            Bar(offset) => {
                tip *= Pose::from_parts((*offset).into(), UnitQuaternion::identity());
                builder.translation(*offset)
            }
        };
    }
    let mut machine = Mechanism::builder("machine");
    let tool = machine.platform(Platform::new("tool", tip));
    let chain = builder.build().unwrap();
    let own = limb("arm", 0, tool, Pose::identity(), chain);
    machine.limb(own).build().unwrap()
}

fn at_home(machine: &Mechanism) -> Posture {
    let home = machine.platforms()[machine.tool()].home;
    machine.posture(&home).unwrap()
}

fn nearest(posture: &Posture, within: f64) -> NearSingularity {
    let list = posture.near_singularities(within).unwrap();
    let lost = list.into_iter().find(|n| n.kind == SingularityKind::Lost);
    lost.expect("a singular posture is near")
}

fn somewhere(turn: [f64; 3]) -> Pose {
    let at = vector![0.3, -0.2, 0.7];
    Pose::from_parts(at.into(), UnitQuaternion::new(Vector3::from(turn)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Two bars, with the elbow driven: the arm may go out to the sum of their lengths.
    #[test]
    fn an_arm_of_two_bars_is_as_far_from_stretched_as_its_reach(
        elbow in 0.0005..60.0_f64, sign in prop::bool::ANY, shoulder in -3.0..3.0_f64,
        l1 in 0.4..1.2_f64, l2 in 0.4..1.2_f64, turn in prop::array::uniform3(-1.5..1.5_f64),
        toggle in prop::bool::ANY,
    ) {
        let bend = elbow.to_radians() * if sign { 1.0 } else { -1.0 };
        let frame = somewhere(turn);
        let z = Vector3::z();
        let first = if toggle { Free(z) } else { Drive(R, z) };
        let parts = [first, Bar(vector![l1, 0.0, 0.0]), Drive(R, z), Bar(vector![l2, 0.0, 0.0]), Free(z)];
        let machine = arm(&frame, &parts, &[shoulder, bend, 0.4]);
        let posture = at_home(&machine);
        // Without the cancellation of l1 + l2 - r.
        let r = (l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * bend.cos()).sqrt();
        let expected = 4.0 * l1 * l2 * (0.5 * bend).sin().powi(2) / (l1 + l2 + r);
        let found = nearest(&posture, 1.0);
        prop_assert!(found.followed);
        // Positions are known to rounding.
        prop_assert!((found.distance_m - expected).abs() <= 1e-7 * expected + 1e-14,
            "{} {expected}", found.distance_m);
        if expected > 1e-8 {
            let out = posture.target().translation.vector - frame.translation.vector;
            prop_assert!(found.towards.linear().dot(&out.normalize()) > 0.999_999);
            prop_assert!(found.motion.linear().dot(&out.normalize()).abs() > 0.999_99);
        }
        if expected > 1e-6 {
            let list = posture.near_singularities(0.99 * expected).unwrap();
            prop_assert!(list.is_empty(), "{}", list[0].description());
        }
    }

    /// Two upright joints, a quill that slides and turns.
    #[test]
    fn a_scara_is_as_far_from_stretched_as_its_reach(
        elbow in 0.01..60.0_f64, shoulder in -3.0..3.0_f64, turn in prop::array::uniform3(-1.5..1.5_f64),
    ) {
        let (l1, l2, bend) = (0.325, 0.275, elbow.to_radians());
        let z = Vector3::z();
        let parts = [Drive(R, z), Bar(vector![l1, 0.0, 0.0]), Drive(R, z), Bar(vector![l2, 0.0, 0.0]),
            Drive(P, z), Drive(R, z)];
        let machine = arm(&somewhere(turn), &parts, &[shoulder, bend, -0.1, 0.2]);
        let r = f64::sqrt(l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * bend.cos());
        let expected = l1 + l2 - r;
        let found = nearest(&at_home(&machine), 0.5);
        prop_assert!(found.followed);
        prop_assert!((found.distance_m - expected).abs() <= 1e-7 * expected + 1e-14,
            "{} {expected}", found.distance_m);
    }

    /// On three slides nothing but a turn by the middle angle brings the outer axes in line.
    #[test]
    fn a_wrist_on_slides_is_as_far_from_singular_as_its_middle_joint_is_turned(
        middle in 0.01..40.0_f64, first in -3.0..3.0_f64, last in -3.0..3.0_f64,
        turn in prop::array::uniform3(-1.5..1.5_f64),
    ) {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let parts = [Drive(P, x), Drive(P, y), Drive(P, z), Drive(R, x), Drive(R, y), Drive(R, x),
            Bar(vector![0.2, 0.05, 0.0])];
        let b = middle.to_radians();
        let machine = arm(&somewhere(turn), &parts, &[0.5, 0.2, 0.3, first, b, last]);
        let found = nearest(&at_home(&machine), 3.0);
        let turned = found.towards.angular().norm() * found.distance_m;
        prop_assert!(found.followed);
        prop_assert!((turned - b).abs() <= 1e-7 * b, "{turned} {b}");
        prop_assert!(found.towards.linear().norm() < 1e-5);
    }
}

/// Upper arm and forearm of an articulated arm, m.
const ARM: [f64; 2] = [0.8, 0.7];

/// Six joints, the tool at the wrist's centre.
fn articulated(q: &[f64; 6]) -> Mechanism {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let parts = [
        Drive(R, z),
        Bar(vector![0.0, 0.0, 0.5]),
        Drive(R, y),
        Bar(vector![0.0, 0.0, ARM[0]]),
        Drive(R, y),
        Bar(vector![0.0, 0.0, ARM[1]]),
        Drive(R, z),
        Drive(R, x),
        Drive(R, z),
    ];
    arm(&somewhere([0.3, -0.2, 0.5]), &parts, q)
}

#[test]
fn the_elbow_of_an_articulated_arm_is_as_far_from_stretched_as_its_reach() {
    for degrees in [0.1_f64, 1.0, 5.0, 20.0, 40.0] {
        let bend = degrees.to_radians();
        let machine = articulated(&[0.3, 0.7, bend, 0.4, 1.4, 0.2]);
        let [l1, l2] = ARM;
        let expected = l1 + l2 - (l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * bend.cos()).sqrt();
        let found = nearest(&at_home(&machine), 0.3);
        assert!(found.followed);
        let off = (found.distance_m - expected).abs();
        assert!(
            off < 1e-7 * expected + 1e-13,
            "{degrees}: {} {expected}",
            found.distance_m
        );
    }
}

#[test]
fn a_wrist_beside_the_first_axis_is_as_far_from_the_shoulder_s_singularity() {
    for aside in [0.001, 0.02, 0.1] {
        // Elbow out, wrist above the shoulder but for `aside`.
        let (reach, [l1, l2]) = (0.9_f64, ARM);
        let r = f64::hypot(reach, aside);
        let bend = ((r * r - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)).acos();
        let lean = f64::atan2(aside, reach) - f64::atan2(l2 * bend.sin(), l1 + l2 * bend.cos());
        let machine = articulated(&[0.3, lean, bend, 0.4, 1.4, 0.2]);
        let found = nearest(&at_home(&machine), 0.3);
        assert!(found.followed);
        let off = (found.distance_m - aside).abs();
        assert!(
            off < 1e-7 * aside,
            "{aside}: {} {}",
            found.distance_m,
            found.description()
        );
        // Across the plane of the arm nothing moves there.
        assert!(found.towards.linear().norm() > 0.999_999);
    }
}

/// To first order: what of the fifth joint's motion the other five cannot make good, by difference
/// of a product of rotations.
#[test]
fn a_wrist_near_zero_is_as_far_from_singular_as_its_fifth_joint_moves_the_tool() {
    let (y, z, x) = (Vector3::y(), Vector3::z(), Vector3::x());
    let product = |q: &DVector<f64>| {
        let turn = |axis: Vector3<f64>, by: f64| UnitQuaternion::new(axis * by);
        let a = turn(z, q[0]) * turn(y, q[1]);
        let b = a * turn(y, q[2]);
        let at = a * vector![0.0, 0.0, ARM[0]] + b * vector![0.0, 0.0, ARM[1]];
        (at, b * turn(z, q[3]) * turn(x, q[4]) * turn(z, q[5]))
    };
    for fifth in [1e-3_f64, -3e-4] {
        let q = [0.3, 0.7, 1.2, 0.4, fifth, 0.2];
        let machine = articulated(&q);
        let posture = at_home(&machine);
        let length = posture.stiffness().unwrap().length;
        let at = DVector::from_row_slice(&q);
        let columns: Vec<DVector<f64>> = (0..6)
            .map(|j| {
                let mut by = DVector::zeros(6);
                by[j] = 1e-6;
                let (plus, minus) = (product(&(&at + &by)), product(&(&at - &by)));
                let v = (plus.0 - minus.0) / 2e-6;
                let w = (plus.1 * minus.1.inverse()).scaled_axis() / 2e-6 * length;
                DVector::from_iterator(6, v.iter().chain(w.iter()).copied())
            })
            .collect();
        let all = [0, 1, 2, 3, 5].map(|j| columns[j].clone());
        let others = DMatrix::from_columns(&all);
        // Joints four and six are all but one: together they cannot cross the lost motion.
        let eigen = (&others * others.transpose()).symmetric_eigen();
        let u = &eigen.eigenvectors;
        let mut left = &columns[4] * fifth;
        for k in 0..6 {
            if eigen.eigenvalues[k] > 1e-4 {
                left -= u.column(k) * u.column(k).dot(&(&columns[4] * fifth));
            }
        }
        let found = nearest(&posture, 0.1);
        assert!(found.followed);
        let span = found.towards.0 * found.distance_m;
        let span = DVector::from_fn(6, |i, _| span[i] * if i < 3 { 1.0 } else { length });
        let turned = somewhere([0.3, -0.2, 0.5]).rotation;
        let size = left.norm();
        assert!(
            (span.norm() - size).abs() < 0.01 * size,
            "{} {size}",
            span.norm()
        );
        let mut expected = DVector::zeros(6);
        for part in [0, 3] {
            let own = turned * Vector3::from_iterator(left.rows(part, 3).iter().copied());
            expected.rows_mut(part, 3).copy_from(&own);
        }
        assert!(
            (&span + &expected).norm() < 0.02 * size,
            "{span} {expected}"
        );
    }
}

#[test]
fn a_stretched_arm_is_singular_here_and_a_bent_one_is_not() {
    let z = Vector3::z();
    let bar = |l: f64| Bar(vector![l, 0.0, 0.0]);
    let parts = [Drive(R, z), bar(1.0), Drive(R, z), bar(1.0), Free(z)];
    let frame = somewhere([0.4, 0.2, -0.3]);
    let straight = arm(&frame, &parts, &[0.3, 0.0, 0.1]);
    let posture = straight
        .posture(PostureRequest::commands(&[0.3, 0.0]))
        .unwrap();
    let found = nearest(&posture, 0.1);
    assert_eq!((found.distance_m, found.share), (0.0, 0.0));
    let out = (posture.target().translation.vector - frame.translation.vector).normalize();
    assert!(found.motion.linear().dot(&out).abs() > 0.999_99);
    assert!(found.description().starts_with("singular posture"));
    // What a planar arm never does is no loss.
    let bent = arm(&frame, &parts, &[0.3, 1.5, 0.1]);
    assert!(at_home(&bent).near_singularities(0.3).unwrap().is_empty());
}
