//! The free turn of a round tool, chosen along the whole path for an arm before the program is written.

use std::path::Path;

use kinetostat::Pose;
use kinetostat_formats::StatedFrame;
use kinetostat_machining::{Placement, TurnError, TurnTask, choose_turns, with_turns};
use kinetostat_program::Path as ToolPath;
use kinetostat_report::turns_svg;
use nalgebra::Isometry3;

use crate::convert::template_file::TemplateFile;
use crate::files::input_files::InputFiles;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failure};

/// The path with the tool turned about its axis.
pub(crate) struct FreeTurn {
    pub(crate) path: ToolPath,
    /// What was chosen, in words.
    pub(crate) description: String,
    /// The turn over the path, among those that the arm can take.
    pub(crate) picture: String,
}

/// Chooses the turn along a path of positions for the arm of a model.
pub(crate) fn free_turn(
    files: &InputFiles,
    model: &str,
    path: &ToolPath,
    (setting, template): (&Setting, &TemplateFile),
) -> Answer<FreeTurn> {
    if path.moves.iter().any(|motion| motion.tool_turn.is_some()) {
        return Err(setting.within(Failure::input(
            "--free-turn is for programs of positions, and this one states the orientation of its tool: leave it out",
        )));
    }
    let (model, _) = files.model(model, Path::new(""))?;
    let stated = &template.template;
    let base = known(&stated.base, "where the part is: pose under [base]")?;
    let tool = known(
        &stated.tool.frame,
        "where the tip of the tool is: pose under [tool]",
    )?;
    let Some(orientation) = stated.tool_orientation else {
        return Err(Failure::input(
            "--free-turn turns the tool about its axis from an orientation that is stated: tool_orientation in the template, or --tool-orientation",
        ));
    };
    let mechanism = model.mechanism.with_tool(&tool);
    let placement = Placement {
        base_from_part: base,
        tool_orientation: base.rotation * orientation,
        ..Placement::at(base.translation.vector)
    };
    let task = TurnTask::new(&mechanism, path, placement);
    let choice = choose_turns(&task).map_err(|error| refused(setting, &error))?;
    let turned = with_turns(&task, &choice).map_err(|error| refused(setting, &error))?;
    Ok(FreeTurn {
        path: turned.path,
        description: choice.description(),
        picture: turns_svg(&choice),
    })
}

/// A path without a way is a finding of the machine, not a fault of the question.
fn refused(setting: &Setting, error: &TurnError) -> Failure {
    setting.within(match error {
        TurnError::NoWay(_) | TurnError::Point { .. } => Failure::unanswered(error),
        _ => Failure::input(error),
    })
}

fn known(frame: &StatedFrame, what: &str) -> Answer<Pose> {
    let pose = frame.pose.as_ref().map(in_metres);
    pose.ok_or_else(|| {
        Failure::input(format!(
            "--free-turn needs to know {what}, in the template (--template)"
        ))
    })
}

fn in_metres(pose: &Isometry3<f64>) -> Pose {
    Pose::from_parts((1e-3 * pose.translation.vector).into(), pose.rotation)
}
