//! The table `[robot]` of a job file: what a program of a robot does not say itself.

use std::collections::BTreeMap;

use kinetostat_formats::StatedValue;
use kinetostat_model::schema::{Axis, Placement as PoseTable};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::job::robot_arguments::{CorrectWord, JointRowsWord};
use crate::job::target_word::RobotWord;
use crate::job::turn_arguments::FreeTurnWord;

/// Data that a program of a robot does not state itself.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RobotTable {
    /// Tools (in the flange) and work objects (in the robot's base) by their names in the program.
    #[serde(default)]
    pub frames: BTreeMap<Spanned<String>, Spanned<PoseTable>>,
    /// Additional files of the program: modules, data.
    #[serde(default)]
    pub files: Vec<Spanned<String>>,
    /// Corrected directions of the tool's pose.
    pub correct: Option<CorrectWord>,
    /// Linear motions at this speed or a higher one position the tool in air.
    pub rapid_from_mm_per_s: Option<Spanned<f64>>,
    /// Direction from the tool's tip to its holder, in axes of the tool.
    pub tool_axis: Option<Spanned<Axis>>,
    /// Redundancy resolution about the tool axis where the program states the axis alone; by default the smallest turn.
    pub turn_about_axis: Option<Spanned<TurnTable>>,
    /// Policy for moving external axes.
    pub external_axes: Option<ExternalAxesWord>,
    /// Policy for motions to ends that are not known from the text.
    pub unknown_targets: Option<UnknownTargetsWord>,
    /// Policy for paths that the controller offsets by the tool's radius.
    pub cutter_compensation: Option<CutterCompensationWord>,
    /// The turn of a round tool about its own axis.
    #[serde(default)]
    pub free_turn: FreeTurnWord,
    /// The language of the compensated program, where it is another one.
    pub to: Option<Spanned<RobotWord>>,
    /// Template of the cell for that.
    pub template: Option<Spanned<String>>,
    /// Length unit of a list of poses that does not state it.
    pub length_unit: Option<Spanned<LengthUnitWord>>,
    /// Interpolation of the controller between the rows of a table of joint values.
    pub joint_rows: Option<Spanned<JointRowsWord>>,
}

/// A direction of the tool that lies at every pose as near as possible to one of the part.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TurnTable {
    /// Axis of the tool's frame.
    pub tool: Axis,
    /// Axis of the part.
    pub part: Axis,
}

impl RobotTable {
    /// True if the table has no keys for programs of robots only: corrected directions, turn about the tool and output language
    /// apply to G-code as well.
    pub(crate) fn is_of_any_program(&self) -> bool {
        let lists = self.frames.is_empty() && self.files.is_empty();
        let axes = self.tool_axis.is_none() && self.external_axes.is_none();
        let turns = self.turn_about_axis.is_none() && self.joint_rows.is_none();
        let others = self.rapid_from_mm_per_s.is_none() && self.unknown_targets.is_none();
        let text = self.cutter_compensation.is_none() && self.length_unit.is_none();
        lists && axes && turns && others && text
    }
}

/// Paths that the controller moves aside by the tool's radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CutterCompensationWord {
    /// Refused by line.
    Refused,
    /// Their places are those of the tool's centre.
    CentrePath,
}

/// Length unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum LengthUnitWord {
    /// Millimetres.
    Mm,
    /// Metres.
    M,
}

/// Effect of a call to a routine that is in none of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CallWord {
    /// The call moves the tool: it is refused by line.
    Moves,
}

/// A value of a name.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub(crate) enum ValueWord {
    Number(f64),
    Truth(bool),
    Text(String),
}

impl From<&ValueWord> for StatedValue {
    fn from(word: &ValueWord) -> Self {
        match word {
            ValueWord::Number(number) => Self::Number(*number),
            ValueWord::Truth(truth) => Self::Truth(*truth),
            ValueWord::Text(text) => Self::Text(text.clone()),
        }
    }
}

/// External axes that move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ExternalAxesWord {
    /// The program is refused.
    Refused,
    /// Carried as written.
    Carried,
}

/// Motions to ends that are not known from the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum UnknownTargetsWord {
    /// Refused by line.
    Refused,
    /// Left as written.
    LeftAsWritten,
}
