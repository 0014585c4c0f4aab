//! Arcs, or straight pieces, in place of the stretches of a move: as few as follow the corrected curve.
//!
//! Knows: the corrected curve of one move ([`crate::writing::corrected_curve`]) and the tolerances. Takes a stretch without a jump
//! ([`stretch::Span`]), gives its pieces ([`stretch::FittedPiece`]).
//!
//! With a varying correction the corrected curve of an arc is nearly an arc. A stretch of it is taken for one arc about an axis of
//! the same direction, that rises evenly and passes through both ends in its plane ([`Circle`]): the centre is where the squares of
//! the radial distances in between are least. Equal ways along the path are not quite equal angles of the new arc; what is left of
//! that after a polynomial of third degree ([`crate::WrittenArc::slip`]) counts as a distance too. The tolerance that remains
//! beside the distances in the plane is a tube about the height of the curve, and an arc that rises evenly is a straight line in it
//! ([`stretch`]).
//!
//! A move is taken whole, or in two or three equal stretches. Otherwise the ends of its pieces may leave the curve along the axis, within
//! the tube ([`free_ends`]): broken lines with free corners need fewer pieces by a factor `sqrt 2` than those with corners on a curve (the
//! largest distance of a parabola of second derivative `k` is `k h^2 / 16` instead of `k h^2 / 8` over pieces of `h`). That such a broken
//! line has as few pieces as it can have, if each is the longest that can be seen in the tube from where the one before was seen, is the
//! theorem of Suri (A linear time algorithm for minimum link paths, 1986) and of Imai and Iri (An optimal algorithm for approximating a
//! piecewise linear function, 1986). If that is not enough, the ends lie on the curve and each piece is as long as it can be ([`free_ends`]).
//! If a piece is shorter than the controller takes, others are looked for ([`fit`]). A straight piece is taken where no arc can be
//! printed: one that is bent by less than its digits, or too small for them.

pub(crate) mod fit;
pub(crate) mod free_ends;
pub(crate) mod stretch;

use std::f64::consts::TAU;

/// A circle in the plane of an arc.
///
/// It is found by Newton's method in the one unknown that is left, the distance of the centre from the chord.
pub(crate) struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
    pub start_angle: f64,
}

impl Circle {
    /// Through two ends, and as near to the places between as it can be; the sweep is about this.
    pub fn through(
        start: [f64; 2],
        end: [f64; 2],
        places: &[[f64; 2]],
        sweep: f64,
    ) -> Option<Self> {
        let chord = [end[0] - start[0], end[1] - start[1]];
        let length = chord[0].hypot(chord[1]);
        let left = [-chord[1] / length, chord[0] / length];
        let half = 0.5 * length;
        let middle = [start[0] + 0.5 * chord[0], start[1] + 0.5 * chord[1]];
        // Distance of the centre from the chord, to its left.
        let mut height = half / (0.5 * sweep).tan();
        let centre = |height: f64| [middle[0] + height * left[0], middle[1] + height * left[1]];
        for _ in 0..4 {
            let (about, radius) = (centre(height), half.hypot(height));
            let (mut product, mut square) = (0.0, 0.0);
            for place in places {
                let out = [place[0] - about[0], place[1] - about[1]];
                let distance = out[0].hypot(out[1]);
                let slope = -(out[0] * left[0] + out[1] * left[1]) / distance - height / radius;
                product += (distance - radius) * slope;
                square += slope * slope;
            }
            height -= product / square;
        }
        let (centre, radius) = (centre(height), half.hypot(height));
        let out = [start[0] - centre[0], start[1] - centre[1]];
        let usable = radius.is_finite() && radius > 0.0;
        usable.then(|| Self {
            centre,
            radius,
            start_angle: out[1].atan2(out[0]),
        })
    }

    /// Angle from the start to a place, the one that is nearest to what is expected.
    pub fn turned(&self, place: [f64; 2], expected: f64) -> f64 {
        let angle = (place[1] - self.centre[1]).atan2(place[0] - self.centre[0]) - self.start_angle;
        angle + TAU * ((expected - angle) / TAU).round()
    }
}
