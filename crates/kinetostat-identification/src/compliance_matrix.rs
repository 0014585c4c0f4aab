//! Symmetric 6 x 6 matrices of metres and radians, and their upper triangles.

use nalgebra::{DVector, Matrix6};

/// Row and column of the upper triangle of a 6 x 6 matrix, row by row.
pub(crate) fn entries() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|row| (row..6).map(move |column| (row, column)))
}

/// Index of an entry of the upper triangle, row by row.
pub(crate) fn index_of(row: usize, column: usize) -> usize {
    row * (11 - row) / 2 + column
}

/// Size of an entry, by the diagonal of its matrix: the geometric mean of those of its row and its column.
pub(crate) fn entry_size(row: usize, column: usize, diagonal: impl Fn(usize) -> f64) -> f64 {
    (diagonal(row) * diagonal(column)).sqrt()
}

/// The matrix of an upper triangle.
pub(crate) fn matrix_of(upper: &DVector<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    for ((row, column), value) in entries().zip(upper.iter()) {
        matrix[(row, column)] = *value;
        matrix[(column, row)] = *value;
    }
    matrix
}

/// A matrix of metres and radians in units in which its diagonal is one.
pub(crate) fn with_unit_diagonal(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.abs().sqrt());
    Matrix6::from_fn(|i, j| matrix[(i, j)] * scale[i] * scale[j])
}

/// Inverse of a symmetric matrix of metres and radians, scaled by its diagonal; not a number where it has none.
pub(crate) fn inverse(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.abs().sqrt());
    let found = with_unit_diagonal(matrix)
        .try_inverse()
        .unwrap_or_else(|| Matrix6::repeat(f64::NAN));
    Matrix6::from_fn(|i, j| found[(i, j)] * scale[i] * scale[j])
}
