//! One suite over both ways to the modes of a chain: along it, and by dense matrices.

use crate::arms::arm6;
use crate::common::*;
use kinetostat::chain::Prescribed;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, LongChain, ModeKind, Modes, lowest_modes};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector3, vector};

/// Two links of different sections off every axis, a joint with a spring between them, a body at a corner and one at the
/// tip.
fn crane(segments: usize) -> Chain {
    let mass = LinkMass::of_section(&section(), DENSITY);
    let link = |length| {
        LinkSpec::beam(section(), length)
            .segments(segments)
            .with_mass(mass)
    };
    let corner = Matrix3::new(0.5, 0.02, 0.01, 0.02, 0.4, -0.03, 0.01, -0.03, 0.6);
    Chain::builder("crane")
        .spring("slew", MotionKind::Revolute, Vector3::z(), 4e5, 0.0)
        .rigid(Pose::rotation(vector![0.1, -0.9, 0.2]))
        .link_with("mast", &link(0.9))
        .rigid(Pose::new(
            vector![0.05, 0.02, -0.03],
            vector![0.3, 0.8, -0.4],
        ))
        .body("corner", 6.0, vector![0.02, -0.03, 0.05], corner * 0.1)
        .spring("elbow", MotionKind::Revolute, Vector3::y(), 9e4, 0.0)
        .link_with("jib", &link(0.7))
        .body("head", 3.0, vector![0.04, 0.01, -0.02], corner * 0.02)
        .translation(vector![0.05, 0.03, 0.02])
        .build()
        .unwrap()
}

fn in_gravity(chain: &Chain, wrench: Wrench) -> ChainProblem<'_> {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(wrench));
    problem.posture = chain.home_coordinates();
    problem.loads.push(Load::gravity(down()));
    problem
}

/// Both, at the equilibrium of a problem.
fn both(problem: &ChainProblem<'_>, held: &Held, count: usize) -> (Option<Modes>, Modes) {
    let at = solve_chain(problem, &Settings::default()).unwrap();
    let (x, w) = (&at.coordinates, &at.wrench);
    let long = LongChain::of_chain(problem, x, w, held).unwrap();
    let dense = LinearDynamics::of_chain(problem, x, w, held).unwrap();
    let found = long.and_then(|long| long.lowest_modes(count).unwrap());
    (found, dense.modes().unwrap())
}

#[track_caller]
fn agree(found: &Modes, dense: &Modes, count: usize) {
    assert_eq!(found.counts, dense.counts);
    let mut worst = Worst::new();
    assert!(
        found.modes.len() >= count.min(dense.modes.len()),
        "{}",
        found.modes.len()
    );
    for (own, other) in found.modes.iter().zip(&dense.modes) {
        assert_eq!(own.kind, other.kind);
        if own.kind != ModeKind::Free {
            worst.add(relative(own.frequency_hz(), other.frequency_hz()));
        }
    }
    let most = worst.of(found.modes.len() - found.counts.free);
    assert!(
        most < 1e-9,
        "{most} {:?} {:?}",
        found.frequencies_hz(),
        dense.frequencies_hz()
    );
}

#[test]
fn along_the_chain_and_dense_agree_under_loads() {
    for segments in [1, 2, 5, 12] {
        let chain = crane(segments);
        for force in [
            [0.0, 0.0, 0.0],
            [700.0, -400.0, -900.0],
            [-2500.0, 800.0, 300.0],
        ] {
            let wrench = Wrench::new(Vector3::from(force), Vector3::zeros());
            let problem = in_gravity(&chain, wrench);
            let (found, dense) = both(&problem, &Held::nothing(), 9);
            agree(&found.unwrap(), &dense, 9);
        }
    }
}

#[test]
fn motions_of_the_tool_in_a_mode_are_those_of_the_dense_matrices() {
    let chain = crane(6);
    let problem = in_gravity(
        &chain,
        Wrench::new(vector![300.0, -500.0, 100.0], Vector3::zeros()),
    );
    let (found, dense) = both(&problem, &Held::nothing(), 5);
    for (own, other) in found.unwrap().modes.iter().zip(&dense.modes) {
        // Shapes are unique but for their sign.
        let sign = own.tool.dot(&other.tool).signum();
        assert!((own.tool * sign - other.tool).norm() < 1e-7 * other.tool.norm());
    }
}

