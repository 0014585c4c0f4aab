//! Points of the envelope's meridian.

use std::f64::consts::FRAC_PI_2;

use crate::tool::cutter::Tool;

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
