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
mod rigid_motion;
mod run;
mod table;
mod task;
mod verify;
mod warning;
mod watch;
mod weight_correction;

pub use arm_joints::ArmJoints;
pub use checks::correction::odd_correction;
pub use checks::displacement::{folds, folds_at, is_large};
pub use checks::load::{large_load, unusual_load};
pub use checks::placement::origin_in_metres;
pub use checks::refused::{fastest_feed, of_accounting};
pub use checks::tool::{beyond_tool_length, odd_tool_length};
pub use checks::unusual::{odd_tolerances, unusual_question};
pub use cut::choice::ForceChoice;
pub use cut::clock::DwellUnit;
pub use cut::cutting_tool::CuttingTool;
pub use cut::engagement_source::EngagementSource;
pub use cut::failure::CutFailure;
pub use cut::finding::{CutFinding, CutFindingKind};
pub use cut::limits::deeper_than_edges;
pub use cut::measured::MeasuredForces;
pub use cut::measured_report::{ActsOn, MeasuredAxes, MeasuredReport};
pub use cut::origin::ForceOrigin;
pub use cut::profile::ForceAlongPath;
pub use cut::question::CutQuestion;
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
pub use result::force_band::ForceBand;
pub use result::joints::{
    ArmConfiguration, Elbow, JointsResult, LimitEnd, LimitPlace, MostLoaded, NearestLimit,
    PostureChange, RatingPlace, Shoulder, WayOut, Wrist,
};
pub use result::kept_points::KeptPoints;
pub use result::largest_change::LargestChange;
pub use result::point::{PointKind, PointResult};
pub use result::program_place::ProgramPlace;
pub use result::run_inputs::{ActuatorColumn, FileRead, RunInputs, ToolAtCorners};
pub use result::run_result::{NearSingularPlace, RESULT_SCHEMA, RunResult};
pub use result::selection::{farthest_off, thinned};
pub use result::solving::{FoundCount, Solving};
pub use result::summary::Summary;
pub use result::tolerance::{
    MissedTolerance, ToleranceResult, keeps_as_it_is, of_table, unchanged_text,
};
pub use result::uncertainty_band::{BandPlace, ScatteredError, UncertainNumber, UncertaintyBand};
pub use rigid_motion::{nearest_rotation, rigid_motion};
pub use run::compensate::{analyse, analyse_part, compensate_part, compensate_program};
pub use run::conclude::{Run, load_description, marked_as_compensated, of_program};
pub use run::cutting::{cut_places, cutting_result};
pub use run::look_at_part::look_at_part;
pub use run::merged::MergedRun;
pub use run::movable::{MovableProgram, Reach};
pub use run::places::wrenches_at;
pub use run::preparation::{OfWhole, with_model_field};
pub use run::refused_question::refused_question;
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
