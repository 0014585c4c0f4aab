//! Rigid bodies: mass and inertia at a point, and whether a body can have it.

use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3};

use kinetostat::spatial::hat;

use crate::error::{Error, Result};

/// Inertia of a body about its centre of mass in base axes, `blkdiag(m 1, R I R^T)` [D1].
pub(crate) fn at_centre(
    mass: f64,
    inertia: &Matrix3<f64>,
    rotation: &Matrix3<f64>,
) -> DMatrix<f64> {
    let turned = rotation * inertia * rotation.transpose();
    let mut matrix = DMatrix::zeros(6, 6);
    matrix.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    matrix.view_mut((0, 0), (3, 3)).scale_mut(mass);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turned);
    matrix
}

/// Inertia of a body about a point from which its centre of mass is at `arm` (base axes, m), as equation D2 of the theory has it: linear
/// before angular.
#[must_use]
pub fn about_point(
    mass: f64,
    inertia: &Matrix3<f64>,
    rotation: &Matrix3<f64>,
    arm: &Vector3<f64>,
) -> Matrix6<f64> {
    let turned = rotation * inertia * rotation.transpose();
    let mut matrix = Matrix6::zeros();
    matrix
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(Matrix3::identity() * mass));
    matrix
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&(hat(arm) * -mass));
    matrix
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&(hat(arm) * mass));
    let offset = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
    matrix
        .fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&(turned + offset * mass));
    matrix
}

/// Refuses what no body has: negative or unsymmetric inertia, and principal moments of which one is larger than the sum
/// of the two others. A millionth of the largest moment is allowed for rounding in files.
pub(crate) fn check(part: &str, mass: f64, inertia: &Matrix3<f64>) -> Result<()> {
    let fault = |reason: String| {
        Err(Error::Inertia {
            part: part.to_owned(),
            reason,
        })
    };
    if !(mass.is_finite() && mass >= 0.0) {
        return fault(format!(
            "its mass is {mass} kg, a number not below zero is needed"
        ));
    }
    let size = inertia.iter().fold(
        0.0_f64,
        |m, x| if x.is_nan() { f64::NAN } else { m.max(x.abs()) },
    );
    if !size.is_finite() {
        return fault("its inertia is not finite".to_owned());
    }
    if size == 0.0 {
        return Ok(());
    }
    let scaled = inertia / size;
    let skew = scaled - scaled.transpose();
    if skew.iter().any(|x| x.abs() > 1e-6) {
        return fault("its inertia is not symmetric".to_owned());
    }
    let mut moments = ((scaled + scaled.transpose()) * 0.5).symmetric_eigenvalues() * size;
    moments.as_mut_slice().sort_by(f64::total_cmp);
    let (least, middle, most) = (moments[0], moments[1], moments[2]);
    if least < -1e-6 * size {
        return fault(format!(
            "its inertia is {least} kg m^2 about one axis, which is below zero"
        ));
    }
    if most > least + middle + 1e-6 * size {
        return fault(format!(
            "its principal moments of inertia are {least}, {middle} and {most} kg m^2; the largest cannot exceed the sum of the others"
        ));
    }
    Ok(())
}
