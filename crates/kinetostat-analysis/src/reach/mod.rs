//! Reach of the tool: of an arm by search over its joints, of a parallel machine by inverse kinematics around home.
//!
//! The posture at home is given; lengths are in mm, base axes. Collisions are ignored, and so are limits of passive
//! joints where the machine has loops.

mod along_axes;
mod arm;

use kinetostat::Posture;

pub use along_axes::{CommandReach, ReachAlongAxes, ReachEnd, reach_by_commands};
pub use arm::{ArmReach, ReachError};

/// Machines of more limbs take too long.
const MOST_LIMBS: usize = 24;

/// Reach of the tool.
#[derive(Clone, Debug, PartialEq)]
pub enum Reach {
    /// A machine of one limb between base and tool.
    Arm(ArmReach),
    /// Every other machine.
    AlongAxes(Box<ReachAlongAxes>),
}

/// Reach of a machine from its posture at home.
///
/// # Errors
/// See [`ReachError`].
pub fn reach(home: &Posture) -> Result<Reach, ReachError> {
    let m = home.mechanism();
    match m.limbs() {
        [limb] if m.platforms().len() == 2 => arm::arm_reach(m, limb).map(Reach::Arm),
        limbs if limbs.len() > MOST_LIMBS => Err(ReachError::TooManyLimbs { most: MOST_LIMBS }),
        _ => along_axes::reach_along_axes(home).map(|r| Reach::AlongAxes(Box::new(r))),
    }
}
