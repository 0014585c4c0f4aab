//! FANUC TP programs as text (LS): programs read together, and what the writer must know of them.
//!
//! From lines ([`lines`], [`words`]) to steps ([`step`], [`motion`], [`instructions`]) and positions ([`positions`],
//! [`configuration`]), and to the order and the frames in which they run ([`program`], [`linking`], [`beside`], [`flow`], [`registers`], [`given_frames`], [`order`], [`ends`],
//! [`made_motion`]); [`names`] are what people call positions; [`found`] keeps what comes of it. What each statement is taken for stands in [`table`].
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure", and the ASCII
//! listings of 22 public programs (docs/robot-programs.csv).

pub(crate) mod beside;
pub(crate) mod configuration;
pub(crate) mod ends;
pub(crate) mod flow;
mod found;
mod given_frames;
mod instructions;
pub(crate) mod lines;
mod linking;
mod made_motion;
pub(crate) mod motion;
pub(crate) mod names;
pub(crate) mod order;
pub(crate) mod positions;
pub(crate) mod program;
pub(crate) mod reader;
pub(crate) mod registers;
pub(crate) mod step;
pub(crate) mod table;
pub(crate) mod words;
pub(crate) mod write;
