//! The largest entry of a matrix where it decides whether an iteration has converged.

use nalgebra::{Dim, Matrix, RawStorage};

use crate::number::largest_size;

/// Largest size of an entry, NaN where one is: nalgebra's `amax` forgets it.
pub(crate) fn largest<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(a: &Matrix<f64, R, C, S>) -> f64 {
    largest_size(a.iter())
}
