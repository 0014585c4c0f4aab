//! Chatter of a program, and spindle speeds and depths that are stable [D 10].
//!
//! The cut of a program changes slowly: consecutive places with the same tool, speed, arc, depth, heading and posture
//! are one group and judged once, at the deepest of them; similar groups are judged once, too, except those near their
//! limit and those that set the stable depth of a line. The modes at each are those of the machine in its posture
//! there, under the mean force of the cut (without its moment about the tip); the limit of depth at the speed of the
//! program is exact for one arc at all heights.

mod along;
mod forced;
mod judge;
mod judged;
mod question;
mod site;
mod speeds;

pub use along::{ChatterStretch, ProgramChatter};
pub use forced::ForcedVibration;
pub use judged::{JudgedSite, Verdict};
pub use question::{ChatterQuestion, ProgramChatterError};
pub use site::{CutSite, WithoutSide};
pub use speeds::StableSpeed;
