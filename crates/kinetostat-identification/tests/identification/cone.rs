//! Constraints: link compliance P4 of the reference values, non-negative numbers, combinations that nothing shows.

use kinetostat_identification::{Constrained, ConstrainedRows, Constraint};
use kinetostat_testing::largest_size;
use nalgebra::{DMatrix, DVector};

use crate::support::Random;
use crate::{active_set, link_problem};

type Outcome = anyhow::Result<()>;

fn link() -> [Constraint; 1] {
    [Constraint::PositiveSemidefinite((0..21).collect())]
}

fn solved(
    a: &DMatrix<f64>,
    y: &DVector<f64>,
    constraints: &[Constraint],
    reference: &DVector<f64>,
    sizes: &DVector<f64>,
) -> anyhow::Result<Constrained> {
    Ok(ConstrainedRows {
        matrix: a,
        values: y,
        constraints,
        reference,
        sizes,
    }
    .solve()?)
}

/// Sizes of the entries of the tube of P4.
fn sizes() -> DVector<f64> {
    let tube = link_problem::tube();
    let each = link_problem::entries().map(|(a, b)| (tube[(a, a)] * tube[(b, b)]).sqrt());
    DVector::from_iterator(21, each)
}

#[test]
fn symmetric_least_squares_of_p4_is_indefinite() -> Outcome {
    let (a, y) = link_problem::problem();
    let free = a.clone().qr().solve_of(&a, &y)?;
    assert!(((&a * &free - &y).norm_squared() / 86.49963813 - 1.0).abs() < 1e-9);
    let scale = link_problem::tube().diagonal().map(f64::sqrt);
    let mut scaled = link_problem::matrix(free.as_slice());
    for (i, k) in (0..6).flat_map(|i| (0..6).map(move |k| (i, k))) {
        scaled[(i, k)] /= scale[i] * scale[k];
    }
    assert!((scaled.symmetric_eigenvalues().min() + 0.5312173956).abs() < 1e-8);
    assert!(!link()[0].holds(&free));
    Ok(())
}

/// Least squares by orthogonal columns.
trait SolveOf {
    fn solve_of(&self, a: &DMatrix<f64>, y: &DVector<f64>) -> anyhow::Result<DVector<f64>>;
}

impl SolveOf for nalgebra::QR<f64, nalgebra::Dyn, nalgebra::Dyn> {
    fn solve_of(&self, a: &DMatrix<f64>, y: &DVector<f64>) -> anyhow::Result<DVector<f64>> {
        let right = self.q().tr_mul(y);
        let found = self
            .r()
            .solve_upper_triangular(&right.rows(0, a.ncols()).into_owned());
        found.ok_or_else(|| anyhow::anyhow!("singular"))
    }
}

#[test]
fn semidefinite_optimum_of_p4() -> Outcome {
    let (a, y) = link_problem::problem();
    let zero = DVector::zeros(21);
    let found = solved(&a, &y, &link(), &zero, &sizes())?;
    assert!(
        (2.0 * found.objective / 86.63962781 - 1.0).abs() < 1e-9,
        "{}",
        found.objective
    );
    assert!(
        found.gap < 1e-9 * found.objective && found.kkt < 1e-6,
        "{found:?}"
    );
    assert_eq!(found.at_bound, [1]);
    let c = link_problem::matrix(found.estimate.as_slice());
    let entries = [
        (0, 0, 2.30913e-11),
        (1, 1, 1.733892e-8),
        (2, 2, 1.806975e-8),
        (3, 3, 6.650406e-8),
        (4, 4, 5.171798e-8),
        (5, 5, 5.293750e-8),
        (1, 5, 2.612700e-8),
        (2, 4, -2.495038e-8),
    ];
    for (i, k, expected) in entries {
        assert!(
            (c[(i, k)] / expected - 1.0).abs() < 1e-4,
            "{i} {k}: {}",
            c[(i, k)]
        );
    }
    // Another start, and other units: lengths in mm.
    let from_nominal = DVector::from_iterator(
        21,
        link_problem::entries().map(|(i, k)| link_problem::tube()[(i, k)]),
    );
    let again = solved(&a, &y, &link(), &from_nominal, &sizes())?;
    assert!((again.objective / found.objective - 1.0).abs() < 1e-9);
    let unit = DVector::from_iterator(
        21,
        link_problem::entries().map(|(i, k)| {
            let of = |axis: usize| if axis < 3 { 1e3 } else { 1.0 };
            of(i) * of(k)
        }),
    );
    let in_mm = DMatrix::from_fn(a.nrows(), 21, |r, c| a[(r, c)] / unit[c]);
    let again = solved(&in_mm, &y, &link(), &zero, &sizes().component_mul(&unit))?;
    let off = (again.estimate.component_div(&unit) - &found.estimate).component_div(&sizes());
    let off = largest_size(off.iter().copied());
    assert!(
        (again.objective / found.objective - 1.0).abs() < 1e-9 && off < 1e-4,
        "{off:e}"
    );
    Ok(())
}

