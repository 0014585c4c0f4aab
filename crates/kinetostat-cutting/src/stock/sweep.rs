//! Coverage of grid points by the sweep of a tool along a straight move.

use crate::stock::profile::{Bend, Normal, Profile};

/// A straight move seen from above, with its heights above the stock's bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sweep {
    from: [f64; 2],
    /// Unit vector along it; x where it is vertical.
    along: [f64; 2],
    length: f64,
    tip: f64,
    /// Lowest tip.
    lowest: f64,
    /// Rise per length.
    slope: f64,
    /// True if the tool goes down, even if only straight down.
    down: bool,
}

/// A point of the plane as the sweep sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// Way along the move, not held between its ends.
    along: f64,
    across: f64,
    /// Square of the distance from the nearest place of the axis.
    pub square: f64,
}

impl Sweep {
    pub fn new(from: [f64; 3], to: [f64; 3], bottom: f64) -> Self {
        let (dx, dy, dz) = (to[0] - from[0], to[1] - from[1], to[2] - from[2]);
        let length = dx.hypot(dy);
        let level = length > 1e-9;
        Self {
            from: [from[0], from[1]],
            along: if level {
                [dx / length, dy / length]
            } else {
                [1.0, 0.0]
            },
            length: if level { length } else { 0.0 },
            // Straight down or up: all of it is done at its lower end.
            tip: if level || dz > 0.0 { from[2] } else { to[2] } - bottom,
            lowest: if dz < 0.0 { to[2] } else { from[2] } - bottom,
            slope: if level { dz / length } else { 0.0 },
            down: dz < 0.0,
        }
    }

    /// Lowest place of the tip above the stock's bottom.
    pub fn lowest(&self) -> f64 {
        self.lowest
    }

    /// True if the tool does not go down.
    pub fn never_down(&self) -> bool {
        !self.down
    }

    /// Smallest and greatest y within a distance of the move.
    pub fn rows(&self, reach: f64) -> [f64; 2] {
        let end = self.from[1] + self.length * self.along[1];
        let (low, high) = if end < self.from[1] {
            (end, self.from[1])
        } else {
            (self.from[1], end)
        };
        [low - reach, high + reach]
    }

    /// Smallest and greatest x of a row within a distance of the move.
    #[inline]
    pub fn span(&self, y: f64, reach: f64) -> Option<[f64; 2]> {
        let [ux, uy] = self.along;
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |low: f64, high: f64| {
            span[0] = if low < span[0] { low } else { span[0] };
            span[1] = if high > span[1] { high } else { span[1] };
        };
        let y0 = y - self.from[1];
        for end in [0.0, self.length] {
            let dy = y0 - end * uy;
            let half = reach * reach - dy * dy;
            if half >= 0.0 {
                let (x, half) = (self.from[0] + end * ux, half.sqrt());
                add(x - half, x + half);
            }
        }
        // The two straight sides; where they are level, the ends of them lie on the circles.
        if uy != 0.0 {
            for side in [-reach, reach] {
                let way = (y0 - side * ux) / uy;
                if (0.0..=self.length).contains(&way) {
                    let x = self.from[0] + way * ux - side * uy;
                    add(x, x);
                }
            }
        }
        (span[0] <= span[1]).then_some(span)
    }

    /// Smallest and greatest x of a row within a distance of the start.
    #[inline]
    pub fn start_span(&self, y: f64, reach: f64) -> Option<[f64; 2]> {
        let dy = y - self.from[1];
        let half = reach * reach - dy * dy;
        (reach > 0.0 && half > 0.0).then(|| {
            let half = half.sqrt();
            [self.from[0] - half, self.from[0] + half]
        })
    }

    #[inline]
    pub fn see(&self, x: f64, y: f64) -> Seen {
        let (dx, dy) = (x - self.from[0], y - self.from[1]);
        let along = dx * self.along[0] + dy * self.along[1];
        let held = match along {
            a if a <= 0.0 => 0.0,
            a if a >= self.length => self.length,
            a => a,
        };
        let (ex, ey) = (dx - held * self.along[0], dy - held * self.along[1]);
        Seen {
            along,
            across: dy * self.along[0] - dx * self.along[1],
            square: ex * ex + ey * ey,
        }
    }

    /// Direction from the nearest place of the axis to a point, seen from above: the normal of a wall of the move.
    #[inline]
    pub fn outward(&self, seen: &Seen) -> Normal {
        let (rest, bend) = match seen.along {
            a if a <= 0.0 => (a, Bend::Round),
            a if a >= self.length => (a - self.length, Bend::Round),
            _ => (0.0, Bend::Straight),
        };
        let [ux, uy] = self.along;
        let per_distance = 1.0 / seen.square.sqrt();
        let outward = [
            (rest * ux - seen.across * uy) * per_distance,
            (rest * uy + seen.across * ux) * per_distance,
        ];
        Normal::new(outward, bend)
    }

    /// The point lies beyond the end of the move: what follows will say what becomes of it.
    #[inline]
    pub fn is_ahead(&self, seen: &Seen) -> bool {
        seen.along > self.length && self.length > 0.0
    }

    /// The point lies behind the start of the move.
    #[inline]
    pub fn is_behind(&self, seen: &Seen) -> bool {
        seen.along < 0.0
    }

    /// Lowest height of the envelope over a point within `reach` of the move.
    #[inline]
    pub fn height(&self, profile: &Profile, seen: &Seen, reach: f64) -> f64 {
        if self.slope == 0.0 {
            if seen.square <= profile.end * profile.end {
                return self.tip;
            }
            return self.tip + profile.height(seen.square.sqrt());
        }
        let square = reach * reach - seen.across * seen.across;
        let half = if square > 0.0 { square.sqrt() } else { 0.0 };
        let hold = |way: f64| way.max(0.0).min(self.length);
        let (first, last) = (hold(seen.along - half), hold(seen.along + half));
        let way = match (profile.is_flat(), self.slope < 0.0) {
            (true, true) => last,
            (true, false) => first,
            _ => self.lowest_way(profile, seen, [first, last]),
        };
        let rest = seen.along - way;
        let distance = (rest * rest + seen.across * seen.across).sqrt();
        let outer = if distance < reach { distance } else { reach };
        self.tip + self.slope * way + profile.height(outer)
    }

    /// Position along the move at which a round tool is lowest over a point.
    fn lowest_way(&self, profile: &Profile, seen: &Seen, ends: [f64; 2]) -> f64 {
        let [mut low, mut high] = ends;
        if profile.end == 0.0 && profile.cone.is_none() {
            // The sphere: the derivative has one root.
            let square = profile.corner * profile.corner - seen.across * seen.across;
            let half = if square > 0.0 { square.sqrt() } else { 0.0 };
            let ahead = half * self.slope / (1.0 + self.slope * self.slope).sqrt();
            return (seen.along - ahead).max(low).min(high);
        }
        for _ in 0..30 {
            let way = 0.5 * (low + high);
            let rest = seen.along - way;
            let distance = (rest * rest + seen.across * seen.across).sqrt();
            let falls = profile.slope(distance) * rest / distance.max(1e-12);
            match self.slope - falls < 0.0 {
                true => low = way,
                false => high = way,
            }
        }
        0.5 * (low + high)
    }
}
