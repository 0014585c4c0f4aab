//! What is asked, in the order in which it is.

/// A question by what it asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ask {
    Robot,
    Tip,
    FlangeAxis,
    JointStiffness,
    Program,
    To,
    Numbers,
    SpindleStart,
    SpindleStop,
    Tool,
    ToolAxis,
    Mass,
    Part,
    Weight,
    TouchOff,
    Cut,
    Cutter,
    Engaged,
    Speed,
    Air,
    Tolerance,
}
