//! Non-negative and free unknowns, priors, unseen combinations and errors.

use crate::support::Random;
use crate::{active_set, link_problem};
use kinetostat_identification::{ConeError, ConeLeastSquares, ConeSolution, Constraint};
use nalgebra::{DMatrix, DVector};

fn non_negative(columns: usize) -> Vec<Constraint> {
    (0..columns).map(Constraint::NonNegative).collect()
}

/// Random rows with columns of size 1e-3 to 1e3, and data.
fn random_problem(seed: u64, rows: usize, columns: usize) -> (DMatrix<f64>, DVector<f64>) {
    let mut random = Random::new(seed);
    let sizes: Vec<f64> = (0..columns)
        .map(|_| 10_f64.powf(random.between(-3.0, 3.0)))
        .collect();
    let a = DMatrix::from_fn(rows, columns, |_, k| sizes[k] * random.normal());
    let y = DVector::from_fn(rows, |_, _| random.normal());
    (a, y)
}

#[test]
fn non_negative_unknowns_agree_with_an_active_set_method() {
    for seed in 0..50 {
        let columns = 3 + seed as usize % 20;
        let (a, y) = random_problem(seed, columns + 10, columns);
        let expected = active_set::non_negative(&a, &y);
        let constraints = non_negative(columns);
        let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
        let least = 0.5 * (&a * &expected - &y).norm_squared();
        assert!((solution.objective / least - 1.0).abs() < 1e-12, "{seed}");
        for k in 0..columns {
            let error = (solution.x[k] - expected[k]).abs() * a.column(k).norm();
            assert!(error < 1e-9, "{seed} {k} {error:e}");
            let is_zero = expected[k] == 0.0;
            assert_eq!(is_zero, solution.blocks[k].at_bound == 1);
            assert_eq!(is_zero, solution.x[k] == 0.0);
        }
    }
}

#[test]
fn objective_is_certified_for_mixed_problems() {
    // 7 links, 6 joints and 3 free unknowns, as for a six-axis robot; the truth lies on the boundary.
    let mut random = Random::new(5);
    let p = 7 * 21 + 6 + 3;
    let a = DMatrix::from_fn(300, p, |_, _| random.normal());
    let mut truth = DVector::zeros(p);
    let mut constraints = Vec::new();
    for first in (0..147).step_by(21) {
        let factor = DMatrix::from_fn(6, 4, |_, _| random.normal());
        let c = &factor * factor.transpose();
        for (k, (i, j)) in link_problem::entries().enumerate() {
            truth[first + k] = c[(i, j)];
        }
        constraints.push(Constraint::PositiveSemidefinite(
            (first..first + 21).collect(),
        ));
    }
    constraints.extend((147..153).map(Constraint::NonNegative));
    let y = &a * &truth + DVector::from_fn(300, |_, _| 0.1 * random.normal());
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    assert!(solution.gap < 1e-12 * solution.objective);
    assert!(solution.kkt.stationarity < 1e-12 && solution.kkt.dual_infeasibility < 1e-12);
    let unconstrained = ConeLeastSquares::new(&a, &y, &[]).solve().unwrap();
    let error = |s: &ConeSolution| (&s.x - &truth).norm();
    assert!(error(&solution) < error(&unconstrained));
    assert!(
        solution.blocks[..7]
            .iter()
            .all(|b| b.eigenvalues[0] > -1e-12)
    );
}

#[test]
fn equal_columns_share_their_effect_equally() {
    // Only the sum of unknowns 0 and 1 is seen; unknown 2 is at its bound.
    let mut random = Random::new(3);
    let mut a = DMatrix::from_fn(12, 4, |_, _| random.normal());
    let copy = a.column(0).into_owned();
    a.set_column(1, &copy);
    let noise = DVector::from_fn(12, |_, _| 1e-2 * random.normal());
    let y = &a * DVector::from_vec(vec![1.0, 2.0, -1.0, 0.5]) + noise;
    let constraints = non_negative(4);
    let problem = ConeLeastSquares::new(&a, &y, &constraints);
    let solution = problem.clone().solve().unwrap();
    assert_eq!((solution.rank, solution.unseen.ncols()), (3, 1));
    assert!((&a * &solution.unseen).amax() < 1e-12);
    assert!((solution.x[0] / solution.x[1] - 1.0).abs() < 1e-6);
    assert_eq!(solution.x[2], 0.0);
    assert!(solution.penalty < 1e-7 * solution.objective);
    let least = 0.5 * (&a * active_set::non_negative(&a, &y) - &y).norm_squared();
    assert!((solution.objective / least - 1.0).abs() < 1e-9);
    // The reference decides how the sum is split, up to the bound.
    let x0 = DVector::from_vec(vec![9.0, 1.0, 0.0, 0.0]);
    let near = problem.reference(&x0).solve().unwrap();
    assert!((near.objective / least - 1.0).abs() < 1e-6);
    assert!(near.x[1] < 1e-6 && (near.x[0] - 2.0 * solution.x[0]).abs() < 1e-5);
}

