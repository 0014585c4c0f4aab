//! A path written as a new program, in the language of a robot, in APT, in G-code or as a table of poses.
//!
//! The way: [`gcode_events`] and [`robot_events`] find what a source says beside its moves ([`motion_events`]: in their statements;
//! [`siemens_events`] and [`heidenhain_events`]: the words of blocks, with [`words`], how the spindle turns and what they do
//! before a motion and behind it; [`run_statements`]: all of them for whoever compares two programs),
//! [`course`] says in which order all of it runs ([`robot_course`], [`routines`]: of robots' programs, [`of_tools`]: their tools, [`configurations`], [`reconfigured`]: their
//! postures), [`plan`] makes steps
//! (where [`tools_told`] finds every tool of the program in the template, and its edges)
//! of moves and events ([`pieces`] divides what the other side has no curve for or turns otherwise), one file for each language writes them, and [`compare`] reads what
//! was written and holds it against the path. [`template`] is what the caller states of the cell.

use thiserror::Error;

pub(crate) mod compare;
pub(crate) mod configurations;
pub(crate) mod course;
pub(crate) mod csv;
pub(crate) mod events;
pub(crate) mod gcode;
pub(crate) mod gcode_events;
pub(crate) mod heidenhain_events;
pub(crate) mod joint_table;
pub(crate) mod krl;
pub(crate) mod limits;
pub(crate) mod ls;
pub(crate) mod make;
pub(crate) mod motion_events;
pub(crate) mod names;
pub(crate) mod of_robot;
pub(crate) mod of_tools;
pub(crate) mod otherwise;
pub(crate) mod pieces;
pub(crate) mod plan;
pub(crate) mod rapid;
pub(crate) mod reconfigured;
pub(crate) mod robot_course;
pub(crate) mod robot_events;
pub(crate) mod routines;
pub(crate) mod run_statements;
pub(crate) mod siemens_events;
pub(crate) mod stated;
pub(crate) mod step;
pub(crate) mod template;
pub(crate) mod tools_told;
pub(crate) mod words;

/// Error that prevents a program from being made of a path: line of the source, reason, remedy.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}{reason}; {remedy}", place(*line))]
#[non_exhaustive]
pub struct MakeError {
    /// Line of the source, counted from 1; none where it is not about a line.
    pub line: Option<usize>,
    /// Reason for the error.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
    /// The error is in the template, not in the program.
    pub is_of_template: bool,
}

fn place(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

impl MakeError {
    pub(crate) fn at(line: usize, reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::of(reason, remedy)
        }
    }

    pub(crate) fn of(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: None,
            reason: reason.into(),
            remedy: remedy.into(),
            is_of_template: false,
        }
    }

    pub(crate) fn of_template(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            is_of_template: true,
            ..Self::of(reason, remedy)
        }
    }
}

/// Difference between a made program and its source, or an assumption.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MakeFinding {
    /// First line of the source that it is about, counted from 1; none where it is about all of it.
    pub line: Option<usize>,
    /// Text of the finding.
    pub message: String,
}

impl MakeFinding {
    pub(crate) fn of(line: impl Into<Option<usize>>, message: impl Into<String>) -> Self {
        Self {
            line: line.into(),
            message: message.into(),
        }
    }
}