#[test]
fn a_held_end_is_held_along_the_chain_too() {
    let chain = crane(4);
    for directions in [
        [true; 6],
        [true, true, true, false, false, false],
        [false, false, true, false, true, false],
    ] {
        let wrench = Wrench::new(vector![150.0, -250.0, -600.0], Vector3::zeros());
        let problem = in_gravity(&chain, wrench);
        let mut held = Held::nothing();
        held.directions = directions;
        held.axes = nalgebra::Rotation3::from_scaled_axis(vector![0.3, -0.2, 0.5]);
        let (found, dense) = both(&problem, &held, 8);
        agree(&found.unwrap(), &dense, 8);
    }
}

#[test]
fn unstable_free_and_massless_directions_are_counted_alike() {
    // A straight column beyond its first, second and third critical load: 2.47 EI/L^2 and 22.2 in both planes.
    let column = Chain::builder("column")
        .link_with("beam", &thin_link(1.0, 6, 1.0))
        .build()
        .unwrap();
    for (push, unstable) in [(2e4, 1), (4e4, 2), (1.6e5, 3)] {
        let wrench = Wrench::new(vector![-push, 0.0, 0.0], Vector3::zeros());
        let problem = ChainProblem::new(&column, EndCondition::wrench(wrench));
        // The straight column, whatever it would do.
        let straight = {
            let held = ChainProblem::new(
                &column,
                EndCondition {
                    prescribed: [
                        Prescribed::Wrench,
                        Prescribed::Pose,
                        Prescribed::Pose,
                        Prescribed::Pose,
                        Prescribed::Pose,
                        Prescribed::Pose,
                    ],
                    pose: Pose::translation(1.0, 0.0, 0.0),
                    ..EndCondition::wrench(wrench)
                },
            );
            solve_chain(&held, &Settings::default())
                .unwrap()
                .coordinates
        };
        let nothing = Held::nothing();
        let long = LongChain::of_chain(&problem, &straight, &wrench, &nothing)
            .unwrap()
            .unwrap();
        let dense = LinearDynamics::of_chain(&problem, &straight, &wrench, &nothing).unwrap();
        let (found, dense) = (
            long.lowest_modes(2).unwrap().unwrap(),
            dense.modes().unwrap(),
        );
        assert_eq!(dense.counts.unstable, unstable, "{push}");
        agree(&found, &dense, 2);
    }
    // A boom that may turn about its root, without gravity: one free direction; a body without inertia: massless ones.
    let boom = Chain::builder("boom")
        .passive("pin", MotionKind::Revolute, vector![0.6, 0.0, 0.8], 0.0)
        .link_with("beam", &thin_link(1.2, 5, 1.0))
        .link_with("tip", &LinkSpec::beam(section(), 0.3))
        .body("load", 2.0, vector![0.0, 0.0, 0.1], Matrix3::zeros())
        .build()
        .unwrap();
    let problem = ChainProblem::new(&boom, EndCondition::wrench(Wrench::zero()));
    let x = boom.home_coordinates();
    let long = LongChain::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing())
        .unwrap()
        .unwrap();
    let dense = LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap();
    let (found, dense) = (
        long.lowest_modes(5).unwrap().unwrap(),
        dense.modes().unwrap(),
    );
    assert_eq!(dense.counts.free, 1);
    assert!(dense.counts.massless > 0);
    agree(&found, &dense, 5);
}

