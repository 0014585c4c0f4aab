//! Jacobians, Hessians, symmetry and energy of random chains and machines, on fixed seeds.

use super::{Figures, Worst};
use crate::common::invariants::antisymmetric_error;
use crate::common::{Orthoglide, Recipe, Rng, golden, orthoglide_point, random_chain};
use crate::energy_equals_work::{balance_of_chain, balance_of_machine};
use crate::jacobians_are_derivatives::{hessian_error, jacobian_error};
use crate::orthoglide_reference::milling;
use crate::stored_stiffness_is_the_derivative_of_the_wrench::loaded_stiffness_error;
use kinetostat::{
    EndCondition, Load, Mechanism, Settings, Twist, Wrench, solve_chain, spatial::moved,
};
use nalgebra::Vector3;

const CHAINS: u64 = 24;
/// Chains whose iteration does not end, and shapes too near their loss of stability to be
/// differenced, are left out; this many at least must be left.
pub const LEAST: usize = 20;
pub const OF: &str = "of 24 chains (floor of this measurement)";
const TEST: &str = "relative (test's tolerance)";

pub fn seeds() -> impl Iterator<Item = u64> {
    (0..CHAINS).map(|i| 0xf1_6000 + i)
}

pub fn one_degree() -> Mechanism {
    Orthoglide {
        line_error: 1_f64.to_radians(),
        ..Default::default()
    }
    .build()
}

#[test]
fn jacobians_and_hessians_against_central_differences() {
    let (mut worst, mut hessian) = (Worst::new(), Worst::new());
    for seed in seeds() {
        worst.add(jacobian_error(seed).0);
        hessian.add(hessian_error(seed));
    }
    let mut f = Figures::new();
    f.at_most(
        "Random chains: Jacobians of all nodes against central differences",
        &worst,
        2e-10,
        "m/m, m/rad, rad/rad (test's tolerance)",
    );
    f.at_most(
        "Random chains: Hessians of wrenches on all nodes against central differences",
        &hessian,
        1e-6,
        TEST,
    );
    f.finish();
}

#[test]
fn stored_stiffness_against_resolved_differences() {
    let (mut bordered, mut resolved) = (Worst::new(), Worst::new());
    let (mut found, mut differenced) = (0, 0);
    for error in seeds().filter_map(loaded_stiffness_error) {
        found += 1;
        bordered.add(error.bordered);
        if let Some(error) = error.resolved {
            differenced += 1;
            resolved.add(error);
        }
    }
    let mut f = Figures::new();
    let name = "Random chains under node loads, weight and preload";
    f.at_most(
        &format!("{name}: K_C against re-solved differences"),
        &resolved,
        1e-6,
        TEST,
    );
    f.at_most(
        &format!("{name}: K_C against Hessians in column form"),
        &bordered,
        1e-9,
        TEST,
    );
    f.at_least(&format!("{name}: equilibria found"), found, LEAST, OF);
    f.at_least(&format!("{name}: differenced"), differenced, LEAST, OF);
    f.finish();
}

/// Of a chain under forces on two nodes, weight and preload, held away from rest.
fn antisymmetric_error_of_chain(seed: u64) -> Option<f64> {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        stages: 3,
        preload: 0.05,
        ..Recipe::default()
    };
    let r = random_chain(&mut rng, &recipe);
    let target = moved(&r.tip(), &Twist::new(rng.vector(0.01), rng.vector(0.03)));
    let mut problem = r.problem(EndCondition::pose(target));
    problem.loads = vec![Load::Gravity(rng.axis() * 9.81)];
    for _ in 0..2 {
        // A dead moment on an inner node has no such simple rule.
        problem.loads.push(Load::Dead {
            node: rng.below(r.chain.nodes().len()),
            wrench: Wrench::new(rng.vector(150.0), Vector3::zeros()),
        });
    }
    let e = solve_chain(&problem, &Settings::default()).ok()?;
    let k = e.stiffness.cartesian.matrix;
    Some(antisymmetric_error(
        &k,
        &e.wrench.moment(),
        r.chain.scale().length,
    ))
}

#[test]
fn what_is_not_symmetric_in_the_stiffness() {
    let (mut chains, mut machine, mut found) = (Worst::new(), Worst::new(), 0);
    for error in seeds().filter_map(antisymmetric_error_of_chain) {
        found += 1;
        chains.add(error);
    }
    let orthoglide = one_degree();
    let wrench = milling(&golden("orthoglide_milling.json"));
    for index in 0..5 {
        let posture = orthoglide.posture(&orthoglide_point(index)).unwrap();
        let e = posture.deflected_by(&wrench).unwrap();
        let reach = orthoglide.limbs()[0].actual.scale().length;
        machine.add(antisymmetric_error(
            &e.stiffness.matrix,
            &wrench.moment(),
            reach,
        ));
    }
    let mut f = Figures::new();
    let name = "K_C - K_C^T = blkdiag(0, -hat(m))";
    f.at_most(
        &format!("{name}, random chains under load"),
        &chains,
        1e-9,
        TEST,
    );
    f.at_least(
        &format!("{name}, random chains: equilibria found"),
        found,
        LEAST,
        OF,
    );
    f.at_most(
        &format!("{name}, Orthoglide under load"),
        &machine,
        1e-9,
        TEST,
    );
    f.finish();
}

#[test]
fn energy_minus_work() {
    let (mut chains, mut machine, mut found) = (Worst::new(), Worst::new(), 0);
    for energy in seeds().filter_map(balance_of_chain) {
        found += 1;
        chains.add(energy.error());
    }
    (0..5).for_each(|index| machine.add(balance_of_machine(index).error()));
    let mut f = Figures::new();
    let name = "Energy minus work";
    f.at_most(
        &format!("{name}, random chains along a path"),
        &chains,
        1e-7,
        TEST,
    );
    f.at_least(
        &format!("{name}, random chains: paths found"),
        found,
        LEAST,
        OF,
    );
    f.at_most(
        &format!("{name}, Orthoglide loaded slowly"),
        &machine,
        1e-9,
        TEST,
    );
    f.finish();
}
