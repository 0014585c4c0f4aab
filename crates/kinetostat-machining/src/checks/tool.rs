//! Plausibility of the length of a tool, by its limits and in relation to the machine.

use kinetostat::Mechanism;
use kinetostat::number::short;

use crate::checks::Exceeded;
use crate::checks::load::numbered;
use crate::limits::{Beyond, Limits};
use crate::near::natural_length;
use crate::task::{Task, ToolGiven};
use crate::warning::{Warning, WarningCode};

/// Length, with holder, below which a tool is unusual, mm.
const SHORT_MM: f64 = 15.0;

/// Notes the length of a tool, mm, where it is beyond a limit; a tool that is not there has none.
pub(crate) fn note_length(exceeded: &mut Exceeded<'_>, length: f64, place: &str) {
    if length != 0.0 {
        exceeded.above("longest_tool_mm", length, None, place.to_owned());
        exceeded.above("shortest_tool_mm", length, None, place.to_owned());
    }
}

/// Limits that the length of a tool leaves.
#[must_use]
pub fn beyond_tool_length(limits: &Limits, tool: &ToolGiven) -> Vec<Beyond> {
    let mut exceeded = Exceeded {
        limits,
        found: Vec::new(),
    };
    note_length(&mut exceeded, tool.length_mm(), &numbered(tool.number));
    exceeded.found
}

/// Warnings about the length of a tool (mm, along z of the flange) with the machine in a posture.
#[must_use]
pub fn odd_tool_length(mechanism: &Mechanism, length_mm: f64) -> Vec<Warning> {
    let limits = Limits::default();
    let mut exceeded = Exceeded {
        limits: &limits,
        found: Vec::new(),
    };
    note_length(&mut exceeded, length_mm, "");
    let beyond = exceeded.found.iter();
    let beyond = beyond.map(|b| Warning::new(WarningCode::OverLimit, b.description()));
    let odd = odd_length(mechanism, length_mm, &limits);
    beyond.chain(odd).collect()
}

pub(crate) fn odd_tool(task: &Task<'_>, tool: &ToolGiven) -> Option<Warning> {
    let length = tool.length_mm();
    if !tool.stated {
        return Some(Warning::new(
            WarningCode::NoTool,
            "no tool is given: the load acts on the platform's own point. Write --tool-length-mm or, under [tool], length_mm (0 where the model has the tool in it)",
        ));
    }
    odd_length(task.mechanism, length, &task.bounds.limits)
}

/// A tool within its limits that is short, or long beside the machine.
fn odd_length(mechanism: &Mechanism, length: f64, limits: &Limits) -> Option<Warning> {
    if length != 0.0 && length >= limits.shortest_tool_mm && length < SHORT_MM {
        return Some(Warning::new(
            WarningCode::OddTool,
            format!(
                "the tool is only {} mm long, from the flange to its tip: check the unit",
                short(length)
            ),
        ));
    }
    let machine = 1e3 * natural_length(mechanism);
    (length > 0.4 * machine && length <= limits.longest_tool_mm).then(|| {
        Warning::new(
            WarningCode::OddTool,
            format!(
                "the tool is {} mm long, on limbs of {} mm: check the unit",
                short(length),
                short(machine)
            ),
        )
    })
}
