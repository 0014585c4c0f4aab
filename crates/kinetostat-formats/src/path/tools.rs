//! The tools of a program, and where it takes another one.

use std::collections::BTreeSet;

use kinetostat_program::ToolChange;

use crate::model::frame::FrameUse;
use crate::model::motion::Motion;

/// The number by which a tool of a program is known: that at the end of its name, if it has one, else its place among the tools
/// counted from 1.
///
/// ```
/// use kinetostat_formats::{Frame, FrameUse, tool_number};
/// use nalgebra::Isometry3;
///
/// let tool = |name: &str| FrameUse { name: name.into(), frame: Frame::Known(Isometry3::identity()) };
/// let tools = [tool("UT:4"), tool("UT:2")];
/// assert_eq!(tool_number(&tools, 1), 2);
/// assert_eq!(tool_number(&[tool("tMill"), tool("tDrill")], 1), 2);
/// ```
#[must_use]
pub fn tool_number(tools: &[FrameUse], index: usize) -> u32 {
    let own = |tool: &FrameUse| -> Option<u32> {
        let digits = tool.name.trim_start_matches(|c: char| !c.is_ascii_digit());
        digits.parse().ok()
    };
    let numbers: Vec<Option<u32>> = tools.iter().map(own).collect();
    let distinct: BTreeSet<u32> = numbers.iter().copied().flatten().collect();
    match numbers.get(index).copied().flatten() {
        // Two tools with one number, or one without: all are counted.
        Some(number) if distinct.len() == tools.len() => number,
        _ => u32::try_from(index + 1).unwrap_or(u32::MAX),
    }
}

pub(crate) fn tools_of(poses: &[&Motion]) -> Vec<FrameUse> {
    let mut tools: Vec<FrameUse> = Vec::new();
    for motion in poses {
        if !tools.iter().any(|known| same_frame(known, &motion.tool)) {
            tools.push(motion.tool.clone());
        }
    }
    tools
}

/// Where another tool is taken, by lines that ascend.
pub(crate) fn changes(poses: &[&Motion], tools: &[FrameUse]) -> Vec<ToolChange> {
    let mut changes: Vec<ToolChange> = Vec::new();
    for motion in poses {
        let index = tools.iter().position(|tool| same_frame(tool, &motion.tool));
        let number = tool_number(tools, index.unwrap_or(0));
        if changes.last().is_none_or(|last| last.number != number) {
            changes.push(ToolChange {
                line: motion.line,
                number,
            });
        }
    }
    changes
}

pub(crate) fn same_frame(one: &FrameUse, other: &FrameUse) -> bool {
    match (one.known(), other.known()) {
        (Some(one), Some(other)) => one == other,
        _ => one.name == other.name,
    }
}
