//! Outcome of a posture, and the engine that solved it.

/// Outcome of one posture of many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// Solved by the vectorised kernels.
    Vectorised,
    /// Solved by the general engine, one posture at a time: the machine has something that no kernel knows (see
    /// [`Engine::Scalar`]), or this posture is singular, nearly, or far from where the kernels' iterations contract.
    Scalar,
    /// There is no answer: the error that the general engine gives for this posture says why. Its numbers are NaN.
    Unsolved,
}

impl Status {
    /// True if there is an answer, from either engine.
    #[must_use]
    pub fn is_solved(self) -> bool {
        self != Self::Unsolved
    }
}

/// Feature of a machine that no vectorised kernel supports.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoKernel {
    /// The processor lacks the instructions that the kernels are compiled for.
    #[error("this processor has no AVX2")]
    Processor,
    /// A limb bears loads of its own.
    #[error("'{0}' bears loads of its own")]
    LoadedLimb(String),
    /// A platform bears loads of its own.
    #[error("a platform bears loads of its own")]
    LoadedPlatform,
    /// There are platforms between base and tool.
    #[error("it has platforms between base and tool")]
    PlatformsBetween,
    /// A limb does not lead from base to tool.
    #[error("'{0}' does not lead from base to tool")]
    OtherPlatforms(String),
    /// A limb has more than six passive joints.
    #[error("'{0}' has more than six passive joints")]
    PassiveJoints(String),
    /// A spring is not like those that kernels know.
    #[error("'{limb}': '{spring}' {what}")]
    Spring {
        /// Name of the limb that has the spring.
        limb: String,
        /// Name of the spring in its chain.
        spring: String,
        /// Description of the spring.
        what: &'static str,
    },
}

/// Engine that solves a machine's postures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Engine {
    /// The vectorised kernels; single postures that they leave over go to the general engine, see [`Status`].
    #[default]
    Vectorised,
    /// The general engine, one posture at a time.
    Scalar {
        /// Feature that no kernel supports.
        reason: NoKernel,
    },
}

impl Engine {
    /// Engine of a machine compiled into `plans`, or with the reason why it was not.
    pub(crate) fn of<T>(plans: &std::result::Result<T, NoKernel>) -> Self {
        match plans {
            Ok(_) => Self::Vectorised,
            Err(reason) => Self::Scalar {
                reason: reason.clone(),
            },
        }
    }

    /// Reason why the vectorised kernels are not used, if they are not.
    #[must_use]
    pub fn reason(&self) -> Option<&NoKernel> {
        match self {
            Self::Vectorised => None,
            Self::Scalar { reason } => Some(reason),
        }
    }
}
