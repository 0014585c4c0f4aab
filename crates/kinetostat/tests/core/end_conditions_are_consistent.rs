//! Pose prescribed, wrench prescribed, or a mixture per direction in any axes: one equilibrium.

use crate::common::{Recipe, Rng, assert_chain_equilibrium, cases, random_chain};
use kinetostat::{
    EndCondition, Load, Prescribed, Settings, Twist, Wrench, solve_chain,
    spatial::{moved, pose_residual},
};
use nalgebra::Rotation3;
use proptest::prelude::*;

fn tight() -> Settings {
    Settings::default().with_torque(1e-12)
}

proptest! {
    #![proptest_config(cases(32))]
    #[test]
    fn wrench_pose_and_mixture_find_the_same_equilibrium(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 0, preload: 0.03, ..Recipe::default() });
        let loads = vec![
            Load::Gravity(rng.axis() * 9.81),
            Load::Dead { node: rng.below(r.chain.nodes().len()), wrench: rng.wrench(60.0, 5.0) },
        ];
        let wrench = rng.wrench(100.0, 10.0);
        let mut problem = r.problem(EndCondition::wrench(wrench));
        problem.loads = loads;
        let a = solve_chain(&problem, &tight()).unwrap();
        assert_chain_equilibrium(&problem, &a);

        problem.end = EndCondition::pose(a.tip);
        let b = solve_chain(&problem, &tight()).unwrap();
        assert_chain_equilibrium(&problem, &b);
        prop_assert!((a.wrench.0 - b.wrench.0).norm() < 1e-7 * wrench.0.norm(), "pose: {:e}", (a.wrench.0 - b.wrench.0).norm());

        for _ in 0..4 {
            let kinds = std::array::from_fn(|_| if rng.below(2) == 0 { Prescribed::Pose } else { Prescribed::Wrench });
            problem.end = EndCondition {
                axes: Rotation3::new(rng.vector(2.0)),
                prescribed: kinds,
                pose: a.tip,
                wrench,
            };
            let c = solve_chain(&problem, &tight()).unwrap_or_else(|e| panic!("{kinds:?}: {e}"));
            assert_chain_equilibrium(&problem, &c);
            prop_assert!((c.wrench.0 - wrench.0).norm() < 1e-7 * wrench.0.norm(), "{kinds:?}");
            prop_assert!(pose_residual(&a.tip, &c.tip).0.norm() < 1e-10, "{kinds:?}");
        }
    }

    #[test]
    fn mixed_positions_far_from_the_free_end_are_reached(seed in any::<u64>()) {
        // Some positions prescribed where the free end is not; rotations all held or all free.
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 0, ..Recipe::default() });
        let axes = Rotation3::new(rng.vector(2.0));
        let held = rng.below(2) == 0;
        let kinds = std::array::from_fn(|k| {
            let pose = if k < 3 { rng.below(2) == 0 } else { held };
            if pose { Prescribed::Pose } else { Prescribed::Wrench }
        });
        let end = EndCondition {
            axes,
            prescribed: kinds,
            pose: moved(&r.tip(), &Twist::new(rng.vector(0.01), rng.vector(0.05))),
            wrench: rng.wrench(80.0, 8.0),
        };
        let problem = r.problem(end);
        let e = solve_chain(&problem, &tight()).unwrap();
        assert_chain_equilibrium(&problem, &e);
        // The tangent of what was found predicts a neighbouring condition: one more newton of load.
        let mut next = problem.clone();
        next.end.wrench = Wrench(next.end.wrench.0 * 1.0001);
        next.posture.clone_from(&e.coordinates);
        let n = solve_chain(&next, &tight()).unwrap();
        let d = pose_residual(&n.tip, &e.tip);
        let predicted = e.stiffness.cartesian.matrix * d.0;
        let change = n.wrench.0 - e.wrench.0;
        prop_assert!((predicted - change).norm() < 3e-3 * change.norm().max(1e-3), "{predicted} {change}");
    }

    #[test]
    fn a_rotation_prescribed_about_one_axis_while_others_follow(seed in any::<u64>()) {
        // Rows of log(R* R^T) are held although the free components are large.
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 0, ..Recipe::default() });
        let mut kinds = [Prescribed::Wrench; 6];
        kinds[3 + rng.below(3)] = Prescribed::Pose;
        let end = EndCondition {
            axes: Rotation3::identity(),
            prescribed: kinds,
            pose: moved(&r.tip(), &Twist::new(rng.vector(0.3), rng.vector(0.4))),
            wrench: rng.wrench(50.0, 5.0),
        };
        let problem = r.problem(end);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        assert_chain_equilibrium(&problem, &e);
    }
}
