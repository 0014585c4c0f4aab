//! Access to internals for this crate's own tests in `tests/model/internal`. It is not part of the interface and
//! changes without notice.

use kinetostat::Pose;
use nalgebra::{Unit, Vector3};

use crate::elements::placement;
use crate::problem::KeyPath;
use crate::schema::{Axis, Placement};

/// Error of a table, worded as in the messages for model files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(pub String);

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

/// The pose that a table of a model file states.
///
/// # Errors
/// What is wrong with it.
pub fn pose(written: &Placement) -> Result<Pose, Fault> {
    placement::pose(&KeyPath::root(), written).map_err(|finding| Fault(finding.message))
}

/// The direction that a model file states.
///
/// # Errors
/// What is wrong with it.
pub fn direction(axis: &Axis) -> Result<Unit<Vector3<f64>>, Fault> {
    placement::direction(&KeyPath::root(), axis).map_err(|finding| Fault(finding.message))
}
