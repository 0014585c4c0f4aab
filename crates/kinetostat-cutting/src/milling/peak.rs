//! Largest force and torque of the revolution.
//!
//! Between two angles at which the end of an edge enters or leaves the material, or its chip begins or follows another tooth,
//! the force is a smooth function of the angle. At such an angle it may jump (straight teeth), so that every interval is
//! searched from within.

use std::f64::consts::TAU;

use crate::engagement::{Contact, Edge};
use crate::law::ForceLaw;
use crate::milling::chip::Tooth;
use crate::milling::cut::{CutForce, Milling};
use crate::tool::{Meridian, Piece};

/// Largest distance of two samples of a smooth interval, rad: forces are made of sines of the angle and of twice the angle.
const STEP: f64 = 0.1;

/// Distance from a break at which its one-sided limit is taken, rad.
const INSIDE: f64 = 1e-9;

/// Local maxima of the samples below this share of the largest sample are not refined.
const REFINED: f64 = 0.95;

/// Steps of the golden section: they end at a millionth of a radian.
const GOLDEN_STEPS: usize = 26;

/// The force at the angle of the spindle at which a size of it is largest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// Angle of the spindle, rad, from 0 below one turn.
    pub turn: f64,
    /// Force at that angle; where the force jumps, its limit on the larger side.
    pub force: CutForce,
}

/// The largest values of one revolution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// Largest force across the tool axis.
    pub across: Peak,
    /// Largest torque of the spindle.
    pub torque: Peak,
}

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// The largest force across the tool axis and the largest torque of a revolution.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 6.0, 1)?.with_helix(1_f64.to_radians())?;
    /// let law = Linear::new([2448.9, 135.4, 393.7], [21.44, 4.81, 1.28])?;
    /// let climb = Engagement::straight(3.0, 0.173, 2.91, Side::Right)?;
    /// let peak = Milling::new(&tool, &law, &climb, Feed::level(0.1)?).peaks().across;
    /// assert!((peak.force.in_plane_n() - 296.41).abs() < 0.005); // N; samples of one degree give 289.54
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn peaks(&self) -> Peaks {
        let intervals = self.smooth_intervals();
        let samples: Vec<Vec<(f64, CutForce)>> = intervals
            .windows(2)
            .filter(|ends| ends[1] - ends[0] > 4.0 * INSIDE)
            .map(|ends| self.samples(ends[0] + INSIDE, ends[1] - INSIDE))
            .collect();
        let [across, torque] = [CutForce::in_plane_n, CutForce::torque_n_mm].map(|size| {
            let peak = self.largest(&samples, size);
            Peak {
                turn: peak.turn.rem_euclid(TAU),
                force: self.as_it_turns(peak.force, CutForce::mirrored),
            }
        });
        Peaks { across, torque }
    }

    fn samples(&self, from: f64, to: f64) -> Vec<(f64, CutForce)> {
        let parts = ((to - from) / STEP).ceil().max(2.0) as usize;
        let turn = |i: usize| from + (to - from) * i as f64 / parts as f64;
        (0..=parts)
            .map(|i| (turn(i), self.at_clockwise(turn(i))))
            .collect()
    }

    fn largest(&self, intervals: &[Vec<(f64, CutForce)>], size: impl Fn(&CutForce) -> f64) -> Peak {
        let mut peak = Peak::default();
        let mut take = |turn: f64, force: CutForce| {
            let found = size(&force);
            if found > size(&peak.force) || found.is_nan() {
                peak = Peak { turn, force };
            }
            size(&peak.force)
        };
        let all = intervals.iter().flatten();
        let sampled = all.fold(0.0, |_, (turn, force)| take(*turn, *force));
        for samples in intervals {
            for (i, (_, force)) in samples.iter().enumerate() {
                let (before, after) = (i.saturating_sub(1), (i + 1).min(samples.len() - 1));
                let found = size(force);
                let neighbour = |at: usize| size(&samples[at].1);
                if found < REFINED * sampled
                    || found < neighbour(before)
                    || found < neighbour(after)
                {
                    continue;
                }
                let turn = self.golden(samples[before].0, samples[after].0, &size);
                take(turn, self.at_clockwise(turn));
            }
        }
        peak
    }

    /// Angle of the largest size between two angles with one maximum.
    fn golden(&self, mut low: f64, mut high: f64, size: impl Fn(&CutForce) -> f64) -> f64 {
        let share = 0.5 * (5_f64.sqrt() - 1.0);
        let at = |turn: f64| size(&self.at_clockwise(turn));
        let (mut a, mut b) = (high - share * (high - low), low + share * (high - low));
        let (mut at_a, mut at_b) = (at(a), at(b));
        for _ in 0..GOLDEN_STEPS {
            if at_a > at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - share * (high - low);
                at_a = at(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + share * (high - low);
                at_b = at(b);
            }
        }
        0.5 * (low + high)
    }

    /// Ends of the intervals in which the force is smooth, in order, over the angle after which the force repeats.
    fn smooth_intervals(&self) -> Vec<f64> {
        let period = match self.chips.alike() {
            true => self.tool.pitch(),
            false => TAU,
        };
        let mut ends = Vec::with_capacity(64);
        for (j, tooth) in self.chips.teeth.iter().enumerate() {
            let behind = self.tool.pitch() * j as f64;
            for contact in &self.engagement.contacts {
                self.breaks_of_contact(tooth, contact, |tip| {
                    ends.push((tip - behind).rem_euclid(period));
                });
            }
        }
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup_by(|a, b| *a - *b < INSIDE);
        let first = ends.first().copied().unwrap_or(0.0);
        if ends.is_empty() {
            ends.push(first);
        }
        ends.push(first + period);
        ends
    }

    /// Angles of the tip at which an end of an edge enters or leaves the arc of a contact or changes its kind of chip.
    fn breaks_of_contact(&self, tooth: &Tooth, contact: &Contact, mut found: impl FnMut(f64)) {
        let mut at_place = |place: &Meridian| {
            let ahead = self.tool.lag_per_mm() * place.height;
            found(contact.entry + ahead);
            found(contact.exit + ahead);
            let (from, to) = (contact.entry, contact.exit);
            tooth.breaks(&self.feed, place, from, to, |phi| found(phi + ahead));
        };
        if contact.edge == Edge::End {
            at_place(&Meridian::of_end(contact.to_mm));
            return;
        }
        for (piece, from, to) in Piece::between(self.tool, contact.from_mm, contact.to_mm) {
            for end in [from, to] {
                at_place(&piece.point(end));
            }
        }
    }
}
