//! SINUMERIK 840D: part programs and subprograms as text.
//!
//! From bytes to [`tokens`], [`expression`]s and [`block`]s; what words say ([`words`], [`gathering`], [`codes`], [`turned_axes`]) and what blocks do
//! ([`motion`], [`made_motion`], [`arcs`]) along a program that runs straight on ([`reader`]). Programs with jumps, loops, calls and
//! drilling cycles are run once and written flat ([`flat`]); what is corrected is written by [`writing`]. What each word is taken for stands in [`table`].
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manuals Fundamentals, Job Planning and Cycles, and public programs.

pub(crate) mod arcs;
pub(crate) mod block;
pub(crate) mod called;
mod codes;
pub(crate) mod declarations;
pub(crate) mod expression;
pub(crate) mod flat;
mod gathering;
pub(crate) mod language;
mod made_motion;
mod motion;
pub(crate) mod reader;
pub(crate) mod state;
pub(crate) mod steps_behind_frames;
pub(crate) mod table;
pub(crate) mod tokens;
pub(crate) mod turned_axes;
pub(crate) mod values;
mod walker;
mod words;
pub(crate) mod writing;
