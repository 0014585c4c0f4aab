//! How often the iterations find an equilibrium that exists: a chain of springs can be held at any
//! pose, so every failure is the solver's.

use crate::common::{
    Orthoglide, Recipe, Rng, assert_chain_equilibrium, assert_equilibrium, orthoglide_point,
    random_chain,
};
use kinetostat::{EndCondition, Settings, Twist, Wrench, solve_chain, spatial::moved};
use nalgebra::{Vector3, vector};

/// Solved cases of `count`, for displacements of the given size.
fn solved(count: u64, passive: usize, d: f64, angle: f64) -> u64 {
    (0..count)
        .filter(|seed| {
            let mut rng = Rng(0xabc0 + seed);
            let r = random_chain(
                &mut rng,
                &Recipe {
                    stages: 3,
                    passive,
                    ..Recipe::default()
                },
            );
            let target = moved(&r.tip(), &Twist::new(rng.axis() * d, rng.axis() * angle));
            let problem = r.problem(EndCondition::pose(target));
            let found = solve_chain(&problem, &Settings::default());
            match &found {
                Ok(e) => assert_chain_equilibrium(&problem, e),
                Err(e) => assert!(e.is_unanswered(), "{e}"),
            }
            found.is_ok()
        })
        .count() as u64
}

#[test]
fn held_chains_are_solved_from_rest() {
    // Displacement m, rotation rad, passive joints, least share solved.
    for (d, angle, passive, least) in [
        (0.005, 0.02, 0, 100),
        (0.005, 0.02, 3, 96),
        (0.05, 0.2, 0, 100),
        (0.05, 0.2, 3, 90),
        (0.2, 0.8, 0, 90),
        (0.2, 0.8, 3, 75),
    ] {
        let found = solved(100, passive, d, angle);
        println!("{d} m, {angle} rad, {passive} passive: {found} of 100");
        assert!(
            found >= least,
            "{d} m, {angle} rad, {passive} passive: {found} of 100"
        );
    }
}

#[test]
fn the_orthoglide_is_solved_far_beyond_its_milling_loads() {
    let machine = Orthoglide {
        line_error: 0.035,
        ..Default::default()
    }
    .build();
    let (mut found, mut all) = (0, 0);
    for index in 0..5 {
        let posture = machine.posture(&orthoglide_point(index)).unwrap();
        for share in [1.0, 2.0, 3.0] {
            all += 1;
            let wrench = Wrench::new(
                vector![215.0, -10.0, -25.0] * share,
                vector![1.0, 21.5, 0.0] * share,
            );
            match posture.deflected_by(&wrench) {
                Ok(e) => {
                    assert_equilibrium(&posture, &e);
                    found += 1;
                }
                Err(e) => println!("Q{index} x {share}: {e}"),
            }
        }
    }
    println!("orthoglide: {found} of {all}");
    assert!(found >= all - 1, "{found} of {all}");
}

#[test]
fn a_wrench_on_a_soft_arm_bends_it_far() {
    // Cantilever of four soft segments under a growing dead force: elastica-like, 60 deg and more.
    let section = kinetostat::BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: 1e6,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 0.8,
    };
    let mut b = kinetostat::Chain::builder("soft");
    for i in 0..16 {
        b = b.link(&format!("s{i}"), &section, 1.0 / 16.0);
    }
    let chain = b.build().unwrap();
    // Exact elastica at P L^2 / E I = 10: w / L = 0.810609, 16 TR segments come within 0.3 %.
    for (load, least) in [(1.0, 0.30), (3.0, 0.60), (10.0, 0.80)] {
        let problem = kinetostat::ChainProblem::new(
            &chain,
            EndCondition::wrench(Wrench::new(vector![0.0, load, 0.0], Vector3::zeros())),
        );
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        assert_chain_equilibrium(&problem, &e);
        let w = e.tip.translation.vector.y;
        println!("load {load}: w/L {w}");
        assert!(w > least && w < 0.83);
        if load == 10.0 {
            assert!((w - 0.810_609_024_880).abs() < 0.003, "{w}");
        }
    }
}
