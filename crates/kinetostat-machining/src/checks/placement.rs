//! Checks that the part lies in the workspace of the machine, and that the length of the tool is plausible.

use kinetostat::number::short;
use kinetostat::{Mechanism, Pose};
use kinetostat_program::Knowledge;
use nalgebra::Vector3;

use crate::checks::Exceeded;
use crate::checks::load::numbered;
use crate::limits::{Beyond, Limits};
use crate::measured_frame::PartPlace;
use crate::near::natural_length;
use crate::placement::Placement;
use crate::result::point::{PointKind, PointResult, place};
use crate::task::{Task, ToolGiven};
use crate::warning::{Warning, WarningCode};

/// Origins of parts that are nearer than this to the origin of a large machine may be metres, mm.
const NEAR_MM: f64 = 10.0;

/// Smallest distance, mm, that is suspected of being in metres: no large machine works nearer.
const LEAST_MM: f64 = 0.05;

/// A base that is nearer than this to a part stands beside it, mm.
const BESIDE_MM: f64 = 200.0;

/// Machines of this size, working as far from the origin of their base, are large, m.
const LARGE_M: f64 = 0.3;

/// Warning of a placement that was most likely written in metres: some millimetres from the origin of the base, so
/// that the base of a large machine stands in the part. If no placement was stated, also of a base that stands beside
/// it.
#[must_use]
pub fn origin_in_metres(
    mechanism: &Mechanism,
    placement: &Placement,
    path: &kinetostat_program::Path,
    is_unplaced: bool,
) -> Option<Warning> {
    let origin = 1e3 * placement.base_from_part.translation.vector;
    let home = mechanism.platforms()[mechanism.tool()].home;
    // Machines whose base has its origin where they work have parts there.
    let away = home.translation.vector.norm().min(mechanism.size());
    let is_unplaced = is_unplaced && origin.amax() == 0.0;
    let is_near = is_unplaced || (LEAST_MM..NEAR_MM).contains(&origin.amax());
    if !is_near || away <= LARGE_M {
        return None;
    }
    let places = path
        .moves
        .iter()
        .filter(|m| m.known != Knowledge::Nothing)
        .map(|m| 1e3 * placement.on(m, 1.0).tool_pose(&m.end).translation.vector);
    let (low, high) = places
        .map(|p| (p, p))
        .reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))?;
    let beside = if is_unplaced { BESIDE_MM } else { NEAR_MM };
    let inside = (0..3).all(|k| low[k] <= beside && high[k] >= -beside);
    if inside && is_unplaced {
        return Some(Warning::new(
            WarningCode::NoPlacement,
            "no place of the part is given: its zero is that of the machine's base, which stands in the part or beside it. Write --part-origin-mm or, under [placement], part_origin_mm (0 0 0 where it is so)",
        ));
    }
    inside.then(|| {
        let [x, y, z] = [0, 1, 2].map(|k| short(origin[k]));
        Warning::new(
            WarningCode::OddPlacement,
            format!(
                "the program's zero lies at ({x}, {y}, {z}) mm, so that the machine's base is inside the part: check the unit of part_origin_mm (millimetres, not metres)"
            ),
        )
    })
}

/// Limit for a part far below the base of a machine whose tool is above it at home: mostly a wrong sign. A workspace of the model
/// takes precedence.
pub(crate) fn below_base(task: &Task<'_>) -> Option<Beyond> {
    let mechanism = task.mechanism;
    let up = match mechanism.gravity().try_normalize(1e-9) {
        Some(down) => -down,
        None => Vector3::z(),
    };
    let home = mechanism.platforms()[mechanism.tool()].home;
    let is_above = home.translation.vector.dot(&up) > 0.0;
    if !is_above || task.bounds.workspace.is_some() {
        return None;
    }
    let origin = &task.placement.base_from_part.translation.vector;
    let depth_mm = -1e3 * origin.dot(&up);
    (task.bounds.limits).beyond("below_base_mm", depth_mm, None, "")
}

pub(crate) fn outside_workspace(task: &Task<'_>, points: &[PointResult]) -> Option<Warning> {
    let (low, high) = task.bounds.workspace?;
    // With several tools the flange is not one.
    let flange = match task.bounds.tools.as_slice() {
        [] => Pose::identity(),
        [tool] => tool.pose.inverse(),
        _ => return None,
    };
    let slack = 1e-3;
    let outside = |p: &&PointResult| {
        let at = (PartPlace::of_point(task, p).pose() * flange)
            .translation
            .vector;
        (0..3).any(|k| at[k] < low[k] - slack || at[k] > high[k] + slack)
    };
    let first = points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid)
        .find(outside)?;
    Some(Warning::at_line(
        WarningCode::OutsideWorkspace,
        first.line,
        format!(
            "{} the flange leaves the workspace that the model states: check where the part lies and the tool's length",
            place(first)
        ),
    ))
}

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