#[test]
fn what_it_does_not_serve_is_left_to_the_dense_matrices() {
    // A spin without mass and stiffness.
    let chain = Chain::builder("spin")
        .link_with("beam", &thin_link(1.0, 2, 1.0))
        .passive("spin", MotionKind::Revolute, Vector3::x(), 0.0)
        .build()
        .unwrap();
    let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    let x = chain.home_coordinates();
    let long = LongChain::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing())
        .unwrap()
        .unwrap();
    assert!(long.lowest_modes(3).unwrap().is_none());
    let bare = Chain::builder("bare")
        .link_with("beam", &LinkSpec::beam(section(), 1.0))
        .build()
        .unwrap();
    let problem = ChainProblem::new(&bare, EndCondition::wrench(Wrench::zero()));
    let long = LongChain::of_chain(&problem, &[0.0; 6], &Wrench::zero(), &Held::nothing())
        .unwrap()
        .unwrap();
    assert!(
        long.lowest_modes(1)
            .unwrap_err()
            .to_string()
            .contains("no mass")
    );
}

#[test]
fn long_beams_meet_the_continuum_without_a_limit_of_length() {
    // D1, clamped-free, exact in both planes: Iz for v, Iy for w.
    let other = (3e-8_f64 / 7e-8).sqrt();
    let hertz = [31.2621684, 195.916665, 548.572335];
    let mut expected: Vec<f64> = hertz.iter().flat_map(|f| [*f, f * other]).collect();
    expected.sort_by(f64::total_cmp);
    for segments in [64, 512] {
        let chain = Chain::builder("beam")
            .link_with("beam", &thin_link(1.0, segments, 1.0))
            .build()
            .unwrap();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let x = chain.home_coordinates();
        let long = LongChain::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing())
            .unwrap()
            .unwrap();
        let found = long.lowest_modes(6).unwrap().unwrap().frequencies_hz();
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                relative(*found, *expected).abs() < 3e-7,
                "{segments} {found} {expected}"
            );
        }
        assert!(relative(found[1], 31.2621684).abs() < 1e-8, "{}", found[1]);
    }
}

#[test]
fn a_machine_of_one_long_limb_goes_along_its_chain() {
    let arm = Matrix3::new(0.05, 0.004, 0.0, 0.004, 0.06, -0.01, 0.0, -0.01, 0.04);
    for segments in [3, 9] {
        let mut machine = Mechanism::builder("crane");
        let chain = crane(segments);
        let tip = kinetostat::model::Kinematics::new(
            &chain,
            &Pose::identity(),
            &chain.home_coordinates(),
            &[],
        )
        .tip_pose();
        let offset = Pose::new(vector![0.06, -0.02, 0.04], vector![0.2, 0.1, -0.3]);
        let hook = machine.platform(Platform {
            mass: 4.0,
            inertia: arm,
            centre_of_mass: vector![0.03, 0.02, -0.05],
            ..Platform::new("hook", tip * offset)
        });
        let mut limb = Limb::between("crane", 0, hook, chain);
        limb.platform_from_tip = offset.inverse();
        let machine = machine.limb(limb).gravity(down()).build().unwrap();
        let home = machine.platforms()[1].home;
        let posture = machine.posture(&home).unwrap();
        let at = posture
            .deflected_by(&Wrench::new(
                vector![-300.0, 120.0, -400.0],
                Vector3::zeros(),
            ))
            .unwrap();
        for held in [Held::nothing(), Held::directions(Directions::POSITION)] {
            let dense = LinearDynamics::of_machine(&posture, &at, &held)
                .unwrap()
                .modes()
                .unwrap();
            let long = LongChain::of_machine(&posture, &at, &held)
                .unwrap()
                .unwrap();
            agree(&long.lowest_modes(7).unwrap().unwrap(), &dense, 7);
            agree(&lowest_modes(&posture, &at, &held, 7).unwrap(), &dense, 7);
        }
    }
}

#[test]
fn the_six_axis_arm_along_its_chain() {
    // D3, with gravity.
    let chain = arm6();
    let problem = in_gravity(&chain, Wrench::zero());
    let (found, dense) = both(&problem, &Held::nothing(), 6);
    let found = found.unwrap();
    agree(&found, &dense, 6);
    assert!(relative(found.frequencies_hz()[0], 9.98746752).abs() < 1e-8);
}
