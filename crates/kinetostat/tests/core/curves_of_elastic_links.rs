//! The chain of two elastic links under a load on its middle [R 4.6.2]: its tabulated equilibria, its limit points, and
//! the fork of the same chain laid flat.

use crate::common::close;
use crate::curves_and_bifurcations::{along_x, assert_curves, held, of_kind, solved};
use kinetostat::{
    Chain, ChainProblem, CurveSettings, Load, MotionKind, Wrench, continuation::SpecialKind, follow,
};
use nalgebra::{Vector3, vector};

/// Two elastic links (axial stiffness 200), torsion spring 1 at rest at -2 a0, load on the middle.
pub fn elastic_links(a0: f64) -> Chain {
    let (z, x) = (Vector3::z(), Vector3::x());
    Chain::builder("two elastic links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("s1", MotionKind::Prismatic, x, 200.0, 0.0)
        .node("middle")
        .spring("th", MotionKind::Revolute, z, 1.0, -2.0 * a0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("s2", MotionKind::Prismatic, x, 200.0, 0.0)
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap()
}

/// Example 4.6.2: load `g` times `G* = 4 sin 15 deg` on the middle, end at `2 cos 15 deg + dx`.
pub fn elastic_problem(chain: &Chain, g: f64, dx: f64) -> ChainProblem<'_> {
    let a0 = 15_f64.to_radians();
    let mut problem = held(chain, 2.0 * a0.cos() + dx);
    problem.posture = vec![a0, 0.0, -2.0 * a0, 0.0, a0];
    problem.loads = vec![Load::Dead {
        node: chain.node("middle").unwrap(),
        wrench: Wrench::new(vector![0.0, -4.0 * g * a0.sin(), 0.0], Vector3::zeros()),
    }];
    problem
}

/// Table of 4.6.2: G/G*, dx, node y, F_x, K_xx, stable with the end fixed, and with x free.
pub const ELASTIC: [(f64, f64, f64, f64, f64, bool, bool); 31] = [
    (0.0, -0.05, 0.332059848, -0.466562542, 6.6865303, true, true),
    (
        0.0,
        -0.05,
        -0.0558138838,
        -11.5042347,
        107.03798,
        false,
        false,
    ),
    (
        0.0,
        -0.05,
        -0.277685964,
        -3.95247246,
        -13.025878,
        true,
        false,
    ),
    (0.0, 0.0, 0.258819045, 0.0, 13.1031674, true, true),
    (0.0, 0.05, 0.169711219, 1.08631261, 34.9160772, true, true),
    (0.5, -0.05, 0.320528747, -1.17486288, 3.82893158, true, true),
    (
        0.5,
        -0.05,
        -0.0291332205,
        -11.7382855,
        101.620169,
        false,
        false,
    ),
    (
        0.5,
        -0.05,
        -0.294797399,
        -3.00988625,
        -4.750592,
        true,
        false,
    ),
    (0.5, 0.0, 0.240291385, -0.890746544, 8.56480523, true, true),
    (
        0.5,
        0.0,
        -0.0625734445,
        -6.44010554,
        120.604171,
        false,
        false,
    ),
    (
        0.5,
        0.0,
        -0.181093188,
        -3.55760959,
        -28.4844902,
        true,
        false,
    ),
    (
        0.5,
        0.05,
        0.133130014,
        0.000220914926,
        35.4558273,
        true,
        true,
    ),
    (
        1.0,
        -0.05,
        0.307819718,
        -1.93555766,
        0.102541188,
        true,
        true,
    ),
    (
        1.0,
        -0.05,
        -0.00377089379,
        -11.8154929,
        100.003569,
        false,
        false,
    ),
    (
        1.0,
        -0.05,
        -0.30941257,
        -2.17166073,
        0.592230381,
        true,
        true,
    ),
    (1.0, 0.0, 0.217119305, -1.92801064, 0.266275245, true, true),
    (
        1.0,
        0.0,
        -0.00497392752,
        -6.81502933,
        100.023984,
        false,
        false,
    ),
    (1.0, 0.0, -0.217474079, -2.14510657, 0.39406621, true, true),
    (1.0, 0.05, 0.0326498911, -1.6911571, 55.647624, true, true),
    (
        1.5,
        -0.05,
        0.293515333,
        -2.76559553,
        -5.0534236,
        true,
        false,
    ),
    (
        1.5,
        -0.05,
        0.0215035817,
        -11.7510249,
        101.343891,
        false,
        false,
    ),
    (1.5, -0.05, -0.322344531, -1.4056792, 4.40766084, true, true),
    (1.5, 0.0, 0.183254036, -3.28168368, -23.8408494, true, false),
    (
        1.5,
        0.0,
        0.0509213565,
        -6.51473313,
        115.315614,
        false,
        false,
    ),
    (1.5, 0.0, -0.241457546, -1.09132852, 9.20935573, true, true),
    (
        1.5,
        0.05,
        -0.132601447,
        -0.152624747,
        37.2838169,
        true,
        true,
    ),
    (
        2.0,
        -0.05,
        0.276881175,
        -3.69433828,
        -12.8819489,
        true,
        false,
    ),
    (
        2.0,
        -0.05,
        0.047876969,
        -11.5336727,
        106.269758,
        false,
        false,
    ),
    (
        2.0,
        -0.05,
        -0.334045631,
        -0.693788745,
        7.31006187,
        true,
        true,
    ),
    (2.0, 0.0, -0.260418851, -0.193099914, 13.8712314, true, true),
    (2.0, 0.05, -0.170732964, 0.943231422, 36.2957185, true, true),
];

/// G/G*, x, dx, node y, F_x of the five limit points of 4.6.2.
pub const ELASTIC_LIMITS: [(f64, f64, f64, f64, f64); 5] = [
    (0.0, 1.922272795, -0.0095788571, -0.137732345, -5.86836656),
    (0.5, 1.942925249, 0.011073597, -0.111303931, -4.49506146),
    (1.0, 1.975281172, 0.043429519, -0.0405154222, -2.32892263),
    (1.5, 1.945566931, 0.013715278, 0.103783052, -4.28099972),
    (2.0, 1.92463389, -0.0072177621, 0.13138615, -5.66307168),
];

/// The limit point on the branch of the unstable shape between the two folds of its loop: x, dx,
/// node y, F_x; `y` is near it.
pub fn elastic_limit(g: f64, y: f64) -> [f64; 4] {
    let label = format!("G/G* {g}");
    let chain = elastic_links(15_f64.to_radians());
    let mut problem = elastic_problem(&chain, g, -0.05);
    problem.posture = vec![y.atan2(1.0) * 0.6, -0.05, 0.0, -0.05, 0.0];
    problem.posture[2] = -2.0 * problem.posture[0];
    let bounds = kinetostat::equilibrium::Bounds::of(&chain);
    let all = kinetostat::equilibria(&problem, &bounds, &Default::default()).unwrap();
    let start = &all.found.last().unwrap().equilibrium;
    assert!(!start.stability.stable, "{label}");
    let settings = CurveSettings::within(-0.02, 0.2);
    let c = follow(&problem, &along_x(), start, 0.0, &settings).unwrap();
    assert_curves(&c);
    let limits = of_kind(&c, SpecialKind::DisplacementLimit);
    assert_eq!(limits.len(), 1, "{label}");
    let p = &limits[0].point;
    assert!(limits[0].stable_side, "{label}");
    assert!(
        p.slope.abs() > 1e6,
        "{label}: the displacement stands still"
    );
    let y = p.equilibrium.nodes[0].translation.y;
    [
        p.equilibrium.tip.translation.x,
        p.parameter - 0.05,
        y,
        p.conjugate,
    ]
}

#[test]
fn the_two_elastic_links_have_the_five_limit_points() {
    for (g, x, dx, y, force) in ELASTIC_LIMITS {
        let label = format!("G/G* {g}");
        let found = elastic_limit(g, y);
        for (found, expected) in found.into_iter().zip([x, dx, y]) {
            close(&label, found, expected, 6e-10);
        }
        close(&label, found[3], force, 6e-9);
    }
}

/// Without preload the flat chain forks where `K_L r^2 - K_L r + 2 K = 0`, x = 2 r. With the
/// preload of the example and the load `4 a0 / r` that holds it flat, the same place is a limit
/// point: the third derivative of the energy is `8 a0 / r^3`, so nothing forks there under a
/// constant load.
#[test]
fn the_flat_chain_forks_without_preload_and_has_a_limit_point_with_it() {
    let r = 0.5 * (1.0 + (1.0_f64 - 8.0 / 200.0).sqrt());
    let [fork, force, limit, y] = flat_chain();
    close("x", fork, 1.979795897113, 1e-11);
    close("F_x", force, 200.0 * (r - 1.0), 1e-9);
    close("x", limit, 1.979795897113, 1e-11);
    close("flat", y, 0.0, 1e-9);
}

/// x and F_x of the fork without preload, x and node y of the limit point with it.
pub fn flat_chain() -> [f64; 4] {
    let r = 0.5 * (1.0 + (1.0_f64 - 8.0 / 200.0).sqrt());
    close("reference", 2.0 * r, 1.979795897113, 1e-12);
    let chain = elastic_links(0.0);
    let problem = held(&chain, 2.0);
    let start = solved(&problem);
    let mut settings = CurveSettings::within(-0.2, 0.05);
    settings.branches = 4;
    let c = follow(&problem, &along_x(), &start, 0.0, &settings).unwrap();
    assert_curves(&c);
    let forks = of_kind(&c, SpecialKind::Pitchfork);
    assert_eq!(forks.len(), 1);
    let fork = &forks[0].point;
    let fork = [2.0 + fork.parameter, fork.conjugate];
    assert_eq!(c.branches.len(), 2);
    assert!(
        c.branches[1]
            .points
            .iter()
            .all(|p| p.arc == 0.0 || p.parameter < -0.02)
    );

    let a0 = 15_f64.to_radians();
    let chain = elastic_links(a0);
    let mut problem = held(&chain, 2.0 * r);
    problem.loads = vec![Load::Dead {
        node: chain.node("middle").unwrap(),
        wrench: Wrench::new(vector![0.0, -4.0 * a0 / r, 0.0], Vector3::zeros()),
    }];
    close("G", 4.0 * a0 / r, 1.057884353, 1e-9);
    // From the upper shape, a little pushed together, to where it ceases to exist.
    problem.end.pose.translation.vector.x -= 0.01;
    problem.posture = vec![0.1, 0.0, -0.2, 0.0, 0.0];
    let start = solved(&problem);
    assert!(start.nodes[0].translation.y > 0.05);
    let c = follow(
        &problem,
        &along_x(),
        &start,
        0.0,
        &CurveSettings::within(-0.02, 0.1),
    )
    .unwrap();
    assert_curves(&c);
    assert!(c.specials.iter().all(|s| !s.kind.is_bifurcation()));
    let limits = of_kind(&c, SpecialKind::DisplacementLimit);
    assert_eq!(limits.len(), 1);
    let p = &limits[0].point;
    let y = p.equilibrium.nodes[0].translation.y;
    [fork[0], fork[1], 2.0 * r - 0.01 + p.parameter, y]
}
