//! Traps of the theory (dynamics.md, section 13) that no other test would fall into; each number is that of the trap and
//! of what is right. The list of all traps with their tests stands in `main.rs`.

use kinetostat::chain::Prescribed;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, Rotor};
use nalgebra::{Matrix3, Vector3, vector};

use crate::common::{DENSITY, section};

/// First frequency in the plane of a column with both ends hinged, under an axial dead force.
fn hinged(chain: &Chain, push: f64) -> f64 {
    let mut end = EndCondition::wrench(Wrench::new(vector![-push, 0.0, 0.0], Vector3::zeros()));
    end.pose = Pose::translation(1.0, 0.0, 0.0);
    for k in 1..5 {
        end.prescribed[k] = Prescribed::Pose;
    }
    let held = Held::of_end(&end);
    let mut problem = ChainProblem::new(chain, end);
    problem.posture = chain.home_coordinates();
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &held).unwrap();
    // The whole link turns about its hinge in the plane.
    let pin = d.place("probe").unwrap();
    let modes = d.modes().unwrap().modes;
    let turns = modes.iter().find(|mode| {
        let motion = d.motions(pin) * &mode.shape;
        motion[5].abs() > 1e3 * (motion[3].abs() + motion[4].abs())
            && motion[5].abs() > motion[0].abs()
    });
    turns.unwrap().frequency_hz()
}

fn column(beam: &LinkSpec, rigid: bool) -> Chain {
    let chain = Chain::builder("column")
        .passive("pin", MotionKind::Revolute, Vector3::z(), 0.0)
        .node("probe");
    // A rigid rod of the same mass, as a file of a robot has it.
    let mass = DENSITY * section().area;
    let rod = Matrix3::from_diagonal(&vector![0.0, mass / 12.0, mass / 12.0]);
    let chain = match rigid {
        true => chain.body("rod", mass, vector![0.5, 0.0, 0.0], rod),
        false => chain,
    };
    chain.link_with("bar", beam).build().unwrap()
}

/// Trap 1: the rigid link of a URDF as the mass of an elastic leg that is hinged at both ends is 70 % off, below.
#[test]
fn rigid_links_are_no_mass_model_of_elastic_legs() {
    let exact = 87.7542363;
    let bar = LinkSpec::beam(section(), 1.0);
    let consistent = bar.with_mass(LinkMass::of_section(&section(), DENSITY).thin());
    let right = hinged(&column(&consistent, false), 0.0) / exact - 1.0;
    assert!((right - 0.1099).abs() < 1e-4, "{right}");
    let rigid = hinged(&column(&bar, true), 0.0) / exact - 1.0;
    assert!((rigid + 0.6960).abs() < 1e-4, "{rigid}");
}

/// Trap 10: a rotor sits before the spring of its transmission. It is the same as a wheel on the servo's spring with the
/// transmission behind it, and far from an inertia added to the link.
#[test]
fn rotors_sit_before_the_transmission() {
    let (servo, gear) = (4e5, 1.6e5);
    let (inertia, ratio) = (1.1e-3, 90.0);
    let seen = inertia * ratio * ratio;
    let wheel = Matrix3::from_diagonal(&vector![0.5 * seen, 0.5 * seen, seen]);
    let link = Matrix3::new(0.4, 0.05, -0.02, 0.05, 0.6, 0.03, -0.02, 0.03, 0.5);
    let axis = vector![0.2, -0.3, 1.0].normalize();
    let turn = nalgebra::Rotation3::rotation_between(&Vector3::z(), &axis).unwrap();
    let along = turn.matrix() * wheel * turn.matrix().transpose();
    let behind = |chain: kinetostat::ChainBuilder| {
        chain
            .body("arm", 12.0, vector![0.4, 0.1, 0.05], link)
            .translation(vector![0.6, 0.0, 0.1])
            .spring(
                "elbow",
                MotionKind::Revolute,
                vector![0.1, 1.0, 0.2].normalize(),
                7e4,
                0.0,
            )
            .body("fore", 5.0, vector![0.3, -0.05, 0.1], link)
            .build()
            .unwrap()
    };
    let of = |chain: &Chain| {
        let problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
        let x = chain.home_coordinates();
        LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap()
    };
    let turns = MotionKind::Revolute;
    let joint = 1.0 / (1.0 / servo + 1.0 / gear);
    let bare = of(&behind(
        Chain::builder("arm").spring("drive", turns, axis, joint, 0.0),
    ));
    let rotor = Rotor {
        joint: "drive".into(),
        inertia,
        ratio,
        servo_stiffness: servo,
    };
    let found = bare
        .with_rotors(&[rotor])
        .unwrap()
        .modes()
        .unwrap()
        .frequencies_hz();
    let explicit = of(&behind(
        Chain::builder("arm")
            .spring("servo", turns, axis, servo, 0.0)
            .body("wheel", 0.0, Vector3::zeros(), along)
            .spring("drive", turns, axis, gear, 0.0),
    ));
    let expected = explicit.modes().unwrap().frequencies_hz();
    assert_eq!((found.len(), expected.len()), (3, 3));
    for (f, e) in found.iter().zip(&expected) {
        assert!((f / e - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
    }
    let trap = of(&behind(
        Chain::builder("arm")
            .spring("drive", turns, axis, joint, 0.0)
            .body("armature", 0.0, Vector3::zeros(), along),
    ));
    let trap = trap.modes().unwrap().frequencies_hz();
    assert!(
        (trap[0] / found[0] - 1.0).abs() > 0.05,
        "{trap:?} {found:?}"
    );
}

/// Trap 14: a column of true stretch does not have the formula's load, by about P/EA; with stretch taken away it does.
#[test]
fn an_extensible_column_is_not_that_of_the_formula() {
    let ratio = |stretch: f64| {
        let mut own = section();
        let mass = LinkMass::of_section(&own, DENSITY).thin();
        own.area *= stretch;
        let chain = column(&LinkSpec::beam(own, 1.0).segments(8).with_mass(mass), false);
        let euler = std::f64::consts::PI.powi(2) * 14700.0;
        (hinged(&chain, 0.9 * euler) / hinged(&chain, 0.0)).powi(2)
    };
    assert!((ratio(1e5) - 0.1).abs() < 5e-5, "{}", ratio(1e5));
    let extensible = ratio(1.0) - 0.1;
    // P/EA = 1.04e-3.
    assert!((3e-4..5e-3).contains(&extensible.abs()), "{extensible}");
}
