//! Milling cutters: shape of the envelope, teeth, helix, run-out.
//!
//! Knows geometry alone; takes what a catalogue states; gives points of the meridian with the normal of the
//! envelope. `shared/theory/cutting.md`, "Frame and angles".

use std::f64::consts::{FRAC_PI_2, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutErrorKind, Result, within};

/// A point of an edge in the plane of the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meridian {
    /// Height above the tip, mm.
    pub(crate) height: f64,
    /// Distance from the axis, mm.
    pub(crate) radius: f64,
    /// Sine of the angle between the axis and the outward normal.
    pub(crate) sin: f64,
    /// Cosine of the normal's angle: the normal is `(sin radially, -cos along the axis)`.
    pub(crate) cos: f64,
    /// Width of the edge per parameter.
    pub(crate) width: f64,
}

/// A smooth piece of the meridian above the flat end.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Piece {
    /// A circle; the parameter is the angle of the normal, so that the pole is a regular place.
    Corner { end_radius: f64, corner: f64 },
    /// A straight line; the parameter is the height.
    Straight { foot: f64, sin: f64, cos: f64 },
}

impl Piece {
    /// The pieces between two heights, each with its parameters, from the tip to the shank.
    pub(crate) fn between(
        tool: &Tool,
        bottom: f64,
        top: f64,
    ) -> impl Iterator<Item = (Self, f64, f64)> {
        let corner = tool.corner_radius_mm();
        let round = (bottom < corner).then(|| {
            let piece = Self::Corner {
                end_radius: tool.end_radius_mm(),
                corner,
            };
            (
                piece,
                piece.parameter(bottom),
                piece.parameter(top.min(corner)),
            )
        });
        let straight = (top > corner).then(|| {
            let (sin, cos) = match tool.side_angle() {
                angle if angle >= FRAC_PI_2 => (1.0, 0.0),
                angle => angle.sin_cos(),
            };
            let piece = Self::Straight {
                foot: tool.radius_mm(),
                sin,
                cos,
            };
            (piece, bottom.max(corner), top)
        });
        round.into_iter().chain(straight)
    }

    /// Parameter at a height, mm.
    pub(crate) fn parameter(&self, height: f64) -> f64 {
        match *self {
            Self::Corner { corner, .. } => (1.0 - height / corner).clamp(-1.0, 1.0).acos(),
            Self::Straight { .. } => height,
        }
    }

    /// Share of a corner up to a parameter: the whole of it is a right angle.
    pub(crate) fn parameter_share(parameter: f64) -> f64 {
        parameter / FRAC_PI_2
    }

    /// The point at a parameter.
    #[inline]
    pub(crate) fn point(&self, parameter: f64) -> Meridian {
        match *self {
            Self::Corner { end_radius, corner } => {
                let (sin, cos) = parameter.sin_cos();
                Meridian {
                    height: corner * (1.0 - cos),
                    radius: end_radius + corner * sin,
                    sin,
                    cos,
                    width: corner,
                }
            }
            Self::Straight { foot, sin, cos } => Meridian {
                height: parameter,
                radius: foot + parameter * cos / sin,
                sin,
                cos,
                width: 1.0 / sin,
            },
        }
    }
}

impl Meridian {
    /// A place of the flat end: the normal is the axis, downwards.
    pub(crate) fn of_end(radius: f64) -> Self {
        Self {
            height: 0.0,
            radius,
            sin: 0.0,
            cos: 1.0,
            width: 1.0,
        }
    }
}

/// Envelope of the cutting edges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A cylinder with a flat end.
    Flat,
    /// A cylinder that ends in a half sphere.
    Ball,
    /// A cylinder with a corner radius (bull nose, torus).
    Bull {
        /// Radius of the corner, mm, below the tool's radius.
        corner_radius_mm: f64,
    },
    /// A face mill with straight inserts; its diameter is that at the tip.
    Face {
        /// Angle between the edge and the plane of the feed, rad: 90 degrees is a cylinder.
        lead_angle: f64,
    },
}

impl Shape {
    /// Keyword of the shape: `flat`, `ball`, `bull` or `face`.
    ///
    /// ```
    /// use kinetostat_cutting::Shape;
    ///
    /// assert_eq!(Shape::Bull { corner_radius_mm: 1.0 }.word(), "bull");
    /// ```
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Ball => "ball",
            Self::Bull { .. } => "bull",
            Self::Face { .. } => "face",
        }
    }
}

/// The axis of the teeth lies beside the axis of rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct RunOut {
    /// Distance of the two axes, mm.
    pub offset_mm: f64,
    /// Direction of the offset, seen from tooth 0, rad: tooth `j` of `N` protrudes by `offset cos(angle - 2 pi j/N)`.
    pub angle: f64,
}

/// A milling cutter with evenly spaced teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    shape: Shape,
    diameter_mm: f64,
    teeth: usize,
    helix: f64,
    run_out: RunOut,
}

