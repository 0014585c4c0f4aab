//! Orientations of the tool that are not as they should be.

use kinetostat::Directions;
use kinetostat_machining::{PointResult, number::largest};
use serde::Serialize;

/// The place at which the tool is tilted most, where that is more than is allowed.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Tilted {
    /// Lines of the program and of the original.
    pub(crate) line: usize,
    pub(crate) line_of_original: usize,
    pub(crate) tilt_deg: f64,
    pub(crate) allowed_deg: f64,
}

/// Compensated programs are as near at a lever as at the tip; others are given as much once more.
const SLACK: f64 = 2.0;

impl Tilted {
    /// Where the orientation is to be corrected too: a tilt that moves a point of the tool at a lever from its tip by more than is
    /// allowed there.
    pub(crate) fn of(
        points: &[PointResult],
        corrected: Directions,
        (allowed_mm, lever_mm): (f64, f64),
    ) -> Option<Self> {
        let worst = (points.iter())
            .max_by(|a, b| a.residual_rotation_deg.total_cmp(&b.residual_rotation_deg))?;
        let allowed_deg = (SLACK * allowed_mm / lever_mm).to_degrees();
        let is_tilted = corrected == Directions::ALL && worst.residual_rotation_deg > allowed_deg;
        is_tilted.then_some(Self {
            line: worst.output_line,
            line_of_original: worst.line,
            tilt_deg: worst.residual_rotation_deg,
            allowed_deg,
        })
    }

    /// As a fault.
    pub(crate) fn text(&self) -> String {
        format!(
            "THE TOOL IS TILTED at line {} (line {} of the original): by {}, more than the {} that are allowed where its orientation is corrected.",
            self.line,
            self.line_of_original,
            largest(self.tilt_deg, "deg"),
            largest(self.allowed_deg, "deg")
        )
    }
}
