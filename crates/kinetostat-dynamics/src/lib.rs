//! Elasto-dynamics about a loaded equilibrium: mass, modes, damping, response.

mod ends;
mod error;
mod linear;
mod mass;
mod modes;

pub use ends::Held;
pub use error::{Error, Result};
pub use linear::LinearDynamics;
pub use linear::places::Point;
pub use mass::body::about_point;
pub use mass::{MassKind, MassPart};
pub use modes::{DirectionCounts, EnergyShare, Mode, ModeKind, Modes};
