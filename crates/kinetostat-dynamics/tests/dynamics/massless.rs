//! Coordinates without mass, without stiffness, and with too little of it.

use crate::common::*;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, MassKind, ModalResponse, Rotor};
use nalgebra::{Matrix3, Vector3, vector};

/// A body on a joint, and behind it a massless lever on a spring with a force on its end.
fn lever(force: f64) -> LinearDynamics {
    let chain = Chain::builder("lever")
        .spring("first", MotionKind::Revolute, Vector3::z(), 1e4, 0.0)
        .body(
            "body",
            5.0,
            vector![0.4, 0.0, 0.0],
            Matrix3::identity() * 0.1,
        )
        .translation(vector![0.4, 0.0, 0.0])
        .spring("second", MotionKind::Revolute, Vector3::z(), 10.0, 0.0)
        .translation(vector![0.5, 0.0, 0.0])
        .build()
        .unwrap();
    let push = Wrench::new(vector![force, 0.0, 0.0], Vector3::zeros());
    let problem = ChainProblem::new(&chain, EndCondition::wrench(push));
    LinearDynamics::of_chain(&problem, &[0.0, 0.0], &push, &Held::nothing()).unwrap()
}

#[test]
fn massless_levers_follow_and_may_give_way() {
    for force in [0.0, 100.0, -100.0] {
        let modes = lever(force).modes().unwrap();
        // K - H of both joints by hand; the massless one follows: k11 - k12^2 / k22.
        let (k11, k12, k22) = (1e4 + force * 0.9, force * 0.5, 10.0 + force * 0.5);
        let squared = (k11 - k12 * k12 / k22) / (0.1 + 5.0 * 0.16);
        assert_eq!((modes.modes.len(), modes.counts.massless), (1, 1));
        assert!(
            (modes.modes[0].squared / squared - 1.0).abs() < 1e-10,
            "{force}: {} {squared}",
            modes.modes[0].squared
        );
        assert_eq!(modes.counts.massless_unstable, usize::from(force < 0.0));
        assert_eq!(modes.stable(), force >= 0.0, "no frequency tells of it");
    }
}

#[test]
fn responses_have_the_flexibility_of_what_has_no_mass() {
    let d = lever(100.0);
    let modes = d.modes().unwrap();
    let tool = d.tool();
    let response = ModalResponse::new(&d, &modes, &Damping::Undamped, tool, tool, 1).unwrap();
    let direct = d.direct(&modes, &Damping::Undamped).unwrap();
    for hz in [0.0, 3.0, 40.0] {
        let (a, b) = (
            response.at_hz(hz)[(1, 1)],
            direct.at_hz(tool, tool, hz).unwrap()[(1, 1)],
        );
        assert!((a - b).norm() < 1e-10 * b.norm());
    }
    assert!(response.residual()[(1, 1)] > 1e-3, "the lever is soft");
}

#[test]
fn a_massless_joint_changes_nothing() {
    let arm = |more: bool| {
        let mut chain = Chain::builder("arm")
            .spring(
                "first",
                MotionKind::Revolute,
                vector![0.1, 1.0, 0.2],
                1e4,
                0.0,
            )
            .body(
                "body",
                5.0,
                vector![0.4, 0.1, 0.0],
                Matrix3::identity() * 0.1,
            )
            .translation(vector![0.4, 0.0, 0.0])
            .spring(
                "second",
                MotionKind::Revolute,
                vector![1.0, 0.3, 0.2],
                4e3,
                0.0,
            )
            .body(
                "head",
                2.0,
                vector![0.2, 0.1, 0.3],
                Matrix3::identity() * 0.05,
            );
        if more {
            chain = chain
                .spring("idle", MotionKind::Revolute, Vector3::z(), 7e2, 0.0)
                .translation(vector![0.1, 0.2, 0.0]);
        }
        let chain = chain.build().unwrap();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        about(&problem, &Held::nothing())
            .modes()
            .unwrap()
            .frequencies_hz()
    };
    for (a, b) in arm(false).iter().zip(arm(true)) {
        assert!((a / b - 1.0).abs() < 1e-12);
    }
}

