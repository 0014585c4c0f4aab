//! Machines of slender links reach what chains reach: axial stiffnesses of any ratio to bending, end
//! moments that roll a link up, forces far beyond small deflections, in as many steps.

use std::f64::consts::TAU;

use kinetostat::{spatial::pose_residual, *};
use nalgebra::{Vector3, vector};

use crate::fuzz_short::fuzz::rod::slender;

/// Of unit length and bending stiffness.
fn rod(segments: usize, axial: f64) -> Chain {
    let link = LinkSpec::beam(slender(axial), 1.0).segments(segments);
    Chain::builder("rod")
        .link_with("rod", &link)
        .build()
        .unwrap()
}

fn straight() -> Pose {
    Pose::new(vector![1.0, 0.0, 0.0], Vector3::zeros())
}

/// Equilibria of chain and machine.
fn both(chain: &Chain, wrench: Wrench) -> (Equilibrium, MechanismEquilibrium) {
    let problem = ChainProblem::new(chain, EndCondition::wrench(wrench));
    let alone = solve_chain(&problem, &Settings::default()).unwrap();
    let machine = Mechanism::serial(chain.clone(), straight(), Vector3::zeros()).unwrap();
    let posture = machine.posture(&straight()).unwrap();
    (alone, posture.deflected_by(&wrench).unwrap())
}

#[test]
fn slender_links_bend_alike_in_chains_and_machines() {
    // Few segments of the stiffest rod turn too far each to be a rod any more.
    let axial = [
        (8, 1e3),
        (8, 1e6),
        (8, 1e9),
        (32, 1e6),
        (32, 1e9),
        (32, 1e11),
    ];
    let loads = [
        (0.0, 1.0),
        (0.0, 3.0),
        (0.0, TAU),
        (1.0, 0.0),
        (10.0, 0.0),
        (100.0, 0.0),
        (30.0, -4.0),
    ];
    for (segments, axial) in axial {
        for (force, moment) in loads {
            let case = format!("{segments} segments, EA {axial:e}, force {force}, moment {moment}");
            let wrench = Wrench::new(vector![0.0, 0.2 * force, force], vector![0.0, moment, 0.0]);
            let (alone, machine) = both(&rod(segments, axial), wrench);
            let off = pose_residual(&alone.tip, &machine.tool).0.norm();
            assert!(off <= 1e-9, "{case}: off by {off:e}");
            let (a, b) = (
                alone.stability.share_to_buckling.unwrap(),
                machine.share_to_buckling().unwrap(),
            );
            assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "{case}: {a}, {b}");
            // Compared by motion, not by the residual, which grows with the axial stiffness.
            let (few, own) = (alone.residual.iterations, machine.residual.iterations);
            assert!(own <= 2 * few + 4, "{case}: {few}, {own} iterations");
        }
    }
}

/// A moment bends a rod to an arc: its tip is known whatever the axial stiffness.
#[test]
fn a_moment_rolls_a_long_machine_up() {
    for (segments, axial) in [(32, 1e6), (32, 1e11), (100, 1e6), (100, 1e11)] {
        for turn in [1.0, 3.0, TAU] {
            let wrench = Wrench::new(Vector3::zeros(), vector![0.0, turn, 0.0]);
            let (_, machine) = both(&rod(segments, axial), wrench);
            let tip = machine.tool.translation.vector;
            let arc = vector![turn.sin() / turn, 0.0, (turn.cos() - 1.0) / turn];
            // Segments turn by their own small angle in the middle.
            let coarse = (turn / segments as f64).powi(2);
            let off = (tip - arc).norm();
            assert!(off <= coarse, "{segments}, {axial:e}, {turn}: {tip}, {arc}");
        }
    }
}

#[test]
fn curves_reach_what_chains_reach() {
    for (segments, axial, force, moment) in [
        (10, 1e11, [0.0; 3], [0.0, 1.0, 2.0]),
        (10, 1e11, [0.0; 3], [1.0, 0.0, 3.0]),
        (10, 1e10, [0.0; 3], [0.0, 0.0, 3.0]),
        (4, 1e9, [0.0, 5.0, 5.0], [0.0; 3]),
        (8, 1e13, [0.0, 10.0, 0.0], [0.0; 3]),
    ] {
        let chain = rod(segments, axial);
        let wrench = Wrench::new(Vector3::from(force), Vector3::from(moment));
        let loaded = ChainProblem::new(&chain, EndCondition::wrench(wrench));
        let there = solve_chain(&loaded, &Settings::default()).unwrap();
        let still = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let rest = solve_chain(&still, &Settings::default()).unwrap();
        let grown = Parameter::end_wrench(wrench);
        let settings = CurveSettings::within(0.0, 1.0);
        let curves = follow(&still, &grown, &rest, 0.0, &settings).unwrap();
        let last = curves.branches[0].points.last().unwrap();
        assert!(
            (last.parameter - 1.0).abs() < 1e-9,
            "{segments} {axial:e}: the curve ends at {}",
            last.parameter
        );
        let off = pose_residual(&there.tip, &last.equilibrium.tip).0.norm();
        assert!(off < 1e-5, "{segments} {axial:e}: {off:e}");
    }
}
