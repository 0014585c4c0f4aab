//! The directional matrix of one tooth, and its integral over an angle.

use nalgebra::{Matrix3, Vector3};

use crate::cut::coefficients::Coefficients;

/// `D = -(Kt t + Kr n - Ka z) n^T` with `n = (sin, cos, 0)`, `t = (cos, -sin, 0)`, N/m^2: [D 8] with the axial sign of
/// `cutting.md`.
pub(crate) fn at(coefficients: &Coefficients, angle: f64) -> Matrix3<f64> {
    force_direction(coefficients, angle) * normal(angle).transpose()
}

/// Force on the tool for a chip of one metre, per depth: `-(Kt t + Kr n - Ka z)`, N/m^2.
pub(crate) fn force_direction(coefficients: &Coefficients, angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    let (kt, kr, ka) = (
        coefficients.tangential(),
        coefficients.radial(),
        coefficients.axial(),
    );
    Vector3::new(-kt * c - kr * s, kt * s - kr * c, ka)
}

/// Outward normal at an angle.
pub(crate) fn normal(angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    Vector3::new(s, c, 0.0)
}

/// Integral of [`at`] from 0 to an angle, N/m^2 rad.
pub(crate) fn integral(coefficients: &Coefficients, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    let (kt, kr, ka) = (
        coefficients.tangential(),
        coefficients.radial(),
        coefficients.axial(),
    );
    let ss = 0.5 * (angle - s * c); // integral of sin^2
    let cc = 0.5 * (angle + s * c); // integral of cos^2
    let sc = 0.5 * s * s; // integral of sin cos
    let (int_s, int_c) = (1.0 - c, s);
    Matrix3::new(
        -(kt * sc + kr * ss),
        -(kt * cc + kr * sc),
        0.0,
        kt * ss - kr * sc,
        kt * sc - kr * cc,
        0.0,
        ka * int_s,
        ka * int_c,
        0.0,
    )
}
