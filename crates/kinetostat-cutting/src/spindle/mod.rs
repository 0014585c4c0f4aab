//! Limits of a spindle: torque and power over its speed.
//!
//! Takes the values of the data sheet, at the spindle's nose; returns the limit at a speed, and what a cut exceeds as a
//! finding.

mod curve;

pub use curve::SpindleCurve;
pub use curve::{SpindleFinding, SpindleLimit, SpindlePoint};
