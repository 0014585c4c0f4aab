//! From a machining program and a robot model to deflections, corrections and a checked result.
//!
//! [`analyse`] tells how far the tool is off along a program; [`compensate_program`] writes one that
//! cuts where it should and proves it by solving the written program again. [`map()`] tells stiffness
//! and deflection on a grid of places.

mod again;
mod claims;
mod corners;
mod field;
mod figures;
mod following;
mod judge;
mod limits;
mod load;
mod map;
mod near;
mod own_weight;
mod placement;
mod result;
mod run;
mod sites;
mod solve;
mod thin;
mod tool;
mod verdict;
mod warning;

pub use field::ModelField;
pub use figures::Figures;
pub use judge::{
    Bounds, ToolGiven, large_load, odd_correction, odd_tolerances, odd_tool_length, of_accounting,
    origin_in_metres,
};
pub use kinetostat::number;
pub use limits::{Beyond, Limit, Limits};
pub use load::{CornerLoad, CuttingLoad, LoadAlongPath, LoadAxes, ProgramLoad, straight_tool};
pub use map::{Grid, MapPlace, MapTask, PlaceState, map};
pub use near::{NEAR_SINGULAR, NearKind, NearSingular, natural_length, near_singular};
pub use placement::Placement;
pub use result::{
    ActuatorColumn, FileRead, MissedTolerance, NearSingularPlace, PointKind, PointResult, Question,
    RESULT_SCHEMA, RunResult, Summary, ToleranceVerdict, ToolAtCorners,
};
pub use run::{
    Run, RunError, Task, Unwatched, Watch, analyse, compensate_program, load_in_words, of_program,
};
pub use thin::thinned;
pub use tool::Tool;
pub use verdict::{keeps_as_it_is, of_table, unchanged_in_words};
pub use warning::{Warning, WarningCode};
