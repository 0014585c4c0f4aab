//! Eigenvalues of a small real matrix by the QR iteration, and the largest one of an operator in a Krylov space.

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;

/// Rounds of the QR iteration for each row: it needs three or four where it converges at all.
const ROUNDS: usize = 60;
/// Matrices with the same eigenvalues from which the iteration begins anew where it does not end: it has no shifts for that, and
/// cycles for some matrices whose eigenvalues are all apart.
const BEGUN: usize = 6;
/// Threshold of rounding below the diagonal in each attempt, in units of it: the last steps may end a little above one.
const ROUNDING: [f64; BEGUN] = [1.0, 1.0, 1.0, 8.0, 8.0, 64.0];

/// All eigenvalues of a real matrix, the largest first.
pub(crate) fn eigenvalues(matrix: DMatrix<f64>) -> Result<Vec<Complex64>> {
    let fault = |found: &str| {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "multipliers",
            found,
            "eigenvalues of a matrix of finite numbers",
        )
    };
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(fault("an entry that is not finite"));
    }
    let found = by_qr(&matrix).ok_or_else(|| fault("no convergence of the QR iteration"))?;
    let mut all: Vec<Complex64> = found;
    // Equal sizes: the one of a pair that turns forward comes first.
    all.sort_by(|a, b| {
        b.norm()
            .total_cmp(&a.norm())
            .then_with(|| b.im.total_cmp(&a.im))
    });
    Ok(all)
}

/// Eigenvalues of a matrix of finite numbers by the QR iteration; `None` where it ends from no beginning.
pub(crate) fn by_qr(matrix: &DMatrix<f64>) -> Option<Vec<Complex64>> {
    let n = matrix.nrows();
    let rounds = ROUNDS * n.max(2);
    // Seen in another mirror each time.
    let mut seen = matrix.clone();
    ROUNDING.iter().enumerate().find_map(|(begun, rounding)| {
        let schur = Schur::try_new(seen.clone(), rounding * f64::EPSILON, rounds);
        let found = schur.map(|schur| schur.complex_eigenvalues().iter().copied().collect());
        if found.is_none() {
            let along = start(n + begun).rows(begun, n).normalize();
            let mirror = DMatrix::identity(n, n) - 2.0 * &along * along.transpose();
            seen = &mirror * &seen * &mirror;
        }
        found
    })
}

