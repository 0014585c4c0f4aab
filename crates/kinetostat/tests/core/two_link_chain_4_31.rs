//! The rigid two-link chain with a preloaded middle spring and a vertical load on its middle:
//! closed form [R 4.31, 4.32], Table 5.2.

use crate::common::{assert_chain_equilibrium, close, golden, number};
use kinetostat::{
    Chain, ChainProblem, DirectionKind, EndCondition, Load, Mechanism, MotionKind, Pose,
    PostureRequest, Prescribed, Wrench, machine::LimbPosture, solve_chain,
};
use nalgebra::{Matrix2, Vector3, vector};
use serde_json::Value;

/// Hinge, link, torsion spring with theta0 = -30 deg, link, hinge; planar in x y.
pub fn chain() -> Chain {
    Chain::builder("two links")
        .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .node("middle")
        .spring(
            "theta",
            MotionKind::Revolute,
            Vector3::z(),
            1.0,
            -30_f64.to_radians(),
        )
        .translation(vector![1.0, 0.0, 0.0])
        .passive("q2", MotionKind::Revolute, Vector3::z(), 0.0)
        .build()
        .unwrap()
}

/// The chain of a case under its load on the middle, the end held at its place and free to turn.
pub fn loaded<'c>(chain: &'c Chain, a0: f64, case: &Value) -> (ChainProblem<'c>, f64) {
    let (g, dx) = (number(&case["g"]), number(&case["dx"]));
    let load = g * 4.0 * a0.sin();
    // Position prescribed, rotation free: the end hinge sees to that when its angle is free.
    let mut end = EndCondition::pose(Pose::translation(2.0 * a0.cos() + dx, 0.0, 0.0));
    end.prescribed[5] = Prescribed::Wrench;
    let mut problem = ChainProblem::new(chain, end);
    problem.posture = vec![a0, -2.0 * a0, a0];
    problem.loads = vec![Load::Dead {
        node: chain.node("middle").unwrap(),
        wrench: Wrench::new(vector![0.0, -load, 0.0], Vector3::zeros()),
    }];
    (problem, load)
}

#[test]
fn the_loaded_two_link_chain_has_the_closed_form_of_eqs_4_31_and_4_32() {
    let file = golden("table_5_2.json");
    let chain = chain();
    let a0 = number(&file["alpha0_deg"]).to_radians();
    for case in file["cases"].as_array().unwrap() {
        let (g, dx, own) = (number(&case["g"]), number(&case["dx"]), &case["computed"]);
        let label = format!("G/G* {g}, dx {dx}");
        let (problem, load) = loaded(&chain, a0, case);
        let e = solve_chain(&problem, &Default::default())
            .unwrap_or_else(|error| panic!("{label}: {error}"));
        assert_chain_equilibrium(&problem, &e);
        let a = number(&own["alpha"]);
        close(&label, e.coordinates[0], a, 1e-9);
        close(&label, e.coordinates[1], -2.0 * a, 1e-9);
        close(
            &label,
            e.wrench.0[0],
            number(&own["F_x"]),
            2e-9 * (1.0 + load),
        );
        close(&label, e.wrench.0[1], number(&own["F_y"]), 1e-9);
        close(&label, e.wrench.0[5], 0.0, 1e-12);
        // K of the position with the rotation free: the end hinge already makes row 6 zero.
        let k = e.stiffness.cartesian.matrix;
        let k_xy = Matrix2::new(k[(0, 0)], k[(0, 1)], k[(1, 0)], k[(1, 1)]);
        close(
            &label,
            k_xy[(0, 0)],
            number(&own["K_x"]),
            1e-7 * (1.0 + k_xy[(0, 0)].abs()),
        );
        close(&label, k_xy[(1, 1)], number(&own["K_y"]), 1e-7);
        close(&label, k_xy[(0, 1)], 0.0, 1e-9);
        close(&label, k[(5, 5)], 0.0, 1e-9);
        // Both x and y held: a rigid two-link chain has no inner freedom left.
        assert!(e.stability.stable, "{label}");
        assert_eq!(e.stability.share_to_buckling, None, "{label}");
    }
}

