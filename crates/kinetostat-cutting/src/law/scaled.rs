//! A law whose parts are multiplied by factors: for coefficients that are uncertain.

use std::sync::Arc;

use crate::law::force_law::{EdgeForce, ForceLaw};

/// A law with its tangential, radial and axial parts multiplied by factors.
///
/// ```
/// use std::sync::Arc;
/// use kinetostat_cutting::{EdgeForce, ForceLaw, Linear, Scaled};
///
/// let law = Linear::new([800.0, 300.0, 100.0], [10.0, 5.0, 0.0])?;
/// let stronger = Scaled::new(Arc::new(law), EdgeForce::new(1.1, 1.0, 1.0));
/// assert!((stronger.edge_force(0.1).tangential - 1.1 * 90.0).abs() < 1e-9);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scaled {
    law: Arc<dyn ForceLaw>,
    factors: EdgeForce,
}

impl Scaled {
    /// A law and a factor for each part of its force.
    #[must_use]
    pub fn new(law: Arc<dyn ForceLaw>, factors: EdgeForce) -> Self {
        Self { law, factors }
    }
}

impl ForceLaw for Scaled {
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        let own = self.law.edge_force(chip_mm);
        EdgeForce {
            tangential: own.tangential * self.factors.tangential,
            radial: own.radial * self.factors.radial,
            axial: own.axial * self.factors.axial,
        }
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        self.law.known_between_mm()
    }
}
