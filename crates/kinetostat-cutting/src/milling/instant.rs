//! Force at one angle of the spindle.

use std::f64::consts::TAU;

use crate::engagement::{Contact, Edge};
use crate::law::ForceLaw;
use crate::milling::chip::Tooth;
use crate::milling::cut::{CutForce, Milling};
use crate::number::integrate;
use crate::tool::{Meridian, Piece};

/// True if an angle lies on an arc, modulo full turns.
fn on_arc(contact: &Contact, phi: f64) -> bool {
    (phi - contact.entry).rem_euclid(TAU) <= contact.exit - contact.entry
}

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// Force when the tip of tooth 0 stands at an angle, rad; it grows as the spindle turns.
    ///
    /// With a spindle that turns clockwise it is the angle of the place of that tooth ([`crate::Contact`]); with one that turns
    /// the other way it counts from -y.
    #[must_use]
    pub fn at(&self, turn: f64) -> CutForce {
        let force = self.at_clockwise(turn);
        self.as_it_turns(force, CutForce::mirrored)
    }

    pub(crate) fn at_clockwise(&self, turn: f64) -> CutForce {
        let mut sum = CutForce::default();
        let mut breaks = Vec::with_capacity(16);
        for j in 0..self.tool.teeth() {
            let tooth = &self.chips.teeth[if self.chips.alike() { 0 } else { j }];
            let tip = turn + self.tool.pitch() * j as f64;
            for contact in &self.engagement.contacts {
                self.add_tooth(tooth, tip, contact, &mut breaks, &mut sum);
            }
        }
        sum
    }

    fn add_tooth(
        &self,
        tooth: &Tooth,
        tip: f64,
        contact: &Contact,
        breaks: &mut Vec<f64>,
        sum: &mut CutForce,
    ) {
        if contact.edge == Edge::End {
            if on_arc(contact, tip) {
                let place = Meridian::of_end(0.5 * (contact.from_mm + contact.to_mm));
                self.add_edge(tooth, &place, tip, contact.to_mm - contact.from_mm, sum);
            }
            return;
        }
        for (piece, from, to) in Piece::between(self.tool, contact.from_mm, contact.to_mm) {
            self.heights_of_breaks(tooth, tip, contact, &piece, [from, to], breaks);
            for pair in breaks.windows(2) {
                let middle = piece.point(0.5 * (pair[0] + pair[1]));
                let phi = tip - self.tool.lag_per_mm() * middle.height;
                if pair[1] <= pair[0] || !on_arc(contact, phi) {
                    continue;
                }
                integrate(pair[0], pair[1], |at, weight| {
                    let place = piece.point(at);
                    let phi = tip - self.tool.lag_per_mm() * place.height;
                    self.add_edge(tooth, &place, phi, place.width * weight, sum);
                });
            }
        }
    }

    /// Parameters of the meridian between which the edge of a tooth is all in the arc or all out of it, with one kind of chip.
    fn heights_of_breaks(
        &self,
        tooth: &Tooth,
        tip: f64,
        contact: &Contact,
        piece: &Piece,
        [from, to]: [f64; 2],
        breaks: &mut Vec<f64>,
    ) {
        breaks.clear();
        breaks.extend([from, to]);
        let lag = self.tool.lag_per_mm();
        if lag != 0.0 {
            let phi = |at: f64| tip - lag * piece.point(at).height;
            let (a, b) = (phi(from), phi(to));
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            let mut found = |angle: f64| {
                breaks.push(piece.parameter((tip - angle) / lag).clamp(from, to));
            };
            for one in [contact.entry, contact.exit] {
                let mut angle = one + TAU * ((low - one) / TAU).ceil();
                while angle < high {
                    found(angle);
                    angle += TAU;
                }
            }
            let middle = piece.point(0.5 * (from + to));
            tooth.breaks(&self.feed, &middle, low, high, found);
        }
        breaks.sort_unstable_by(f64::total_cmp);
    }

    #[inline]
    fn add_edge(&self, tooth: &Tooth, place: &Meridian, phi: f64, width: f64, sum: &mut CutForce) {
        let (sin, cos) = phi.sin_cos();
        let chip = tooth.thickness(&self.feed, place, sin);
        if chip > 0.0 {
            sum.add(place, sin, cos, self.law.edge_force(chip), width);
        }
    }
}
