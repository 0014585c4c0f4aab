//! Motions that the end of a chain or a machine can make.

use kinetostat::Pose;
use kinetostat_analysis::movable::MovableDirections;

/// Motions that the tool of a chain or a machine can make.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    /// `chain` or `machine`.
    pub(crate) subject: &'static str,
    /// Commanded pose of the tool.
    pub(crate) place: Pose,
    pub(crate) directions: MovableDirections,
}
