//! A parallelogram as one link with a coupled coordinate, and as two explicit bars.
//!
//! Unloaded they are one machine. Held displaced by `t` they differ in the second order of `t`, for
//! a reason: with `y` the coordinates and `F` the wrench of the linear answer to `t`, a limb's energy
//! is `U2(t) - F . c2(y, y) / 2 + ...`, where `c2` is the second derivative of the pose of its tip
//! along `y`. `F . c2` is the geometric stiffness of the limb: axial forces on motions across (the
//! `N / L` terms of bars) and wrenches on turned ends. The lumped link has one bar in the middle and
//! ends that do not turn against each other, so its sum over one limb is not that over two bars.

use crate::common::scaled_error;
use crate::graphs::limb;
use crate::oracle::{Frames, scaled_solve, springs};
use kinetostat::{
    Chain, Mechanism, MotionKind, Platform, Pose, Posture, Twist, Wrench, spatial::moved,
};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Matrix6, Vector3, Vector6, vector};

const LENGTH: f64 = 0.31;
const WIDTH: f64 = 0.08;
const AXIAL: f64 = 3.25e7;

/// The lumped machine, that of two bars between two beams, and the pose of the far beam at an
/// inclination.
fn machines(q: f64) -> (Mechanism, Mechanism, Pose) {
    let mut bar = Matrix6::zeros();
    for (i, j, value) in [
        (0, 0, AXIAL),
        (1, 1, 18.03e3),
        (1, 5, -2878.5),
        (5, 5, 598.8),
        (3, 3, 34.76),
        (2, 2, 18.03e3),
        (2, 4, 2878.5),
        (4, 4, 598.8),
    ] {
        bar[(i, j)] = value;
        bar[(j, i)] = value;
    }
    let far = Pose::rotation(Vector3::y() * q)
        * Pose::translation(LENGTH, 0.0, 0.0)
        * Pose::rotation(Vector3::y() * -q);
    let lumped = Chain::builder("lumped")
        .parallelogram("q", LENGTH, WIDTH, &bar, q)
        .build()
        .unwrap();
    let lumped = Mechanism::serial(lumped, far, Vector3::zeros()).unwrap();
    let mut builder = Mechanism::builder("two bars");
    let beam = builder.platform(Platform::new("beam", Pose::identity()));
    let tool = builder.platform(Platform::new("tool", far));
    let root = Chain::builder("root").build().unwrap();
    let mut builder = builder.limb(limb("root", 0, beam, Pose::identity(), root));
    for (name, side) in [("left", -0.5), ("right", 0.5)] {
        let offset = vector![0.0, 0.0, side * WIDTH];
        let chain = Chain::builder(name)
            .translation(offset)
            .passive("near", MotionKind::Revolute, Vector3::y(), q)
            .translation(vector![LENGTH, 0.0, 0.0])
            .spring6("bar", &bar, [0.0; 6])
            .passive("far", MotionKind::Revolute, Vector3::y(), -q)
            .translation(-offset)
            .build()
            .unwrap();
        builder = builder.limb(limb(name, beam, tool, Pose::identity(), chain));
    }
    (lumped, builder.build().unwrap(), far)
}

const INCLINATIONS: [f64; 4] = [0.0, 0.3, -0.7, 1.1];

/// A displacement in all directions but the parallelogram's own.
fn aside(q: f64) -> Twist {
    let along = Pose::rotation(Vector3::y() * q);
    Twist::new(
        along * vector![2e-5, 1e-3, 0.0],
        along * vector![4e-3, 1e-3, -2e-3],
    )
}

/// Stiffness unloaded, and the wrench under a displacement, relative.
pub fn parallelogram_apart() -> [f64; 2] {
    let (mut worst, mut apart) = (Worst::new(), Worst::new());
    for q in INCLINATIONS {
        let (lumped, bars, far) = machines(q);
        let (a, b) = (lumped.posture(&far).unwrap(), bars.posture(&far).unwrap());
        assert_eq!(b.overconstraint().degree, 3, "a planar loop of four pins");
        assert_eq!(a.mobility().ncols(), 1);
        assert_eq!(b.mobility().ncols(), 1);
        let (ka, kb) = (a.stiffness().unwrap(), b.stiffness().unwrap());
        assert_eq!(ka.rank(), 5);
        assert_eq!(kb.rank(), 5);
        worst.add(scaled_error(&kb.cartesian.matrix, &ka.cartesian.matrix));
        let pose = moved(&far, &aside(q));
        let (x, y) = (a.wrench_at(&pose).unwrap(), b.wrench_at(&pose).unwrap());
        let d = (x.wrench.0 - y.wrench.0).norm() / x.wrench.0.norm();
        apart.add(d);
    }
    [worst.value(), apart.value()]
}

