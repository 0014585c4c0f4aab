//! How far the tool gets: an arm's reach by search over its joints, a parallel machine's by inverse
//! kinematics around home.
//!
//! It takes the posture at home and gives lengths in mm, base axes. Collisions are not looked at, nor are
//! limits of passive joints where the machine has loops.

mod along_axes;
mod arm;
mod by_commands;

use kinetostat::Posture;

pub use along_axes::{ReachAlongAxes, ReachEnd};
pub use arm::ArmReach;
pub use by_commands::{CommandReach, reach_by_commands};

/// Machines of more limbs take too long.
const MOST_LIMBS: usize = 24;

/// How far the tool gets.
#[derive(Clone, Debug, PartialEq)]
pub enum Reach {
    /// A machine of one limb between base and tool.
    Arm(ArmReach),
    /// Every other machine.
    AlongAxes(Box<ReachAlongAxes>),
}

/// Why there is no reach.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReachError {
    /// The search would take too long.
    #[error("not searched: the machine has more than {most} limbs")]
    TooManyLimbs {
        /// Limbs of the largest machine that is searched.
        most: usize,
    },
    /// An actuator slides without limits.
    #[error("not bounded: the actuator '{actuator}' slides without limits")]
    UnlimitedActuator {
        /// Its name.
        actuator: String,
    },
    /// A passive joint slides without limits.
    #[error("not bounded: the passive joint '{joint}' slides without limits")]
    UnlimitedPassiveJoint {
        /// Its name.
        joint: String,
    },
    /// The machine is outside its limits where the search would begin.
    #[error("not searched: at home the actuator '{actuator}' is outside its limits")]
    HomeOutsideLimits {
        /// Its name.
        actuator: String,
    },
    /// No actuator has limits, and the tool goes on and on.
    #[error("not bounded: the actuators have no limits")]
    NoLimits,
    /// The loops do not close at home.
    #[error("not searched: the loops do not close at home")]
    OpenLoops,
}

/// Reach of a machine from its posture at home.
///
/// # Errors
/// See [`ReachError`].
pub fn reach(home: &Posture<'_>) -> Result<Reach, ReachError> {
    let m = home.mechanism();
    match m.limbs() {
        [limb] if m.platforms().len() == 2 => arm::arm_reach(m, limb).map(Reach::Arm),
        limbs if limbs.len() > MOST_LIMBS => Err(ReachError::TooManyLimbs { most: MOST_LIMBS }),
        _ => along_axes::reach_along_axes(home).map(|r| Reach::AlongAxes(Box::new(r))),
    }
}
