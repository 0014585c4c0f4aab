//! The few largest eigenvalues of a large symmetric matrix.
//!
//! A block Krylov space `[W, A W, A^2 W, ...]` with full orthogonalisation, and Rayleigh and Ritz in it (Saad,
//! Numerical Methods for Large Eigenvalue Problems, 2011, section 6.4). Blocks find eigenvalues that are
//! equal, as those of a round rod in its two planes are.

use nalgebra::{DMatrix, DVector};

/// Matrices of up to so many rows are decomposed as a whole.
const SMALL: usize = 96;
/// Motions in a block: eigenvalues of this multiplicity are found.
const BLOCK: usize = 4;
/// What a vector may miss of being an eigenvector, as a share of the matrix.
const RESIDUAL: f64 = 1e-10;

/// The largest eigenvalues of a symmetric matrix, from the largest, and their orthonormal vectors.
pub(crate) fn largest_eigenvalues(a: &DMatrix<f64>, count: usize) -> (DVector<f64>, DMatrix<f64>) {
    let n = a.nrows();
    if n > SMALL
        && 4 * count <= n
        && let Some(found) = in_krylov_space(a, count)
    {
        return found;
    }
    of_the_whole(a.clone(), count)
}

/// Share of the largest entry below which one is nothing to the largest eigenvalues; products of such numbers
/// underflow, and the iteration ends in NaN.
const NOTHING: f64 = 1e-60;

fn of_the_whole(mut a: DMatrix<f64>, count: usize) -> (DVector<f64>, DMatrix<f64>) {
    let least = NOTHING * a.amax();
    a.iter_mut()
        .filter(|x| x.abs() < least)
        .for_each(|x| *x = 0.0);
    let eigen = a.symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    order.truncate(count);
    (
        eigen.eigenvalues.select_rows(&order),
        eigen.eigenvectors.select_columns(&order),
    )
}

/// `None` where half of all motions do not hold the vectors.
fn in_krylov_space(a: &DMatrix<f64>, count: usize) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let n = a.nrows();
    let most = n / 2;
    let (mut space, mut image) = (DMatrix::zeros(n, 0), DMatrix::zeros(n, 0));
    // Numbers without any order that a motion of a machine could have.
    #[allow(clippy::cast_precision_loss)]
    let mut block = DMatrix::from_fn(n, BLOCK, |i, j| {
        ((1 + i + j * n) as f64 * 0.618_033_988_749_895).fract() - 0.5
    });
    while space.ncols() + BLOCK <= most {
        // Twice, for once leaves rounding.
        for _ in 0..2 {
            block -= &space * (space.transpose() * &block);
            block = block.qr().q();
        }
        let moved = a * &block;
        space = joined(space, &block);
        image = joined(image, &moved);
        if space.ncols() >= count + BLOCK {
            let within = space.transpose() * &image;
            let (values, chosen) = of_the_whole(0.5 * (&within + within.transpose()), count);
            let vectors = &space * &chosen;
            let missed = &image * &chosen - &vectors * DMatrix::from_diagonal(&values);
            if missed.amax() <= RESIDUAL * a.amax() {
                return Some((values, vectors));
            }
        }
        block = moved;
    }
    None
}

fn joined(mut space: DMatrix<f64>, block: &DMatrix<f64>) -> DMatrix<f64> {
    let first = space.ncols();
    space = space.resize_horizontally(first + block.ncols(), 0.0);
    space.columns_mut(first, block.ncols()).copy_from(block);
    space
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Q diag(d) Q` with a reflection `Q`: eigenvalues known exactly.
    fn turned(d: &[f64]) -> DMatrix<f64> {
        let n = d.len();
        let v = DVector::from_fn(n, |i, _| (1.0 + i as f64 * 0.37).sin()).normalize();
        let q = DMatrix::identity(n, n) - 2.0 * &v * v.transpose();
        &q * DMatrix::from_diagonal(&DVector::from_row_slice(d)) * &q
    }

    #[test]
    fn the_largest_are_found_also_where_they_are_equal() {
        for n in [20, 96, 97, 200, 300] {
            for equal in 1..=4 {
                // A buckling load, its partners, and many that are small or negative.
                let mut d: Vec<f64> = (0..n).map(|i| -1.0 + 1.7 * i as f64 / n as f64).collect();
                for x in &mut d[..equal] {
                    *x = 1.25;
                }
                d[equal] = 1.1;
                let a = turned(&d);
                let count = equal + 1;
                let (values, vectors) = largest_eigenvalues(&a, count);
                for k in 0..count {
                    let asked = if k < equal { 1.25 } else { 1.1 };
                    assert!((values[k] - asked).abs() < 1e-12, "{n} {equal}: {values}");
                }
                let missed = &a * &vectors - &vectors * DMatrix::from_diagonal(&values);
                assert!(missed.amax() < 1e-9, "{n} {equal}: {}", missed.amax());
                let gram = vectors.transpose() * &vectors;
                assert!(gram.is_identity(1e-12), "{n} {equal}: {gram}");
            }
        }
    }

    #[test]
    fn a_matrix_without_order_is_decomposed_as_a_whole() {
        // All eigenvalues close together: no small space holds the largest.
        let d: Vec<f64> = (0..150).map(|i| 1.0 + 1e-7 * f64::from(i)).collect();
        let (values, vectors) = largest_eigenvalues(&turned(&d), 2);
        assert!((values[0] - d[149]).abs() < 1e-13 && (values[1] - d[148]).abs() < 1e-13);
        assert!((vectors.transpose() * &vectors).is_identity(1e-12));
    }

    #[test]
    fn numbers_whose_products_underflow_are_none() {
        let mut a = DMatrix::zeros(5, 5);
        for (i, j, value) in [
            (0, 0, -3.6e-240),
            (0, 4, -5.2e-240),
            (1, 1, -2.5e-240),
            (1, 3, 3.7e-240),
        ]
        .into_iter()
        .chain([
            (2, 2, 2.7e-271),
            (2, 3, -3.9e-136),
            (2, 4, -3.6e-139),
            (3, 4, -6.0e-274),
        ]) {
            a[(i, j)] = value;
            a[(j, i)] = value;
        }
        let (values, vectors) = largest_eigenvalues(&a, 1);
        assert!((values[0] / 3.9e-136 - 1.0).abs() < 1e-6, "{values}");
        assert!((vectors.norm() - 1.0).abs() < 1e-12, "{vectors}");
    }
}
