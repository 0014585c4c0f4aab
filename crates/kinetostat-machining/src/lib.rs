//! From a machining program and a robot model to deflections, corrections and a checked result.
//!
//! [`analyse`] tells how far the tool is off along a program; [`compensate_program`] writes one that
//! cuts where it should and proves it by solving the written program again. [`map()`] tells stiffness
//! and deflection on a grid of places.

mod arm_joints;
mod checks;
mod cut;
mod field;
mod flat_program;
mod free_turn;
#[doc(hidden)]
pub mod internal;
mod joints;
mod limits;
mod load;
mod map;
mod measured_frame;
mod near;
mod placement;
mod postures;
mod profile;
mod result;
mod run;
mod table;
mod task;
mod verify;
mod warning;
mod watch;
mod weight_correction;

pub use arm_joints::ArmJoints;
pub use checks::correction::{folds, folds_at, is_large, odd_correction};
pub use checks::load::{large_load, unusual_load};
pub use checks::placement::{beyond_tool_length, odd_tool_length, origin_in_metres};
pub use checks::refused::{fastest_feed, of_accounting};
pub use checks::unusual::{odd_tolerances, unusual_question};
pub use cut::clock::DwellUnit;
pub use cut::finding::{CutFailure, CutFinding, CutFindingKind};
pub use cut::limits::deeper_than_edges;
pub use cut::measured::MeasuredForces;
pub use cut::measured_stations::{ActsOn, MeasuredAxes, MeasuredReport};
pub use cut::profile::{ForceAlongPath, ForceOrigin};
pub use cut::question::{CutQuestion, CuttingTool, EngagementSource, ForceChoice};
pub use cut::removal::StockAlong;
pub use cut::station::{ContactArc, CutStation};
pub use field::ModelField;
pub use flat_program::FlatProgram;
pub use free_turn::choice::{
    ConstantTurn, TurnCell, TurnChoice, TurnFigures, TurnMap, TurnStation,
};
pub use free_turn::choose::choose_turns;
pub use free_turn::error::{NoWay, TurnBarrier, TurnError, TurnPart};
pub use free_turn::task::{
    TipCompliance, TurnBand, TurnBounds, TurnCriterion, TurnCurve, TurnTask,
};
pub use free_turn::turned_path::{TurnedPath, with_turns};
pub use kinetostat::number;
pub use limits::{Beyond, Limit, Limits};
pub use load::along_path::LoadAlongPath;
pub use load::law::{CornerLoad, CuttingLoad, LoadAxes, ProgramLoad, Tool, straight_tool};
pub use load::ramp_findings::{LoadBegins, LoadRamp};
pub use map::{
    Entry, EvaluationRoom, Evaluator, Grid, MAP_BLOCK, MapPlace, MapTask, Outcome, PlaceState,
    VARIABLES, Variable, Width, Worse, map,
};
pub use measured_frame::{nearest_rotation, rigid_motion};
pub use near::{NEAR_SINGULAR, NearKind, NearSingular, natural_length, near_singular};
pub use placement::Placement;
pub use postures::configurations::{Configurations, posture_at};
pub use result::assessment::{Assessment, Assumption, AssumptionKind, Level};
pub use result::chatter::{ChatterLines, ChatterPlace, ChatterResult};
pub use result::cutting::{CutPlace, CuttingResult};
pub use result::envelope::{Envelope, Quantity, StretchRange};
pub use result::feature::{
    Feature, FeatureResult, add_to_features, feature_results, judge_features,
};
pub use result::figures::Figures;
pub use result::joints::{
    ArmConfiguration, Elbow, JointsResult, LimitEnd, LimitPlace, MostLoaded, NearestLimit,
    PostureChange, RatingPlace, Shoulder, WayOut, Wrist,
};
pub use result::kept_points::KeptPoints;
pub use result::point::{PointKind, PointResult, ProgramPlace};
pub use result::run_result::{
    ActuatorColumn, FileRead, NearSingularPlace, RESULT_SCHEMA, RunInputs, RunResult, ToolAtCorners,
};
pub use result::selection::{farthest_off, thinned};
pub use result::summary::{FoundCount, LargestChange, Solving, Summary};
pub use result::tolerance::{
    MissedTolerance, ToleranceResult, keeps_as_it_is, of_table, unchanged_text,
};
pub use result::uncertainty_band::{
    BandPlace, ForceBand, ScatteredError, UncertainNumber, UncertaintyBand,
};
pub use run::compensate::{analyse, analyse_part, compensate_part, compensate_program};
pub use run::conclude::{Run, load_description, marked_as_compensated, of_program};
pub use run::cutting::{cut_places, cutting_result};
pub use run::merged::MergedRun;
pub use run::movable::{MovableProgram, Reach};
pub use run::places::wrenches_at;
pub use run::preparation::{OfWhole, look_at_part, refused_question, with_model_field};
pub use run::summary::feed_arcs;
pub use table::{FieldCorrection, correct_by_field, wide_table};
pub use task::{Bounds, NoMotion, RunError, Task, ToolGiven};
pub use verify::{
    Condition, ExtraCut, Matched, OtherCondition, RapidElsewhere, Turned, Uncut, Verified,
    verify_program,
};
pub use warning::{Warning, WarningCode, merged};
pub use watch::{Unwatched, Watch};
pub use weight_correction::{TouchOff, TouchOffError, WeightCorrection};
