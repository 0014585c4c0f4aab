//! Errors of the sensitivity analysis.

use kinetostat::Error;
use kinetostat_model::ModelError;

/// Reason why there are no derivatives at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SensitivityError {
    /// No equilibrium.
    #[error(transparent)]
    Machine(#[from] Error),
    /// A path names nothing.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Another posture has the same commands.
    #[error(
        "the commands of this posture lead to another pose of the tool; take a posture that its commands alone determine"
    )]
    Elsewhere,
}
