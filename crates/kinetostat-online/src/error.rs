//! Reasons why no plan is made. What happens in a cycle is a status, never an error.

/// Refusal of a plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Error of the statics: the home pose of the machine is not reachable, for example.
    #[error(transparent)]
    Statics(#[from] kinetostat::Error),
    /// A machine that no plan supports.
    #[error("'{machine}' cannot be compensated on-line: {reason}")]
    Unsupported {
        /// Name of the mechanism.
        machine: String,
        /// Feature that is not supported, and what is.
        reason: String,
    },
    /// The low-pass filter is too fast for the structure.
    #[error(
        "the low pass of {cutoff_hz} Hz is too fast for a first natural frequency of {first_hz} Hz; at most {} Hz are allowed: lower the cutoff",
        first_hz / 4.0
    )]
    FilterTooFast {
        /// Cutoff of the low pass, Hz.
        cutoff_hz: f64,
        /// First natural frequency of the machine, Hz.
        first_hz: f64,
    },
    /// A setting that nothing can be done with.
    #[error("{what} is {found}; {low} to {high} are allowed")]
    Setting {
        /// Name of the setting.
        what: &'static str,
        /// Value found.
        found: f64,
        /// Smallest value allowed.
        low: f64,
        /// Largest value allowed.
        high: f64,
    },
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;
