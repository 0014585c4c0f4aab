//! Arcs of a circle on which a function is positive.

use std::f64::consts::TAU;

/// Steps of the regula falsi that places the end of an arc between two samples.
const STEPS: usize = 5;
/// Angles that differ by less are the same.
const SAME: f64 = 1e-6;
/// Circles are sampled at least and at most this often.
const SAMPLES: [f64; 2] = [8.0, 4096.0];

/// Arcs that are not longer than one of these and nowhere deeper in the material say nothing: a circle leaves its tangent by
/// about as much within a cell, and no wall is placed better where it begins to bend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sliver {
    /// Length of the arc, rad.
    pub arc: f64,
    /// Depth, mm.
    pub depth: f64,
}

/// Range of a circle, and the number of samples on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub from: f64,
    pub to: f64,
    samples: usize,
}

impl Range {
    /// Range from one angle to another, with samples no farther apart than `step` on a circle of this radius.
    pub fn new(from: f64, to: f64, radius: f64, step: f64) -> Self {
        let samples = ((to - from) * radius / step).ceil();
        Self {
            from,
            to,
            samples: samples.clamp(SAMPLES[0], SAMPLES[1]) as usize,
        }
    }

    /// The whole circle.
    pub fn full(radius: f64, step: f64) -> Self {
        Self::new(0.0, TAU, radius, step)
    }

    /// Range of angles in which the outward normal of a tool faces its motion: `normal` is its angle from the axis, the
    /// motion has a horizontal and a vertical part (up).
    pub fn facing(
        normal: f64,
        [horizontal, vertical]: [f64; 2],
        radius: f64,
        step: f64,
    ) -> Option<Self> {
        // n v = sin(normal) sin(phi) horizontal - cos(normal) vertical
        let (side, down) = (normal.sin() * horizontal, normal.cos() * vertical);
        if side - down <= 1e-12 {
            return None;
        }
        if side + down < -1e-12 {
            return Some(Self::full(radius, step));
        }
        let from = (down / side).max(-1.0).asin();
        Some(Self::new(from, std::f64::consts::PI - from, radius, step))
    }

    /// Directions of the samples, `(sin, cos)`.
    #[inline]
    pub fn each(&self, mut at: impl FnMut(f64, [f64; 2])) {
        let step = (self.to - self.from) / self.samples as f64;
        let (sin_step, cos_step) = step.sin_cos();
        let (mut sin, mut cos) = self.from.sin_cos();
        for k in 0..=self.samples {
            at(self.from + step * k as f64, [sin, cos]);
            (sin, cos) = (
                sin * cos_step + cos * sin_step,
                cos * cos_step - sin * sin_step,
            );
        }
    }

    /// Writes the arcs on which `value` is positive.
    #[inline]
    pub fn arcs(&self, value: impl Fn([f64; 2]) -> f64, arcs: &mut Vec<[f64; 2]>) {
        self.arcs_but(Sliver::default(), value, arcs);
    }

    /// Finds the arcs without slivers.
    #[inline]
    pub fn arcs_but(
        &self,
        sliver: Sliver,
        value: impl Fn([f64; 2]) -> f64,
        arcs: &mut Vec<[f64; 2]>,
    ) {
        arcs.clear();
        let mut last = [self.from, -1.0];
        let (mut begin, mut deepest) = (self.from, 0.0);
        let mut push = |begin: f64, end: f64, deepest: f64| {
            if deepest > sliver.depth || end - begin > sliver.arc {
                arcs.push([begin, end]);
            }
        };
        self.each(|angle, direction| {
            let now = [angle, value(direction)];
            match (last[1] > 0.0, now[1] > 0.0) {
                (false, true) => {
                    deepest = 0.0;
                    if angle > self.from {
                        begin = root(&value, now, last);
                    }
                }
                (true, false) => push(begin, root(&value, last, now), deepest),
                _ => {}
            }
            deepest = if now[1] > deepest { now[1] } else { deepest };
            last = now;
        });
        if last[1] > 0.0 {
            push(begin, self.to, deepest);
        }
        self.close(arcs);
    }

    /// Joins what meets where a whole circle begins, and brings the beginnings into one turn.
    fn close(&self, arcs: &mut Vec<[f64; 2]>) {
        let ends = (arcs.first().copied(), arcs.last().copied());
        if let (Some(first), Some(last)) = ends
            && self.to - self.from >= TAU - SAME
            && arcs.len() > 1
            && first[0] <= self.from + SAME
            && last[1] >= self.to - SAME
        {
            arcs.pop();
            arcs[0] = [last[0], first[1] + TAU];
        }
        for arc in arcs {
            let turns = (arc[0] / TAU).floor() * TAU;
            *arc = [arc[0] - turns, arc[1] - turns];
        }
    }
}

/// Root of a function between two angles with values of opposite sign (Dowell and Jarratt, "A modified regula falsi",
/// 1971: the Illinois method).
fn root(value: &impl Fn([f64; 2]) -> f64, mut a: [f64; 2], mut b: [f64; 2]) -> f64 {
    let close = 1e-3 * (a[1] - b[1]).abs();
    for _ in 0..STEPS {
        let middle = (a[0] * b[1] - b[0] * a[1]) / (b[1] - a[1]);
        let (sin, cos) = middle.sin_cos();
        let now = [middle, value([sin, cos])];
        if now[1].abs() < close {
            return middle;
        }
        // `b` is the newest; where it stays on one side the weight of the other is halved.
        match (now[1] > 0.0) == (b[1] > 0.0) {
            true => a[1] *= 0.5,
            false => a = b,
        }
        b = now;
    }
    (a[0] * b[1] - b[0] * a[1]) / (b[1] - a[1])
}

/// True if both lists of arcs are equal within rounding.
pub(crate) fn same(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| (a[0] - b[0]).abs() < SAME && (a[1] - b[1]).abs() < SAME)
}
