//! The free turn of a round tool, chosen along the whole path for the arm of a run.

use kinetostat::Mechanism;
use kinetostat_machining::{
    Placement, RunInputs, TurnChoice, TurnError, TurnTask, choose_turns, with_turns,
};
use kinetostat_program::Path as ToolPath;

use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failure};
use crate::ui::layout::item;

/// The path with the tool turned about its axis.
pub(crate) struct FreeTurn {
    pub(crate) path: ToolPath,
    /// What was chosen, in words.
    pub(crate) description: String,
    /// The turn over the path, among those that the arm can take.
    pub(crate) choice: TurnChoice,
}

impl FreeTurn {
    /// What was chosen, for the answer.
    pub(crate) fn said(&self) -> String {
        format!(
            "\nTurn of the tool about its axis\n{}",
            item(&format!("{}.", self.description))
        )
    }

    /// What was chosen, among the inputs of a run.
    pub(crate) fn put_into(&self, inputs: &mut RunInputs) {
        inputs.placement.push_str("; ");
        inputs.placement.push_str(&self.description);
    }
}

/// Chooses the turn along a path of positions for an arm with its tool.
pub(crate) fn chosen(
    setting: &Setting,
    mechanism: &Mechanism,
    path: &ToolPath,
    placement: Placement,
) -> Answer<FreeTurn> {
    if path.moves.iter().any(|motion| motion.tool_turn.is_some()) {
        return Err(setting.within(Failure::input(
            "--free-turn is for programs of positions, and this one states the orientation of its tool: leave it out",
        )));
    }
    if path.tool_changes.len() > 1 {
        return Err(setting.within(Failure::input(
            "--free-turn is for programs of one tool, and this one takes several: give the parts of the program with each of them one by one",
        )));
    }
    let task = TurnTask::new(mechanism, path, placement);
    let choice = choose_turns(&task).map_err(|error| refused(setting, &error))?;
    let turned = with_turns(&task, &choice).map_err(|error| refused(setting, &error))?;
    Ok(FreeTurn {
        path: turned.path,
        description: choice.description(),
        choice,
    })
}

/// A path without a way is a finding of the machine, not a fault of the question.
fn refused(setting: &Setting, error: &TurnError) -> Failure {
    setting.within(match error {
        TurnError::NoWay(_) | TurnError::Point { .. } => Failure::unanswered(error),
        _ => Failure::input(error),
    })
}
