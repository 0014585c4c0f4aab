//! Explains the difference between measured and computed poses: a sign, an offset, a coupling, a frame.
//!
//! Every explanation is a small change of the assumed controller map, or one constant frame. All small changes are
//! tried in the order of their number, so that a simpler one is found first, and all that fit equally are reported:
//! three poses decide the usual cases, but not every set of three.

mod controller_coordinates;
mod corrected;
mod explanation;
mod search;

pub use controller_coordinates::{ControllerCoordinates, ControllerPoseError};
pub use corrected::{CorrectionError, corrected};
pub use explanation::{
    Axis, Coupling, Difference, Explanation, Forward, Frame, MeasuredPose, Tolerance, difference,
};
pub use search::{Effort, Explained, explain, remaining_differences};
