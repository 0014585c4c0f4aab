//! Correction of a place of a program.

use nalgebra::{UnitQuaternion, Vector3, Vector6};

/// Correction that a field adds to the programmed pose so that the tool reaches the desired one, part axes.
///
/// A [`Vector3`] is a correction of the position alone:
///
/// ```
/// use kinetostat_program::Correction;
/// use nalgebra::Vector3;
///
/// let raised = Correction::from(Vector3::new(0.0, 0.0, 0.2));
/// assert_eq!(raised.shift_mm.z, 0.2);
/// assert_eq!(raised.turn, Vector3::zeros());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Correction {
    /// Added to the position, in mm.
    pub shift_mm: Vector3<f64>,
    /// Rotation vector, in rad, about the tool's tip: the tool is turned by it from the orientation of the program. Zero in a
    /// program of positions.
    pub turn: Vector3<f64>,
}

impl From<Vector3<f64>> for Correction {
    fn from(shift_mm: Vector3<f64>) -> Self {
        Self {
            shift_mm,
            turn: Vector3::zeros(),
        }
    }
}

impl Correction {
    /// The correction as one vector of lengths, in mm: rotations are multiplied by the lever.
    pub(crate) fn in_lengths(&self, lever_mm: f64) -> Vector6<f64> {
        let (shift, turn) = (self.shift_mm, self.turn * lever_mm);
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    }

    /// The inverse of [`Self::in_lengths`].
    pub(crate) fn of_lengths(lengths: &Vector6<f64>, lever_mm: f64) -> Self {
        Self {
            shift_mm: lengths.fixed_rows::<3>(0).into_owned(),
            turn: lengths.fixed_rows::<3>(3) / lever_mm,
        }
    }

    /// The orientation to command, part axes from tool axes, where the program wants this one.
    ///
    /// ```
    /// use kinetostat_program::Correction;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let turn = Vector3::new(0.001, 0.0, 0.0); // 1 mrad about x of the part
    /// let correction = Correction { turn, ..Correction::default() };
    /// let programmed = UnitQuaternion::from_euler_angles(3.0, 0.1, -2.0);
    /// let commanded = correction.turned(&programmed);
    /// assert!(((commanded * programmed.inverse()).scaled_axis() - turn).norm() < 1e-12);
    /// ```
    #[must_use]
    pub fn turned(&self, programmed: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(self.turn) * programmed
    }
}
