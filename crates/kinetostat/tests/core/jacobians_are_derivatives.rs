//! `J_j` of every node is the derivative of that node's pose by coordinates, commands and motions of
//! the base, on random spatial chains with off-axis geometry.

use crate::common::{Recipe, Rng, cases, random_chain};
use kinetostat::{
    Twist, Wrench,
    model::Kinematics,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::LargestEntry;
use nalgebra::{DVector, Vector6};
use proptest::prelude::*;

/// Largest difference of the Jacobians of all nodes of a random chain from fourth-order central
/// differences of the nodes' poses, and where it is.
pub fn jacobian_error(seed: u64) -> (f64, String) {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        passive: 5,
        ..Recipe::default()
    };
    let r = random_chain(&mut rng, &recipe);
    let (n, c) = (r.chain.coordinate_count(), r.commands.len());
    let x: Vec<f64> = r.posture.iter().map(|v| v + 0.3 * rng.signed()).collect();
    let kinematics = Kinematics::with_moving_base(&r.chain, &r.base, &x, &r.commands);
    assert_eq!(kinematics.velocity_count(), n + c + 6);
    let at = |index: usize, s: f64| {
        let (mut x, mut commands, mut base) = (x.clone(), r.commands.clone(), r.base);
        if index < n {
            x[index] += s;
        } else if index < n + c {
            commands[index - n] += s;
        } else {
            let mut t = Vector6::zeros();
            t[index - n - c] = s;
            base = moved(&base, &Twist(t));
        }
        Kinematics::with_moving_base(&r.chain, &base, &x, &commands)
    };
    let h = 2e-3;
    let mut worst = (0.0, String::new());
    for index in 0..n + c + 6 {
        let near: Vec<_> = [-2.0, -1.0, 1.0, 2.0]
            .iter()
            .map(|s| at(index, s * h))
            .collect();
        for node in 0..r.chain.nodes().len() {
            let centre = kinematics.node_pose(node);
            let d: Vec<_> = near
                .iter()
                .map(|k| pose_residual(&k.node_pose(node), &centre).0)
                .collect();
            let column = (8.0 * (d[2] - d[1]) - (d[3] - d[0])) / (12.0 * h);
            let error = (column - kinematics.jacobian(node).column(index)).largest_entry();
            // NaN counts as the worst.
            if error.is_nan() || error > worst.0 {
                worst = (error, format!("node {node} velocity {index}"));
            }
        }
    }
    worst
}

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn jacobians_at_every_node_agree_with_differences(seed in any::<u64>()) {
        let (error, place) = jacobian_error(seed);
        prop_assert!(error < 2e-10, "{place}: {error:e}");
    }
}

#[test]
fn tiny_rigid_rotations_are_kept() {
    for angle in [1e-7, 2e-8, 1e-9] {
        let chain = kinetostat::Chain::builder("c")
            .rigid(kinetostat::Pose::rotation(nalgebra::Vector3::z() * angle))
            .translation(nalgebra::Vector3::x() * 2.0)
            .build()
            .unwrap();
        let tip = kinetostat::model::unloaded_tip(&chain, &kinetostat::Pose::identity(), &[], &[]);
        let found = tip.translation.vector.y;
        assert!(
            (found / (2.0 * angle) - 1.0).abs() < 1e-6,
            "{angle:e}: {found:e}"
        );
    }
}

/// Largest difference of the Hessian of dead wrenches on all nodes of a random chain from
/// fourth-order central differences of their torques, as a share of its largest entry.
pub fn hessian_error(seed: u64) -> f64 {
    let mut rng = Rng(seed);
    let r = random_chain(&mut rng, &Recipe::default());
    let x: Vec<f64> = r.posture.iter().map(|v| v + 0.3 * rng.signed()).collect();
    let wrenches: Vec<(usize, Wrench)> = (0..r.chain.nodes().len())
        .map(|node| (node, rng.wrench(300.0, 40.0)))
        .collect();
    let n = r.chain.coordinate_count();
    let at = |x: &[f64]| Kinematics::new(&r.chain, &r.base, x, &r.commands);
    let torques = |j: usize, s: f64| {
        let mut x = x.clone();
        x[j] += s;
        let k = at(&x);
        wrenches
            .iter()
            .fold(DVector::zeros(k.velocity_count()), |sum, (node, w)| {
                sum + k.jacobian(*node).transpose() * w.0
            })
    };
    let hessian = at(&x).hessian(&wrenches);
    let h = 2e-3;
    let mut worst = 0.0_f64;
    for j in 0..n {
        let column = (8.0 * (torques(j, h) - torques(j, -h))
            - (torques(j, 2.0 * h) - torques(j, -2.0 * h)))
            / (12.0 * h);
        for i in 0..n {
            let error = (hessian[(i, j)] - column[i]).abs() / hessian.largest_entry();
            // NaN counts as the worst.
            if error.is_nan() || error > worst {
                worst = error;
            }
        }
    }
    worst
}

#[test]
fn the_hessian_is_the_derivative_of_the_torques_of_dead_wrenches_on_any_node() {
    for seed in 0..20 {
        let error = hessian_error(0x4e55 + seed);
        assert!(error < 1e-6, "seed {seed}: off by {error:e}");
    }
}
