//! Options for programs of robots.

use std::path::PathBuf;

use clap::{ArgAction, Args, ValueEnum};
use kinetostat::Directions;
use kinetostat_formats::{BetweenRows, StatedValue};
use serde::Deserialize;

use crate::options::number;

/// Corrected directions of the tool's pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CorrectWord {
    /// Its position
    #[default]
    Position,
    /// Its position and its orientation
    Pose,
}

/// Interpolation of the controller between the rows of a table of joint values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum JointRowsWord {
    /// All joints in step
    Joint,
    /// The tool on a straight line
    Linear,
}

impl From<JointRowsWord> for BetweenRows {
    fn from(word: JointRowsWord) -> Self {
        match word {
            JointRowsWord::Joint => Self::Joint,
            JointRowsWord::Linear => Self::Linear,
        }
    }
}

/// An axis and its sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AxisWord {
    X,
    Y,
    Z,
    #[value(name = "-x")]
    MinusX,
    #[value(name = "-y")]
    MinusY,
    #[value(name = "-z")]
    MinusZ,
}

/// Facts that only the controller of a robot's program knows.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct StatedArgs {
    /// What the program calls by this name, and none of its files holds, moves the tool: NAME=moves (repeat for more). Such a call is
    /// refused by line; others are taken not to move the tool and not to change speed, tool or frame
    #[arg(long = "call", value_name = "NAME=moves", action = ArgAction::Append, help_heading = "Robot programs", value_parser = moving_call)]
    pub(crate) moving_calls: Vec<String>,
    /// Value of a name that only the controller knows (a signal, an input, a register), as in di1=1 (repeat for more)
    #[arg(long = "set", value_name = "NAME=VALUE", action = ArgAction::Append, help_heading = "Robot programs", value_parser = stated_value)]
    pub(crate) values: Vec<(String, StatedValue)>,
}

impl StatedArgs {
    /// The option that was given and means nothing to a program in G-code.
    pub(crate) fn of_others(&self) -> Option<&'static str> {
        (!self.values.is_empty()).then_some("--set")
    }
}

/// Options for programs of robots.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct RobotArgs {
    /// What of the tool's pose is corrected, in programs that state its orientation (of robots, and of
    /// machines with rotary axes) [default: position]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Robot programs")]
    pub(crate) correct: Option<CorrectWord>,
    /// Linear motions at this speed or a higher one position the tool in air, mm/s: no load acts there
    #[arg(long, value_name = "V", allow_negative_numbers = true, help_heading = "Robot programs", value_parser = number)]
    pub(crate) rapid_from_mm_per_s: Option<f64>,
    /// Axis of the tool from its tip to its holder, in axes of its frame [default: -z]
    #[arg(
        long,
        value_enum,
        value_name = "AXIS",
        allow_hyphen_values = true,
        help_heading = "Robot programs"
    )]
    pub(crate) tool_axis: Option<AxisWord>,
    /// How the controller moves between the rows of a table of joint values
    #[arg(long, value_enum, value_name = "WAY", help_heading = "Robot programs")]
    pub(crate) joint_rows: Option<JointRowsWord>,
    #[command(flatten)]
    pub(crate) stated: StatedArgs,
    /// The program is converted into the language of a robot before it is run.
    #[arg(skip)]
    pub(crate) converted: bool,
    /// Template of the cell, in place of the job's.
    #[arg(skip)]
    pub(crate) template: Option<PathBuf>,
}

/// The name in `NAME=moves`.
fn moving_call(text: &str) -> Result<String, String> {
    match text.split_once('=') {
        Some((name, "moves")) if !name.trim().is_empty() => Ok(name.trim().to_owned()),
        _ => Err("write NAME=moves, as in SPINDLE_ON=moves".to_owned()),
    }
}

/// Name and value in `NAME=VALUE`.
fn stated_value(text: &str) -> Result<(String, StatedValue), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), StatedValue::of(value.trim())))
        }
        _ => Err("write NAME=VALUE, as in di1=1".to_owned()),
    }
}

impl CorrectWord {
    /// Directions of the tool's pose.
    pub(crate) fn directions(self) -> Directions {
        match self {
            Self::Position => Directions::POSITION,
            Self::Pose => Directions::ALL,
        }
    }
}

impl RobotArgs {
    /// The first option that was given and means nothing to a program in G-code.
    pub(crate) fn of_robots_alone(&self) -> Option<&'static str> {
        let all = [
            ("--rapid-from-mm-per-s", self.rapid_from_mm_per_s.is_some()),
            ("--tool-axis", self.tool_axis.is_some()),
            ("--joint-rows", self.joint_rows.is_some()),
        ];
        let mut given = all.into_iter().filter(|(_, given)| *given);
        given
            .next()
            .map(|(name, _)| name)
            .or_else(|| self.stated.of_others())
    }
}