#[test]
fn non_negative_unknowns_agree_with_an_active_set_method() -> Outcome {
    for seed in 0..50 {
        let mut random = Random::new(seed);
        let (rows, columns) = (20 + (seed as usize % 20), 3 + (seed as usize % 9));
        let sizes = DVector::from_fn(columns, |_, _| 10_f64.powf(random.between(-3.0, 3.0)));
        let a = DMatrix::from_fn(rows, columns, |_, k| random.normal() / sizes[k]);
        let y = DVector::from_fn(rows, |_, _| random.normal());
        let wanted = active_set::non_negative(&a, &y);
        let constraints: Vec<Constraint> = (0..columns).map(Constraint::NonNegative).collect();
        let found = solved(&a, &y, &constraints, &sizes, &sizes)?;
        let least = 0.5 * (&a * &wanted - &y).norm_squared();
        assert!(
            (found.objective / least - 1.0).abs() < 1e-8,
            "{seed}: {} {least}",
            found.objective
        );
        let off = (&found.estimate - &wanted).component_div(&sizes);
        let off = largest_size(off.iter().copied());
        let size = largest_size(wanted.component_div(&sizes).iter().copied());
        assert!(off < 1e-4 * size.max(1.0), "{seed}: {off:e}");
        for (k, count) in found.at_bound.iter().enumerate() {
            assert_eq!(*count == 1, wanted[k] == 0.0, "{seed}: {k}");
        }
    }
    Ok(())
}

#[test]
fn what_nothing_shows_stays_near_the_reference() -> Outcome {
    // Two columns are the same, one is zero; the third is pushed to its bound.
    let a = DMatrix::from_row_slice(
        4,
        4,
        &[
            1.0, 1.0, 0.5, 0.0, 2.0, 2.0, 0.1, 0.0, 0.5, 0.5, -1.0, 0.0, 1.0, 1.0, 1.0, 0.0,
        ],
    );
    let y = DVector::from_vec(vec![1.0, 2.2, 1.6, 0.2]);
    let constraints: Vec<Constraint> = (0..4).map(Constraint::NonNegative).collect();
    let reference = DVector::from_vec(vec![0.3, 0.1, 0.2, 0.7]);
    let found = solved(&a, &y, &constraints, &reference, &DVector::repeat(4, 1.0))?;
    assert_eq!(found.at_bound, [0, 0, 1, 0]);
    assert!((found.estimate[3] - 0.7).abs() < 1e-2, "{}", found.estimate);
    // Both grow by the same from where the reference has them.
    assert!(
        (found.estimate[0] - found.estimate[1] - 0.2).abs() < 1e-2,
        "{}",
        found.estimate
    );
    Ok(())
}

#[test]
fn a_matrix_of_numbers_that_are_none_is_refused() {
    let (a, mut y) = link_problem::problem();
    y[3] = f64::NAN;
    assert!(solved(&a, &y, &link(), &DVector::zeros(21), &sizes()).is_err());
}
