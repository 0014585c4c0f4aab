//! From a machining program and a robot model to deflections, corrections and a checked result.

mod result;

pub use result::{
    ActuatorColumn, PointKind, PointResult, Question, RESULT_SCHEMA, RunResult, Summary,
};
