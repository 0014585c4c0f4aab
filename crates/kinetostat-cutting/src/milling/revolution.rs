//! Force over the revolution at evenly spaced angles, and its harmonics.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::law::ForceLaw;
use crate::milling::cut::Milling;
use crate::milling::cut_force::CutForce;
use crate::number::larger;

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
