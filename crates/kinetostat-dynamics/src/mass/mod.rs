//! Mass of bodies, of slices of links and of platforms, at the loaded posture [D1, D2, D7].

pub(crate) mod body;
pub(crate) mod segment;

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of a part with mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum MassKind {
    /// A rigid body on a limb.
    Body,
    /// A segment of a link with mass along it.
    Link,
    /// A platform.
    Platform,
    /// The rotor of a drive.
    Rotor,
}

/// A part with mass: its motions by the coordinates of its limb, and its inertia in them.
#[derive(Clone, Debug)]
pub struct MassPart {
    /// Name of the body, link, platform or actuator.
    pub name: String,
    /// Kind of the part.
    pub kind: MassKind,
    /// Block of coordinates that move it, see [`crate::LinearDynamics`].
    pub(crate) block: usize,
    /// Motions of the part by the coordinates of the block, k x n.
    pub(crate) motions: DMatrix<f64>,
    /// Inertia in these motions, k x k.
    pub(crate) inertia: DMatrix<f64>,
}

impl MassPart {
    /// Kinetic energy of the part at unit velocity along `motion` (coordinates of its block), J per (1/s)^2.
    pub(crate) fn kinetic(&self, motion: &DVector<f64>) -> f64 {
        let own = &self.motions * motion;
        0.5 * own.dot(&(&self.inertia * &own))
    }

    /// Adds its mass matrix in the coordinates of its block.
    pub(crate) fn add_to(&self, mass: &mut DMatrix<f64>) {
        let moved = &self.inertia * &self.motions;
        mass.gemm_tr(1.0, &self.motions, &moved, 1.0);
    }
}
