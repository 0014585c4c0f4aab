//! The rounding or the chamfer between two straight lines in a plane.

use nalgebra::Vector2;

/// What stands in place of a corner, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cut {
    /// An arc of this radius, tangential to both lines.
    Rounded(f64),
    /// A line that takes so much of each side.
    Sides(f64),
    /// A line of this length.
    Length(f64),
}

/// What it becomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Where the first line ends, and where the second one begins, mm.
    pub ends: [Vector2<f64>; 2],
    /// 1 where the path turns to the left, -1 to the right.
    pub sense: f64,
}

/// Lines that turn by less than this, or turn back as nearly, have no corner, rad.
const LEAST_TURN: f64 = 1e-6;

/// How much longer than its line a side may be, mm: rounding.
const ROUNDING_MM: f64 = 1e-6;

/// The sentence of a corner that is refused.
pub(crate) fn not_followed(why: &str) -> String {
    format!("the corner is not followed by what is known here: {why}")
}

impl Corner {
    /// Between lines from one place over the corner to another.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn cut([from, at, to]: [Vector2<f64>; 3], cut: Cut) -> Result<Self, String> {
        let size = match cut {
            Cut::Rounded(size) | Cut::Sides(size) | Cut::Length(size) => size,
        };
        if !(size > 0.0 && size.is_finite()) {
            return Err("its size is not above zero".to_owned());
        }
        let (back, on) = (from - at, to - at);
        let (Some(u), Some(v)) = (back.try_normalize(1e-9), on.try_normalize(1e-9)) else {
            return Err("one of the lines at the corner has no length in the plane".to_owned());
        };
        let inner = u.perp(&v).abs().atan2(u.dot(&v));
        let turn = std::f64::consts::PI - inner;
        if turn < LEAST_TURN || inner < LEAST_TURN {
            return Err("the lines at the corner go straight on, or back on themselves".to_owned());
        }
        let side = match cut {
            Cut::Rounded(radius) => radius / (0.5 * inner).tan(),
            Cut::Sides(side) => side,
            Cut::Length(length) => 0.5 * length / (0.5 * inner).sin(),
        };
        for line in [back.norm(), on.norm()] {
            if side > line + ROUNDING_MM {
                return Err(format!(
                    "it takes {side:.4} mm of a line at the corner that is {line:.4} mm long"
                ));
            }
        }
        Ok(Self {
            ends: [at + u * side, at + v * side],
            // From `from` to the corner and on.
            sense: match u.perp(&v) < 0.0 {
                true => 1.0,
                false => -1.0,
            },
        })
    }
}
