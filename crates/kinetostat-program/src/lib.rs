//! G-code programs: read without loss, corrected by any field of corrections, written and checked.
//!
//! The way of a program:
//!
//! 1. [`Program::read`] keeps every byte and divides the file into lines and words. What cannot be
//!    followed at all (subroutines, variables, binary files) is refused with its line.
//! 2. [`interpret`] says where the tool goes: a [`Path`] of straight and circular [`Move`]s in mm, in
//!    the part frame. What is not followed is refused with line, reason and what to do; the table of
//!    codes is [`CODES`].
//! 3. [`write_corrected`] asks a [`CorrectionField`] (a [`CorrectionMap`], a robot's model, a closure)
//!    what to add to the path, divides blocks where the answer varies, and writes the program.
//! 4. [`verify_written`] reads what was written with the same reader and checks every promise;
//!    [`verify_against_field`] asks the field again, in places that the division did not choose.
//!
//! This crate knows no robot. It reads and writes bytes in memory; files are the caller's. Lengths are in
//! mm and points in the part frame unless a name says otherwise; lines are counted from 1.
//!
//! ```
//! use kinetostat_program::*;
//! use nalgebra::Vector3;
//!
//! let text = "G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300 (plunge)\nG1 X100 ; groove\nM2\n";
//! let program = Program::read(text)?;
//! let reading = ReadOptions::default();
//! let path = interpret(&program, &reading)?;
//! assert_eq!(path.moves[2].end, Vector3::new(100.0, 0.0, -1.0));
//!
//! // A machine that sags by 1 um for each 10 mm of x, quadratically more further out.
//! let field = |request: &Request| {
//!     let x = request.position_mm.x;
//!     Ok(Vector3::new(0.0, 0.0, 1e-4 * x + 1e-5 * x * x))
//! };
//! let mut writing = WriteOptions::default();
//! writing.header = None;
//! let written = write_corrected(&program, &path, &field, &writing, &Unwatched)?;
//! verify_written(&program, &path, &written, &reading, &writing)?;
//!
//! let output = String::from_utf8(written.bytes)?;
//! assert!(output.starts_with("G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300 (plunge)\nG1 X"));
//! assert!(output.ends_with("X100.0000 Z-0.8900\nM2\n"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod along;
mod checking;
mod error;
mod expanding;
mod field;
#[doc(hidden)]
pub mod internal;
mod machine_program;
mod number;
mod parts;
mod path;
mod reading;
mod text;
mod writing;

pub use along::in_order::{WhyLeftOut, in_order, in_order_by};
pub use along::{FeedPiece, Foot, NoFeedMove, NominalPath, Pass};
pub use checking::Verification;
pub use checking::field::{Farthest, FieldCheck, verify_against_field};
pub use checking::verify::verify_written;
pub use error::{MapError, ProgramError, ProgramErrorKind, WriteError};
pub use expanding::expand::{expand, expand_or_faults, expansion_faults};
pub use expanding::run::source::{NoSubprograms, Subprograms};
pub use expanding::{Dialect, ExpandOptions, Expanded, Origin, OriginComments};
pub use field::map::CorrectionMap;
pub use field::{
    Correction, CorrectionField, Course, FieldFailure, Monitor, NoCorrection, Request, Structure,
    Turning, Unwatched,
};
pub use machine_program::{Gcode, MachineProgram};
pub use number::irregular;
pub use parts::PartLength;
pub use parts::in_order::{GcodePart, PartsInOrder, PlaceInOrder, Standing, WrittenSoFar};
pub use parts::survey::{PartError, Survey};
pub use parts::windows::{Part, Parts};
pub use path::closed_circle::{NearlyClosed, angle_about, last_digit_mm};
pub use path::curve::{Arc, Curve};
pub use path::great_circle::{GreatCircle, OffCircle};
pub use path::moves::{
    CoordinateWords, ExtraAxis, ExtraMode, Feed, FeedMode, Knowledge, Move, MoveKind, Path,
    PathPart, Pause, PauseKind, ToolChange, Warning, WarningTopic,
};
pub use path::rotary::{Carries, RotaryAxes, RotaryAxis};
pub use path::rotary_angles::Unreached;
pub use path::spindle::{SpeedMode, Spindle, SpindleChange, SpindleRotation};
pub use path::tool_direction::Directed;
pub use path::tool_turn::{RotaryTurn, StatedBy, ToolTurn};
pub use reading::dialect::{CODES, Code, Treatment};
pub use reading::faults::faults;
pub use reading::interpreting::interpret::interpret;
pub use reading::moment::{Acts, CONTROLLERS, MOMENTS, Moment, Placed};
pub use reading::options::{BlockDelete, OtherAxes, ReadOptions, ToolCentrePoint, Units};
pub use text::program::{COMPENSATED_MARK, HEADER_PREFIX, MAX_READ_LINE_BYTES, Program};
pub use writing::accounting::{Accounting, ShortBlocksOfLine};
pub use writing::directed_moves::DIRECTION_DECIMALS;
pub use writing::node::Turn;
pub use writing::options::{Arcs, Circles, WriteOptions};
pub use writing::output_state::WrittenArc;
pub use writing::plan::{Plan, PlannedArc, PlannedMove, PlannedPiece, WrittenEnd, WrittenMove};
pub use writing::write::write_corrected;
pub use writing::written::{Corrected, Piece, WriterState, WrittenCircle};
