//! What a program says: its motions, how each is programmed, what is wrong.

use crate::error::ProgramError;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::datum::Datum;
use crate::heidenhain::ends::Shape;
use crate::model::motion::Motion;
use crate::model::program::Finding;

/// A motion as it is programmed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    pub block: Block,
    pub shape: Shape,
    /// In the programmed axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    pub datum: Datum,
    pub unit_mm: f64,
    /// In force, as programmed; none in rapid traverse or where it is not known.
    pub feed: Option<f64>,
    /// The motion at whose end the pole was set from where the tool was.
    pub pole_from: Option<usize>,
}

/// What a program says.
pub(crate) struct Found {
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    pub motions: Vec<Motion>,
    /// Of each motion.
    pub ways: Vec<Way>,
}