/// The same chain whose end hinge slides along x under the dead force F_x while the tip is held:
/// one inner freedom, so the true shape criterion S_c of Table 5.2 is visible. S_c belongs to the
/// unit vector (2, -1, -1)/sqrt 6 of (theta, q1, q2); mu = 1 + (6/4) S_c / K_theta needs no choice.
#[test]
fn the_share_to_buckling_is_the_true_shape_criterion_of_table_5_2() {
    let file = golden("table_5_2.json");
    let a0 = number(&file["alpha0_deg"]).to_radians();
    let chain = Chain::builder("two links, x free")
        .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .node("middle")
        .spring(
            "theta",
            MotionKind::Revolute,
            Vector3::z(),
            1.0,
            -30_f64.to_radians(),
        )
        .translation(vector![1.0, 0.0, 0.0])
        .passive("q2", MotionKind::Revolute, Vector3::z(), 0.0)
        .node("hinge")
        .passive("x", MotionKind::Prismatic, Vector3::x(), 0.0)
        .build()
        .unwrap();
    for case in file["cases"].as_array().unwrap() {
        let (g, dx, own) = (number(&case["g"]), number(&case["dx"]), &case["computed"]);
        let label = format!("G/G* {g}, dx {dx}");
        let dead = |node: &str, x: f64, y: f64| Load::Dead {
            node: chain.node(node).unwrap(),
            wrench: Wrench::new(vector![x, y, 0.0], Vector3::zeros()),
        };
        let (a, s_c) = (number(&own["alpha"]), number(&own["S_c"]));
        let mut problem =
            ChainProblem::new(&chain, EndCondition::pose(Pose::translation(2.0, 0.0, 0.0)));
        problem.posture = vec![a, -2.0 * a, a, 2.0 - 2.0 * a.cos()];
        problem.loads = vec![
            dead("middle", 0.0, -g * 4.0 * a0.sin()),
            dead("hinge", number(&own["F_x"]), 0.0),
        ];
        let mu = 1.0 + 1.5 * s_c;
        if (mu - 1.0).abs() < 1e-3 {
            // At G = G*, dx = 0 the tangent vanishes: a fold, where no iteration is regular.
            continue;
        }
        let e = solve_chain(&problem, &Default::default())
            .unwrap_or_else(|error| panic!("{label}: {error}"));
        assert_chain_equilibrium(&problem, &e);
        close(&label, e.coordinates[0], a, 1e-7);
        close(&label, e.stability.share_to_buckling.unwrap(), mu, 1e-6);
        assert_eq!(e.stability.stable, s_c < 0.0, "{label}");
        let holds = e.stability.inertia.positive == 3;
        assert_eq!(
            holds,
            s_c < 0.0,
            "{label}: inertia {:?}",
            e.stability.inertia
        );
    }
}

/// Links of length `a`, elbow open by `t`, spring of 1 N m/rad at rest at `t0`: the pull
/// `F a sin(t / 2) = t0 - t`, the radial stiffness its derivative by `x = 2 a cos(t / 2)`, the one
/// across `F / x`.
#[test]
fn a_pulled_two_link_chain_is_as_stiff_as_its_closed_form_until_it_is_straight_to_rounding() {
    let half = 15_f64.to_radians();
    let rest = 2.0 * half;
    let nominal = Chain::builder("pulled")
        .passive("q1", MotionKind::Revolute, Vector3::z(), half)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("theta", MotionKind::Revolute, Vector3::z(), 1.0, -rest)
        .translation(vector![1.0, 0.0, 0.0])
        .passive("q2", MotionKind::Revolute, Vector3::z(), half)
        .build()
        .unwrap();
    let mut finite = 0;
    // Along an axis and off it: there the radial direction is no coordinate.
    for turn in [0.0_f64, 0.9] {
        let span = vector![turn.cos(), turn.sin(), 0.0];
        let across = vector![-span.y, span.x, 0.0];
        let place = span * (2.0 * half.cos());
        let home = Pose::translation(place.x, place.y, 0.0);
        let machine = Mechanism::serial(nominal.clone(), home, Vector3::zeros()).unwrap();
        let joints = LimbPosture {
            commands: vec![],
            coordinates: vec![half + turn, -rest, half - turn],
        };
        let posture = machine
            .posture(PostureRequest::joints(&home, vec![joints]))
            .unwrap();
        let unloaded = posture.deflected_by(&Wrench::zero()).unwrap().state;
        for step in 0..=20 {
            let force = 10_f64.powf(0.25 * f64::from(step));
            let mut t = rest;
            for _ in 0..200 {
                let f = force * (0.5 * t).sin() - (rest - t);
                t -= f / (0.5 * force * (0.5 * t).cos() + 1.0);
            }
            let (s, c) = (0.5 * t).sin_cos();
            // From the closed form: the path there does not matter.
            let wrench = Wrench::new(span * force, Vector3::zeros());
            let mut state = unloaded.clone();
            state.coordinates[0] = vec![turn + 0.5 * t, -t, 0.5 * t - turn];
            state.platforms[1] = Pose::translation(2.0 * c * span.x, 2.0 * c * span.y, 0.0);
            state.wrenches[0] = wrench;
            let e = posture
                .deflected_from(&wrench, state)
                .unwrap_or_else(|error| panic!("{force} N: {error}"));
            let radial = (1.0 / s + (rest - t) * 0.5 * c / (s * s)) / s;
            assert!(e.stable(), "{force} N: {:?}", e.directions);
            let kinds = |kind| e.directions.iter().filter(|d| d.kind == kind).count();
            assert_eq!(kinds(DirectionKind::Negative), 0, "{force} N");
            assert_eq!(kinds(DirectionKind::Free), 1, "{force} N: the end hinge");
            let k = e.stiffness.matrix.fixed_view::<3, 3>(0, 0).into_owned();
            // The radial stiffness is so much larger that its rounding shows in the base's axes.
            let own = across.dot(&(k * across));
            let expected = force / (2.0 * c);
            let rounding = 1e-6 * expected + 1e-14 * radial;
            assert!(
                (own - expected).abs() < rounding,
                "{force} N: {own} across, {expected}"
            );
            // However much stiffer than across: out of the plane only it is rigid.
            assert_eq!(kinds(DirectionKind::Rigid), 3, "{force} N");
            let own = span.dot(&(k * span));
            assert!(
                (own / radial - 1.0).abs() < 1e-6,
                "{force} N: {own}, {radial}"
            );
            finite += 1;
        }
    }
    assert_eq!(finite, 42);
}
