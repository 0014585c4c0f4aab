//! Shapes of complex pairs as they are seen: what moves in a pair at two instants, and what is strained in it.

use nalgebra::{Complex, DVector};

use crate::linear::LinearDynamics;
use crate::modes::complex::ComplexMode;
use crate::modes::mode::{Mode, ModeKind};
use crate::modes::shares::EnergyShare;

impl LinearDynamics {
    /// A complex pair at the instant at which the tool moves farthest, and a quarter of a period later. Both together are
    /// normalised by mass (`phi^H M phi = 1`); `squared` is the real part of `-lambda^2`. The second is zero where all parts
    /// swing in step, as without a pair that grows and without damping.
    #[must_use]
    pub fn shapes_of_pair(&self, pair: &ComplexMode) -> [Mode; 2] {
        let own = |shape: &DVector<f64>| shape.dot(&(&self.mass * shape));
        let parts = |turn: Complex<f64>| {
            let turned = pair.right.map(|x| x * turn);
            [turned.map(|x| x.re), turned.map(|x| x.im)]
        };
        let one = Complex::new(1.0, 0.0);
        let size = parts(one).iter().map(own).sum::<f64>().sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        // The phase in which the sum of squares of the tool's motions is largest; without any, that of all coordinates.
        let [re, im] = parts(one).map(|shape| self.motion_at(self.tool, &shape));
        let tool: Complex<f64> = (0..6)
            .map(|k| {
                let length = if k < 3 { 1.0 / self.length } else { 1.0 };
                let motion = Complex::new(re[k], im[k]) * length;
                motion * motion
            })
            .sum();
        let all: Complex<f64> = (pair.right.iter().zip(&self.units))
            .map(|(x, unit)| x * x / (unit * unit))
            .sum();
        let phase = if tool.norm() > 1e-18 * all.norm() {
            tool
        } else {
            all
        };
        let turn = Complex::from_polar(1.0 / size, -0.5 * phase.arg());
        let [first, second] = parts(turn);
        // The largest entry points forwards, so that shapes do not flip from posture to posture.
        let largest = first
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        let sign = if largest < 0.0 { -1.0 } else { 1.0 };
        let kind = match pair.grows() {
            true => ModeKind::Unstable,
            false => ModeKind::Vibration,
        };
        [first * sign, second * sign].map(|shape| Mode {
            squared: pair.squared().re,
            kind,
            tool: self.motion_at(self.tool, &shape),
            shape,
        })
    }

    /// Mean kinetic energy of a complex pair by bodies, links and platforms, as [`Self::kinetic_shares`].
    #[must_use]
    pub fn kinetic_shares_of_pair(&self, pair: &ComplexMode) -> Vec<EnergyShare> {
        self.kinetic_of(&self.shapes_of_pair(pair).each_ref().map(|mode| &mode.shape))
    }

    /// Mean elastic energy of a complex pair by springs, as [`Self::elastic_shares`].
    #[must_use]
    pub fn elastic_shares_of_pair(&self, pair: &ComplexMode) -> Vec<EnergyShare> {
        self.elastic_of(&self.shapes_of_pair(pair).each_ref().map(|mode| &mode.shape))
    }
}