#[test]
fn unseen_entries_of_a_link_have_an_answer() {
    // Forces along x and z alone: the rows see 11 of 21 entries, and the noise makes C11 negative.
    let mut random = Random::new(8);
    let (mut a, mut y) = (DMatrix::zeros(0, 21), Vec::new());
    for k in 0..10 {
        let mut wrench = DVector::zeros(6);
        wrench[if k % 2 == 0 { 0 } else { 2 }] = 1000.0;
        let sigma = 4e-6;
        let twist = link_problem::tube() * &wrench;
        let first = a.nrows();
        a = a.insert_rows(first, 6, 0.0);
        a.rows_mut(first, 6)
            .copy_from(&(link_problem::rows(&wrench) / sigma));
        y.extend(twist.iter().map(|t| t / sigma + random.normal()));
        y[first] -= if k % 2 == 0 { 1.0 } else { 0.0 };
    }
    let y = DVector::from_vec(y);
    let constraints = [Constraint::PositiveSemidefinite((0..21).collect())];
    let free = ConeLeastSquares::new(&a, &y, &[]).solve().unwrap();
    assert!(free.x[0] < 0.0);
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    assert_eq!((solution.rank, solution.unseen.ncols()), (11, 10));
    assert!(solution.gap < 1e-9 * solution.objective);
    let share = solution.penalty / solution.objective;
    assert!(
        share < 1e-7,
        "{share:e} {:?}",
        solution.blocks[0].eigenvalues
    );
    assert!(solution.x.iter().all(|v| v.is_finite()));
    assert!(solution.blocks[0].eigenvalues[0] > -1e-9);
    // C11 is zero, but noise makes seen entries of its row differ from zero: unseen diagonal entries tend to infinity.
    let tube = link_problem::tube();
    let c = link_problem::matrix(solution.x.as_slice());
    assert!(solution.blocks[0].at_bound > 0);
    assert!(c[(1, 1)] > 1e3 * tube[(1, 1)]);
    // A prior keeps them.
    let x0 = DVector::from_iterator(21, link_problem::entries().map(|(i, j)| tube[(i, j)]));
    let sizes: Vec<f64> = (link_problem::entries())
        .map(|(i, j)| (tube[(i, i)] * tube[(j, j)]).sqrt())
        .collect();
    let precision = DVector::from_fn(21, |k, _| (0.5 * sizes[k]).powi(-2));
    let precision = DMatrix::from_diagonal(&precision);
    let problem = ConeLeastSquares::new(&a, &y, &constraints).nominal_sizes(&sizes);
    let near = problem.prior(&x0, &precision).solve().unwrap();
    assert_eq!((near.rank, near.penalty), (21, 0.0));
    assert!(near.gap < 1e-12 * near.objective);
    let c = link_problem::matrix(near.x.as_slice());
    for i in 1..6 {
        let ratio = c[(i, i)] / tube[(i, i)];
        assert!(ratio > 0.5 && ratio < 2.0, "{i} {ratio}");
    }
}

#[test]
fn a_column_of_zeros_keeps_the_reference() {
    let a = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 2.0, 0.0, 1.0, 0.0]);
    let y = DVector::from_vec(vec![-1.0, -2.0, -1.5]);
    let x0 = DVector::from_vec(vec![0.0, 4.0]);
    let constraints = non_negative(2);
    let problem = ConeLeastSquares::new(&a, &y, &constraints).reference(&x0);
    let solution = problem.solve().unwrap();
    assert_eq!((solution.rank, solution.x[0]), (1, 0.0));
    assert!((solution.x[1] - 4.0).abs() < 1e-6, "{}", solution.x[1]);
    assert_eq!(solution.blocks[1].at_bound, 0);
}

#[test]
fn data_without_residuals_are_reproduced() {
    let (a, _) = random_problem(9, 30, 8);
    let truth = DVector::from_fn(8, |k, _| (k % 2) as f64 / a.column(k).norm());
    let y = &a * &truth;
    let constraints = non_negative(8);
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    for k in 0..8 {
        let error = (solution.x[k] - truth[k]).abs() * a.column(k).norm();
        assert!(error < 1e-9, "{k} {error:e}");
    }
}

