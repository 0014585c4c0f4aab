//! Errors of the reach.

/// Reason why there is no reach.
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
        /// Name of the actuator.
        actuator: String,
    },
    /// A passive joint slides without limits.
    #[error("not bounded: the passive joint '{joint}' slides without limits")]
    UnlimitedPassiveJoint {
        /// Name of the joint.
        joint: String,
    },
    /// The machine is outside its limits where the search would begin.
    #[error("not searched: at home the actuator '{actuator}' is outside its limits")]
    HomeOutsideLimits {
        /// Name of the actuator.
        actuator: String,
    },
    /// No actuator has limits, and the tool goes on and on.
    #[error("not bounded: the actuators have no limits")]
    NoLimits,
    /// The loops do not close at home.
    #[error("not searched: the loops do not close at home")]
    OpenLoops,
}
