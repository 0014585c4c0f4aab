//! APT part programs and cutter location data (CLDATA, CLSF) as text.
//!
//! From statements ([`lines`]) to their numbers ([`numbers`], [`places`]), arcs ([`arc`]) and motions ([`reader`]: the
//! statements of a file, [`statements`], those that move, [`motions`], and what is in force between them, [`state`]). What
//! each word is taken for stands in [`table`]; which system wrote the file, [`dialect`] says. Holes of cycles become motions in [`flat`].
//!
//! Source: ISO 3592 and ISO 4343 (CLDATA), ANSI X3.37 (APT), Siemens NX manual "CLSF", Dassault CATIA V5 "APT formats", and
//! 20 public files (docs/robot-programs.csv).

pub(crate) mod arc;
pub(crate) mod dialect;
pub(crate) mod file_reader;
pub(crate) mod flat;
pub(crate) mod language;
pub(crate) mod lines;
pub(crate) mod motions;
pub(crate) mod numbers;
pub(crate) mod places;
pub(crate) mod reader;
pub(crate) mod spindle;
pub(crate) mod state;
pub(crate) mod statements;
pub(crate) mod table;
pub(crate) mod write;
