//! Orientations of the tool that are not as they should be.

use kinetostat::Directions;
use kinetostat_machining::{PointResult, Turned, number::largest};
use schemars::JsonSchema;
use serde::Serialize;

/// The place at which the tool is tilted most, where that is more than is allowed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Tilted {
    /// Lines of the program and of the original.
    pub(crate) line: usize,
    pub(crate) line_of_original: usize,
    pub(crate) tilt_deg: f64,
    pub(crate) allowed_deg: f64,
    /// The program states another orientation than the original where that is not corrected; else the tool is tilted under the load.
    pub(crate) as_stated: bool,
}

/// Compensated programs are as near at a lever as at the tip; others are given as much once more.
const SLACK: f64 = 2.0;

/// Orientations that are stated nearer to each other are one: programs have four digits of a degree, or less.
const STATED_DEG: f64 = 0.02;

impl Tilted {
    /// Finds a tilt that moves a point of the tool at the lever from its tip by more than is allowed, if the orientation is
    /// corrected; otherwise an orientation that differs from the original.
    pub(crate) fn of(
        points: &[PointResult],
        corrected: Directions,
        turned: Option<&Turned>,
        allowed_mm: f64,
        lever_mm: f64,
    ) -> Option<Self> {
        let allowed_deg = (SLACK * allowed_mm / lever_mm).to_degrees();
        if corrected != Directions::ALL {
            let allowed_deg = allowed_deg.max(STATED_DEG);
            let turned = turned.filter(|turned| turned.angle_deg > allowed_deg)?;
            return Some(Self {
                line: turned.line,
                line_of_original: turned.line_of_original,
                tilt_deg: turned.angle_deg,
                allowed_deg,
                as_stated: true,
            });
        }
        let worst = (points.iter())
            .max_by(|a, b| a.residual_rotation_deg.total_cmp(&b.residual_rotation_deg))?;
        (worst.residual_rotation_deg > allowed_deg).then_some(Self {
            line: worst.output_line,
            line_of_original: worst.line,
            tilt_deg: worst.residual_rotation_deg,
            allowed_deg,
            as_stated: false,
        })
    }

    /// Text of the fault.
    pub(crate) fn text(&self) -> String {
        if self.as_stated {
            return format!(
                "ANOTHER ORIENTATION OF THE TOOL at line {} (line {} of the original): {} from that of the original, and only its position is corrected.",
                self.line,
                self.line_of_original,
                largest(self.tilt_deg, "deg")
            );
        }
        format!(
            "THE TOOL IS TILTED at line {} (line {} of the original): by {}, more than the {} that are allowed where its orientation is corrected.",
            self.line,
            self.line_of_original,
            largest(self.tilt_deg, "deg"),
            largest(self.allowed_deg, "deg")
        )
    }
}
