//! Poses of tool and part for the redundancy resolution of a program that is converted.

use kinetostat::Pose;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{StatedFrame, Template, base_of_robot};
use kinetostat_machining::Placement;
use kinetostat_model::Model;
use nalgebra::Isometry3;

use crate::job::free_turn::{FreeTurn, chosen, only_tool};
use crate::job::program::ReadProgram;
use crate::job::robot::frames::in_metres;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};

/// Chooses the turn along a path of positions for the arm of a model, with tool and part where the template has them.
pub(crate) fn free_turn(
    setting: &Setting,
    template: &Template,
    model: &Model,
    read: &ReadProgram<'_>,
) -> Answer<FreeTurn> {
    let base = match base_of_source(read) {
        Some(base) => in_metres(&base),
        None => known(&template.base, "where the part is: pose under [base]")?,
    };
    let number = only_tool(setting, read.path())?;
    let numbered = number.and_then(|number| Some((number, template.tools.get(&number)?)));
    let tool = match numbered {
        Some((number, tool)) => known(
            &tool.frame,
            &format!(
                "where the tip of the tool {number} is: pose under [[tools]], in_program = {number}"
            ),
        )?,
        None => known(
            &template.tool.frame,
            "where the tip of the tool is: pose under [tool]",
        )?,
    };
    let Some(orientation) = template.tool_orientation else {
        return Err(ErrorCode::Missing.failure("--free-turn turns the tool about its axis from an orientation that is stated: tool_orientation in the template, or --tool-orientation",
        ));
    };
    let mechanism = model.mechanism.with_tool(&tool);
    let placement = Placement {
        base_from_part: base,
        tool_orientation: base.rotation * orientation,
        ..Placement::at(base.translation.vector)
    };
    chosen(setting, &mechanism, read.path(), placement)
}

/// The robot's base, where the places of the source are in its axes and not in those of a part, mm.
pub(crate) fn base_of_source(read: &ReadProgram<'_>) -> Option<Isometry3<f64>> {
    let robot = read.robot()?;
    base_of_robot(robot.program, &robot.path)?.pose
}

fn known(frame: &StatedFrame, what: &str) -> Answer<Pose> {
    let pose = frame.pose.as_ref().map(in_metres);
    pose.ok_or_else(|| {
        ErrorCode::Missing.failure(format!(
            "--free-turn needs to know {what}, in the template (--template)"
        ))
    })
}
