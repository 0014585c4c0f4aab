//! Tool centre point control: M128 and FUNCTION TCPM.

/// Mode of tool centre point control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct TipControl {
    pub on: bool,
    /// AXIS SPAT: words of rotary axes are angles in space.
    pub spatial: bool,
    /// PATHCTRL VECTOR: the tool's axis stays in a plane.
    pub by_vector: bool,
}
