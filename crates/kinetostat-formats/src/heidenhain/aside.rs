//! Cutter compensation: the side of the contour.

/// The side of the contour on which the tool goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aside {
    /// RL.
    Left,
    /// RR.
    Right,
}
