//! Dampers that couple modes: lobes with all of the damping, against a semi-discretisation of the second-order form, and receptances
//! against its inverse.

use kinetostat_chatter::{Mode, Process, Regeneration, ToolResponse, coupled_roots};
use kinetostat_testing::Worst;
use nalgebra::{Complex, DMatrix, Matrix3, Matrix3x4, Matrix4, Matrix4x3, Vector3, Vector4};
use proptest::prelude::*;

use crate::semi_discretisation::extrapolated_with;
use crate::support::{aluminium, arc, cut};
use crate::traps::plain;

fn square(rows: &[f64]) -> DMatrix<f64> {
    let n = (rows.len() as f64).sqrt() as usize;
    DMatrix::from_row_slice(n, n, rows)
}

/// Modes of 0.04 kg with shapes in the plane and rates, 1/s.
fn tool(modes: &[(f64, f64)], rates: &DMatrix<f64>) -> ToolResponse {
    let mode = |(k, (angle, hz)): (usize, &(f64, f64))| {
        let direction = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let w = std::f64::consts::TAU * hz;
        Mode::along(direction, 0.04, *hz, 0.5 * rates[(k, k)] / w).expect("a mode")
    };
    let modes = modes.iter().enumerate().map(mode).collect();
    ToolResponse::new(modes)
        .expect("modes")
        .with_coupled_damping(rates.clone(), Vec::new())
        .expect("rates")
}

/// What the whole matrix of damping makes of the multiplier, and what is lost with its diagonal alone.
#[test]
fn lobes_have_all_of_the_damping() {
    let cases = [
        (
            "two apart",
            vec![(0.3, 900.0), (1.7, 1100.0)],
            square(&[180.0, 150.0, 150.0, 220.0]),
        ),
        (
            "two of one frequency",
            vec![(0.2, 900.0), (0.2 + std::f64::consts::FRAC_PI_2, 900.0)],
            square(&[200.0, 120.0, 120.0, 200.0]),
        ),
        (
            "three, two of which meet in frequency and damping",
            vec![(0.0, 900.0), (1.2, 900.0), (2.2, 1300.0)],
            square(&[200.0, 0.0, 150.0, 0.0, 200.0, 0.0, 150.0, 0.0, 400.0]),
        ),
        (
            "a root that does not vibrate",
            vec![(0.4, 900.0), (1.4, 600.0)],
            square(&[7000.0, 4000.0, 4000.0, 5000.0]),
        ),
    ];
    let (mut worst, mut lost) = (Worst::new(), Worst::new());
    let all = cases.len();
    for (name, modes, rates) in cases {
        let tool = tool(&modes, &rates);
        let cut = cut(3, arc("up", 0.5), aluminium());
        let machine = Regeneration::new(tool.clone(), cut.clone().into()).expect("a cut");
        let (speed, depth) = (9000.0, 2e-3);
        let found = machine
            .multiplier(speed, depth)
            .expect("a multiplier")
            .size();
        let expected = extrapolated_with((&tool, &rates), &plain(&cut, 1), speed, depth, 80);
        worst.add_at(found / expected - 1.0, || {
            format!("{name}: {found} {expected}")
        });
        let alone = ToolResponse::new(tool.modes().to_vec()).expect("modes");
        let alone = Regeneration::new(alone, cut.into()).expect("a cut");
        let alone = alone.multiplier(speed, depth).expect("a multiplier").size();
        lost.add(alone / expected - 1.0);
    }
    assert!(worst.of(all) < 5e-4, "{worst}");
    assert!(lost.of(all) > 0.02, "{lost}");
}

/// Rates without coupling change nothing, and the order of the modes is none of the matter.
#[test]
fn a_diagonal_of_rates_is_the_ratios() {
    let modes = [(0.3, 900.0), (1.7, 1100.0)];
    let rates = square(&[180.0, 0.0, 0.0, 220.0]);
    let own = tool(&modes, &rates);
    let alone = ToolResponse::new(own.modes().to_vec()).expect("modes");
    assert_eq!(own, alone);
    let rates = square(&[180.0, 150.0, 150.0, 220.0]);
    let turned = square(&[220.0, 150.0, 150.0, 180.0]);
    let cut = cut(3, arc("up", 0.5), aluminium());
    let limit = |tool: ToolResponse| {
        let machine = Regeneration::new(tool, cut.clone().into()).expect("a cut");
        let found = machine.stability_at(9000.0, 0.02).expect("stability");
        found.limit().expect("a limit").depth
    };
    let [a, b] = [
        limit(tool(&modes, &rates)),
        limit(tool(&[modes[1], modes[0]], &turned)),
    ];
    assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
}

