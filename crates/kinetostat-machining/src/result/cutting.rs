//! Engagement, force, torque and power of the cut along a path, and their largest values. Plain data, units in the
//! names.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::point::PointKind;

/// A place of a path with what the cut asks there; nothing acts at the end of a rapid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct CutPlace {
    /// Line of the program, from 1.
    pub line: usize,
    /// Number of the move, from 1.
    pub move_number: usize,
    /// Kind of move.
    pub kind: PointKind,
    /// Share of the move, 0 to 1.
    pub share: f64,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Position of the tool's tip, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Depth in contact along the tool, mm; 0 in air.
    pub depth_mm: f64,
    /// Sum of the arcs in contact at the lowest height, degrees: 180 in a slot, 0 in air.
    pub arc_deg: f64,
    /// Force on the tool along the feed, N. If the tool goes along its axis, the force is in axes of the part: this one
    /// along x.
    pub force_along_feed_n: f64,
    /// Force on the tool to the left of the feed, N; along y of the part where the tool goes along its axis.
    pub force_left_n: f64,
    /// Force on the tool along z of the part, N.
    pub force_up_n: f64,
    /// Mean torque of the spindle, N m.
    pub torque_n_m: f64,
    /// Mean power of the spindle, W.
    pub power_w: f64,
    /// Torque that the spindle gives at this speed, N m; `None` if it is not stated or does not turn so fast.
    pub spindle_torque_n_m: Option<f64>,
    /// Thickest place of a chip, mm.
    pub chip_mm: f64,
    /// Feed per tooth, mm.
    pub feed_per_tooth_mm: f64,
    /// Speed of the spindle, turns per minute.
    pub rpm: f64,
}

impl CutPlace {
    /// Size of the force on the tool, N.
    ///
    /// ```
    /// use kinetostat_machining::CutPlace;
    ///
    /// assert_eq!(CutPlace::default().force_n(), 0.0);
    /// ```
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.force_along_feed_n
            .hypot(self.force_left_n)
            .hypot(self.force_up_n)
    }

    /// Torque as a share of what the spindle gives at this speed, 1 where it gives no more; `None` where that is not stated.
    ///
    /// ```
    /// use kinetostat_machining::CutPlace;
    ///
    /// let mut place = CutPlace::default();
    /// assert_eq!(place.share_of_spindle(), None);
    /// (place.torque_n_m, place.spindle_torque_n_m) = (1.5, Some(6.0));
    /// assert_eq!(place.share_of_spindle(), Some(0.25));
    /// ```
    #[must_use]
    pub fn share_of_spindle(&self) -> Option<f64> {
        let gives = self.spindle_torque_n_m.filter(|gives| *gives > 0.0)?;
        Some(self.torque_n_m / gives)
    }
}

/// Figures of the cut along a path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct CuttingResult {
    /// Half width of the band in which the forces lie, percent of them.
    pub spread_percent: f64,
    /// Places at which the cut was looked at.
    pub stations: usize,
    /// Length of the path in the material, mm.
    pub cut_length_mm: f64,
    /// Place of the largest force; `None` if nothing is cut.
    pub largest_force: Option<CutPlace>,
    /// Place of the largest torque.
    pub largest_torque: Option<CutPlace>,
    /// Place of the largest power.
    pub largest_power: Option<CutPlace>,
    /// Place of the thickest chip.
    pub largest_chip: Option<CutPlace>,
    /// Place at which the torque is the largest share of the available spindle torque; `None` if that is not stated.
    pub nearest_to_spindle: Option<CutPlace>,
    /// The lines with the largest forces, each where it is largest, worst first; at most ten.
    pub worst_lines: Vec<CutPlace>,
    /// Places along the path, at most [`Self::MAX_PLACES`]: of every stretch those with the largest and the smallest force,
    /// torque, depth and arc.
    pub places: Vec<CutPlace>,
}

impl CuttingResult {
    /// Maximum number of places that are kept for plots.
    pub const MAX_PLACES: usize = 4000;
}
