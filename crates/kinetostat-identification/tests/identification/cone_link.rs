//! Positive semi-definite link compliance: problem P4 of the reference values.

use crate::link_problem;
use kinetostat_identification::{ConeLeastSquares, Constraint};
use nalgebra::{DMatrix, DVector};

fn semidefinite() -> [Constraint; 1] {
    [Constraint::PositiveSemidefinite((0..21).collect())]
}

#[test]
fn symmetric_least_squares_of_p4_is_indefinite() {
    let (a, y) = link_problem::problem();
    let solution = ConeLeastSquares::new(&a, &y, &[]).solve().unwrap();
    assert!((solution.chi_squared / 86.49963813 - 1.0).abs() < 1e-9);
    assert_eq!((solution.rank, solution.newton_steps), (21, 0));
    let sizes = link_problem::tube().diagonal().map(f64::sqrt);
    let mut scaled = link_problem::matrix(solution.x.as_slice());
    for (a, b) in (0..6).flat_map(|a| (0..6).map(move |b| (a, b))) {
        scaled[(a, b)] /= sizes[a] * sizes[b];
    }
    let smallest = scaled.symmetric_eigenvalues().min();
    assert!((smallest + 0.5312173956).abs() < 1e-9);
}

#[test]
fn semidefinite_optimum_of_p4() {
    let (a, y) = link_problem::problem();
    let constraints = semidefinite();
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    assert!((solution.chi_squared / 86.63962781 - 1.0).abs() < 1e-9);
    assert!((solution.objective - solution.chi_squared / 2.0).abs() < 1e-12);
    let c = link_problem::matrix(solution.x.as_slice());
    for (row, column, expected) in [
        (1, 1, 2.30913e-11),
        (2, 2, 1.733892e-8),
        (3, 3, 1.806975e-8),
        (4, 4, 6.650406e-8),
        (5, 5, 5.171798e-8),
        (6, 6, 5.293750e-8),
        (2, 6, 2.612700e-8),
        (3, 5, -2.495038e-8),
    ] {
        let value = c[(row - 1, column - 1)];
        assert!(
            (value / expected - 1.0).abs() < 1e-5,
            "C{row}{column} {value}"
        );
    }
    assert!(
        solution.gap <= 1e-13 * solution.objective,
        "{}",
        solution.gap
    );
    assert!(solution.kkt.dual_infeasibility < 1e-13);
    assert!(solution.kkt.complementarity < 1e-13);
    let block = &solution.blocks[0];
    assert_eq!(block.at_bound, 1);
    assert!(block.eigenvalues[0].abs() < 1e-12 && block.eigenvalues[1] > 0.01);
    // The load that deflects nothing is nearly axial, where the link is stiffest.
    let load = block.rigid_loads.column(0);
    assert!((load[0].abs() - 1.0).abs() < 1e-12);
    let forces = DMatrix::from_diagonal(&load.abs());
    assert!((&c * load).amax() < 1e-9 * (c.abs() * forces).amax());
}

#[test]
fn optimality_conditions_hold_for_the_original_rows() {
    let (a, y) = link_problem::problem();
    let constraints = semidefinite();
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    let gradient = a.tr_mul(&(&a * &solution.x - &y));
    let dual = &solution.blocks[0].dual;
    for (k, (i, j)) in link_problem::entries().enumerate() {
        let entry = dual[(i, j)] * if i == j { 1.0 } else { 2.0 };
        // Columns of the rows have very different length, gradients have, too.
        let size = a.column(k).norm() * 1e-10;
        assert!((entry - gradient[k]).abs() < size, "{i} {j}");
    }
    let c = link_problem::matrix(solution.x.as_slice());
    assert!(c.dot(dual).abs() < 1e-9);
    // Both matrices scaled by the sizes of the tube: eigenvalues of units alike.
    let d = DMatrix::from_diagonal(&link_problem::tube().diagonal().map(f64::sqrt));
    let z = &d * dual * &d;
    let eigenvalues = z.symmetric_eigenvalues();
    assert!(
        eigenvalues.min() > -1e-10 * eigenvalues.amax(),
        "{eigenvalues}"
    );
    let inverse = DMatrix::from_diagonal(&d.diagonal().map(|v| 1.0 / v));
    let x = &inverse * c * &inverse;
    assert!(x.symmetric_eigenvalues().min() > -1e-12);
}

