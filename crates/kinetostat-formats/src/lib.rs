//! Robot programs: read without loss, corrected in place, written byte for byte where nothing changes.
//!
//! The way of a program:
//!
//! 1. A reader ([`read_rapid`], [`read_krl`], or [`read`] by language) takes the files of a program together and says where the tool
//!    goes: a [`RobotProgram`] with its [`Motion`]s, in the order in which they run. What can move the tool and is not
//!    understood is refused, all of it in one run, by line, with what to do. All else is carried. What each statement is
//!    taken for stands in a table ([`RAPID_STATEMENTS`], [`KRL_STATEMENTS`], ...).
//!    Programs with jumps, loops and calls of SINUMERIK and Heidenhain are run once and written flat before ([`expand_siemens`],
//!    [`expand_heidenhain`]).
//! 2. The caller makes [`Piece`]s: where motions are to end instead.
//! 3. [`write()`] changes the numbers of the text that must change, and nothing else.
//!
//! This crate knows no robot. It reads and writes bytes in memory; files are the caller's. Lengths are in mm; poses are in the
//! axes of the motion's work object; lines are counted from 1.
//!
//! ```
//! use kinetostat_formats::*;
//! use nalgebra::Vector3;
//!
//! let text = "MODULE Part\n\
//!     CONST robtarget p1:=[[100,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
//!     PROC main()\n\
//!     MoveJ Offs(p1,0,0,50),v500,z10,tool0;\n\
//!     MoveL p1,v20,fine,tool0;\n\
//!     ENDPROC\nENDMODULE\n";
//! let files = vec![SourceFile::new("Part.mod", text)];
//! let program = read_rapid(files, &ReadOptions::default()).unwrap();
//!
//! // The arm sags by 0.2 mm at the second motion: it is sent higher.
//! let end = program.motions[1].target.pose().unwrap().position_mm;
//! let pieces = [Piece::to(1, end + Vector3::new(0.0, 0.0, 0.2))];
//! let written = write(&program, &pieces, &WriteOptions::default()).unwrap();
//! let output = String::from_utf8(written[0].1.clone()).unwrap();
//! // The first motion rests on p1, which stays.
//! assert!(output.contains("CONST robtarget p1_2:=[[100,0,0.200],[0,1,0,0]"));
//! assert!(output.contains("MoveJ Offs(p1,0,0,50),v500,z10,tool0;\nMoveL p1_2,v20,fine,tool0;"));
//! ```

#[macro_use]
mod language;

mod apt;
mod corner;
mod document;
mod error;
mod extreme;
pub mod fields;
mod file_form;
mod flat_run;
mod heidenhain;
mod interpreter;
mod krl;
mod ls;
mod making;
mod model;
mod options;
mod path;
mod poses;
mod program_language;
mod rapid;
mod siemens;
mod standing;
mod table;
mod text;
mod turned_axis;
mod urscript;
mod val3;
mod writing;

pub use apt::flat::expand::expand_apt;
pub use apt::reader::read_apt;
pub use apt::table::APT_STATEMENTS;
pub use document::{called_files, expand, read, stays_beside_flat, write};
pub use error::{ProgramError, WriteError};
pub use file_form::FileForm;
pub use heidenhain::expand::flat::expand_heidenhain;
pub use heidenhain::reading::reader::read_heidenhain;
pub use heidenhain::table::HEIDENHAIN_STATEMENTS;
pub use krl::frames::{KRL_CONFIG, krl_frames_of_config, krl_needs_config};
pub use krl::reader::read_krl;
pub use krl::table::KRL_STATEMENTS;
pub use language::{language_of, odd_program};
pub use ls::reader::read_ls;
pub use ls::table::LS_STATEMENTS;
pub use making::compare::Kept;
pub use making::events::{Coolant, EventAction, EventKind, SourceEvent};
pub use making::gcode_events::events_of_gcode;
pub use making::joint_table::{JointStart, JointTable, JointTableError, joint_table};
pub use making::limits::MakeLanguage;
pub use making::make::{Made, make};
pub use making::of_robot::{base_of_robot, make_of_flat_robot, make_of_robot};
pub use making::robot_events::{events_of_robot, spindle_of_blocks};
pub use making::run_statements::{
    BlockWord, RunStatement, each_block, mode_of, options_of_motion, statements_of_run,
};
pub use making::template::{
    PlacesUnknown, Rapids, SpindleStatements, StatedFrame, StatedTool, Template, Zones,
};
pub use making::{MakeError, MakeFinding};
pub use model::Language;
pub use model::motion::{Frame, FrameUse, Motion, MotionKind, Runs, Speed, Zone};
pub use model::orientation::OrientationText;
pub use model::program::RobotProgram;
pub use model::site::{BetweenRows, JointArm, TableArm};
pub use model::stated_value::{SlashBlocks, StatedValue};
pub use model::target::{Configuration, PoseTarget, StatedArm, Target};
pub use options::{
    CutterCompensation, ExternalAxes, LengthUnit, ReadOptions, UnknownTargets, WriteOptions,
};
pub use path::PathError;
pub use path::axis_turns::TurnAboutAxis;
pub use path::correctable::Correctable;
pub use path::maker::PathOptions;
pub use path::motion_faults::{ProgramFault, all_faults};
pub use path::of_program::{RobotPath, path_of};
pub use path::tools::tool_number;
pub use poses::columns::POSES_STATEMENTS;
#[cfg(feature = "parquet")]
pub use poses::parquet::text::{ParquetFile, parquet_of_table, table_of_parquet};
pub use poses::reader::read_poses;
pub use rapid::reader::read_rapid;
pub use rapid::table::RAPID_STATEMENTS;
pub use siemens::flat::expand_siemens;
pub use siemens::reader::read_siemens;
pub use siemens::table::SIEMENS_STATEMENTS;
pub use table::{StatementRow, Treatment};
pub use text::source::{Finding, FlatText, SourceFile};
pub use urscript::motion::URSCRIPT_STATEMENTS;
pub use val3::instructions::VAL3_STATEMENTS;
pub use val3::reader::read_val3;
pub use writing::piece::Piece;

/// For the tests of this crate alone: what all languages share and no public function shows by itself.
#[doc(hidden)]
pub mod internal {
    pub use crate::heidenhain::expand::flat::expand_within as expand_heidenhain_within;
    pub use crate::model::orientation::OrientationText;
    pub use crate::siemens::flat::expand_within as expand_siemens_within;
    pub use crate::text::number::{Width, printed};
}
