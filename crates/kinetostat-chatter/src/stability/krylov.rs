//! The largest eigenvalue of an operator by Arnoldi's method with full orthogonalisation.
//!
//! The monodromy operator is compact: a few eigenvalues count, the others fall faster than any power. So a space of some
//! twenty vectors holds the largest to rounding; it grows to the whole space where it has to.

use nalgebra::{DMatrix, DVector};

use crate::error::Result;
use crate::number::Complex64;
use crate::stability::eigenvalues::start;
use crate::stability::followed::Followed;

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
pub(crate) fn largest(
    (size, states): (usize, usize),
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
