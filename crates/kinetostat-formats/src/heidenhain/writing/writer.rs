//! What the writer knows on its way through the motions.

use nalgebra::{Vector2, Vector3};

use crate::axis_count::CountShown;
use crate::heidenhain::digits::decimals;
use crate::heidenhain::plane::Plane;
use crate::heidenhain::reading::found::Way;
use crate::heidenhain::writing::words::Stated;
use crate::model::program::RobotProgram;
use crate::options::WriteOptions;
use crate::text::edits::Edits;

/// Why a motion cannot be written, and what to do.
pub(crate) type Reason = (String, &'static str);

/// A pole of the writer's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OwnPole {
    pub plane: Plane,
    /// In it, in the programmed axes, mm.
    pub at: Vector2<f64>,
    /// How many CC blocks of the program ran before it.
    pub count: usize,
}

/// The walk over the motions.
pub(crate) struct Writer<'w> {
    pub program: &'w RobotProgram,
    /// What the program shows of how rotary axes count.
    pub shown: Vec<CountShown>,
    pub options: &'w WriteOptions,
    pub edits: Vec<Edits>,
    /// Whether positive numbers have their sign, by file.
    pub signs: Vec<bool>,
    /// Whether blocks were added, by file.
    pub added: Vec<bool>,
    /// Where the written blocks leave the tool, from where the input does; in the preset's axes, mm.
    pub off: Vector3<f64>,
    /// The feed that the written blocks leave behind, where it is another one.
    pub feed: Option<f64>,
    /// A pole of the writer's own that is in force, or would be behind CC blocks that need one from before.
    pub pole: Option<OwnPole>,
    /// How the tool stands, where it stands otherwise than in the program; in the preset's axes.
    pub axis: Option<Vector3<f64>>,
    /// By how much rotary axes stand otherwise than in the program, and where they stand within a motion, deg.
    pub turned_deg: Vec<f64>,
    pub angles_now: Vec<f64>,
    /// A polar block was written by X and Y: those behind it have no last radius.
    pub polar_broken: bool,
    /// Whether the written blocks are elsewhere at the end of each motion.
    pub off_at: Vec<bool>,
    /// Whether each motion is another one.
    pub changed: Vec<bool>,
    pub file: usize,
}

/// Least difference of places that counts, mm.
pub(crate) const SAME_MM: f64 = 1e-9;

pub(crate) const ABOUT_CENTRE: &str =
    "a piece goes through a place between its ends, and circles are written about centres";

impl Writer<'_> {
    /// Half of the last digit, mm.
    pub(crate) fn half_mm(&self, way: &Way) -> f64 {
        0.5 * 10.0_f64.powi(-(self.decimals(way) as i32)) * way.unit_mm
    }

    pub(crate) fn decimals(&self, way: &Way) -> usize {
        // As fine in inches.
        let more = match way.unit_mm == 1.0 {
            true => 0,
            false => 2,
        };
        (self.options.position_decimals + more).min(decimals(way.unit_mm))
    }

    /// Axes that a block states as it did are where they were.
    pub(crate) fn stated_again(&mut self, way: &Way, stated: &Stated) {
        let mut off = way.datum.step(&self.off);
        for axis in 0..3 {
            if stated.absolute[axis] {
                off[axis] = 0.0;
            }
        }
        self.off = way.datum.preset(&off) - way.datum.shift_mm;
    }
}
