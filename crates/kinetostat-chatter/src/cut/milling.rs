//! Milling with evenly spaced teeth.
//!
//! The arc on which a tooth is in the material.
//!
//! Angles count from +y (left of the feed) clockwise seen from the spindle, towards +x (the feed), as in `cutting.md`.

use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{Shape, Tool};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::cut::coefficients::Coefficients;
use crate::cut::piece::{Active, End, Piece, directional_integral};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::wrapped;

/// Breaks of the turn that are nearer to each other are one, rad.
const SAME: f64 = 1e-9;

/// A milling cut: teeth of even pitch on a cylinder, one arc at all heights.
#[derive(Clone, Debug, PartialEq)]
pub struct MillingCut {
    teeth: usize,
    arc: Arc,
    coefficients: Coefficients,
    lag_per_depth: f64,
}

impl MillingCut {
    /// Straight teeth.
    ///
    /// # Errors
    /// No tooth, or more than 200.
    pub fn new(teeth: usize, arc: Arc, coefficients: Coefficients) -> Result<Self> {
        if !(1..=200).contains(&teeth) {
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "teeth",
                teeth,
                "1 to 200 teeth",
            ));
        }
        Ok(Self {
            teeth,
            arc,
            coefficients,
            lag_per_depth: 0.0,
        })
    }

    /// Sets the helix angle, rad, on a tool of a diameter, m: the edge lags behind its tip by `tan(helix)/radius` for
    /// each metre of height. The lag is integrated in closed form, without slices.
    ///
    /// # Errors
    /// A diameter that is not positive, a helix beyond 70 degrees.
    pub fn with_helix(mut self, helix: f64, diameter: f64) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        above(kind, "diameter", diameter, 0.0, true, "m")?;
        if helix.is_nan() || helix.to_degrees().abs() > 70.0 {
            return Err(ChatterError::new(
                kind,
                "helix",
                format!("{} deg", helix.to_degrees()),
                "an angle of at most 70 degrees",
            ));
        }
        self.lag_per_depth = 2.0 * helix.tan() / diameter;
        Ok(self)
    }

    /// Teeth, diameter and helix of a tool of the project.
    ///
    /// # Errors
    /// A ball, a corner radius or inserts at an angle: their chips differ from height to height, which is not covered.
    pub fn of_tool(tool: &Tool, arc: Arc, coefficients: Coefficients) -> Result<Self> {
        if tool.shape() != Shape::Flat {
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "shape of the tool",
                tool.shape().word(),
                "a flat end mill: lobes of other shapes are not covered",
            ));
        }
        Self::new(tool.teeth(), arc, coefficients)?
            .with_helix(tool.helix(), 1e-3 * tool.diameter_mm())
    }

    /// Number of teeth.
    #[must_use]
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// Arc on which a tooth is in the material.
    #[must_use]
    pub fn arc(&self) -> Arc {
        self.arc
    }

    /// Force per area of chip.
    #[must_use]
    pub fn coefficients(&self) -> &Coefficients {
        &self.coefficients
    }

    /// Angle by which the edge lags behind its tip, rad per metre of height.
    #[must_use]
    pub fn lag_per_depth(&self) -> f64 {
        self.lag_per_depth
    }

    /// Mean of the directional matrix over the turn, N/m^2: `(N/2 pi) int D dphi`; the helix does not change it.
    pub(crate) fn mean(&self) -> Matrix3<f64> {
        let upper = directional_integral(&self.coefficients, self.arc.exit());
        (upper - directional_integral(&self.coefficients, self.arc.entry())) * self.teeth as f64
            / TAU
    }

    /// The pieces of one tooth period at a depth, m, in order of time; they begin at a break, if there is one.
    pub(crate) fn pieces(&self, depth: f64) -> Vec<Piece> {
        let pitch = TAU / self.teeth as f64;
        let lag = self.lag_per_depth * depth;
        let (entry, exit) = (self.arc.entry(), self.arc.exit());
        let mut breaks: Vec<f64> = Vec::with_capacity(5);
        for angle in [entry, exit, entry + lag, exit + lag] {
            let at = wrapped(angle, pitch);
            let near = |other: &f64| {
                let apart = (at - other).abs();
                apart < SAME || (pitch - apart).abs() < SAME
            };
            if !breaks.iter().any(near) {
                breaks.push(at);
            }
        }
        breaks.sort_unstable_by(f64::total_cmp);
        breaks.push(breaks[0] + pitch);
        let piece = |pair: &[f64]| Piece {
            start: pair[0],
            length: pair[1] - pair[0],
            active: self.active(0.5 * (pair[0] + pair[1]), lag),
        };
        breaks.windows(2).map(piece).collect()
    }

    /// Edges in the material when tooth 0 is at this turn.
    fn active(&self, turn: f64, lag: f64) -> Vec<Active> {
        let pitch = TAU / self.teeth as f64;
        let mut all = Vec::new();
        for tooth in 0..self.teeth {
            let offset = pitch * tooth as f64;
            let tip = turn + offset;
            // The edge covers places from the lower to the upper angle; a positive lag goes back from the tip.
            let (low, high) = match lag < 0.0 {
                true => (tip, tip - lag),
                false => (tip - lag, tip),
            };
            let mut around = ((low - self.arc.exit()) / TAU).ceil();
            while self.arc.entry() + TAU * around < high {
                let (entry, exit) = (
                    self.arc.entry() + TAU * around,
                    self.arc.exit() + TAU * around,
                );
                all.push(match lag.abs() < SAME {
                    true => Active::Edge(offset - TAU * around),
                    false => Active::Swept {
                        from: match low < entry {
                            true => End::Fixed(entry),
                            false => End::Moving(low - turn),
                        },
                        to: match high > exit {
                            true => End::Fixed(exit),
                            false => End::Moving(high - turn),
                        },
                        per_lag: lag.abs().recip(),
                    },
                });
                around += 1.0;
            }
        }
        all
    }
}

