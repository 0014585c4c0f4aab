//! States between two neighbouring points of a curve, and zeros of functions there.

use crate::continuation::linear::tangent::Tangent;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Point, Row};

/// States between two points of a curve, by their share of the step.
pub(crate) struct Segment<'s, S: CurveSystem> {
    pub here: &'s Point<S>,
    pub there: &'s Point<S>,
}

impl<S: CurveSystem> Segment<'_, S> {
    pub fn at(&self, system: &mut S, share: f64) -> Option<(Corrected, Tangent)> {
        system.start_from(&self.here.equilibrium);
        let t = &self.here.tangent;
        let guess = &self.here.z + (&self.there.z - &self.here.z) * share;
        let c = system.correct(&guess, &Row::Plane(t, t.dot(&guess)), 10)?;
        if (&c.z - &guess).norm() > (&self.there.z - &self.here.z).norm() {
            return None;
        }
        let next = c.matrix.tangent(t, system.family().map(|f| &**f))?;
        Some((c, next))
    }

    /// Zero of a function of the state (Illinois), as a share of the step.
    pub fn root(
        &self,
        system: &mut S,
        mut low: (f64, f64),
        mut high: (f64, f64),
        width: f64,
        f: &dyn Fn(&mut S, &Corrected, &Tangent) -> f64,
    ) -> f64 {
        let mut side = 0;
        for _ in 0..60 {
            if (high.0 - low.0).abs() < width || low.1 == 0.0 || high.1 == 0.0 {
                break;
            }
            let mut share = high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1);
            if !(share > low.0 && share < high.0) {
                share = 0.5 * (low.0 + high.0);
            }
            let value = match self.at(system, share) {
                Some((c, t)) => f(system, &c, &t),
                None => break,
            };
            if !value.is_finite() {
                break;
            }
            if value == 0.0 {
                return share;
            }
            if (value > 0.0) == (high.1 > 0.0) {
                high = (share, value);
                if side == 1 {
                    low.1 *= 0.5;
                }
                side = 1;
            } else {
                low = (share, value);
                if side == -1 {
                    high.1 *= 0.5;
                }
                side = -1;
            }
        }
        if low.1.abs() < high.1.abs() {
            low.0
        } else {
            high.0
        }
    }
}

/// Point where a function of the share of the step, `a` and `b` of one sign at the ends, comes nearest to zero or
/// beyond it: parabolas through three values, a few times.
pub(crate) fn dip<S: CurveSystem>(
    system: &mut S,
    a: f64,
    b: f64,
    f: &dyn Fn(&mut S, f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let (mut low, mut high) = ((0.0, a), (1.0, b));
    let mut middle = (0.5, f(system, 0.5)?);
    for _ in 0..8 {
        if middle.1 * a < 0.0 {
            return Some(middle);
        }
        let (d1, d2) = (
            (middle.1 - low.1) / (middle.0 - low.0),
            (high.1 - middle.1) / (high.0 - middle.0),
        );
        let bend = (d2 - d1) / (high.0 - low.0);
        // Nearest to zero must be inside, and the parabola must come near it.
        if bend * a <= 0.0 || d1 * a >= 0.0 || d2 * a <= 0.0 {
            return None;
        }
        let vertex = 0.5 * (low.0 + middle.0) - 0.5 * d1 / bend;
        if !(vertex > low.0 && vertex < high.0) || (vertex - middle.0).abs() < 1e-4 {
            return None;
        }
        let next = (vertex, f(system, vertex)?);
        let (left, right) = if next.0 < middle.0 {
            (next, middle)
        } else {
            (middle, next)
        };
        if left.1 * a < right.1 * a {
            (middle, high) = (left, right);
        } else {
            (low, middle) = (left, right);
        }
    }
    None
}

/// Scales a motion so that its largest component is 1.
pub(crate) fn largest_one(motion: Vec<f64>) -> Vec<f64> {
    let most = motion
        .iter()
        .copied()
        .fold(0.0_f64, |m, x| if x.abs() > m.abs() { x } else { m });
    if most == 0.0 {
        return motion;
    }
    motion.iter().map(|x| x / most).collect()
}
