//! Intersections of a move with planes of one coordinate.

use std::f64::consts::PI;

use crate::path::curve::{Arc, Curve};
use crate::path::moves::Move;

/// Halvings of a share: to the last bit.
const HALVINGS: u32 = 54;

impl Move {
    /// Shares, strictly between 0 and 1, at which coordinate `axis` (0 to 2) of the move passes one of
    /// the `places_mm`, which ascend. Each to rounding, in no order.
    pub fn shares_at(&self, axis: usize, places_mm: &[f64]) -> Vec<f64> {
        match &self.curve {
            Curve::Line => {
                let (from, to) = (self.start[axis], self.end[axis]);
                let span = to - from;
                between(places_mm, from, to)
                    .iter()
                    .map(|place| (place - from) / span)
                    .filter(|share| *share > 0.0 && *share < 1.0)
                    .collect()
            }
            Curve::Arc(arc) => {
                let mut shares = Vec::new();
                let mut turns = turning_shares(arc, axis);
                turns.push(1.0);
                let mut from = 0.0;
                for to in turns {
                    self.shares_of_climb(axis, places_mm, [from, to], &mut shares);
                    from = to;
                }
                shares
            }
        }
    }

    /// Intersections on a stretch where the coordinate is monotonic.
    fn shares_of_climb(
        &self,
        axis: usize,
        places: &[f64],
        stretch: [f64; 2],
        shares: &mut Vec<f64>,
    ) {
        let height = |share: f64| self.point(share)[axis];
        let ends = stretch.map(height);
        for place in between(places, ends[0], ends[1]) {
            let [mut low, mut high] = stretch;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (height(middle) < *place) == (ends[0] < *place) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            if high > 0.0 && high < 1.0 {
                shares.push(high);
            }
        }
    }
}

/// The places strictly between two ends.
fn between(places: &[f64], a: f64, b: f64) -> &[f64] {
    let (low, high) = (a.min(b), a.max(b));
    let first = places.partition_point(|place| *place <= low);
    let last = places.partition_point(|place| *place < high);
    &places[first.min(last)..last]
}

/// Shares at which a coordinate of an arc turns round, ascending.
fn turning_shares(arc: &Arc, axis: usize) -> Vec<f64> {
    let (cosine, sine) = (arc.first[axis], arc.second[axis]);
    if cosine.hypot(sine) < 1e-12 || arc.sweep == 0.0 {
        return Vec::new();
    }
    // The coordinate is largest at `phase` and every whole turn from it, smallest half a turn on. A change of the
    // radius by some micrometres on the way moves these places by as little.
    let phase = sine.atan2(cosine);
    let (low, high) = (
        arc.start_angle.min(arc.start_angle + arc.sweep),
        arc.start_angle.max(arc.start_angle + arc.sweep),
    );
    let first = ((low - phase) / PI).ceil() as i64;
    let last = ((high - phase) / PI).floor() as i64;
    let mut shares: Vec<f64> = (first..=last)
        .map(|k| (phase + k as f64 * PI - arc.start_angle) / arc.sweep)
        .filter(|share| *share > 0.0 && *share < 1.0)
        .collect();
    shares.sort_by(f64::total_cmp);
    shares
}
