//! Trials one after the other: their corrections, what is to be expected of the next, and when to stop.

mod convergence;
mod field;
mod machined;
mod state;
mod taking;

pub use convergence::{Convergence, bound_on_relaxation};
pub use field::{MirrorField, SumOfFields};
pub use state::{Averaging, MirrorState, Outcome, Repeatability, floor_mm};
pub use taking::{MeasuredFile, Trial};