#[test]
fn inside_the_cone_the_constraint_changes_nothing() {
    let (a, _) = link_problem::problem();
    let truth = link_problem::tube();
    let x = DVector::from_iterator(21, link_problem::entries().map(|(i, j)| truth[(i, j)]));
    let y = &a * &x;
    let constraints = semidefinite();
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    assert_eq!((solution.newton_steps, solution.blocks[0].at_bound), (0, 0));
    let error = (link_problem::matrix(solution.x.as_slice()) - &truth).norm();
    assert!(error < 1e-12 * truth.norm());
}

#[test]
fn a_block_inside_the_cone_is_exact_beside_an_active_one() {
    // Two links without common rows: the first is P4, the second has data without noise.
    let (a, y) = link_problem::problem();
    let truth = link_problem::tube();
    let x = DVector::from_iterator(21, link_problem::entries().map(|(i, j)| truth[(i, j)]));
    let mut both = DMatrix::zeros(216, 42);
    both.view_mut((0, 0), (108, 21)).copy_from(&a);
    both.view_mut((108, 21), (108, 21)).copy_from(&a);
    let data = DVector::from_iterator(216, y.iter().chain(&(&a * x)).copied());
    let constraints = [
        Constraint::PositiveSemidefinite((0..21).collect()),
        Constraint::PositiveSemidefinite((21..42).collect()),
    ];
    let solution = ConeLeastSquares::new(&both, &data, &constraints)
        .solve()
        .unwrap();
    assert!(solution.newton_steps > 0);
    assert!((solution.chi_squared / 86.63962781 - 1.0).abs() < 1e-9);
    let at_bound: Vec<usize> = solution.blocks.iter().map(|b| b.at_bound).collect();
    assert_eq!(at_bound, [1, 0]);
    let error = (link_problem::matrix(&solution.x.as_slice()[21..]) - &truth).norm();
    assert!(error < 1e-9 * truth.norm(), "{:e}", error / truth.norm());
}

#[test]
fn units_do_not_change_the_optimum() {
    let (a, y) = link_problem::problem();
    let constraints = semidefinite();
    let metres = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    // Any change of the units of forces and moments, for which C' = S C S.
    let units = [1e3, 2e3, 500.0, 1.0, 7.0, 0.1];
    let factors: Vec<f64> = link_problem::entries()
        .map(|(i, j)| units[i] * units[j])
        .collect();
    let mut b = a.clone();
    for (mut column, factor) in b.column_iter_mut().zip(&factors) {
        column /= *factor;
    }
    let other = ConeLeastSquares::new(&b, &y, &constraints).solve().unwrap();
    assert!((other.chi_squared / metres.chi_squared - 1.0).abs() < 1e-10);
    let back = DVector::from_fn(21, |k, _| other.x[k] / factors[k]);
    let error = link_problem::matrix(back.as_slice()) - link_problem::matrix(metres.x.as_slice());
    let sizes = link_problem::tube().diagonal().map(f64::sqrt);
    for (i, j) in link_problem::entries() {
        assert!(error[(i, j)].abs() < 1e-9 * sizes[i] * sizes[j], "{i} {j}");
    }
    // Nominal sizes scale differently; the optimum is the same.
    let nominal: Vec<f64> = link_problem::entries()
        .map(|(i, j)| sizes[i] * sizes[j])
        .collect();
    let problem = ConeLeastSquares::new(&a, &y, &constraints);
    let scaled = problem.nominal_sizes(&nominal).solve().unwrap();
    assert!((scaled.chi_squared / metres.chi_squared - 1.0).abs() < 1e-10);
}

#[test]
fn repeated_rows_multiply_the_objective() {
    let (a, y) = link_problem::problem();
    let constraints = semidefinite();
    let once = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    let times = 50;
    let rows: Vec<_> = (0..times).flat_map(|_| a.row_iter()).collect();
    let many = DMatrix::from_rows(&rows);
    let data = DVector::from_fn(times * 108, |i, _| y[i % 108]);
    let repeated = ConeLeastSquares::new(&many, &data, &constraints)
        .solve()
        .unwrap();
    let ratio = repeated.objective / (times as f64 * once.objective);
    assert!((ratio - 1.0).abs() < 1e-10);
    assert!((&repeated.x - &once.x).norm() < 1e-9 * once.x.norm());
}
