//! Content of a program: its motions, their programming, its errors.

use std::collections::BTreeMap;

use nalgebra::{Vector2, Vector3};

use crate::axis_count::CountShown;
use crate::error::ProgramError;
use crate::heidenhain::aside::Aside;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::datum::Datum;
use crate::heidenhain::ends::Shape;
use crate::heidenhain::plane::Plane;
use crate::heidenhain::reading::rounded::{Rounded, Unrounded};
use crate::heidenhain::state::Pole;
use crate::model::motion::Motion;
use crate::model::outside_call::OutsideCall;
use crate::model::stated_axes::AxesStated;
use crate::text::finding::Finding;

/// A motion as it is programmed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    pub block: Block,
    pub shape: Shape,
    /// Start in the programmed axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    pub datum: Datum,
    pub unit_mm: f64,
    /// Modal feed as programmed; `None` in rapid traverse or if unknown.
    pub feed: Option<f64>,
    /// The plane of its arc, or of its pole; and that of the tool's axis.
    pub plane: Plane,
    pub working: Plane,
    /// RL or RR in force, and the tool's radius where the program states it, mm.
    pub aside: Option<(Aside, Option<f64>)>,
    /// Sense of its arc in the programmed axes, 1 anticlockwise; 0 of what is straight.
    pub turns: f64,
    /// Surface normals at its start and its end, where blocks state them, as programmed.
    pub normals: [Option<Vector3<f64>>; 2],
    pub pole: PoleThere,
    /// A block up to here stated the direction of the tool.
    pub directed: bool,
    /// Rotary axis positions that it states, with shortest-path traverse (M126).
    pub axes: Option<AxesStated>,
    pub shorter: bool,
    /// The motion at whose end the pole was set from where the tool was.
    pub pole_from: Option<usize>,
}

/// The pole at a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PoleThere {
    /// Active pole.
    pub at: Option<Pole>,
    /// The block counts from it.
    pub used: bool,
    /// Number of executed CC blocks, in all and up to the last that does not depend on an earlier pole.
    pub count: usize,
    pub whole: usize,
}

/// Content of a program.
#[derive(Default)]
pub(crate) struct Found {
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    /// First line of a feed whose way is the control's own.
    pub unjudged_feed_on: Option<usize>,
    /// Calls of programs that are in none of the files.
    pub outside_calls: Vec<OutsideCall>,
    pub motions: Vec<Motion>,
    /// Source positions of each motion.
    pub ways: Vec<Way>,
    /// Rotary axis positions that the motions state.
    pub axes: BTreeMap<usize, AxesStated>,
    /// Evidence in the words for the way in which these axes count.
    pub shown: Vec<CountShown>,
    /// Rounded corners, in the order in which they run.
    pub corners: Vec<Result<Rounded, Unrounded>>,
    /// LP blocks after the first that continue an earlier radius or angle: their ends, mm, and the unit, mm.
    pub polar: Vec<(Block, Vector2<f64>, f64)>,
}