/// Up or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Milled {
    /// Conventional: the chip begins with no thickness, the part is on the left with a spindle that turns clockwise.
    Up,
    /// Climb: the chip ends with no thickness, the part is on the right.
    Down,
}

/// The arc on which a tooth is in the material, rad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Arc {
    entry: f64,
    exit: f64,
}

impl Arc {
    /// Arc from entry to exit, rad.
    ///
    /// # Errors
    /// Angles that are not finite, an entry outside 0 to one turn, an exit that is not beyond the entry, or is so by more
    /// than one turn.
    pub fn new(entry: f64, exit: f64) -> Result<Self> {
        let holds =
            (0.0..TAU).contains(&entry) && exit > entry && exit - entry <= TAU * (1.0 + 1e-12);
        match holds {
            true => Ok(Self { entry, exit }),
            false => Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "arc of engagement",
                format!("{entry} to {exit} rad"),
                "an entry from 0 to below one turn, and an exit beyond it by at most one turn",
            )),
        }
    }

    /// The arc of a straight cut: `up (0, acos(1 - 2 a_e/D)), down (acos(2 a_e/D - 1), pi)` [D 8].
    ///
    /// ```
    /// use kinetostat_chatter::{Arc, Milled};
    ///
    /// let down = Arc::straight(Milled::Down, 0.5)?; // half the diameter is in the material
    /// assert!((down.entry().to_degrees() - 90.0).abs() < 1e-9);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// An immersion `a_e/D` that is not above 0, or is above 1 (a slot).
    pub fn straight(milled: Milled, immersion: f64) -> Result<Self> {
        if !(immersion > 0.0 && immersion <= 1.0) {
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "immersion",
                immersion,
                "width of cut by diameter, above 0 and at most 1 (a slot)",
            ));
        }
        let angle = (1.0 - 2.0 * immersion).acos();
        Ok(match milled {
            Milled::Up => Self {
                entry: 0.0,
                exit: angle,
            },
            Milled::Down => Self {
                entry: PI - angle,
                exit: PI,
            },
        })
    }

    /// The whole front half.
    #[must_use]
    pub fn slot() -> Self {
        Self {
            entry: 0.0,
            exit: PI,
        }
    }

    /// Entry angle of a tooth, rad.
    #[must_use]
    pub fn entry(&self) -> f64 {
        self.entry
    }

    /// Exit angle, rad; beyond the entry.
    #[must_use]
    pub fn exit(&self) -> f64 {
        self.exit
    }

    /// Mean thickness of the chip on the arc by feed per tooth: mean of `sin phi`.
    #[must_use]
    pub fn mean_sine(&self) -> f64 {
        (self.entry.cos() - self.exit.cos()) / (self.exit - self.entry)
    }
}
