//! The free turn of a round tool, chosen along the whole path for the arm of a run.

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    Placement, RunInputs, TipCompliance, TurnChoice, TurnCriterion, TurnError, TurnTask,
    choose_turns, with_turns,
};
use kinetostat_program::Path as ToolPath;

use crate::job::setting::Setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::item;
use crate::ui::numbers::number;

/// Weight of the stiffness if requested; limits, singular postures and evenness have 1 each.
const STIFFNESS_WEIGHT: f64 = 2.0;

/// The path with the tool turned about its axis.
pub(crate) struct FreeTurn {
    pub(crate) path: ToolPath,
    /// Choice in words.
    pub(crate) description: String,
    /// The turn over the path, among those that the arm can take.
    pub(crate) choice: TurnChoice,
}

impl FreeTurn {
    /// Text of the choice, for the answer.
    pub(crate) fn said(&self) -> String {
        format!(
            "\nTurn of the tool about its axis\n{}",
            item(&format!("{}.", self.description))
        )
    }

    /// Appends the choice to the inputs of a run.
    pub(crate) fn put_into(&self, inputs: &mut RunInputs) {
        inputs.placement.push_str("; ");
        inputs.placement.push_str(&self.description);
    }
}

/// The number of the tool that the whole path is made with, where the program says one: the turn is chosen for one tool, and it would
/// jump where another is taken.
pub(crate) fn only_tool(setting: &Setting, path: &ToolPath) -> Answer<Option<u32>> {
    let mut used: Vec<(u32, usize)> = Vec::new();
    for motion in &path.moves {
        if let Some(number) = path.tool_on(motion.line)
            && used.iter().all(|(known, _)| *known != number)
        {
            used.push((number, motion.line));
        }
    }
    match used.as_slice() {
        [] => Ok(None),
        [(only, _)] => Ok(Some(*only)),
        [(first, _), (second, line), ..] => Err(setting.within(ErrorCode::ProgramUnsuited.failure(format!(
            "line {line}: the tool {second} moves here, and the tool {first} before: --free-turn (free_turn under [robot]) is for programs of one tool. Divide the program where the tool changes and run each part by itself ([[tools]] of job and template may stay), or leave the free turn out"
        )))),
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
        return Err(setting.within(ErrorCode::ProgramUnsuited.failure("--free-turn is for programs of positions, and this one states the orientation of its tool: leave it out",
        )));
    }
    let mut task = TurnTask::new(mechanism, path, placement);
    let is_stiff = setting.free_turn == FreeTurnWord::Stiff;
    if is_stiff {
        task.criteria.push(TurnCriterion::Compliance {
            weight: STIFFNESS_WEIGHT,
            of: TipCompliance::Worst,
        });
    }
    let choice = choose_turns(&task).map_err(|error| refused(setting, &error))?;
    let turned = with_turns(&task, &choice).map_err(|error| refused(setting, &error))?;
    Ok(FreeTurn {
        path: turned.path,
        description: match is_stiff {
            true => choice.description() + &softest(&choice),
            false => choice.description(),
        },
        choice,
    })
}

/// Largest compliance of the tip, for turns that were chosen to be stiff.
fn softest(choice: &TurnChoice) -> String {
    let stations = choice.stations.iter();
    let most = stations.max_by(|a, b| a.compliance_m_per_n.total_cmp(&b.compliance_m_per_n));
    most.map_or(String::new(), |most| {
        format!(
            ". Chosen to be stiff, too: without weights and loads the tip yields at most {} um/N (line {})",
            number(1e6 * most.compliance_m_per_n, 4),
            most.line
        )
    })
}

/// A path without a way is a finding of the machine, not a fault of the question.
fn refused(setting: &Setting, error: &TurnError) -> Failure {
    setting.within(match error {
        TurnError::NoWay(_) | TurnError::Point { .. } => ErrorCode::NoAnswer.failure(error),
        _ => ErrorCode::ProgramUnsuited.failure(error),
    })
}
