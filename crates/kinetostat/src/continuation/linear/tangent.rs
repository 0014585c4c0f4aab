//! The direction in which an equilibrium persists, and the determinant that changes its sign at bifurcations.

use nalgebra::DVector;

/// Sign and logarithm of a determinant, and the direction in which equilibrium persists.
pub(crate) struct Tangent {
    pub direction: DVector<f64>,
    /// Sign of `det [G_z; t^T]`: it changes at a simple bifurcation.
    pub sign: f64,
    pub logarithm: f64,
}

impl Tangent {
    /// Builds from the solution of `[G_z; p^T] solution = (0, 1)` and the determinant of that matrix.
    pub fn new(solution: &DVector<f64>, sign: f64, logarithm: f64) -> Option<Self> {
        let norm = solution.norm();
        if !norm.is_finite() || norm == 0.0 {
            return None;
        }
        // det [A; t] = det [A; p] / (p . t), and p . t = 1 / norm.
        Some(Self {
            direction: solution / norm,
            sign,
            logarithm: logarithm + norm.ln(),
        })
    }
}

/// Sign and logarithm of the size of a determinant.
pub(crate) fn determinant(lu: &nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>) -> (f64, f64) {
    let mut sign: f64 = lu.p().determinant();
    let mut logarithm = 0.0;
    for pivot in lu.lu_internal().diagonal().iter() {
        sign *= pivot.signum();
        logarithm += pivot.abs().max(1e-300).ln();
    }
    (sign, logarithm)
}
