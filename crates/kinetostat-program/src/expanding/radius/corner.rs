//! Angle between pieces of a contour, and the motion of the tool there.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::expanding::radius::geometry::{Point, Side};
use crate::expanding::translate::wrong::Wrong;

/// Corners flatter than this are none, in rad (LinuxCNC, `TOLERANCE_CONCAVE_CORNER`).
const FLAT: f64 = 0.05;

/// Distance from a bound, in rad, below which the last digit would decide.
const UNSURE: f64 = 1e-9;

/// Motion of the tool between two pieces of a contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Corner {
    /// No turn.
    Flat,
    /// The tool rolls round the corner.
    Outside,
    /// The tool stops short of the corner.
    Inside,
}

/// Motion at a reversal of the contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reversal {
    /// The tool goes round its end.
    Outside,
    /// The reversal is the foot of an arc that bends away from the tool, as in the letter h.
    Inside,
}

/// The corner between two directions of motion, unit vectors.
pub(crate) fn corner(
    before: Point,
    after: Point,
    side: Side,
    reversal: Reversal,
) -> Result<Corner, Wrong> {
    let opening = opening(before, after, side);
    if [-FLAT, FLAT, PI - FLAT, PI + FLAT]
        .iter()
        .any(|bound| (opening - bound).abs() < UNSURE)
    {
        return Err((
            format!(
                "the corner turns by {opening:.3} rad, where LinuxCNC begins to take it for another kind of corner"
            ),
            "change the angle by a little",
        ));
    }
    let most = match reversal {
        Reversal::Outside => PI + FLAT,
        Reversal::Inside => PI - FLAT,
    };
    Ok(match opening {
        opening if opening < -FLAT || opening > most => Corner::Inside,
        opening if opening > FLAT => Corner::Outside,
        _ => Corner::Flat,
    })
}

/// Angle by which a contour turns away from the tool, in rad: from a quarter turn towards it to three quarters away.
fn opening(before: Point, after: Point, side: Side) -> f64 {
    let away = -side.sign() * before.perp(&after).atan2(before.dot(&after));
    match away < -FRAC_PI_2 {
        true => away + TAU,
        false => away,
    }
}
