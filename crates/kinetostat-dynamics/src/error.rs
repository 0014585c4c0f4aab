//! Errors of the vibration analysis. A physical finding (unstable, neutral, free) is no error.

/// A question without an answer, or a wrong input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Error of the statics: a state that is none of this machine, numbers that are not finite.
    #[error(transparent)]
    Statics(#[from] kinetostat::Error),
    /// Nothing that moves has a mass.
    #[error("'{0}' has no mass anywhere: give its bodies, platforms or links a mass")]
    NoMass(String),
    /// An inertia that no body has.
    #[error("{part}: {reason}")]
    Inertia {
        /// Name of the body or platform.
        part: String,
        /// Description of the error.
        reason: String,
    },
    /// A damping that is not meant.
    #[error("damping: {0}")]
    Damping(String),
    /// A name that does not exist.
    #[error("there is no {what} '{name}'; there are: {known}")]
    UnknownName {
        /// Kind of the unknown object.
        what: &'static str,
        /// Unknown name.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// A drive whose rotor cannot be where it is said to be.
    #[error("rotor of '{joint}': {reason}")]
    Rotor {
        /// Name of the actuator.
        joint: String,
        /// Description of the error.
        reason: String,
    },
    /// The question does not fit: lists of the wrong length, frequencies that are no numbers.
    #[error("{0}")]
    Question(String),
    /// An iteration that did not end, or a matrix that is singular where it must not be.
    #[error("{0}")]
    NotSolved(String),
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;