#[test]
fn a_prior_equals_rows_and_determines_unseen_unknowns() {
    let (a, y) = random_problem(4, 5, 8);
    let mean = DVector::from_fn(8, |k, _| 0.3 / a.column(k).norm());
    let sigma = DVector::from_fn(8, |k, _| 0.5 / a.column(k).norm());
    let precision = DMatrix::from_diagonal(&sigma.map(|s| s.powi(-2)));
    let constraints = non_negative(8);
    let problem = ConeLeastSquares::new(&a, &y, &constraints);
    let solution = problem.prior(&mean, &precision).solve().unwrap();
    assert_eq!((solution.rank, solution.penalty), (8, 0.0));
    let mut rows = a.clone().insert_rows(5, 8, 0.0);
    let data = DVector::from_iterator(
        13,
        (y.iter().copied()).chain((0..8).map(|k| mean[k] / sigma[k])),
    );
    for k in 0..8 {
        rows[(5 + k, k)] = 1.0 / sigma[k];
    }
    let expected = active_set::non_negative(&rows, &data);
    let least = 0.5 * (&rows * &expected - &data).norm_squared();
    assert!((solution.objective / least - 1.0).abs() < 1e-12);
    assert!(solution.objective > 0.5 * solution.chi_squared);
    // A singular precision determines nothing beyond its range.
    let mut singular = DMatrix::zeros(8, 8);
    singular[(0, 0)] = precision[(0, 0)];
    let problem = ConeLeastSquares::new(&a, &y, &constraints);
    assert_eq!(problem.prior(&mean, &singular).solve().unwrap().rank, 6);
}

#[test]
fn smallest_problem_has_the_known_optimum() {
    // 2 x 2 matrix nearest to diag(1, -1) with weights 1: diag(1, 0), dual diag(0, 1).
    let a = DMatrix::identity(3, 3);
    let y = DVector::from_vec(vec![1.0, 0.0, -1.0]);
    let constraints = [Constraint::PositiveSemidefinite(vec![0, 1, 2])];
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    let expected = DVector::from_vec(vec![1.0, 0.0, 0.0]);
    assert!((&solution.x - expected).amax() < 1e-9);
    assert!((solution.objective - 0.5).abs() < 1e-12);
    let block = &solution.blocks[0];
    let dual = DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, 1.0]);
    assert!((&block.dual - dual).amax() < 1e-9);
    assert_eq!(block.at_bound, 1);
    assert!((block.rigid_loads[(1, 0)].abs() - 1.0).abs() < 1e-12);
}

#[test]
fn data_of_zeros_give_zeros() {
    let (a, _) = random_problem(2, 9, 4);
    let y = DVector::zeros(9);
    let constraints = non_negative(4);
    let solution = ConeLeastSquares::new(&a, &y, &constraints).solve().unwrap();
    assert_eq!(solution.x, DVector::zeros(4));
    assert_eq!(solution.objective, 0.0);
}

#[test]
fn wrong_input_is_refused() {
    let (a, y) = random_problem(1, 6, 3);
    let refuse = |constraints: &[Constraint]| {
        let error = ConeLeastSquares::new(&a, &y, constraints).solve();
        error.err().unwrap()
    };
    let out = refuse(&[Constraint::NonNegative(3)]);
    assert_eq!(
        out,
        ConeError::Column {
            column: 3,
            columns: 3
        }
    );
    let semidefinite = |columns: &[usize]| Constraint::PositiveSemidefinite(columns.to_vec());
    assert_eq!(refuse(&[semidefinite(&[0, 1])]), ConeError::Triangle(2));
    assert_eq!(refuse(&[semidefinite(&[])]), ConeError::Triangle(0));
    let twice = refuse(&[semidefinite(&[0, 1, 2]), Constraint::NonNegative(1)]);
    assert_eq!(
        twice,
        ConeError::Column {
            column: 1,
            columns: 3
        }
    );

    let short = DVector::zeros(5);
    let error = ConeLeastSquares::new(&a, &short, &[])
        .solve()
        .err()
        .unwrap();
    assert!(matches!(
        error,
        ConeError::Size {
            found: 5,
            expected: 6,
            ..
        }
    ));
    let mut broken = y.clone();
    broken[2] = f64::NAN;
    let error = ConeLeastSquares::new(&a, &broken, &[])
        .solve()
        .err()
        .unwrap();
    assert_eq!(error, ConeError::NotFinite("the data vector"));
    let mean = DVector::zeros(3);
    let indefinite = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, -1.0, 1.0]));
    let problem = ConeLeastSquares::new(&a, &y, &[]).prior(&mean, &indefinite);
    assert_eq!(problem.solve().err(), Some(ConeError::Precision));
    let problem = ConeLeastSquares::new(&a, &y, &[]).nominal_sizes(&[1.0, 0.0, 1.0]);
    let error = problem.solve().err();
    assert_eq!(
        error,
        Some(ConeError::NominalSize {
            column: 1,
            size: 0.0
        })
    );
    let empty = DMatrix::zeros(0, 3);
    let error = ConeLeastSquares::new(&empty, &mean, &[]).solve().err();
    assert_eq!(
        error,
        Some(ConeError::Size {
            what: "the matrix",
            found: 0,
            expected: 1
        })
    );
}