#[test]
fn rates_that_are_none_are_refused() {
    let modes = [(0.3, 900.0), (1.7, 1100.0)];
    let rates = square(&[180.0, 150.0, 150.0, 220.0]);
    let own = tool(&modes, &rates);
    for (rates, says) in [
        (square(&[180.0]), "1 x 1"),
        (square(&[180.0, 150.0, 140.0, 220.0]), "symmetric"),
        (square(&[190.0, 150.0, 150.0, 220.0]), "2 zeta w"),
        (square(&[180.0, 250.0, 250.0, 220.0]), "it drives"),
        (square(&[180.0, f64::NAN, 150.0, 220.0]), "symmetric"),
    ] {
        let error = own
            .clone()
            .with_coupled_damping(rates, Vec::new())
            .expect_err(says);
        assert!(error.to_string().contains(says), "{error}");
    }
}

/// Entries of `M`, `C` and `K`, the last coordinate without mass, as modes with what dampers hold: against the inverse of all.
fn assert_without_mass(entries: &[f64], hz: f64) {
    let spd = |from: usize, size: f64, least: f64| {
        let a = Matrix4::from_iterator(entries[from..from + 16].iter().copied());
        (a * a.transpose() + Matrix4::identity() * least) * size
    };
    let (damping, stiffness) = (spd(0, 40.0, 0.05), spd(16, 1.3e6, 0.2));
    let mass = Matrix4::from_diagonal(&Vector4::new(0.04, 0.05, 0.07, 0.0));
    // What follows at rest is condensed.
    let mut follows = Matrix4x3::identity();
    for j in 0..3 {
        follows[(3, j)] = -stiffness[(3, j)] / stiffness[(3, 3)];
    }
    let condensed = follows.transpose() * stiffness * follows;
    let roots =
        Matrix3::from_diagonal(&Vector3::new(0.04, 0.05, 0.07).map(|m: f64| 1.0 / m.sqrt()));
    let eigen = (roots * condensed * roots).symmetric_eigen();
    let shapes = follows * roots * eigen.eigenvectors;
    let held = Vector4::w() / stiffness[(3, 3)].sqrt();
    let all = Matrix4::from_columns(&[
        shapes.column(0).into(),
        shapes.column(1).into(),
        shapes.column(2).into(),
        held,
    ]);
    let rates = all.transpose() * damping * all;
    let w = |k: usize| eigen.eigenvalues[k].sqrt();
    let ratio = |k: usize| 0.5 * rates[(k, k)] / w(k);
    if (0..3).any(|k| ratio(k) >= 0.99) {
        return;
    }
    // The point moves with all of them.
    let point =
        Matrix3x4::from_fn(|i, j| 1.0 + 0.3 * (i as f64) - 0.2 * ((i * j) as f64) + entries[i + j]);
    let mode = |k: usize| {
        Mode::new(point * shapes.column(k), eigen.eigenvalues[k], ratio(k)).expect("a mode")
    };
    let flexible = point * held;
    let tool = ToolResponse::new((0..3).map(mode).collect()).expect("modes");
    let tool = tool
        .with_residual(flexible * flexible.transpose())
        .and_then(|tool| {
            let rates = DMatrix::from_fn(4, 4, |i, j| rates[(i, j)]);
            tool.with_coupled_damping(rates, vec![flexible])
        })
        .expect("rates");
    let turn = std::f64::consts::TAU * hz;
    let dynamic = Matrix4::from_fn(|i, j| {
        let own = stiffness[(i, j)] - turn * turn * mass[(i, j)];
        Complex::new(own, turn * damping[(i, j)])
    });
    let point = point.map(Complex::from);
    let wanted = point * dynamic.try_inverse().expect("a receptance") * point.transpose();
    let size = |m: Matrix3<Complex<f64>>| m.map(|x| x.norm()).norm();
    let mut worst = Worst::new();
    worst.add(size(tool.receptance(hz) - wanted) / size(wanted));
    assert!(worst.of(1) < 1e-9, "{worst}");
    // Seven roots, each of `s^2 M + s C + K`.
    let process = Process::new(Vector3::x(), Vector3::y()).expect("a process");
    let mut worst = Worst::new();
    for (re, im) in coupled_roots(&tool, &process, 0.0).expect("roots") {
        let s = Complex::new(re, im);
        let at =
            Matrix4::from_fn(|i, j| s * s * mass[(i, j)] + s * damping[(i, j)] + stiffness[(i, j)]);
        worst.add(at.try_inverse().map_or(0.0, |inverse| 1.0 / inverse.norm()) / at.norm());
    }
    assert!(worst.of(7) < 1e-7, "{worst}");
    // Stability is asked for with complex modes that make this response, or it says so.
    let cut = cut(3, arc("up", 0.5), aluminium());
    let machine = Regeneration::new(tool, cut.into()).expect("a cut");
    match machine.multiplier(9000.0, 0.0) {
        Ok(multiplier) => assert!(multiplier.size() < 1.0, "{multiplier:?}"),
        Err(error) => assert!(
            error.to_string().contains("while a tooth is in the cut"),
            "{error}"
        ),
    }
}