/// A vector that no symmetry makes blind for an eigenvector: numbers without order, the same in every run.
pub(crate) fn start(size: usize) -> DVector<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    DVector::from_fn(size, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// Size of the first space that is looked at, and by how much it grows.
const FIRST: usize = 10;
const GROWTH: usize = 4;
/// Residual of an eigenvalue that is to be known well, by its size.
pub(crate) const ACCURATE: f64 = 1e-10;
/// Residual where it matters on which side of the unit circle it lies.
pub(crate) const ROUGH: f64 = 1e-6;

/// Periods after which the largest eigenvalue is looked for, at most.
const SETTLED: usize = 48;
/// Periods if the first vector of a nearby depth is known, and the random share of it: a larger eigenvector at this
/// depth grows out of that share, or out of the space, long before a residual is accepted.
const SETTLED_AGAIN: usize = 28;
const FRESH: f64 = 1e-4;

/// The largest eigenvalue of an operator on vectors of a length to a residual by its size, with its vector.
///
/// The first vector has gone through some periods: what dies away quickly is gone then, and the space need not hold it. It is
/// kept in `last`, for the next depth: its first entries, the `states`, which make the others in the next period, whatever their
/// number. Of few states fewer periods are enough.
/// The QR iteration of the small matrix costs more than anything else here, so it is asked only which eigenvalue is the
/// largest: one is followed by inverse iteration as the space grows, until its residual is small, and then the QR iteration
/// says whether there is a larger one.
///
/// The monodromy operator is compact: a few eigenvalues count, the others fall faster than any power. So a space of some
/// twenty vectors holds the largest to rounding; it grows to the whole space where it has to.
pub(crate) fn largest(
    size: usize,
    states: usize,
    accuracy: f64,
    last: &mut Option<DVector<f64>>,
    mut apply: impl FnMut(&DVector<f64>) -> Result<DVector<f64>>,
) -> Result<(Complex64, DVector<Complex64>)> {
    let mut first = start(size).normalize();
    let settled = match last {
        Some(last) => {
            first *= FRESH;
            let mut before = first.rows_mut(0, states);
            before += &*last;
            SETTLED_AGAIN
        }
        None => SETTLED,
    };
    for _ in 0..settled.min(states) {
        let next = apply(&first)?;
        let length = next.norm();
        if !(length > 0.0 && length.is_finite()) {
            break;
        }
        first = next / length;
    }
    *last = first.rows(0, states).try_normalize(0.0);
    let mut basis: Vec<DVector<f64>> = vec![first];
    let mut hessenberg: Vec<Vec<f64>> = Vec::new();
    let mut wanted = FIRST.min(size);
    let mut followed: Option<Followed> = None;
    // Size of the space from which on the QR iteration is asked anew in any case.
    let mut asked_again = 0;
    loop {
        let k = basis.len();
        let mut next = apply(&basis[k - 1])?;
        let length = next.norm();
        let mut column = vec![0.0; k + 1];
        // Twice is enough to be at right angles to rounding.
        for _ in 0..2 {
            for (i, vector) in basis.iter().enumerate() {
                let share = vector.dot(&next);
                next.axpy(-share, vector, 1.0);
                column[i] += share;
            }
        }
        let rest = next.norm();
        column[k] = rest;
        hessenberg.push(column);
        let whole = k >= size || rest.is_nan() || rest <= 1e-14 * length;
        if whole || k >= wanted {
            wanted = (wanted + GROWTH).min(size);
            let small = DMatrix::from_fn(k, k, |i, j| {
                hessenberg[j].get(i).copied().unwrap_or_default()
            });
            let before = followed.filter(|_| !whole && k < asked_again);
            let mut now = match before {
                Some(before) => before.in_larger(&small)?,
                None => Followed::largest_of(&small)?,
            };
            if !now.is_largest && now.residual(rest) <= accuracy * now.value.norm() {
                now = Followed::largest_of(&small)?;
            }
            if now.is_largest {
                asked_again = 4 * k;
            }
            if whole || now.is_largest && now.residual(rest) <= accuracy * now.value.norm() {
                let mut full = DVector::from_element(size, Complex64::default());
                for (share, vector) in now.vector.iter().zip(&basis) {
                    full.zip_apply(vector, |entry, v| *entry += share * v);
                }
                return Ok((now.value, full));
            }
            followed = Some(now);
        }
        basis.push(next / rest);
    }
}

/// An eigenvalue of the small matrix with its vector of unit length.
pub(crate) struct Followed {
    pub(crate) value: Complex64,
    pub(crate) vector: DVector<Complex64>,
    /// Norm of the residual `A x - value x` in the small matrix.
    left: f64,
    /// The QR iteration has found no larger one.
    pub(crate) is_largest: bool,
}

impl Followed {
    /// The largest one, by the QR iteration.
    pub(crate) fn largest_of(matrix: &DMatrix<f64>) -> Result<Self> {
        let value = *eigenvalues(matrix.clone())?.first().ok_or_else(no_vector)?;
        let from = start(matrix.nrows()).map(Complex64::from);
        Ok(Self {
            value,
            vector: inverse_iteration(matrix, value, from)?,
            left: 0.0,
            is_largest: true,
        })
    }

    /// Follows the eigenvalue into a matrix that has grown.
    pub(crate) fn in_larger(self, matrix: &DMatrix<f64>) -> Result<Self> {
        let from = self
            .vector
            .resize_vertically(matrix.nrows(), Complex64::default());
        let vector = inverse_iteration(matrix, self.value, from)?;
        let image = matrix.map(Complex64::from) * &vector;
        let value = vector.dotc(&image);
        Ok(Self {
            value,
            left: (image - &vector * value).norm(),
            vector,
            is_largest: false,
        })
    }

    /// Residual in the whole space, of which the next vector is so long.
    pub(crate) fn residual(&self, rest: f64) -> f64 {
        let last = self.vector[self.vector.len() - 1].norm();
        self.left.hypot(rest * last)
    }
}

fn no_vector() -> ChatterError {
    ChatterError::new(
        ChatterErrorKind::NotConverged,
        "largest multiplier",
        "no eigenvector",
        "an operator of finite numbers",
    )
}

/// The eigenvector of unit length that belongs to the eigenvalue nearest to a value.
fn inverse_iteration(
    matrix: &DMatrix<f64>,
    value: Complex64,
    from: DVector<Complex64>,
) -> Result<DVector<Complex64>> {
    let size = matrix.norm().max(f64::MIN_POSITIVE);
    // A little beside the eigenvalue, so that there is an answer.
    let beside = value + Complex64::new(1e-14 * size, 0.7e-14 * size);
    let shifted = Shifted::new(matrix, beside);
    let mut vector = from;
    for _ in 0..2 {
        shifted.solve(&mut vector);
        let norm = vector.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            return Err(no_vector());
        }
        vector /= Complex64::from(norm);
    }
    Ok(vector)
}

/// A matrix with nothing below its first subdiagonal, less a number on its diagonal, eliminated row by row with pivots.
struct Shifted {
    upper: DMatrix<Complex64>,
    /// Elimination steps of each row: true if it was swapped with the next one, and the multiple of that subtracted
    /// from it.
    steps: Vec<(bool, Complex64)>,
}

impl Shifted {
    fn new(matrix: &DMatrix<f64>, shift: Complex64) -> Self {
        let n = matrix.nrows();
        let mut upper = matrix.map(Complex64::from);
        let mut steps = Vec::with_capacity(n);
        for i in 0..n {
            upper[(i, i)] -= shift;
        }
        for i in 0..n.saturating_sub(1) {
            let changes = upper[(i + 1, i)].norm_sqr() > upper[(i, i)].norm_sqr();
            if changes {
                for j in i..n {
                    upper.swap((i, j), (i + 1, j));
                }
            }
            let below = upper[(i + 1, i)];
            let factor = match below == Complex64::default() {
                true => below,
                false => below / upper[(i, i)],
            };
            for j in i..n {
                let taken = factor * upper[(i, j)];
                upper[(i + 1, j)] -= taken;
            }
            steps.push((changes, factor));
        }
        Self { upper, steps }
    }

    fn solve(&self, vector: &mut DVector<Complex64>) {
        for (i, (changes, factor)) in self.steps.iter().enumerate() {
            if *changes {
                vector.swap_rows(i, i + 1);
            }
            let taken = factor * vector[i];
            vector[i + 1] -= taken;
        }
        for j in (0..vector.len()).rev() {
            vector[j] /= self.upper[(j, j)];
            let known = vector[j];
            for i in 0..j {
                vector[i] -= self.upper[(i, j)] * known;
            }
        }
    }
}
