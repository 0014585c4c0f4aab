//! Mean over the revolution.
//!
//! The mean does not depend on the helix: each piece of edge passes every angle of the arc once a revolution. So it is an
//! integral over the envelope, not over the edge.

use std::borrow::Cow;
use std::f64::consts::TAU;

use crate::engagement::{Contact, Edge, Engagement};
use crate::law::ForceLaw;
use crate::milling::chip::Tooth;
use crate::milling::cut::Milling;
use crate::milling::cut_force::CutForce;
use crate::number::integrate;
use crate::tool::{Meridian, Piece};

/// Arcs longer than this are divided, rad.
const LONGEST_ARC: f64 = 1.6;

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// Mean force over a revolution, and its moment about the tip.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 12.0, 4)?.with_helix(38_f64.to_radians())?; // mm, teeth
    /// let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?; // N/mm2, N/mm
    /// let climb = Engagement::straight(6.0, 3.97, 1.58, Side::Right)?; // mm
    /// let mean = Milling::new(&tool, &law, &climb, Feed::level(0.191)?).mean();
    /// assert!((mean.force_n.x - 58.79).abs() < 0.01); // N, along the feed
    /// assert!((mean.torque_n_mm() - 812.01).abs() < 0.1);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn mean(&self) -> CutForce {
        let mut sum = CutForce::default();
        let mut breaks = Vec::with_capacity(16);
        for contact in &self.engagement.contacts {
            match contact.edge {
                Edge::End => {
                    let place = Meridian::of_end(0.5 * (contact.from_mm + contact.to_mm));
                    let width = contact.to_mm - contact.from_mm;
                    self.add_arc(&place, width, contact, &mut breaks, &mut sum);
                }
                Edge::Side => {
                    for (piece, from, to) in
                        Piece::between(self.tool, contact.from_mm, contact.to_mm)
                    {
                        match piece {
                            // Chips are the same at all heights, and radius and height are linear: the middle is exact.
                            Piece::Straight { .. } => {
                                let place = piece.point(0.5 * (from + to));
                                let width = place.width * (to - from);
                                self.add_arc(&place, width, contact, &mut breaks, &mut sum);
                            }
                            Piece::Corner { .. } => integrate(from, to, |at, weight| {
                                let place = piece.point(at);
                                let width = place.width * weight;
                                self.add_arc(&place, width, contact, &mut breaks, &mut sum);
                            }),
                        }
                    }
                }
            }
        }
        self.as_it_turns(sum * TAU.recip(), CutForce::mirrored)
    }

    /// Mean force of the edges on the flat end alone.
    #[must_use]
    pub fn mean_of_end(&self) -> CutForce {
        let contacts = self.engagement.contacts.iter();
        let contacts = contacts
            .filter(|contact| contact.edge == Edge::End)
            .copied();
        let ends = Milling {
            tool: self.tool,
            law: self.law,
            engagement: Cow::Owned(Engagement {
                contacts: contacts.collect(),
            }),
            feed: self.feed,
            chips: self.chips.clone(),
            rotation: self.rotation,
        };
        ends.mean()
    }

    /// Adds what all teeth bear on an arc, with a width of edge.
    fn add_arc(
        &self,
        place: &Meridian,
        width: f64,
        contact: &Contact,
        breaks: &mut Vec<f64>,
        sum: &mut CutForce,
    ) {
        for tooth in &self.chips.teeth {
            breaks.clear();
            breaks.push(contact.entry);
            tooth.breaks(&self.feed, place, contact.entry, contact.exit, |phi| {
                breaks.push(phi);
            });
            breaks.push(contact.exit);
            breaks.sort_unstable_by(f64::total_cmp);
            for pair in breaks.windows(2) {
                self.add_smooth_arc(tooth, place, [pair[0], pair[1]], width * tooth.alike, sum);
            }
        }
    }

    fn add_smooth_arc(
        &self,
        tooth: &Tooth,
        place: &Meridian,
        [from, to]: [f64; 2],
        width: f64,
        sum: &mut CutForce,
    ) {
        let middle = 0.5 * (from + to);
        if to <= from || tooth.thickness(&self.feed, place, middle.sin()) <= 0.0 {
            return;
        }
        let parts = ((to - from) / LONGEST_ARC).ceil();
        let step = (to - from) / parts;
        for part in 0..parts as usize {
            let start = from + step * part as f64;
            integrate(start, start + step, |phi, weight| {
                let (sin, cos) = phi.sin_cos();
                let chip = tooth.thickness(&self.feed, place, sin);
                if chip > 0.0 {
                    sum.add(place, sin, cos, self.law.edge_force(chip), width * weight);
                }
            });
        }
    }
}
