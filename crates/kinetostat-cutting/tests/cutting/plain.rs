//! The force of a cutter by plain summation over slices, as `shared/theory/cutting.md` states it: written apart from the crate.

use std::f64::consts::TAU;

use kinetostat_testing::{largest, least};

/// A law as a function of the chip, mm, to tangential, radial and axial N/mm.
pub(crate) type Law<'a> = &'a dyn Fn(f64) -> [f64; 3];

/// A cutter and a cut; mm, rad.
#[derive(Clone, Copy)]
pub(crate) struct Plain<'a> {
    pub(crate) ball: bool,
    pub(crate) radius: f64,
    pub(crate) teeth: usize,
    pub(crate) helix: f64,
    pub(crate) run_out: (f64, f64),
    /// Arc and depth.
    pub(crate) arc: (f64, f64),
    pub(crate) depth: f64,
    pub(crate) feed: f64,
    pub(crate) law: Law<'a>,
}

/// Force and torque.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    pub(crate) force: [f64; 3],
    pub(crate) torque: f64,
    /// Force times height, about the tip.
    pub(crate) moment: [f64; 2],
}

impl Plain<'_> {
    pub(crate) fn at(&self, turn: f64, slices: usize) -> Sum {
        let n = self.teeth;
        let out = |j: usize| self.run_out.0 * (self.run_out.1 - TAU * j as f64 / n as f64).cos();
        let mut sum = Sum::default();
        // A ball is divided in equal angles: in equal heights the edge at the pole is missed.
        let pole_angle = (1.0 - self.depth / self.radius).clamp(-1.0, 1.0).acos();
        for i in 0..slices {
            let share = (i as f64 + 0.5) / slices as f64;
            let (z, r, sin, cos, width) = match self.ball {
                true => {
                    let kappa = share * pole_angle;
                    let (sin, cos) = kappa.sin_cos();
                    let width = self.radius * pole_angle / slices as f64;
                    (
                        self.radius * (1.0 - cos),
                        self.radius * sin,
                        sin,
                        cos,
                        width,
                    )
                }
                false => (
                    share * self.depth,
                    self.radius,
                    1.0,
                    0.0,
                    self.depth / slices as f64,
                ),
            };
            for j in 0..n {
                let phi = turn + TAU * j as f64 / n as f64 - z * self.helix.tan() / self.radius;
                if (phi - self.arc.0).rem_euclid(TAU) > self.arc.1 - self.arc.0 {
                    continue;
                }
                let left = |m: usize| m as f64 * self.feed * phi.sin() + out(j) - out((j + m) % n);
                let chip = sin * least((1..=n).map(left));
                if chip <= 0.0 {
                    continue;
                }
                let [t, normal, a] = (self.law)(chip).map(|f| f * width);
                let force = [
                    -t * phi.cos() - normal * sin * phi.sin() + a * cos * phi.sin(),
                    t * phi.sin() - normal * sin * phi.cos() + a * cos * phi.cos(),
                    normal * cos + a * sin,
                ];
                for (s, f) in sum.force.iter_mut().zip(force) {
                    *s += f;
                }
                sum.torque += t * r;
                let (x, y) = (r * phi.sin(), r * phi.cos());
                sum.moment[0] += y * force[2] - z * force[1];
                sum.moment[1] += z * force[0] - x * force[2];
            }
        }
        sum
    }

    /// Mean over evenly spaced angles, the largest force in the plane and the largest torque.
    pub(crate) fn revolution(&self, angles: usize, slices: usize) -> (Sum, f64, f64) {
        let mut mean = Sum::default();
        let (mut peak, mut torque) = (Vec::new(), Vec::new());
        for i in 0..angles {
            let at = self.at(TAU * (i as f64 + 0.5) / angles as f64, slices);
            for (m, f) in mean.force.iter_mut().zip(at.force) {
                *m += f / angles as f64;
            }
            for (m, f) in mean.moment.iter_mut().zip(at.moment) {
                *m += f / angles as f64;
            }
            mean.torque += at.torque / angles as f64;
            assert!(at.torque.is_finite() && at.force.iter().all(|f| f.is_finite()));
            peak.push(at.force[0].hypot(at.force[1]));
            torque.push(at.torque);
        }
        (mean, largest(peak), largest(torque))
    }
}
