//! APT part programs and cutter location data (CLDATA, CLSF) as text.
//!
//! From statements and their numbers ([`lines`], [`file_reader`]) to motions ([`reader`]: the statements of a file, [`motions`]: those that
//! move, [`state`]: what is in force between them). What each word is taken for, and which system wrote the file, stands in [`table`]. Holes of cycles become motions in [`flat`].
//!
//! Source: ISO 3592 and ISO 4343 (CLDATA), ANSI X3.37 (APT), Siemens NX manual "CLSF", Dassault CATIA V5 "APT formats", and
//! 20 public files (docs/robot-programs.csv).

pub(crate) mod file_reader;
pub(crate) mod flat;
pub(crate) mod language;
pub(crate) mod lines;
pub(crate) mod motions;
pub(crate) mod reader;
pub(crate) mod state;
pub(crate) mod table;