impl Tool {
    /// A cutter with straight teeth and without run-out.
    ///
    /// ```
    /// use kinetostat_cutting::{Shape, Tool};
    ///
    /// let cutter = Tool::new(Shape::Flat, 12.0, 4)?.with_helix(38_f64.to_radians())?;
    /// assert_eq!(cutter.radius_mm(), 6.0);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A diameter outside 0.01 to 1000 mm, no tooth or more than 200, a corner radius that does not fit, a lead angle outside
    /// 5 to 90 degrees.
    pub fn new(shape: Shape, diameter_mm: f64, teeth: usize) -> Result<Self> {
        let tool = CutErrorKind::Tool;
        within(tool, "diameter", diameter_mm, 0.01..=1000.0, "mm")?;
        within(tool, "teeth", teeth as f64, 1.0..=200.0, "")?;
        match shape {
            Shape::Flat | Shape::Ball => {}
            Shape::Bull { corner_radius_mm } => {
                within(
                    tool,
                    "corner radius",
                    corner_radius_mm,
                    0.0..=0.5 * diameter_mm,
                    "mm",
                )?;
            }
            Shape::Face { lead_angle } => {
                within(
                    tool,
                    "lead angle",
                    lead_angle.to_degrees(),
                    5.0..=90.0,
                    "deg",
                )?;
            }
        }
        Ok(Self {
            shape,
            diameter_mm,
            teeth,
            helix: 0.0,
            run_out: RunOut::default(),
        })
    }

    /// Sets the helix angle, rad. Positive lifts the chip: the edge lags behind the tip as it rises.
    ///
    /// # Errors
    /// An angle beyond 70 degrees.
    pub fn with_helix(mut self, helix: f64) -> Result<Self> {
        within(
            CutErrorKind::Tool,
            "helix",
            helix.to_degrees(),
            -70.0..=70.0,
            "deg",
        )?;
        self.helix = helix;
        Ok(self)
    }

    /// Sets the run-out.
    ///
    /// # Errors
    /// An offset that is negative or more than a tenth of the diameter, an angle that is no number.
    pub fn with_run_out(mut self, run_out: RunOut) -> Result<Self> {
        let most = 0.1 * self.diameter_mm;
        within(
            CutErrorKind::Tool,
            "run-out",
            run_out.offset_mm,
            0.0..=most,
            "mm",
        )?;
        within(
            CutErrorKind::Tool,
            "angle of the run-out",
            run_out.angle,
            -1e3..=1e3,
            "rad",
        )?;
        self.run_out = run_out;
        Ok(self)
    }

    /// Envelope of its edges.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Diameter, mm.
    #[must_use]
    pub fn diameter_mm(&self) -> f64 {
        self.diameter_mm
    }

    /// Radius, mm.
    #[must_use]
    pub fn radius_mm(&self) -> f64 {
        0.5 * self.diameter_mm
    }

    /// Number of teeth.
    #[must_use]
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// Helix angle at the shank, rad.
    #[must_use]
    pub fn helix(&self) -> f64 {
        self.helix
    }

    /// Run-out of the teeth.
    #[must_use]
    pub fn run_out(&self) -> RunOut {
        self.run_out
    }

    /// Angle by which the edge lags behind the tip per height above it, rad/mm: the lead is constant.
    #[must_use]
    pub fn lag_per_mm(&self) -> f64 {
        self.helix.tan() / self.radius_mm()
    }

    /// Angle from tooth to tooth, rad.
    #[must_use]
    pub fn pitch(&self) -> f64 {
        TAU / self.teeth as f64
    }

    /// Protrusion of a tooth over the mean, mm.
    #[must_use]
    pub fn stands_out_mm(&self, tooth: usize) -> f64 {
        self.run_out.offset_mm * (self.run_out.angle - self.pitch() * tooth as f64).cos()
    }

    /// Radius of the flat end, mm: 0 on a ball.
    #[must_use]
    pub fn end_radius_mm(&self) -> f64 {
        match self.shape {
            Shape::Flat | Shape::Face { .. } => self.radius_mm(),
            Shape::Ball => 0.0,
            Shape::Bull { corner_radius_mm } => self.radius_mm() - corner_radius_mm,
        }
    }

    /// Radius of the corner between the end and the side, mm.
    #[must_use]
    pub fn corner_radius_mm(&self) -> f64 {
        match self.shape {
            Shape::Flat | Shape::Face { .. } => 0.0,
            Shape::Ball => self.radius_mm(),
            Shape::Bull { corner_radius_mm } => corner_radius_mm,
        }
    }

    /// Angle between the axis and the outward normal of the envelope above the corner, rad.
    #[must_use]
    pub fn side_angle(&self) -> f64 {
        match self.shape {
            Shape::Face { lead_angle } => lead_angle,
            _ => FRAC_PI_2,
        }
    }

    /// Radius of the envelope at a height above the tip, mm.
    ///
    /// ```
    /// use kinetostat_cutting::{Shape, Tool};
    ///
    /// let ball = Tool::new(Shape::Ball, 10.0, 2)?;
    /// assert!((ball.radius_at_mm(1.0) - 3.0).abs() < 1e-12);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn radius_at_mm(&self, height_mm: f64) -> f64 {
        let corner = self.corner_radius_mm();
        match height_mm < corner {
            true => {
                let rest = corner - height_mm;
                self.end_radius_mm() + (corner * corner - rest * rest).sqrt()
            }
            false => match self.shape {
                Shape::Face { lead_angle } => self.radius_mm() + height_mm / lead_angle.tan(),
                _ => self.radius_mm(),
            },
        }
    }
}
