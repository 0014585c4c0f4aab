//! What explains the difference between poses that were measured and poses that were computed: a sign,
//! an offset, a coupling, a frame.
//!
//! Every explanation is a small change of what the controller is taken to show, or one constant frame. All
//! small changes are tried in the order of their number, so that a simpler one is found first, and all
//! that fit equally are reported: three poses decide the usual cases, but not every set of three.

mod changes;
mod controller_coordinates;
mod explanation;
mod frames;
mod measurement;
mod offset;
mod search;

pub use controller_coordinates::{ControllerCoordinates, ControllerPoseError};
pub use explanation::{Axis, Coupling, Explanation, Forward, Frame};
pub use measurement::{Difference, MeasuredPose, Tolerance, difference};
pub use search::{Effort, Explained, explain, remaining_differences};
