//! Mean over the revolution, and harmonics of the force.
//!
//! The mean does not depend on the helix: each piece of edge passes every angle of the arc once a revolution. So it is an
//! integral over the envelope, not over the edge.

use std::borrow::Cow;
use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::engagement::{Contact, Edge, Engagement};
use crate::law::ForceLaw;
use crate::milling::chip::Tooth;
use crate::milling::cut::{CutForce, Milling};
use crate::number::{integrate, larger};
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

/// Angles from tooth to tooth at which a revolution is evaluated, where nobody asks for others.
const ANGLES_PER_TOOTH: usize = 360;

/// Forces at evenly spaced angles of one revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolution {
    /// Force at each angle; the first at 0, one turn in all.
    pub forces: Vec<CutForce>,
    teeth: usize,
}

/// A part of the force that comes back a whole number of times a revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Times a revolution.
    pub per_revolution: usize,
    /// Amplitude of each component of the force, N.
    pub amplitude_n: Vector3<f64>,
    /// Angle of the spindle at which each component is largest, times `per_revolution`, rad.
    pub phase: Vector3<f64>,
}

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// The force over one revolution, at 360 angles from tooth to tooth.
    #[must_use]
    pub fn revolution(&self) -> Revolution {
        self.revolution_at(ANGLES_PER_TOOTH)
    }

    /// The force over one revolution, at so many angles from tooth to tooth (at least one).
    #[must_use]
    pub fn revolution_at(&self, angles_per_tooth: usize) -> Revolution {
        let (teeth, angles) = (self.tool.teeth(), angles_per_tooth.max(1));
        let step = self.tool.pitch() / angles as f64;
        let at = |i: usize| self.at(step * i as f64);
        // Teeth that are alike repeat what the first of them finds.
        let forces = match self.chips.alike() {
            true => (0..angles).map(at).collect::<Vec<_>>().repeat(teeth),
            false => (0..teeth * angles).map(at).collect(),
        };
        Revolution { forces, teeth }
    }
}

impl Revolution {
    /// Angles of the spindle, rad.
    pub fn turns(&self) -> impl Iterator<Item = f64> + '_ {
        let step = TAU / self.forces.len() as f64;
        (0..self.forces.len()).map(move |i| step * i as f64)
    }

    /// Largest force at these angles, N; [`Milling::peaks`] finds the largest between them.
    #[must_use]
    pub fn peak_n(&self) -> f64 {
        self.forces
            .iter()
            .map(|force| force.force_n.norm())
            .fold(0.0, larger)
    }

    /// The part of the force that comes back so many times a revolution; the number of teeth is the frequency of the teeth.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 10.0, 2)?;
    /// let law = Linear::new([1000.0, 300.0, 0.0], [0.0, 0.0, 0.0])?;
    /// let slot = Engagement::straight(5.0, 10.0, 1.0, Side::Left)?;
    /// let revolution = Milling::new(&tool, &law, &slot, Feed::level(0.1)?).revolution();
    /// // K_c c a sin phi: one tooth at a time, (1 - cos 2 phi)/2 across the feed.
    /// assert!((revolution.harmonic(2).amplitude_n.y - 0.5 * 100.0 * (1.0 + 0.09_f64).sqrt()).abs() < 1e-3);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn harmonic(&self, per_revolution: usize) -> Harmonic {
        let (mut cosine, mut sine) = (Vector3::zeros(), Vector3::zeros());
        for (turn, force) in self.turns().zip(&self.forces) {
            let (s, c) = (per_revolution as f64 * turn).sin_cos();
            cosine += force.force_n * c;
            sine += force.force_n * s;
        }
        let of_mean = if per_revolution == 0 { 1.0 } else { 2.0 };
        let scale = of_mean / self.forces.len() as f64;
        Harmonic {
            per_revolution,
            amplitude_n: cosine.zip_map(&sine, |c: f64, s: f64| scale * c.hypot(s)),
            phase: cosine.zip_map(&sine, |c, s| s.atan2(c)),
        }
    }

    /// Number of teeth, whose multiples are the harmonics of a tool without run-out.
    #[must_use]
    pub fn teeth(&self) -> usize {
        self.teeth
    }
}
