//! The one linear solver for bordered and aggregated systems. It owns redundancy: where the matrix
//! is singular (a strut that spins, a direction that is rigid or free) it returns the solution of
//! least norm and the rank, never an exception.

use nalgebra::{DMatrix, Dyn, LU};

use crate::linalg::singular_values::{SingularValues, range};
use crate::number::{larger, smaller};

/// Pivots or singular values below this share of the largest count as zero. Regular machines stay
/// above 1e-8 in scaled units (flat postures to 1 um included); rounding stays below 1e-13.
pub(crate) const RANK_TOLERANCE: f64 = 1e-11;

/// A factorised square system `A x = b`, scaled by `scale` on both sides.
pub struct Saddle {
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    factors: Factors,
}

enum Factors {
    Regular(LU<f64, Dyn, Dyn>),
    Singular {
        matrix: DMatrix<f64>,
        inverse: DMatrix<f64>,
    },
}

impl Saddle {
    /// Factorises `diag(row_scale) A diag(column_scale)`.
    pub fn new(mut a: DMatrix<f64>, row_scale: &[f64], column_scale: &[f64]) -> Self {
        let n = a.nrows();
        for (j, mut column) in a.column_iter_mut().enumerate() {
            for (i, x) in column.iter_mut().enumerate() {
                *x *= row_scale[i] * column_scale[j];
            }
        }
        let lu = a.clone().lu();
        let pivots = lu.lu_internal().diagonal();
        let (least, most) = pivots.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), p| {
            (smaller(l, p.abs()), larger(m, p.abs()))
        });
        let factors = if n == 0 || least > 10.0 * RANK_TOLERANCE * most {
            Factors::Regular(lu)
        } else {
            Factors::Singular {
                inverse: pseudo_inverse(&a).0,
                matrix: a,
            }
        };
        Self {
            row_scale: row_scale.to_vec(),
            column_scale: column_scale.to_vec(),
            factors,
        }
    }

    /// Solves for all columns of `b`, in place.
    pub fn solve(&self, b: &mut DMatrix<f64>) {
        if self.row_scale.is_empty() {
            return; // a chain without coordinates; nalgebra takes no empty system
        }
        for mut column in b.column_iter_mut() {
            for (x, s) in column.iter_mut().zip(&self.row_scale) {
                *x *= s;
            }
        }
        match &self.factors {
            Factors::Regular(lu) => {
                // The pivots were checked, so the triangular solves cannot fail.
                let solved = lu.solve_mut(b);
                debug_assert!(solved);
            }
            Factors::Singular { matrix, inverse } => {
                let mut x = inverse * &*b;
                // Once more for what rounding left.
                let rest = &*b - matrix * &x;
                x += inverse * rest;
                *b = x;
            }
        }
        for mut column in b.column_iter_mut() {
            for (x, s) in column.iter_mut().zip(&self.column_scale) {
                *x *= s;
            }
        }
    }
}

/// Moore-Penrose inverse and rank of a scaled matrix.
pub fn pseudo_inverse(a: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    if a.iter().any(|x| !x.is_finite()) {
        return (DMatrix::from_element(a.ncols(), a.nrows(), f64::NAN), 0);
    }
    if a.is_empty() {
        return (DMatrix::zeros(a.ncols(), a.nrows()), 0);
    }
    let own = SingularValues::of(a);
    (own.pseudo_inverse(RANK_TOLERANCE), own.rank(RANK_TOLERANCE))
}

/// True if the (fewer) rows of a wide scaled matrix are certainly independent: a cheap test by
/// its Gram matrix, whose pivots are squares of the matrix's own.
pub(crate) fn rows_certainly_independent(a: &DMatrix<f64>) -> bool {
    if a.nrows() > a.ncols() {
        return false;
    }
    let gram = a * a.transpose();
    gram.cholesky().is_some_and(|c| {
        let d = c.l_dirty().diagonal();
        d.min() > 1e-4 * d.max()
    })
}

/// Orthonormal bases of the column space and rank of a scaled matrix, by its singular values.
pub fn column_space(a: &DMatrix<f64>) -> DMatrix<f64> {
    if a.is_empty() {
        return DMatrix::zeros(a.nrows(), 0);
    }
    if rows_certainly_independent(a) {
        return DMatrix::identity(a.nrows(), a.nrows());
    }
    crate::linalg::singular_values::range(a, RANK_TOLERANCE)
}

/// Number of positive, negative and zero eigenvalues.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Inertia {
    /// Number of eigenvalues above zero by more than rounding.
    pub positive: usize,
    /// Number of eigenvalues below zero by more than rounding.
    pub negative: usize,
    /// Number of eigenvalues that are zero within rounding.
    pub zero: usize,
}

/// Inertia of a scaled symmetric matrix, from its Bunch-Kaufman factors (Sylvester's law).
pub fn inertia(a: DMatrix<f64>) -> Inertia {
    let n = a.nrows();
    let mut count = Inertia::default();
    if n == 0 {
        return count;
    }
    let most = a.amax().max(f64::MIN_POSITIVE);
    let d = nalgebra::linalg::LBLT::new(a).d();
    let mut note = |value: f64| {
        // The sign of NaN is not known.
        if value.is_nan() || value.abs() <= RANK_TOLERANCE * most {
            count.zero += 1;
        } else if value > 0.0 {
            count.positive += 1;
        } else {
            count.negative += 1;
        }
    };
    let mut i = 0;
    while i < n {
        if i + 1 < n && d[(i + 1, i)] != 0.0 {
            let (p, q, r) = (d[(i, i)], d[(i + 1, i)], d[(i + 1, i + 1)]);
            let middle = 0.5 * (p + r);
            let radius = (0.25 * (p - r) * (p - r) + q * q).sqrt();
            note(middle + radius);
            note(middle - radius);
            i += 2;
        } else {
            note(d[(i, i)]);
            i += 1;
        }
    }
    count
}

/// Orthonormal basis of the span of the columns, by singular values. Columns may be fewer or more
/// than rows.
pub(crate) fn independent_columns(a: &DMatrix<f64>) -> DMatrix<f64> {
    range(a, 1e-10)
}
