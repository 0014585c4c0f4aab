//! Principal directions of a compliance.

use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3};

/// Compliances below this share of the largest are rounding.
pub(crate) const NO_MOTION: f64 = 1e-12;

/// Eigenvalues of the symmetric part of a block, falling; below the rounding of the largest they are zero.
fn eigen(block: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    // Along the push acts the symmetric part alone; loads without a potential leave another.
    let eigen = SymmetricEigen::new(0.5 * (block + block.transpose()));
    let most = eigen.eigenvalues.amax();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let values = Vector3::from_fn(|k, _| {
        let own = eigen.eigenvalues[order[k]];
        if own.abs() <= NO_MOTION * most {
            0.0
        } else {
            own
        }
    });
    let vectors = Matrix3::from_fn(|i, k| eigen.eigenvectors[(i, order[k])]);
    (values, vectors)
}

/// Compliances along the principal directions of forces, falling, and these as columns, the largest part positive.
pub(crate) fn principal(compliance: &Matrix6<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (values, mut vectors) = eigen(&compliance.fixed_view::<3, 3>(0, 0).into_owned());
    for mut column in vectors.column_iter_mut() {
        if column[column.iamax()] < 0.0 {
            column.neg_mut();
        }
    }
    (values, vectors)
}

/// Principal rotational compliances, without directions; values within the rounding of those of forces are zero.
pub(crate) fn rotational(compliance: &Matrix6<f64>, length: f64) -> Vector3<f64> {
    let nothing = NO_MOTION * compliance.fixed_view::<3, 3>(0, 0).amax() / (length * length);
    let (values, _) = eigen(&compliance.fixed_view::<3, 3>(3, 3).into_owned());
    values.map(|c| if c.abs() <= nothing { 0.0 } else { c })
}
