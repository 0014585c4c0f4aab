//! Orientation of an arm's tool over the part.

use kinetostat::Pose;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode, beyond_tool_length};
use kinetostat_program::Path as ToolPath;
use nalgebra::UnitQuaternion;

use crate::job::machine::MachineSetup;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{short, triple};

/// Share of the tool's length by which its holder may lie below its tip.
const LEVEL: f64 = 0.05;

/// Share up to which it may lie above its tip where a tool lies on its side: 20 degrees.
const LYING: f64 = 0.34;

/// Checks the tool axes of a program of positions in the part, by the position of the flange: refuses flanges below the tip, warns
/// of horizontal tools, as those of horizontal spindles.
pub(crate) fn over_part(turn: UnitQuaternion<f64>, tools: &[Pose]) -> Answer<Option<Warning>> {
    let mut lies = None;
    for tool in tools {
        let to_holder = turn * (tool.inverse().translation.vector);
        let at = triple((1e3 * to_holder).into(), short);
        if to_holder.z < -LEVEL * to_holder.norm() {
            return Err(ErrorCode::Value.failure(format!(
                    "the tool points up: its flange lies at {at} mm from its tip, axes of the part, and parts are cut from above (z above 0). Correct tool_orientation, as in a_b_c_kuka_deg=0,0,180, or the sign of the tool's pose"
                ),
            ));
        }
        if to_holder.norm() > 0.0 && to_holder.z <= LYING * to_holder.norm() {
            lies = Some(format!(
                "the tool lies on its side: its flange lies at {at} mm from its tip, axes of the part; where no horizontal spindle cuts, correct tool_orientation, as in a_b_c_kuka_deg=0,0,180"
            ));
        }
    }
    Ok(lies.map(|text| Warning::new(WarningCode::OddToolAxis, text)))
}

/// Arms of fewer drives cannot turn their tool: it stands as it is drawn.
const TURNS_TOOL: usize = 5;

/// Checks the tool axis of an arm over the part, for a program of positions.
pub(crate) fn tool_over_part(
    machine: &MachineSetup,
    is_of_positions: bool,
) -> Answer<Option<Warning>> {
    let turns_tool = machine.mechanism.actuator_names().len() >= TURNS_TOOL;
    if !(machine.is_arm && turns_tool && is_of_positions) {
        return Ok(None);
    }
    let placement = &machine.placement;
    let turn = placement.base_from_part.rotation.inverse() * placement.tool_orientation;
    // One whose length is beyond its limits is refused for that.
    let tools = (machine.bounds.tools.iter())
        .filter(|given| beyond_tool_length(&machine.bounds.limits, given).is_empty());
    let tools: Vec<Pose> = tools.map(|given| given.pose).collect();
    over_part(turn, &tools)
}

/// The program does not say how its tool stands.
pub(crate) fn is_of_positions(path: &ToolPath) -> bool {
    path.moves.iter().all(|motion| motion.tool_turn.is_none())
}
