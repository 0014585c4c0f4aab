//! Vibration of a machine at a place under a load: equilibrium, modes, parts without mass, motion of all parts in a
//! mode, and chatter stability of its cut.
//!
//! Sections of the theory of vibrations are cited as [D 3]. SI units.

mod cut;
mod machine;
mod measured;
pub mod program;
mod receptance;

pub use cut::{MachineCut, MachineCutError};
pub use machine::VibratingMachine;
pub use measured::{MeasuredModes, ShownModes};
pub use receptance::ToolReceptance;
