//! Plausibility of a conversion: the limits of `compensate`, for what the template and the source state.

use kinetostat::Pose;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{FrameUse, Template};
use kinetostat_machining::{
    Beyond, RunError, ToolGiven, Warning, beyond_tool_length, fastest_feed,
};
use nalgebra::{Isometry3, UnitQuaternion};

use crate::job::over_part::{is_of_positions, over_part};
use crate::job::program::ReadProgram;
use crate::job::robot::frames::in_metres;
use crate::job::setting::Setting;
use crate::job::template_file::TemplateFile;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::short;

/// Rotations smaller than this are none, degrees.
const NO_TURN_DEG: f64 = 1e-6;

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
        // The default tool axis is z of the flange, which points away from the arm (ISO 9787).
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
        Some((what, turn)) => Err(ErrorCode::Value.failure(format!(
                "the orientation of the {what} turns by {} deg, which is {} deg in radians: orientations are in degrees here; write them in degrees, or under a name that ends with _rad",
                short(turn.angle().to_degrees()),
                short(turn.angle().to_degrees().to_degrees())
            ),
        )),
        None => Ok(()),
    }
}
