//! A segment of a link as one element: inertia by the motion of its near end and by what the far end does relative to
//! it, four slices at Gauss' points [D7].

use nalgebra::{DMatrix, Matrix3, Matrix6xX, Rotation3, SMatrix, Vector3, Vector6};

use kinetostat::model::{Kinematics, SegmentMass, turn_rates};
use kinetostat::spatial::hat;

/// Inertia of a segment by `(v, w)` of its near end in near axes and the rates of `eta`, 12 x 12.
pub(crate) fn element(segment: &SegmentMass, eta: &Vector6<f64>) -> DMatrix<f64> {
    let mut sum = SMatrix::<f64, 12, 12>::zeros();
    for slice in segment.slices() {
        let by = |rows: &[Vector6<f64>; 3]| Vector3::from_fn(|k, _| rows[k].dot(eta));
        let place = by(&slice.translations) + Vector3::x() * (slice.place * segment.length);
        let turn = by(&slice.turns);
        let rates = turn_rates(turn.x, turn.y);
        let mut motions = SMatrix::<f64, 6, 12>::zeros();
        for k in 0..3 {
            motions[(k, k)] = 1.0;
            motions[(3 + k, 3 + k)] = 1.0;
            motions
                .fixed_view_mut::<1, 6>(k, 6)
                .copy_from(&slice.translations[k].transpose());
        }
        motions
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-hat(&place));
        let turns = SMatrix::<f64, 3, 6>::from_fn(|i, j| slice.turns[i][j]);
        motions
            .fixed_view_mut::<3, 6>(3, 6)
            .copy_from(&(rates * turns));
        let mut inertia = SMatrix::<f64, 6, 6>::zeros();
        for k in 0..3 {
            inertia[(k, k)] = slice.mass;
        }
        let axes = rotation(&turn);
        let own = axes * Matrix3::from_diagonal(&slice.inertia) * axes.transpose();
        inertia.fixed_view_mut::<3, 3>(3, 3).copy_from(&own);
        sum += motions.transpose() * inertia * motions;
    }
    DMatrix::from_fn(12, 12, |i, j| sum[(i, j)])
}

/// `Rx Ry Rz`.
fn rotation(turn: &Vector3<f64>) -> Matrix3<f64> {
    let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
    (about(Vector3::x_axis(), turn.x)
        * about(Vector3::y_axis(), turn.y)
        * about(Vector3::z_axis(), turn.z))
    .into_inner()
}

/// The twelve motions of [`element`] by the columns of the Jacobians of its nodes (6 x n, base axes); the spring's
/// coordinates are `first` and the five behind it.
pub(crate) fn motions(
    segment: &SegmentMass,
    kinematics: &Kinematics,
    near: &Matrix6xX<f64>,
    far: &Matrix6xX<f64>,
    first: usize,
    eta: &Vector6<f64>,
) -> DMatrix<f64> {
    let axes = kinematics.frame(segment.near).0.transpose();
    let mut motions = DMatrix::zeros(12, near.ncols());
    for (j, column) in near.column_iter().enumerate() {
        let (v, w) = (column.fixed_rows::<3>(0), column.fixed_rows::<3>(3));
        motions.fixed_view_mut::<3, 1>(0, j).copy_from(&(axes * v));
        motions.fixed_view_mut::<3, 1>(3, j).copy_from(&(axes * w));
    }
    let turns = turn_rates(eta[3], eta[4]);
    let inverse = turns
        .try_inverse()
        .unwrap_or_else(|| Matrix3::from_element(f64::NAN));
    for j in first..first + 6 {
        let column = far.column(j);
        let (v, w) = (column.fixed_rows::<3>(0), column.fixed_rows::<3>(3));
        motions.fixed_view_mut::<3, 1>(6, j).copy_from(&(axes * v));
        motions
            .fixed_view_mut::<3, 1>(9, j)
            .copy_from(&(inverse * (axes * w)));
    }
    motions
}
