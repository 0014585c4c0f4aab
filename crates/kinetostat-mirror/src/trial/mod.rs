//! Trials one after the other: their corrections, what is to be expected of the next, and when to stop.

mod compared;
mod convergence;
mod field;
mod joined;
mod machined;
mod passing;
mod record;
mod repeatability;
mod state;
mod taking;
mod together;

pub use convergence::{Convergence, bound_on_relaxation};
pub use field::{MirrorField, SumOfFields};
pub use record::{MeasuredFile, Trial};
pub use repeatability::{Averaging, Repeatability, floor_mm};
pub use state::{MirrorState, Outcome};
