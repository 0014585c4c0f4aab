//! States between two neighbouring points of a curve, and zeros of functions there.

use crate::continuation::linear::tangent::Tangent;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Point, Row};

/// States between two points of a curve, by their share of the step.
pub(crate) struct Segment<'s, S: CurveSystem> {
    pub here: &'s Point<S>,
    pub there: &'s Point<S>,
}

/// Value of a function of the state at a share of the step.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    pub share: f64,
    pub value: f64,
}

impl Sample {
    pub fn new(share: f64, value: f64) -> Self {
        Self { share, value }
    }
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
        mut low: Sample,
        mut high: Sample,
        width: f64,
        f: &dyn Fn(&mut S, &Corrected, &Tangent) -> f64,
    ) -> f64 {
        let mut side = 0;
        for _ in 0..60 {
            if (high.share - low.share).abs() < width || low.value == 0.0 || high.value == 0.0 {
                break;
            }
            let mut share =
                high.share - high.value * (high.share - low.share) / (high.value - low.value);
            if !(share > low.share && share < high.share) {
                share = 0.5 * (low.share + high.share);
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
            if (value > 0.0) == (high.value > 0.0) {
                high = Sample { share, value };
                if side == 1 {
                    low.value *= 0.5;
                }
                side = 1;
            } else {
                low = Sample { share, value };
                if side == -1 {
                    high.value *= 0.5;
                }
                side = -1;
            }
        }
        if low.value.abs() < high.value.abs() {
            low.share
        } else {
            high.share
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
) -> Option<Sample> {
    let (mut low, mut high) = (Sample::new(0.0, a), Sample::new(1.0, b));
    let mut middle = Sample::new(0.5, f(system, 0.5)?);
    for _ in 0..8 {
        if middle.value * a < 0.0 {
            return Some(middle);
        }
        let (d1, d2) = (
            (middle.value - low.value) / (middle.share - low.share),
            (high.value - middle.value) / (high.share - middle.share),
        );
        let bend = (d2 - d1) / (high.share - low.share);
        // Nearest to zero must be inside, and the parabola must come near it.
        if bend * a <= 0.0 || d1 * a >= 0.0 || d2 * a <= 0.0 {
            return None;
        }
        let vertex = 0.5 * (low.share + middle.share) - 0.5 * d1 / bend;
        if !(vertex > low.share && vertex < high.share) || (vertex - middle.share).abs() < 1e-4 {
            return None;
        }
        let next = Sample::new(vertex, f(system, vertex)?);
        let (left, right) = if next.share < middle.share {
            (next, middle)
        } else {
            (middle, next)
        };
        if left.value * a < right.value * a {
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
