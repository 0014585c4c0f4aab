//! Rotations and rigid motions that fit best.

use kinetostat::linalg::SingularValues;
use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The rotation nearest to a matrix in the sense of least squares; `None` if a turn about an axis is left open.
#[must_use]
pub fn nearest_rotation(m: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let own = SingularValues::of(m);
    // Points on a line leave a turn about it open.
    if own.rank(1e-9) < 2 {
        return None;
    }
    let u = Matrix3::from_iterator(own.left.iter().copied());
    let v_t = Matrix3::from_iterator(own.right.iter().copied()).transpose();
    let mut sign = Matrix3::identity();
    sign[(2, 2)] = (u * v_t).determinant().signum();
    let rotation = Rotation3::from_matrix_unchecked(u * sign * v_t);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

/// The rigid motion that brings points nearest to others (Kabsch); `None` if they lie on a line.
///
/// ```
/// use kinetostat::nalgebra::{Isometry3, Point3, Vector3};
/// use kinetostat_machining::rigid_motion;
///
/// let motion = Isometry3::new(Vector3::new(0.1, -0.2, 0.3), Vector3::new(0.0, 0.02, -0.01));
/// let points = [Vector3::zeros(), Vector3::x() * 300.0, Vector3::y() * 200.0];
/// let moved = points.map(|p| (motion * Point3::from(p)).coords);
/// let found = rigid_motion(&points, &moved).expect("three points");
/// assert!((found.to_homogeneous() - motion.to_homogeneous()).norm() < 1e-12);
/// assert!(rigid_motion(&points[..2], &moved[..2]).is_none());
/// ```
#[must_use]
pub fn rigid_motion(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Option<Isometry3<f64>> {
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let (here, there) = (mean(from), mean(to));
    let pairs = from.iter().zip(to);
    let h = pairs.fold(Matrix3::zeros(), |h, (from, to)| {
        h + (to - there) * (from - here).transpose()
    });
    let rotation = nearest_rotation(&h)?;
    let shift = there - rotation * here;
    Some(Isometry3::from_parts(shift.into(), rotation))
}
