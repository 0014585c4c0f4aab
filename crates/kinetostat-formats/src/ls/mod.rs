//! FANUC TP programs as text (LS): programs read together, and what the writer must know of them.
//!
//! From lines ([`lines`], [`words`]) to steps ([`step`], [`motion`], [`expression`], [`instructions`]) and positions ([`positions`],
//! [`configuration`]) of programs ([`program`], [`linking`]), which are run: [`run`] holds the state, [`control`] the order,
//! [`storage`] the data, [`passing`] branches that only the controller decides and [`made_motion`] the motions. [`flat`] writes the
//! lines that ran ([`flat_lines`]), [`expand`] the file of them. [`names`] are what people call
//! positions; [`found`] keeps what is said. What each statement is taken for stands in [`table`].
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure", and the ASCII
//! listings of 22 public programs (docs/robot-programs.csv).

pub(crate) mod configuration;
mod control;
mod expand;
mod expression;
mod flat;
mod flat_lines;
mod found;
mod instructions;
pub(crate) mod language;
pub(crate) mod lines;
mod linking;
mod made_motion;
pub(crate) mod motion;
pub(crate) mod names;
mod passing;
pub(crate) mod positions;
pub(crate) mod program;
pub(crate) mod reader;
mod run;
pub(crate) mod step;
mod storage;
pub(crate) mod table;
pub(crate) mod words;
pub(crate) mod write;
