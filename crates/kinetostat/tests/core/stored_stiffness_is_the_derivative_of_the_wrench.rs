//! The stored `K_C` under load (node loads with moments, gravity, preload, an end wrench with a
//! moment) is the derivative of the re-solved wrench, and agrees with a bordered system in column
//! form. This is the proof of the Hessian, which has no public face of its own.

use std::sync::Arc;

use crate::common::{Recipe, Rng, assert_chain_equilibrium, cases, random_chain, scaled_error};
use crate::oracle::{self, Frames};
use kinetostat::{
    ChainProblem, EndCondition, Equilibrium, Load, NodeLoad, Settings, Twist, Wrench,
    model::{Kinematics, NodeTangent},
    solve_chain,
    spatial::moved,
};
use kinetostat_testing::largest;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use proptest::prelude::*;

fn tight() -> Settings {
    Settings::default().with_torque(1e-13).with_closure(1e-14)
}

/// Fourth-order differences of the wrench over re-solved poses.
pub fn differences(problem: &ChainProblem<'_>, e: &Equilibrium, h: f64) -> Matrix6<f64> {
    let mut k = Matrix6::zeros();
    for column in 0..6 {
        let at = |s: f64| {
            let mut t = Vector6::zeros();
            t[column] = s * h;
            let mut next = problem.clone();
            next.end = EndCondition::pose(moved(&e.tip, &Twist(t)));
            let found = solve_chain(&next, &tight())
                .or_else(|_| solve_chain(&next, &Settings::default()))
                .expect("neighbour");
            // The same branch: coordinates move little.
            let jump = found
                .coordinates
                .iter()
                .zip(&e.coordinates)
                .map(|(a, b)| (a - b).abs());
            let jump = largest(jump);
            assert!(jump < 0.2, "the neighbour is another shape: {jump}");
            found.wrench.0
        };
        k.set_column(
            column,
            &((8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h)),
        );
    }
    k
}

/// Dead wrenches on two nodes and weight.
fn loads(rng: &mut Rng, nodes: usize, force: f64) -> Vec<Load> {
    let mut list = vec![Load::Gravity(rng.axis() * 9.81)];
    for _ in 0..2 {
        list.push(Load::Dead {
            node: rng.below(nodes),
            wrench: rng.wrench(force, 0.1 * force),
        });
    }
    list
}

/// How far the stored `K_C` of a loaded random chain is from other ways to it.
pub struct StiffnessError {
    /// From the bordered system with Hessians in column form.
    pub bordered: f64,
    /// From differences of re-solved wrenches; not taken near a shape's loss of stability.
    pub resolved: Option<f64>,
}