/// A spinning slider without mass and stiffness beside free mass: each is counted where it belongs.
#[test]
fn free_and_neutral_directions_are_told_apart() {
    let chain = Chain::builder("free")
        .passive("slide", MotionKind::Prismatic, Vector3::x(), 0.0)
        .spring("drive", MotionKind::Prismatic, Vector3::y(), 1e6, 0.0)
        .body("block", 3.0, Vector3::zeros(), Matrix3::zeros())
        .passive("spin", MotionKind::Revolute, Vector3::z(), 0.0)
        .build()
        .unwrap();
    let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    let d =
        LinearDynamics::of_chain(&problem, &[0.0; 3], &Wrench::zero(), &Held::nothing()).unwrap();
    let modes = d.modes().unwrap();
    assert_eq!(
        (
            modes.counts.free,
            modes.counts.neutral,
            modes.counts.vibrating
        ),
        (1, 1, 1)
    );
    assert_eq!(modes.neutral, ["spin"]);
    assert_eq!(modes.modes[0].squared, 0.0);
    // Free mass in the response: -1 / (m w^2).
    let block = d.place("block").unwrap();
    let response = ModalResponse::new(&d, &modes, &Damping::Ratio(0.02), block, block, 2).unwrap();
    let w = 5.0 * std::f64::consts::TAU;
    assert!((response.at_hz(5.0)[(0, 0)].re * -3.0 * w * w - 1.0).abs() < 1e-9);
}

/// An armature on the link's own coordinate is on the wrong side of the gear: this test falls into that trap by hand.
#[test]
fn rotors_are_on_their_side_of_the_gear() {
    let hinge = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e5);
    let chain = Chain::builder("arm")
        .actuator("drive", hinge)
        .body("arm", 8.0, vector![0.5, 0.0, 0.0], Matrix3::zeros())
        .build()
        .unwrap();
    let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    let d = LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing()).unwrap();
    let rotor = |servo: f64| Rotor {
        joint: "drive".into(),
        inertia: 1e-3,
        ratio: 100.0,
        servo_stiffness: servo,
    };
    // A motor that is held: the rotor does not move, whatever it weighs.
    let stiff = d.with_rotors(&[rotor(1e12)]).unwrap();
    let own = d.modes().unwrap().modes[0].squared;
    let (first, wrong) = (stiff.modes().unwrap().modes[0].squared, 1e5 / (2.0 + 10.0));
    assert!((first / own - 1.0).abs() < 1e-6 && (first / wrong - 1.0).abs() > 1.0);
    // Two masses and two springs by hand, and nothing changed at rest.
    let soft = d.with_rotors(&[rotor(3e5)]).unwrap();
    let modes = soft.modes().unwrap();
    let (a, b) = (1.5e5 / 2.0, 4.5e5 / 10.0);
    let root = (0.25 * (a - b) * (a - b) + 1.5e5_f64.powi(2) / 20.0).sqrt();
    for (mode, expected) in modes
        .modes
        .iter()
        .zip([0.5 * (a + b) - root, 0.5 * (a + b) + root])
    {
        assert!((mode.squared / expected - 1.0).abs() < 1e-10);
        let shares = soft.kinetic_shares(mode);
        assert!(
            (shares.iter().map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-12 && shares.len() == 2
        );
    }
    assert!(soft.mass_parts().iter().any(|p| p.kind == MassKind::Rotor));
    let flexibility = |d: &LinearDynamics| {
        ModalResponse::new(
            d,
            &d.modes().unwrap(),
            &Damping::Undamped,
            d.tool(),
            d.tool(),
            1,
        )
        .unwrap()
        .at_hz(0.0)[(5, 5)]
            .re
    };
    assert!((flexibility(&soft) / flexibility(&d) - 1.0).abs() < 1e-12);
    assert!(
        d.with_rotors(&[rotor(5e4)])
            .unwrap_err()
            .to_string()
            .contains("softer")
    );
}
