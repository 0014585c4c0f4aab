//! Moving the whole robot turns `K_C`; moving the reference point shifts it, with the geometric term
//! of the force [errata of R 5.28].

use crate::common::{
    Orthoglide, Recipe, Rng, assert_chain_equilibrium, assert_equilibrium, cases, orthoglide_point,
    random_chain, same_stiffness, scaled_error,
};
use kinetostat::{
    CartesianStiffness, ChainProblem, EndCondition, Load, Pose, Settings, Twist, Wrench,
    solve_chain, spatial::moved,
};
use kinetostat_testing::Worst;
use nalgebra::Vector3;
use proptest::prelude::*;

/// What a move of the whole robot, its load and its target changes, relative.
pub struct Turned {
    pub wrench: f64,
    pub stiffness: f64,
    pub energy: f64,
    pub shares_to_buckling: (Option<f64>, Option<f64>),
}

/// `None` where no equilibrium was found.
pub fn turned(seed: u64) -> Option<Turned> {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        stages: 3,
        passive: 2,
        preload: 0.03,
        ..Recipe::default()
    };
    let mut r = random_chain(&mut rng, &recipe);
    let gravity = rng.axis() * 9.81;
    let node = rng.below(r.chain.nodes().len());
    let load = rng.wrench(80.0, 6.0);
    let target = moved(&r.tip(), &Twist::new(rng.vector(0.005), rng.vector(0.02)));
    let mut problem = r.problem(EndCondition::pose(target));
    problem.loads = vec![Load::Gravity(gravity), Load::Dead { node, wrench: load }];
    let e = solve_chain(&problem, &Settings::default()).ok()?;
    assert_chain_equilibrium(&problem, &e);
    let x = rng.pose(2.0, 3.0);
    let turn = x.rotation.to_rotation_matrix();
    r.base = x * r.base;
    let mut other = r.problem(EndCondition::pose(x * target));
    other.loads = vec![
        Load::Gravity(turn * gravity),
        Load::Dead {
            node,
            wrench: load.rotated(&turn),
        },
    ];
    let o = solve_chain(&other, &Settings::default()).unwrap();
    assert_chain_equilibrium(&other, &o);
    Some(Turned {
        wrench: (e.wrench.rotated(&turn).0 - o.wrench.0).norm() / e.wrench.0.norm(),
        stiffness: scaled_error(
            &o.stiffness.cartesian.matrix,
            &e.stiffness.cartesian.rotated(&turn).matrix,
        ),
        energy: (e.energy - o.energy).abs() / e.energy,
        shares_to_buckling: (e.stability.share_to_buckling, o.stability.share_to_buckling),
    })
}

/// What a rigid extension behind the tip of a loaded chain changes beyond the shift, relative.
pub struct Extended {
    pub wrench: f64,
    pub stiffness: f64,
    /// With the geometric term of the force left out: must not fit.
    pub without_geometric_term: f64,
}

pub fn extended(seed: u64) -> Extended {
    // The same chain, once to its tip, once with a rigid extension behind it.
    let mut rng = Rng(seed);
    let pose = rng.pose(0.4, 2.0);
    let k = [rng.spring_matrix(2e5, 4e3), rng.spring_matrix(2e5, 4e3)];
    let offsets = [rng.pose(0.4, 1.0), rng.pose(0.4, 1.0)];
    let build = |extended: bool| {
        let b = kinetostat::Chain::builder("c")
            .rigid(offsets[0])
            .spring6("a", &k[0], [0.0; 6])
            .rigid(offsets[1])
            .spring6("b", &k[1], [0.0; 6]);
        if extended { b.rigid(pose) } else { b }.build().unwrap()
    };
    let (short, long) = (build(false), build(true));
    let rest = kinetostat::model::unloaded_tip(&short, &Pose::identity(), &[0.0; 12], &[]);
    let target = moved(&rest, &Twist::new(rng.vector(0.004), rng.vector(0.02)));
    let held = |chain, pose| {
        let problem = ChainProblem::new(chain, EndCondition::pose(pose));
        solve_chain(&problem, &Settings::default()).unwrap()
    };
    let (a, b) = (held(&short, target), held(&long, target * pose));
    // From the short tip to the long one, base axes.
    let arm = target.rotation * pose.translation.vector;
    let off = |wrench: &Wrench| {
        let shifted = a.stiffness.cartesian.shifted(&-arm, wrench);
        scaled_error(&b.stiffness.cartesian.matrix, &shifted.matrix)
    };
    Extended {
        wrench: (a.wrench.shifted(&arm).0 - b.wrench.0).norm() / a.wrench.0.norm(),
        stiffness: off(&a.wrench),
        without_geometric_term: off(&Wrench::zero()),
    }
}

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn moving_the_whole_robot_turns_everything_with_it(seed in any::<u64>()) {
        let Some(d) = turned(seed) else { return Ok(()); };
        prop_assert!(d.wrench < 1e-7, "wrench {:e}", d.wrench);
        prop_assert!(d.stiffness < 1e-8, "stiffness {:e}", d.stiffness);
        prop_assert!(d.energy < 1e-8, "energy {:e}", d.energy);
        match d.shares_to_buckling {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < 1e-6 * a.abs().max(1.0)),
            (a, b) => prop_assert_eq!(a.is_some(), b.is_some()),
        }
    }

    #[test]
    fn a_rigid_extension_shifts_the_loaded_stiffness(seed in any::<u64>()) {
        let d = extended(seed);
        prop_assert!(d.wrench < 1e-7, "wrench {:e}", d.wrench);
        prop_assert!(d.stiffness < 1e-9, "stiffness {:e}", d.stiffness);
        prop_assert!(d.without_geometric_term > 1e-7);
    }
}

