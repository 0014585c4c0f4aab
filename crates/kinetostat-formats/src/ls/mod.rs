//! FANUC TP programs as text (LS): programs read together, and what the writer must know of them.
//!
//! From lines ([`lines`]) to steps ([`step`], [`motion`], [`expression`]) and positions ([`positions`]) of programs ([`program`],
//! [`reader`]), which are run: [`run`] holds the state, [`control`] the order,
//! [`storage`] the data, [`passing`] branches that only the controller decides and [`made_motion`] the motions. [`flat`] writes the
//! lines that ran, and the file of them. What each statement is taken for stands in [`table`].
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure", and the ASCII
//! listings of 22 public programs (docs/robot-programs.csv).

mod control;
mod expression;
mod flat;
pub(crate) mod language;
pub(crate) mod lines;
mod made_motion;
pub(crate) mod motion;
mod passing;
pub(crate) mod positions;
pub(crate) mod program;
pub(crate) mod reader;
mod run;
pub(crate) mod step;
mod storage;
pub(crate) mod table;
pub(crate) mod write;
