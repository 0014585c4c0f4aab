//! Response of a spring law: energy, torque and tangent stiffness.

use nalgebra::{Matrix6, Vector6};

/// Response of a six-dimensional law to a deflection.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// J.
    pub energy: f64,
    /// Gradient of the energy, N or N m.
    pub torque: Vector6<f64>,
    /// Second derivative that the strains' rates make: positive definite as the matrix of the law is.
    pub material: Matrix6<f64>,
    /// Second derivative that a curvature of the strains adds under load: the geometric stiffness.
    pub geometric: Matrix6<f64>,
}
