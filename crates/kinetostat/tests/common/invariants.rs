//! What holds for every equilibrium, whoever asked for it. Checked against the oracle's kinematics
//! and statics, never against the core's own.

use kinetostat::{
    ChainProblem, Equilibrium, Load, MechanismEquilibrium, Posture, Prescribed, Wrench,
    chain::ShapeStability, spatial::hat,
};
use kinetostat_testing::{LargestEntry, largest, largest_size};
use nalgebra::{DVector, Matrix6, Vector3};

use crate::oracle::{Flat, Frames, springs};

/// `K - K^T - blkdiag(0, -hat(m))` as a share of the size of `K`, rotations measured at `length`.
pub fn antisymmetric_error(k: &Matrix6<f64>, moment: &Vector3<f64>, length: f64) -> f64 {
    let mut expected = Matrix6::zeros();
    expected
        .fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&-hat(moment));
    let unit = |i: usize| if i < 3 { 1.0 } else { 1.0 / length };
    let scaled = |m: &Matrix6<f64>| Matrix6::from_fn(|i, j| m[(i, j)] * unit(i) * unit(j));
    scaled(&(k - k.transpose() - expected)).largest_entry() / scaled(k).largest_entry().max(1e-300)
}

#[track_caller]
pub fn assert_antisymmetric_part(
    k: &Matrix6<f64>,
    moment: &Vector3<f64>,
    length: f64,
    tolerance: f64,
) {
    let left = antisymmetric_error(k, moment, length);
    assert!(
        left <= tolerance,
        "K - K^T is not blkdiag(0, -hat(m)): off by {left:.2e}"
    );
}

#[track_caller]
fn assert_stability_is_consistent(s: &ShapeStability) {
    if let Some(mu) = s.share_to_buckling {
        assert!(!mu.is_nan(), "the share is NaN");
        assert_eq!(s.stable, mu < 1.0, "stability and share disagree: {mu}");
    } else {
        assert!(s.stable, "no inner freedom but unstable");
    }
    assert!(s.mode.iter().all(|x| x.is_finite()), "mode {:?}", s.mode);
}

/// Wrenches on the nodes of a chain problem, the end's own excluded (dead loads and gravity only).
pub fn node_wrenches(problem: &ChainProblem<'_>) -> Vec<(usize, Wrench)> {
    let mut list = Vec::new();
    for load in &problem.loads {
        match load {
            Load::Dead { node, wrench } => list.push((*node, *wrench)),
            Load::Gravity(g) => list.extend(
                problem
                    .chain
                    .bodies()
                    .iter()
                    .map(|b| (b.node, Wrench::new(g * b.mass, Vector3::zeros()))),
            ),
            _ => panic!("loads that move with the chain have their own test"),
        }
    }
    list
}

/// Closure, torques, forces, energy, tangent and stability of a chain's equilibrium.
#[track_caller]
pub fn assert_chain_equilibrium(problem: &ChainProblem<'_>, e: &Equilibrium) {
    let chain = problem.chain;
    let finite = e
        .coordinates
        .iter()
        .chain(e.spring_torques.iter())
        .chain(e.wrench.0.iter())
        .chain(e.stiffness.cartesian.matrix.iter())
        .chain(e.stiffness.passive.iter())
        .chain(e.stiffness.springs.iter())
        .all(|x| x.is_finite());
    assert!(finite, "a number is not finite");
    let frames = Frames::new(chain, &problem.base, &e.coordinates, &problem.commands);
    let scale = chain.scale();
    let tip = frames.pose_residual(frames.tip(), &e.tip);
    assert!(tip.norm() < 1e-12 * scale.length.max(1.0), "tip: {tip}");
    for (node, pose) in e.nodes.iter().enumerate() {
        assert!(
            frames.pose_residual(node, pose).norm() < 1e-12 * scale.length.max(1.0),
            "node {node}"
        );
    }

    // End condition, per direction.
    let tip_residual = frames.pose_residual(frames.tip(), &problem.end.pose);
    let back = problem.end.axes.inverse();
    let (d, w) = (
        back * tip_residual.fixed_rows::<3>(0),
        back * tip_residual.fixed_rows::<3>(3),
    );
    let wrench_residual = Wrench(problem.end.wrench.0 - e.wrench.0).rotated(&back);
    let forces = e.wrench.0.largest_entry().max(1e-6);
    for k in 0..6 {
        match problem.end.prescribed[k] {
            Prescribed::Pose => {
                let off = if k < 3 { d[k] } else { w[k - 3] * scale.length };
                assert!(
                    off.abs() <= 1e-11 * scale.length,
                    "direction {k} misses by {off:.2e} m"
                );
            }
            Prescribed::Wrench => assert!(
                wrench_residual.0[k].abs() <= 1e-8 * forces,
                "direction {k} lacks {:.2e} of {forces:.2e}",
                wrench_residual.0[k]
            ),
        }
    }

    // Torques, springs against loads, with the oracle's Jacobians.
    let mut wrenches = node_wrenches(problem);
    wrenches.push((frames.tip(), e.wrench));
    let torque = frames.torque(&wrenches);
    let (spring, k, energy) = springs(chain, &e.coordinates, &problem.posture);
    let scaled = |v: &DVector<f64>, i: usize| {
        let stiffness = k[(i, i)];
        if stiffness > 0.0 {
            v[i] / stiffness.sqrt()
        } else {
            v[i] / (scale.stiffness.sqrt() * scale.length)
        }
    };
    let sizes = (0..torque.len()).flat_map(|i| [scaled(&spring, i), scaled(&torque, i)]);
    let size = largest_size(sizes.chain([
        1e-6 * scale.stiffness.sqrt() * scale.length,
        e.wrench.force().norm() / scale.stiffness.sqrt(),
        e.wrench.moment().norm() / (scale.stiffness.sqrt() * scale.length),
    ]));
    for i in 0..torque.len() {
        let left = (scaled(&torque, i) - scaled(&spring, i)).abs();
        assert!(
            left <= 1e-9 * size,
            "torque {i} unbalanced by {left:.2e} of {size:.2e} {:?}",
            e.residual
        );
        let reported = (e.spring_torques[i] - spring[i]).abs();
        assert!(
            reported <= 1e-9 * spring.largest_entry().max(1e-9),
            "spring torque {i}"
        );
    }
    assert!(e.energy >= 0.0, "energy {}", e.energy);
    assert!(
        (e.energy - energy).abs() <= 1e-10 * energy.max(1e-12),
        "energy"
    );
    // Dead moments on inner nodes have no potential either, and no such simple rule.
    let inner = node_wrenches(problem)
        .iter()
        .any(|(_, w)| w.moment() != Vector3::zeros());
    let rigid = e
        .stiffness
        .directions
        .iter()
        .any(|d| d.stiffness_n_per_m.is_infinite());
    if !inner && !rigid {
        assert_antisymmetric_part(
            &e.stiffness.cartesian.matrix,
            &e.wrench.moment(),
            scale.length,
            1e-9,
        );
    }
    assert_eq!(e.stiffness.directions.len(), 6);
    assert_stability_is_consistent(&e.stability);
}