proptest! {
    /// The same with a coordinate without mass that a damper holds, which no mode has.
    #[test]
    fn what_has_no_mass_and_dampers_is_in_the_response(
        entries in proptest::collection::vec(-1.0..1.0_f64, 32),
        hz in 50.0..2000.0_f64,
    ) {
        assert_without_mass(&entries, hz);
    }

    /// Receptance and roots are those of `M x'' + C x' + K x = F`, whatever M, C and K.
    #[test]
    fn receptances_are_those_of_the_second_order_form(
        entries in proptest::collection::vec(-1.0..1.0_f64, 27),
        hz in 50.0..2000.0_f64,
    ) {
        let spd = |from: usize, size: f64, least: f64| {
            let a = Matrix3::from_iterator(entries[from..from + 9].iter().copied());
            (a * a.transpose() + Matrix3::identity() * least) * size
        };
        let (mass, damping, stiffness) = (spd(0, 0.04, 0.3), spd(9, 8.0, 0.05), spd(18, 1.3e6, 0.2));
        let root = mass.cholesky().expect("a mass").l().try_inverse().expect("a root");
        let eigen = (root * stiffness * root.transpose()).symmetric_eigen();
        let shapes = root.transpose() * eigen.eigenvectors;
        let rates = shapes.transpose() * damping * shapes;
        let w = |k: usize| eigen.eigenvalues[k].sqrt();
        let ratio = |k: usize| 0.5 * rates[(k, k)] / w(k);
        prop_assume!((0..3).all(|k| ratio(k) < 0.99));
        let mode = |k: usize| {
            Mode::new(shapes.column(k).into(), eigen.eigenvalues[k], ratio(k)).expect("a mode")
        };
        let tool = ToolResponse::new((0..3).map(mode).collect()).expect("modes");
        let tool = tool
            .with_coupled_damping(DMatrix::from_fn(3, 3, |i, j| rates[(i, j)]), Vec::new())
            .expect("rates");
        let turn = std::f64::consts::TAU * hz;
        let dynamic = Matrix3::from_fn(|i, j| {
            Complex::new(stiffness[(i, j)] - turn * turn * mass[(i, j)], turn * damping[(i, j)])
        });
        let wanted = dynamic.try_inverse().expect("a receptance");
        let off = (tool.receptance(hz) - wanted).map(|x| x.norm()).norm() / wanted.map(|x| x.norm()).norm();
        let mut worst = Worst::new();
        worst.add(off);
        prop_assert!(worst.of(1) < 1e-9, "{worst}");
        // Without a process the roots are those of the machine alone: `det (s^2 M + s C + K)` vanishes.
        let process = Process::new(Vector3::x(), Vector3::y()).expect("a process");
        let mut worst = Worst::new();
        for (re, im) in coupled_roots(&tool, &process, 0.0).expect("roots") {
            let s = Complex::new(re, im);
            let at = Matrix3::from_fn(|i, j| {
                s * s * mass[(i, j)] + s * damping[(i, j)] + stiffness[(i, j)]
            });
            let least = at.try_inverse().map_or(0.0, |inverse| 1.0 / inverse.norm());
            worst.add(least / at.norm());
        }
        prop_assert!(worst.of(6) < 1e-7, "{worst}");
        // Stability is asked for with complex modes that make this response, or it says so.
        let machine = Regeneration::new(tool, cut(3, arc("up", 0.5), aluminium()).into()).expect("a cut");
        prop_assert!(machine.multiplier(9000.0, 0.0).expect("complex modes").size() < 1.0);
    }
}
