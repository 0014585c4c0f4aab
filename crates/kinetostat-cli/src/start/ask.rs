//! Questions by their subjects, in their order.

/// Subject of a question.
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
