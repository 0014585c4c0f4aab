//! Motions of limbs and platforms in a mode, for drawings.

use nalgebra::DVector;

use crate::linear::LinearDynamics;
use crate::modes::mode::Mode;

impl LinearDynamics {
    /// Motion of every block of coordinates in a mode: of each limb its own coordinates (m, rad; followed by the six of the
    /// platform that it stands on, where that is not the base), then of each platform besides the base its twist at its
    /// origin, base axes. Of a chain there is the one block. Units: those divided by `sqrt(kg)`, as the shape has them.
    #[must_use]
    pub fn block_motions(&self, mode: &Mode) -> Vec<DVector<f64>> {
        let all = self.all(&mode.shape);
        (0..self.blocks.len())
            .map(|block| self.of_block(block, &all))
            .collect()
    }
}
