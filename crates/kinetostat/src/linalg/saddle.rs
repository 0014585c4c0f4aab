//! The one linear solver for bordered and aggregated systems. It owns redundancy: where the matrix
//! is singular (a strut that spins, a direction that is rigid or free) it returns the solution of
//! least norm and the rank, never an exception.

use nalgebra::{DMatrix, Dyn, LU};

use crate::linalg::singular_values::{SingularValues, range};

/// Pivots or singular values below this share of the largest count as zero. Regular machines stay
/// above 1e-8 in balanced units (flat postures to 1 um included); rounding stays below 1e-13.
pub(crate) const RANK_TOLERANCE: f64 = 1e-11;

/// A factorised square system `A x = b`, balanced by `scale` on both sides.
pub(crate) struct Saddle {
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
            (l.min(p.abs()), m.max(p.abs()))
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

/// Moore-Penrose inverse and rank of a balanced matrix.
pub(crate) fn pseudo_inverse(a: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    if a.iter().any(|x| !x.is_finite()) {
        return (DMatrix::from_element(a.ncols(), a.nrows(), f64::NAN), 0);
    }
    if a.is_empty() {
        return (DMatrix::zeros(a.ncols(), a.nrows()), 0);
    }
    let own = SingularValues::of(a);
    (own.pseudo_inverse(RANK_TOLERANCE), own.rank(RANK_TOLERANCE))
}

/// True if the (fewer) rows of a wide balanced matrix are certainly independent: a cheap test by
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

/// Orthonormal bases of the column space and rank of a balanced matrix, by its singular values.
pub(crate) fn column_space(a: &DMatrix<f64>) -> DMatrix<f64> {
    if a.is_empty() {
        return DMatrix::zeros(a.nrows(), 0);
    }
    if rows_certainly_independent(a) {
        return DMatrix::identity(a.nrows(), a.nrows());
    }
    crate::linalg::singular_values::range(a, RANK_TOLERANCE)
}

/// Number of positive, negative and zero eigenvalues.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Inertia {
    /// Positive eigenvalues.
    pub positive: usize,
    /// Negative eigenvalues.
    pub negative: usize,
    /// Eigenvalues that are zero within rounding.
    pub zero: usize,
}

/// Inertia of a balanced symmetric matrix, from its Bunch-Kaufman factors (Sylvester's law).
pub(crate) fn inertia(a: DMatrix<f64>) -> Inertia {
    let n = a.nrows();
    let mut count = Inertia::default();
    if n == 0 {
        return count;
    }
    let most = a.amax().max(f64::MIN_POSITIVE);
    let d = nalgebra::linalg::LBLT::new(a).d();
    let mut note = |value: f64| {
        if value.abs() <= RANK_TOLERANCE * most {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::complement::complement;

    #[test]
    fn singular_systems_get_the_shortest_solution_and_their_rank() {
        let a = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0]);
        assert_eq!(pseudo_inverse(&a).1, 2);
        let saddle = Saddle::new(a, &[1.0; 3], &[1.0; 3]);
        let mut b = DMatrix::from_row_slice(3, 1, &[4.0, 2.0, 2.0]);
        saddle.solve(&mut b);
        assert!((b - DMatrix::from_row_slice(3, 1, &[2.0, 1.0, 1.0])).norm() < 1e-12);
    }

    #[test]
    fn inertia_agrees_with_the_eigenvalues_of_random_matrices() {
        let mut seed = 1_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        for n in 1..20 {
            let m = DMatrix::from_fn(n, n, |_, _| random());
            let a = &m + m.transpose();
            let eigenvalues = a.clone().symmetric_eigenvalues();
            let found = inertia(a);
            assert_eq!(
                found.positive,
                eigenvalues.iter().filter(|x| **x > 0.0).count()
            );
            assert_eq!(
                found.negative,
                eigenvalues.iter().filter(|x| **x < 0.0).count()
            );
        }
    }

    #[test]
    fn complement_is_orthonormal_and_orthogonal() {
        let a = DMatrix::from_fn(7, 3, |i, j| {
            ((i * 3 + j * 5) % 7) as f64 - 2.0 + 0.1 * i as f64
        });
        let n = complement(&a);
        assert_eq!(n.shape(), (7, 4));
        assert!((n.transpose() * &a).norm() < 1e-12);
        assert!((n.transpose() * &n - DMatrix::identity(4, 4)).norm() < 1e-12);
    }
}
