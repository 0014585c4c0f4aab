//! The tools of a program, and where it takes another one.

use std::collections::BTreeSet;

use kinetostat_program::ToolChange;

use crate::model::motion::{FrameUse, Motion};

/// The number by which a tool of a program is known: that at the end of its name where it has one that no tool before it has, else the
/// least one, counted from 1, that is no other tool's.
///
/// ```
/// use kinetostat_formats::{Frame, FrameUse, tool_number};
/// use nalgebra::Isometry3;
///
/// let tool = |name: &str| FrameUse { name: name.into(), frame: Frame::Known(Isometry3::identity()) };
/// let tools = [tool("UT:4"), tool("UT:2")];
/// assert_eq!(tool_number(&tools, 1), 2);
/// assert_eq!(tool_number(&[tool("tMill"), tool("tDrill")], 1), 2);
/// let tools = [tool("{X 0,Y 0,Z 180,A 0,B 0,C 0}"), tool("TOOL_DATA[5]"), tool("TOOL_DATA[1]")];
/// assert_eq!([0, 1, 2].map(|index| tool_number(&tools, index)), [2, 5, 1]);
/// ```
#[must_use]
pub fn tool_number(tools: &[FrameUse], index: usize) -> u32 {
    let number = tool_numbers(tools).get(index).copied();
    number.unwrap_or_else(|| u32::try_from(index + 1).unwrap_or(u32::MAX))
}

/// The numbers of all tools, each another one.
pub(crate) fn tool_numbers(tools: &[FrameUse]) -> Vec<u32> {
    let mut taken = BTreeSet::new();
    let own: Vec<Option<u32>> = (tools.iter())
        .map(|tool| number_in(&tool.name).filter(|number| taken.insert(*number)))
        .collect();
    let mut least = 1;
    let mut free = || {
        while !taken.insert(least) {
            least += 1;
        }
        least
    };
    (own.into_iter())
        .map(|number| number.unwrap_or_else(&mut free))
        .collect()
}

/// The number at the end of a name: `UF:3`, `BASE_DATA[3]`, `wobj3`.
pub(crate) fn number_in(name: &str) -> Option<u32> {
    let digits = name.trim_end_matches(']');
    let start = digits
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + 1);
    digits.get(start..)?.parse().ok()
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

/// Tool changes, in ascending order of lines.
pub(crate) fn changes(poses: &[&Motion], tools: &[FrameUse]) -> Vec<ToolChange> {
    let mut changes: Vec<ToolChange> = Vec::new();
    let numbers = tool_numbers(tools);
    for motion in poses {
        let index = tools.iter().position(|tool| same_frame(tool, &motion.tool));
        let Some(number) = numbers.get(index.unwrap_or(0)).copied() else {
            continue;
        };
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