/// `-1/2 sum F . c2(y, y)` of all limbs that end at the tool, of the linear answer to a displacement,
/// J; nothing of the core but the description of the chains.
fn third_order_energy(posture: &Posture, t: &Vector6<f64>) -> f64 {
    let m = posture.mechanism();
    let own = m.limbs().iter().zip(posture.limbs());
    own.filter(|(limb, _)| limb.to == m.tool())
        .map(|(limb, joints)| {
            let (chain, x) = (&limb.nominal, &joints.coordinates);
            let base = posture.platforms()[limb.from];
            let frames = Frames::new(chain, &base, x, &joints.commands);
            let (n, tip) = (x.len(), frames.tip());
            let j = frames.jacobian(tip);
            let mut a = DMatrix::zeros(6 + n, 6 + n);
            a.view_mut((0, 6), (6, n)).copy_from(&j);
            a.view_mut((6, 0), (n, 6)).copy_from(&j.transpose());
            a.view_mut((6, 6), (n, n))
                .copy_from(&-springs(chain, x, x).1);
            let mut b = DMatrix::zeros(6 + n, 1);
            b.fixed_view_mut::<6, 1>(0, 0).copy_from(t);
            let answer = scaled_solve(&a, &b);
            let force = Wrench(answer.fixed_view::<6, 1>(0, 0).into_owned());
            let y = answer.rows(6, n).into_owned();
            let bent = frames.hessian(&[(tip, force)]);
            -0.5 * (y.transpose() * bent * &y)[(0, 0)]
        })
        .sum()
}

/// Error of the lumped link's wrench, to leading order: the gradient of the difference of the
/// third-order energies (differences of fourth order are exact for a cubic).
fn predicted(a: &Posture, b: &Posture, t: &Vector6<f64>) -> Vector6<f64> {
    let energy = |t: &Vector6<f64>| third_order_energy(b, t) - third_order_energy(a, t);
    Vector6::from_fn(|k, _| {
        let step = 1e-3;
        let at = |share: f64| {
            let mut near = *t;
            near[k] += share * step;
            energy(&near)
        };
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step)
    })
}

fn scaled(wrench: &Vector6<f64>) -> f64 {
    let units = |k: usize| if k < 3 { 1.0 } else { 1.0 / LENGTH };
    (0..6)
        .map(|k| (wrench[k] * units(k)).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// How far the difference is from growing with the square of the displacement (exponent), what the
/// predicted term leaves of it at the smallest displacement, and the stiffness that a turn about the
/// pivots' axis gains from tension, against its closed form.
pub fn left_out() -> [f64; 3] {
    let (mut growth, mut explained, mut term) = (Worst::new(), Worst::new(), Worst::new());
    for q in INCLINATIONS {
        let (lumped, bars, far) = machines(q);
        let (a, b) = (lumped.posture(&far).unwrap(), bars.posture(&far).unwrap());
        let difference = |t: &Vector6<f64>| {
            let pose = moved(&far, &Twist(*t));
            b.wrench_at(&pose).unwrap().wrench.0 - a.wrench_at(&pose).unwrap().wrench.0
        };
        let t = aside(q).0;
        let foreseen = predicted(&a, &b, &t);
        let mut before: Option<(f64, f64)> = None;
        let mut last = 0.0;
        for share in [0.1, 0.05, 0.025] {
            let found = difference(&(t * share));
            let size = scaled(&found);
            let left = scaled(&(found - foreseen * (share * share))) / size;
            if let Some((size_before, left_before)) = before {
                last = (size_before / size).log2();
                // What is left is of the next order, or the one after where signs do not matter.
                let falls: f64 = left_before / left;
                assert!(falls > 1.7, "q {q}: falls by {falls}");
            }
            before = Some((size, left));
        }
        growth.add((last - 2.0_f64).abs());
        explained.add(before.unwrap().1);
        // Tension N in the bars, the far beam turned by psi: the bars incline by -+ psi d sin q / 2L
        // against each other, which costs N d^2 psi^2 sin^2 q / (8 L). The lumped link has one bar.
        let stretch = 1e-6;
        let along = Pose::rotation(Vector3::y() * q) * vector![stretch, 0.0, 0.0];
        let tension = 2.0 * AXIAL * stretch;
        let pose = moved(&far, &Twist::new(along, Vector3::zeros()));
        let k = |p: &Posture| p.wrench_at(&pose).unwrap().stiffness.matrix[(4, 4)];
        let gained = k(&b) - k(&a);
        let formula = tension * (WIDTH * q.sin()).powi(2) / (4.0 * LENGTH);
        let size = tension * WIDTH * WIDTH / (4.0 * LENGTH);
        term.add((gained - formula).abs() / size);
    }
    [growth, explained, term].map(|w| w.value())
}

#[test]
fn unloaded_a_parallelogram_is_its_two_bars() {
    let [unloaded, loaded] = parallelogram_apart();
    assert!(unloaded < 1e-12, "{unloaded:e}");
    assert!((1e-6..0.1).contains(&loaded), "{loaded:e}");
}

#[test]
fn a_loaded_parallelogram_differs_by_the_geometric_stiffness_of_its_bars() {
    let [growth, explained, term] = left_out();
    assert!(growth < 0.05, "{growth:e}");
    assert!(explained < 0.02, "{explained:e}");
    assert!(term < 1e-3, "{term:e}");
}
