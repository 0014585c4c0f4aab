//! Struts whose screw turns with their joints: commands and stiffness of a hexapod against a closed
//! form of vectors, and forward kinematics as the inverse of the inverse one.

use std::f64::consts::TAU;

use kinetostat::{
    ActuatorSpec, Chain, Limb, Mechanism, MotionKind, Platform, Pose, PostureRequest, Twist,
    machine::{LimbPosture, inverse_kinematics},
    model::unloaded_tip,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6, vector};

use crate::common::machines::{Orthoglide, orthoglide_point};
use crate::common::random::Rng;

const HEIGHT: f64 = 0.6;
const STIFFNESS: f64 = 4.0e6;

/// Feet and heads of the six struts and the frame in which each is written: z along the strut at home.
fn strut(i: usize) -> (Vector3<f64>, Vector3<f64>, UnitQuaternion<f64>) {
    let at = |deg: f64, r: f64| {
        let a = deg.to_radians();
        vector![r * a.cos(), r * a.sin(), 0.0]
    };
    let k = (i / 2) as f64 * 120.0;
    let side = if i.is_multiple_of(2) { -1.0 } else { 1.0 };
    let foot = at(k + side * 50.0, 0.5);
    let head = at(k + side * 13.0, 0.3);
    let along = head + vector![0.0, 0.0, HEIGHT] - foot;
    // Turned about itself as well, so that no axis of a joint lies in a plane of symmetry.
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &along).unwrap()
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.4 + 0.7 * i as f64);
    (foot, head, turn)
}

/// How the strut ends: a screw of this lead, or a plain ram whose rod is free to turn.
#[derive(Clone, Copy)]
enum Rod {
    Screw(f64),
    Plain,
}

fn hexapod(rod: Rod) -> Mechanism {
    let mut builder = Mechanism::builder("hexapod");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, HEIGHT)));
    for i in 0..6 {
        let (foot, head, turn) = strut(i);
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), STIFFNESS);
        drive.home = (head + vector![0.0, 0.0, HEIGHT] - foot).norm();
        let chain = Chain::builder(format!("strut {i}"))
            .rigid(Pose::from_parts(foot.into(), turn))
            .passive_universal("foot", Vector3::x(), Vector3::y());
        let chain = match rod {
            Rod::Screw(lead) => chain.screw("ram", drive, lead),
            Rod::Plain => {
                chain
                    .actuator("ram", drive)
                    .passive("rod", MotionKind::Revolute, Vector3::z(), 0.0)
            }
        };
        let chain = chain
            .passive_universal("head", Vector3::y(), Vector3::x())
            .build()
            .unwrap();
        builder = builder.limb(
            Limb::between(format!("strut {i}"), 0, tool, chain)
                .fixed_at(Pose::from_parts(head.into(), turn)),
        );
    }
    builder.build().unwrap()
}

/// Length less what the rod's turn between the inner axes of its two joints makes of it; vectors
/// only. An inner axis is square to the strut and to the outer axis of its joint.
fn command(i: usize, tool: &Pose, lead: f64) -> f64 {
    let (foot, head, turn) = strut(i);
    let along = tool * nalgebra::Point3::from(head) - nalgebra::Point3::from(foot);
    let n = along.normalize();
    let near = n.cross(&(turn * Vector3::x())).normalize();
    let far = n.cross(&(tool.rotation * turn * Vector3::x())).normalize();
    let angle = near.cross(&far).dot(&n).atan2(near.dot(&far));
    along.norm() - lead / TAU * angle
}

fn places() -> Vec<Pose> {
    let mut rng = Rng(20_133);
    (0..20)
        .map(|_| {
            let turn = rng.vector(0.25);
            let shift = rng.vector(0.08) + vector![0.0, 0.0, HEIGHT];
            Pose::new(shift, turn)
        })
        .collect()
}

const LEADS: [f64; 4] = [0.005, -0.005, 0.04, -0.04];

/// Largest difference of commands, m.
pub fn commands_apart() -> f64 {
    let mut worst = Worst::new();
    for lead in LEADS {
        let machine = hexapod(Rod::Screw(lead));
        for tool in places() {
            let posture = machine.posture(&tool).unwrap();
            for (i, c) in posture.commands().iter().enumerate() {
                worst.add((c - command(i, &tool, lead)).abs());
            }
        }
    }
    worst.value()
}

/// Largest difference of the stiffness from `sum k g g^T`, `g` the gradient of the closed form by
/// differences, as a share of the diagonal entries.
pub fn stiffness_apart() -> f64 {
    let mut worst = Worst::new();
    for lead in LEADS {
        let machine = hexapod(Rod::Screw(lead));
        for tool in places().into_iter().take(6) {
            let k = machine.posture(&tool).unwrap().stiffness().unwrap();
            let mut dense = Matrix6::zeros();
            for i in 0..6 {
                let g = gradient(i, &tool, lead);
                dense += STIFFNESS * g * g.transpose();
            }
            for r in 0..6 {
                for c in 0..6 {
                    let size = (dense[(r, r)] * dense[(c, c)]).sqrt();
                    let difference = k.cartesian.matrix[(r, c)] - dense[(r, c)];
                    worst.add((difference / size).abs());
                }
            }
        }
    }
    worst.value()
}

/// Differences of sixth order.
fn gradient(i: usize, tool: &Pose, lead: f64) -> Vector6<f64> {
    let h = 5e-3;
    Vector6::from_fn(|direction, _| {
        let at = |steps: f64| {
            let mut twist = Vector6::zeros();
            twist[direction] = steps * h;
            command(i, &moved(tool, &Twist(twist)), lead)
        };
        let odd = |steps: f64| at(steps) - at(-steps);
        (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * h)
    })
}