/// Closure, equilibrium of every platform about its own origin, torques of every limb, energy, tangent
/// and stability of a mechanism's equilibrium.
#[track_caller]
pub fn assert_equilibrium(posture: &Posture, e: &MechanismEquilibrium) {
    let m = posture.mechanism();
    let flat = Flat::at_state(posture, &e.state, &e.wrench);
    let rows = flat.residual();
    assert!(rows.iter().all(|x| x.is_finite()), "a number is not finite");
    assert!(
        e.stiffness.matrix.iter().all(|x| x.is_finite()),
        "stiffness is not finite"
    );
    let wrenches = || e.limbs.iter().map(|l| &l.wrench).chain([&e.wrench]);
    let force = largest(wrenches().map(|w| w.force().norm()));
    let moment = largest(wrenches().map(|w| w.moment().norm()));
    let reach = largest(m.limbs().iter().map(|l| l.actual.scale().length));
    let forces = (force + moment / reach).max(1e-6);
    let moving = m.platforms().len() - 1;
    for (i, left) in rows.rows(0, 6 * moving).iter().enumerate() {
        let size = if i % 6 < 3 { forces } else { forces * reach };
        assert!(
            left.abs() <= 1e-8 * size,
            "platform {} row {}: {left:.2e} of {size:.2e}",
            i / 6 + 1,
            i % 6
        );
    }
    let mut at = 6 * moving;
    for (i, limb) in m.limbs().iter().enumerate() {
        let n = e.state.coordinates[i].len();
        let own = limb.actual.scale().length;
        for k in 0..6 {
            let off = rows[at + k] * if k < 3 { 1.0 } else { own };
            assert!(
                off.abs() <= 1e-11 * own,
                "limb {i} misses by {off:.2e} m in direction {k}"
            );
        }
        let (spring, k, energy) = springs(
            &limb.actual,
            &e.state.coordinates[i],
            &posture.limbs()[i].coordinates,
        );
        for j in 0..n {
            // Each torque in the unit that its own spring gives it.
            let unit = if k[(j, j)] > 0.0 {
                k[(j, j)].sqrt()
            } else {
                limb.actual.scale().stiffness.sqrt() * own
            };
            // A coordinate without a spring, or a NaN, counts by the residual alone.
            let torques = (0..n).map(|j| spring[j].abs() / k[(j, j)].max(1e-300).sqrt());
            let all = largest(
                torques
                    .filter(|x| x.is_finite())
                    .chain([forces / limb.actual.scale().stiffness.sqrt()]),
            );
            let left = rows[at + 6 + j].abs() / unit;
            assert!(
                left <= 1e-8 * all,
                "limb {i} torque {j}: {left:.2e} of {all:.2e}"
            );
            assert!(
                (e.limbs[i].spring_torques[j] - spring[j]).abs()
                    <= 1e-9 * spring.largest_entry().max(1e-9),
                "limb {i} spring torque {j}"
            );
        }
        assert!(e.limbs[i].energy >= 0.0);
        assert!((e.limbs[i].energy - energy).abs() <= 1e-9 * energy.max(1e-12));
        assert_eq!(e.limbs[i].wrench, e.state.wrenches[i]);
        assert_eq!(e.limbs[i].coordinates, e.state.coordinates[i]);
        assert_stability_is_consistent(&e.limbs[i].stability);
        at += 6 + n;
    }
    assert_antisymmetric_part(&e.stiffness.matrix, &e.wrench.moment(), reach, 1e-9);
    assert!(
        e.residual.torque <= 1e-8 && e.residual.closure_m <= 1e-9 * reach,
        "{:?}",
        e.residual
    );
}