/// `None` where no equilibrium was found: counted by the robustness test.
pub fn loaded_stiffness_error(seed: u64) -> Option<StiffnessError> {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        stages: 3,
        passive: 3,
        preload: 0.05,
        ..Recipe::default()
    };
    let r = random_chain(&mut rng, &recipe);
    let target = moved(&r.tip(), &Twist::new(rng.vector(0.01), rng.vector(0.03)));
    let mut problem = r.problem(EndCondition::pose(target));
    problem.loads = loads(&mut rng, r.chain.nodes().len(), 150.0);
    let e = solve_chain(&problem, &Settings::default()).ok()?;
    assert_chain_equilibrium(&problem, &e);

    let k = e.stiffness.cartesian.matrix;
    let frames = Frames::new(&r.chain, &r.base, &e.coordinates, &r.commands);
    let (_, springs, _) = oracle::springs(&r.chain, &e.coordinates, &problem.posture);
    let mut wrenches = crate::common::invariants::node_wrenches(&problem);
    wrenches.push((frames.tip(), e.wrench));
    let own = oracle::chain_stiffness(&r.chain, &frames, &springs, &wrenches);

    let resolved = e
        .stability
        .share_to_buckling
        .is_none_or(|mu| mu < 0.9)
        .then(|| {
            let mut near = problem.clone();
            // Start where the neighbours are, so that no other branch is found.
            near.posture.clone_from(&e.coordinates);
            scaled_error(&k, &differences(&near, &e, 1e-4))
        });
    Some(StiffnessError {
        bordered: scaled_error(&k, &own),
        resolved,
    })
}

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn loaded_stiffness_agrees_with_resolved_differences(seed in any::<u64>()) {
        let Some(error) = loaded_stiffness_error(seed) else { return Ok(()); };
        prop_assert!(error.bordered < 1e-9, "bordered oracle: {:e}", error.bordered);
        if let Some(error) = error.resolved {
            prop_assert!(error < 1e-6, "differences: {error:e}");
        }
    }

    #[test]
    fn chains_without_passive_joints_answer_a_wrench_with_the_inverse_stiffness(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 0, preload: 0.03, ..Recipe::default() });
        let wrench = rng.wrench(120.0, 15.0);
        let mut problem = r.problem(EndCondition::wrench(wrench));
        problem.loads = loads(&mut rng, r.chain.nodes().len(), 60.0);
        let e = solve_chain(&problem, &tight()).or_else(|_| solve_chain(&problem, &Settings::default())).unwrap();
        assert_chain_equilibrium(&problem, &e);
        let c = e.stiffness.cartesian.compliance().unwrap();
        let mut k = Matrix6::zeros();
        let unit = [1.0, 1.0, 1.0, 0.1, 0.1, 0.1];
        for column in 0..6 {
            let at = |s: f64| {
                let mut w = wrench;
                w.0[column] += s * unit[column];
                let mut next = problem.clone();
                next.end = EndCondition::wrench(w);
                next.posture.clone_from(&e.coordinates);
                let found = solve_chain(&next, &Settings::default()
.with_torque(1e-13)).unwrap();
                kinetostat::spatial::pose_residual(&found.tip, &e.tip).0
            };
            k.set_column(column, &((8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * unit[column])));
        }
        let error = scaled_error(&c, &k);
        prop_assert!(error < 1e-6, "compliance: {error:e}");
    }
}

/// A force that follows its node, and a linear spring from a node to the ground: loads with a
/// tangent.
#[derive(Debug)]
struct Moving {
    node: usize,
    follower: Vector3<f64>,
    spring: Matrix3<f64>,
    anchor: Vector3<f64>,
}

impl NodeLoad for Moving {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        let pose = kinematics.node_pose(self.node);
        let pull = self.spring * (self.anchor - pose.translation.vector);
        out.push((
            self.node,
            Wrench::new(pose.rotation * self.follower + pull, Vector3::zeros()),
        ));
    }
    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        let pose = kinematics.node_pose(self.node);
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&-self.spring);
        let f = pose.rotation * self.follower;
        matrix
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-f.cross_matrix());
        out.push(NodeTangent {
            on: self.node,
            by: self.node,
            matrix,
        });
    }
}

proptest! {
    #![proptest_config(cases(12))]
    #[test]
    fn loads_that_follow_the_chain_enter_with_their_tangent(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 2, ..Recipe::default() });
        let target = moved(&r.tip(), &Twist::new(rng.vector(0.004), rng.vector(0.01)));
        let mut problem = r.problem(EndCondition::pose(target));
        let node = rng.below(r.chain.nodes().len());
        let a = Matrix3::from_fn(|_, _| rng.signed());
        problem.loads = vec![Load::Custom(Arc::new(Moving {
            node,
            follower: rng.vector(100.0),
            spring: (Matrix3::identity() + a * a.transpose()) * 3e3,
            anchor: rng.vector(0.3),
        }))];
        let Ok(e) = solve_chain(&problem, &Settings::default()) else { return Ok(()); };
        prop_assert!(e.residual.torque < 1e-9);
        let mut near = problem.clone();
        near.posture.clone_from(&e.coordinates);
        let d = differences(&near, &e, 1e-4);
        let error = scaled_error(&e.stiffness.cartesian.matrix, &d);
        prop_assert!(error < 1e-6, "differences: {error:e}");
    }
}
