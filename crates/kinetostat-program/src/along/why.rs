//! Reasons for which a point has no place on the path.

use serde::Serialize;

/// Reason for which a point has no place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WhyLeftOut {
    /// The path does not come within the window.
    BeyondWindow,
    /// Several stretches of the path come within the window.
    SeveralStretches,
    /// The point names a line, and only cuts of other lines come within the window.
    NotOnItsLine,
    /// The place would lie before those of earlier points.
    OutOfOrder,
}
