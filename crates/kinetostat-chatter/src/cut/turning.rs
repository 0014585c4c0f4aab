//! A cut that does not change as the spindle turns: turning, boring.

use nalgebra::{Matrix3, Vector3};

use crate::error::{ChatterError, ChatterErrorKind, Result, above};

/// A single edge that never leaves the cut and meets its own track after one turn.
#[derive(Clone, Debug, PartialEq)]
pub struct TurningCut {
    chip: Vector3<f64>,
    force: Vector3<f64>,
}

impl TurningCut {
    /// The force on the tool is `-coefficient a (chip . (r - r_before)) force`: a displacement along `chip` thickens the chip,
    /// and the cut pushes back against `force`; coefficient in N/m^2, `a` the width of the chip. Both directions are made
    /// unit vectors; the frame is that of the tool's response.
    ///
    /// # Errors
    /// A direction without length, a coefficient that is not positive.
    pub fn new(chip: Vector3<f64>, force: Vector3<f64>, coefficient: f64) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        above(kind, "cutting coefficient", coefficient, 0.0, true, "N/m^2")?;
        for (quantity, vector) in [("chip direction", chip), ("force direction", force)] {
            if !(vector.norm() > 0.0 && vector.norm().is_finite()) {
                return Err(ChatterError::new(
                    kind,
                    quantity,
                    format!("{:?}", vector.as_slice()),
                    "a direction: finite numbers, not all zero",
                ));
            }
        }
        Ok(Self {
            chip: chip.normalize(),
            force: -coefficient * force.normalize(),
        })
    }

    /// Force on the tool per width and displacement, N/m^2.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        self.force * self.chip.transpose()
    }

    /// Unit vector along which a displacement thickens the chip, and force on the tool per width and displacement, N/m^2.
    pub(crate) fn factors(&self) -> (Vector3<f64>, Vector3<f64>) {
        (self.chip, self.force)
    }
}