#[test]
fn another_tool_point_sees_the_same_machine() {
    let machine = Orthoglide {
        line_error: 0.01,
        ..Default::default()
    }
    .build();
    let mut rng = Rng(7);
    for index in 0..5 {
        let tool = rng.pose(0.15, 1.5);
        let other = machine.with_tool(&tool);
        let target = orthoglide_point(index);
        let posture = machine.posture(&target).unwrap();
        let there = other.posture(&(target * tool)).unwrap();
        for (a, b) in posture.commands().iter().zip(there.commands()) {
            assert!((a - b).abs() < 1e-12);
        }
        // Unloaded: plain congruence.
        let arm0 = target.rotation * tool.translation.vector;
        let k0 = posture
            .stiffness()
            .unwrap()
            .cartesian
            .shifted(&-arm0, &Wrench::zero());
        same_stiffness(
            "unloaded",
            &there.stiffness().unwrap().cartesian.matrix,
            &k0.matrix,
            1e-11,
        );

        let wrench = rng.wrench(220.0, 20.0);
        let e = posture.deflected_by(&wrench).unwrap();
        assert_equilibrium(&posture, &e);
        // The same load about the new point, as it stands in the deflected place.
        let arm = e.tool.rotation * tool.translation.vector;
        let o = there.deflected_by(&wrench.shifted(&arm)).unwrap();
        assert_equilibrium(&there, &o);
        let residual = kinetostat::spatial::pose_residual(&(e.tool * tool), &o.tool);
        assert!(residual.0.norm() < 1e-12, "{index}: {residual:?}");
        let k = CartesianStiffness {
            matrix: e.stiffness.matrix,
        }
        .shifted(&-arm, &wrench);
        same_stiffness("loaded", &o.stiffness.matrix, &k.matrix, 1e-9);
    }
}

/// What another order of the limbs changes.
pub struct Reordered {
    /// Pose of the tool, m and rad.
    pub tool: f64,
    /// Stiffness, relative.
    pub stiffness: f64,
    /// Wrenches of the limbs, N and N m.
    pub wrench: f64,
}

/// The largest over all orders of the Orthoglide's legs and the points of the report.
pub fn reordered() -> Reordered {
    let wrench = Wrench::new(
        Vector3::new(215.0, -10.0, -25.0),
        Vector3::new(1.0, 21.5, 0.0),
    );
    let build = |order| {
        Orthoglide {
            line_error: 0.017,
            order,
            ..Default::default()
        }
        .build()
    };
    let machine = build([0, 1, 2]);
    let [mut tool, mut stiffness, mut wrenches] = <[Worst; 3]>::default();
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let other = build(order);
        for index in 0..5 {
            let target = orthoglide_point(index);
            let (p, q) = (
                machine.posture(&target).unwrap(),
                other.posture(&target).unwrap(),
            );
            let (e, o) = (
                p.deflected_by(&wrench).unwrap(),
                q.deflected_by(&wrench).unwrap(),
            );
            assert_equilibrium(&p, &e);
            assert_equilibrium(&q, &o);
            let residual = kinetostat::spatial::pose_residual(&e.tool, &o.tool);
            tool.add(residual.0.norm());
            let k = scaled_error(&e.stiffness.matrix, &o.stiffness.matrix);
            stiffness.add(k);
            for (k, &i) in order.iter().enumerate() {
                let d = (e.limbs[i].wrench.0 - o.limbs[k].wrench.0).norm();
                wrenches.add(d);
            }
        }
    }
    Reordered {
        tool: tool.of(5 * 5),
        stiffness: stiffness.of(5 * 5),
        wrench: wrenches.of(5 * 5 * 3),
    }
}

#[test]
fn the_order_of_the_limbs_does_not_matter() {
    let d = reordered();
    assert!(d.tool < 1e-13, "tool {:e}", d.tool);
    assert!(d.stiffness <= 1e-11, "stiffness {:e}", d.stiffness);
    assert!(d.wrench < 1e-8, "limb wrenches {:e}", d.wrench);
}
