//! Elasto-dynamics about a loaded equilibrium: mass, modes, damping, response.

mod damping;
mod ends;
mod error;
mod linear;
mod mass;
mod modes;
mod response;

pub use damping::Damping;
pub use ends::Held;
pub use error::{Error, Result};
pub use linear::LinearDynamics;
pub use linear::places::Point;
pub use mass::body::about_point;
pub use mass::{MassKind, MassPart};
pub use modes::{DirectionCounts, EnergyShare, Mode, ModeKind, Modes};
pub use response::by_limbs::LimbResponse;
pub use response::direct::DirectResponse;
pub use response::modal::{ModalResponse, TranslationalModes};
pub use response::{Quantity, Receptance};
