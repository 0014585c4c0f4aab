//! What a spindle can give: torque and power over its speed.
//!
//! Takes what its data sheet states, at the spindle's nose; gives the limit at a speed, and what a cut exceeds as a finding.

mod curve;
mod limit;

pub use curve::SpindleCurve;
pub use limit::{SpindleFinding, SpindleLimit, SpindlePoint};