#[test]
fn commands_of_a_hexapod_with_screws_are_those_of_the_closed_form() {
    let apart = commands_apart();
    assert!(apart < 1e-12, "{apart:e} m");
    // The coupling is no small thing: a tenth of a millimetre and more.
    let tool = places()[3];
    let (with, without) = (command(0, &tool, 0.04), command(0, &tool, 0.0));
    assert!((with - without).abs() > 1e-4, "{with} {without}");
}

#[test]
fn stiffness_of_a_hexapod_with_screws_is_that_of_the_closed_form() {
    let apart = stiffness_apart();
    assert!(apart < 1e-10, "{apart:e}");
}

#[test]
fn a_screw_without_lead_is_a_plain_ram() {
    let (screw, plain) = (hexapod(Rod::Screw(0.0)), hexapod(Rod::Plain));
    for tool in places().into_iter().take(5) {
        let (a, b) = (screw.posture(&tool).unwrap(), plain.posture(&tool).unwrap());
        for (x, y) in a.commands().iter().zip(b.commands()) {
            assert!((x - y).abs() < 1e-14, "{x} {y}");
        }
        let (k, l) = (a.stiffness().unwrap(), b.stiffness().unwrap());
        let apart = (k.cartesian.matrix - l.cartesian.matrix).largest_entry();
        assert!(
            apart < 1e-13 * l.cartesian.matrix.largest_entry(),
            "{apart:e}"
        );
    }
}

/// One strut at home, its joints straight: a pure force along it and, by the screw, the moment
/// `-F lead / (2 pi)` about it; the hand of the thread is its sign.
#[test]
fn a_strut_turns_what_it_pushes_by_its_lead() {
    for lead in LEADS {
        let drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), STIFFNESS);
        let chain = Chain::builder("strut")
            .passive_universal("foot", Vector3::x(), Vector3::y())
            .screw("ram", drive, lead)
            .passive_universal("head", Vector3::y(), Vector3::x())
            .build()
            .unwrap();
        let k = kinetostat::unloaded_stiffness(
            &chain,
            &Pose::identity(),
            &chain.home_coordinates(),
            &[0.7],
        )
        .unwrap();
        let push = k.cartesian.matrix.column(2);
        assert!((push[2] / STIFFNESS - 1.0).abs() < 1e-12, "{push}");
        let pitch = push[5] / push[2];
        assert!((pitch + lead / TAU).abs() < 1e-15, "{pitch} for {lead}");
        let aside = push[0].abs() + push[1].abs() + push[3].abs() + push[4].abs();
        assert!(aside < 1e-6, "{push}");
    }
}

/// A passive turn of more than half a revolution is not taken back by a whole one: a screw would not
/// be where it was.
#[test]
fn turns_of_a_screw_are_counted() {
    let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), STIFFNESS);
    drive.home = 0.5;
    let chain = Chain::builder("screw")
        .screw("ram", drive, 0.01)
        .build()
        .unwrap();
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 4.0);
    let target = Pose::from_parts(vector![0.0, 0.0, 0.5].into(), turn.into());
    let start = LimbPosture {
        commands: vec![0.5],
        coordinates: vec![0.0, 3.9],
    };
    let found = inverse_kinematics(&chain, &Pose::identity(), &target, Some(&start)).unwrap();
    assert!((found.coordinates[1] - 4.0).abs() < 1e-12, "{found:?}");
    assert!((found.commands[0] - (0.5 - 4.0 * 0.01 / TAU)).abs() < 1e-13);
    let there = unloaded_tip(
        &chain,
        &Pose::identity(),
        &found.coordinates,
        &found.commands,
    );
    assert!(pose_residual(&target, &there).0.norm() < 1e-13);
}

#[test]
fn forward_kinematics_undoes_inverse_kinematics() {
    let machine = hexapod(Rod::Screw(0.04));
    for tool in places() {
        let posture = machine.posture(&tool).unwrap();
        let back = machine
            .posture(PostureRequest::commands(&posture.commands()))
            .unwrap();
        let difference = pose_residual(&tool, back.target()).0.norm();
        assert!(difference < 1e-12, "{difference:e}");
        for (a, b) in back.limbs().iter().zip(posture.limbs()) {
            for (x, y) in a.coordinates.iter().zip(&b.coordinates) {
                assert!((x - y).abs() < 1e-11, "{x} {y}");
            }
        }
    }
    let machine = Orthoglide::default().build();
    for i in 0..5 {
        let tool = orthoglide_point(i);
        let posture = machine.posture(&tool).unwrap();
        let back = machine
            .posture(PostureRequest::commands(&posture.commands()))
            .unwrap();
        let difference = pose_residual(&tool, back.target()).0.norm();
        assert!(difference < 1e-12, "{difference:e}");
    }
}

#[test]
fn commands_that_tear_the_machine_are_refused_with_the_closure_residual() {
    let machine = hexapod(Rod::Plain);
    let mut commands = machine.posture(&places()[0]).unwrap().commands();
    commands[2] += 1.0;
    let error = machine
        .posture(PostureRequest::commands(&commands))
        .unwrap_err();
    assert!(error.is_unanswered());
    assert!(error.to_string().contains("do not close"), "{error}");
    assert!(
        machine
            .posture(PostureRequest::commands(&commands[1..]))
            .is_err()
    );
    commands[2] = f64::NAN;
    assert!(
        machine
            .posture(PostureRequest::commands(&commands))
            .is_err()
    );
}
