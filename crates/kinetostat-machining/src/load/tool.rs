//! The tools of a program, each with its own machine and load.

use kinetostat::{Mechanism, Pose};
use kinetostat_program::Path;

use crate::load::law::ProgramLoad;

/// A tool of the machine's magazine.
///
/// The tool is a part of the machine: its length is in the mechanism, whose platform's reference point is
/// the tool's tip ([`Mechanism::with_tool`]).
#[derive(Clone, Copy, Debug)]
pub struct Tool<'a> {
    /// Number in the program's T words.
    pub number: u32,
    /// Machine with this tool.
    pub mechanism: &'a Mechanism,
    /// Load on this tool.
    pub load: ProgramLoad,
}

/// The tool that the block on a line is made with; `None` where the program names none of these.
pub(crate) fn tool_on<'t, 'a>(
    tools: &'t [Tool<'a>],
    path: &Path,
    line: usize,
) -> Option<&'t Tool<'a>> {
    if tools.is_empty() {
        return None;
    }
    let number = path.tool_on(line)?;
    tools.iter().find(|tool| tool.number == number)
}

/// Turns a tool given by its length along z of the flange into a pose, platform from tool, m.
#[must_use]
pub fn straight_tool(length: f64) -> Pose {
    Pose::translation(0.0, 0.0, length)
}
