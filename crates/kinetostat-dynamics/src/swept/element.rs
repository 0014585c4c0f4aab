//! Mass of a segment of a link by the motion of its near side and the coordinates of its spring.

use kinetostat::model::{Kinematics, SegmentMass, turn_rates};
use kinetostat::spatial::shift_matrix;
use nalgebra::{DMatrix, Matrix3, Matrix6, Matrix6xX, Vector3};

use crate::mass::segment;

/// A symmetric form in the motion of the near side (6) and the own coordinates (k) of a stage.
#[derive(Clone, Debug)]
pub(crate) struct Both {
    pub near: Matrix6<f64>,
    pub across: Matrix6xX<f64>,
    pub own: DMatrix<f64>,
}

impl Both {
    pub fn zeros(count: usize) -> Self {
        Self {
            near: Matrix6::zeros(),
            across: Matrix6xX::zeros(count),
            own: DMatrix::zeros(count, count),
        }
    }
}

/// Adds it; `twists` are those of the spring's coordinates at the tip's place.
pub(crate) fn add(
    own: &SegmentMass,
    kinematics: &Kinematics,
    tip: &Vector3<f64>,
    twists: &Matrix6xX<f64>,
    to: &mut Both,
) {
    if own.total() == 0.0 {
        return;
    }
    let eta = own.deflection(kinematics);
    let inertia = segment::element(own, &eta);
    let axes = kinematics.frame(own.near).0.transpose();
    let both = |angular: &Matrix3<f64>| {
        let mut turn = Matrix6::zeros();
        turn.fixed_view_mut::<3, 3>(0, 0).copy_from(&axes);
        turn.fixed_view_mut::<3, 3>(3, 3).copy_from(angular);
        turn
    };
    let near = both(&axes) * shift_of(kinematics, own.near, tip);
    let rates = turn_rates(eta[3], eta[4])
        .try_inverse()
        .unwrap_or_else(|| Matrix3::from_element(f64::NAN));
    let far = both(&(rates * axes)) * shift_of(kinematics, own.far, tip) * twists;
    let block = |i: usize, j: usize| Matrix6::from_fn(|r, c| inertia[(i + r, j + c)]);
    to.near += near.transpose() * block(0, 0) * near;
    to.across += near.transpose() * block(0, 6) * &far;
    let moved = block(6, 6) * &far;
    to.own += DMatrix::from_fn(far.ncols(), far.ncols(), |i, j| {
        far.column(i).dot(&moved.column(j))
    });
}

/// Motion of a node by that of its part at the tip's place.
pub(crate) fn shift_of(
    kinematics: &Kinematics,
    node: usize,
    tip: &nalgebra::Vector3<f64>,
) -> Matrix6<f64> {
    shift_matrix(&(kinematics.node_position(node) - tip))
}
