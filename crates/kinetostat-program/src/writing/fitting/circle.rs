//! The circle through two ends that is nearest to the places between them: Newton's method in the one unknown that is left, the
//! distance of the centre from the chord.

use std::f64::consts::TAU;

/// A circle in the plane of an arc.
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
