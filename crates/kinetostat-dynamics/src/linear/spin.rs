//! Gyroscopic terms: the angular momentum of rotors couples rotations about the two other axes [D 6].

use kinetostat::spatial::hat;
use nalgebra::{DMatrix, Vector3};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::places::Point;

impl LinearDynamics {
    /// Gyroscopic matrix `-J_w^T hat(h) J_w` of a rotor that spins in the part at a point with the momentum `h` (inertia
    /// about its axis times speed, kg m^2/s, base axes): skew, to be added to a damping matrix for
    /// [`Self::complex_modes`]. That of a tool matters for the modes of the spindle, hardly for those of an arm.
    ///
    /// # Errors
    /// [`Error::Question`] where the momentum is no number.
    pub fn gyroscopic_matrix(&self, point: Point, momentum: &Vector3<f64>) -> Result<DMatrix<f64>> {
        if momentum.iter().any(|x| !x.is_finite()) {
            return Err(Error::Question(format!(
                "the momentum of the rotor is {}, {}, {} kg m^2/s; finite numbers are needed",
                momentum.x, momentum.y, momentum.z
            )));
        }
        let motions = self.motions(point);
        let turns = motions.rows(3, 3);
        let half = turns.tr_mul(&(-hat(momentum) * turns));
        // Skew without rounding.
        Ok((&half - half.transpose()) * 0.5)
    }
}
