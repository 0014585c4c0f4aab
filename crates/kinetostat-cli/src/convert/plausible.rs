//! Plausibility of a conversion: the limits of `compensate`, for what the template and the source state.

use kinetostat::Pose;
use kinetostat_formats::{FrameUse, Template};
use kinetostat_machining::{
    Beyond, RunError, ToolGiven, Warning, WarningCode, beyond_tool_length, fastest_feed,
};
use kinetostat_program::Path as ToolPath;
use nalgebra::{Isometry3, UnitQuaternion};

use crate::job::machine::MachineSetup;
use crate::job::program::ReadProgram;
use crate::job::robot::frames::in_metres;
use crate::job::setting::Setting;
use crate::job::template_file::TemplateFile;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::{short, triple};

/// Rotations smaller than this are none, degrees.
const NO_TURN_DEG: f64 = 1e-6;

/// Share of the tool's length by which its holder may lie below its tip.
const LEVEL: f64 = 0.05;

/// Share up to which it may lie above its tip where a tool lies on its side: 20 degrees.
const LYING: f64 = 0.34;

/// Refuses what no cell has: lengths and speeds beyond their limits, angles in radians, a tool that points up. Warns of
/// one that lies on its side.
pub(super) fn refuse_implausible(
    setting: &Setting,
    file: &TemplateFile,
    read: &ReadProgram<'_>,
) -> Answer<Option<Warning>> {
    let template = &file.template;
    let beyond = beyond_limits(setting, template, read);
    if !beyond.is_empty() {
        return Err(setting.within(Failure::from(RunError::BeyondLimits(beyond))));
    }
    let of_template = |failure: Failure| match &file.name {
        Some(name) => failure.within(name),
        None => failure,
    };
    refuse_radians(template, read).map_err(of_template)?;
    let Some(turn) = template
        .tool_orientation
        .filter(|_| is_of_positions(read.path()))
    else {
        return Ok(None);
    };
    let mut tools: Vec<Pose> = (tools(template, &[]).map(|(_, pose)| in_metres(pose))).collect();
    if tools.is_empty() {
        // Without a tool its axis is z of the flange, which points away from the arm (ISO 9787).
        tools.push(Pose::translation(0.0, 0.0, 1.0));
    }
    over_part(turn, &tools).map_err(of_template)
}

fn beyond_limits(setting: &Setting, template: &Template, read: &ReadProgram<'_>) -> Vec<Beyond> {
    let limits = &setting.limits;
    let mut found = Vec::new();
    let robot = read.robot().map(|robot| &robot.path);
    let work_object = robot.and_then(|path| path.work_object.as_ref()?.known());
    for base in template.base.pose.iter().chain(work_object) {
        let far = base.translation.vector.norm();
        let beyond = limits.beyond(
            "nearest_base_mm",
            far,
            None,
            "[base] or its frame in the program",
        );
        found.extend(beyond.filter(|_| far > 0.0));
    }
    for (number, pose) in tools(template, robot.map_or(&[], |path| path.tools.as_slice())) {
        let given = ToolGiven {
            number,
            pose: in_metres(pose),
            stated: true,
        };
        found.extend(beyond_tool_length(limits, &given));
    }
    found.extend(limits.beyond("zone_mm", template.zones.feeds_mm, None, "[zones]"));
    found.extend(fastest_feed(limits, read.path()));
    found
}

/// Tools of the template, and of the source where it states them; mm.
fn tools<'t>(
    template: &'t Template,
    of_source: &'t [FrameUse],
) -> impl Iterator<Item = (Option<u32>, &'t Isometry3<f64>)> {
    let own = template.tool.frame.pose.iter().map(|pose| (None, pose));
    let numbered = template.tools.iter();
    let numbered = numbered.filter_map(|(n, tool)| Some((Some(*n), tool.frame.pose.as_ref()?)));
    let of_source = of_source
        .iter()
        .filter_map(|tool| Some((None, tool.known()?)));
    own.chain(numbered).chain(of_source)
}

/// Angles in degrees that are a share of pi in radians.
fn refuse_radians(template: &Template, read: &ReadProgram<'_>) -> Answer<()> {
    let robot = read.robot().map(|robot| &robot.path);
    let work_object = robot.and_then(|path| path.work_object.as_ref()?.known());
    let bases = template.base.pose.iter().chain(work_object);
    let bases = bases.map(|pose| ("base", pose.rotation));
    let of_source = robot.map_or(&[][..], |path| path.tools.as_slice());
    let tools = tools(template, of_source).map(|(_, pose)| ("tool", pose.rotation));
    let own = template
        .tool_orientation
        .map(|turn| ("tool (tool_orientation)", turn));
    let all = own.into_iter().chain(bases).chain(tools);
    let odd = |(_, turn): &(&str, UnitQuaternion<f64>)| {
        let deg = turn.angle().to_degrees();
        deg > NO_TURN_DEG && kinetostat_model::looks_like_radians(deg)
    };
    match all.into_iter().find(odd) {
        Some((what, turn)) => Err(Failure::input(format!(
            "the orientation of the {what} turns by {} deg, which is {} deg in radians: orientations are in degrees here; write them in degrees, or under a name that ends with _rad",
            short(turn.angle().to_degrees()),
            short(turn.angle().to_degrees().to_degrees())
        ))),
        None => Ok(()),
    }
}

/// How the tools of a program of positions stand in the part, by the place of their flanges: refused below the tip, warned of where
/// they lie on their side, as those of horizontal spindles do.
fn over_part(turn: UnitQuaternion<f64>, tools: &[Pose]) -> Answer<Option<Warning>> {
    let mut lies = None;
    for tool in tools {
        let to_holder = turn * (tool.inverse().translation.vector);
        let at = triple((1e3 * to_holder).into(), short);
        if to_holder.z < -LEVEL * to_holder.norm() {
            return Err(Failure::input(format!(
                "the tool points up: its flange lies at {at} mm from its tip, axes of the part, and parts are cut from above (z above 0). Correct tool_orientation, as in a_b_c_kuka_deg=0,0,180, or the sign of the tool's pose"
            )));
        }
        if to_holder.norm() > 0.0 && to_holder.z <= LYING * to_holder.norm() {
            lies = Some(format!(
                "the tool lies on its side: its flange lies at {at} mm from its tip, axes of the part; where no horizontal spindle cuts, correct tool_orientation, as in a_b_c_kuka_deg=0,0,180"
            ));
        }
    }
    Ok(lies.map(|text| Warning::new(WarningCode::OddToolAxis, text)))
}

/// How the tool of an arm stands over the part of a program of positions.
pub(crate) fn tool_over_part(
    machine: &MachineSetup,
    is_of_positions: bool,
) -> Answer<Option<Warning>> {
    if !(machine.is_arm && is_of_positions) {
        return Ok(None);
    }
    let placement = &machine.placement;
    let turn = placement.base_from_part.rotation.inverse() * placement.tool_orientation;
    let tools: Vec<Pose> = (machine.bounds.tools.iter().map(|given| given.pose)).collect();
    over_part(turn, &tools)
}

/// The program does not say how its tool stands.
pub(crate) fn is_of_positions(path: &ToolPath) -> bool {
    path.moves.iter().all(|motion| motion.tool_turn.is_none())
}
