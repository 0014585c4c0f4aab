//! Limit of a growing load.

use crate::spatial::Twist;

/// A limit point on the way from rest to a load: the branch that starts at rest carries no more,
/// and a dead load beyond it makes the machine snap to another equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LoadLimit {
    /// Share of the load that is carried, 0 to 1.
    pub share: f64,
    /// Displacement of the tool there, from the nominal target (m, rad).
    pub displacement: Twist,
}
