//! The largest multiplier, the vibration that it stands for, and the depths between which a cut is stable.

use std::f64::consts::TAU;

use nalgebra::{DVector, Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{Complex64, cis};
use crate::stability::operator::Operator;
use crate::stability::swinging::LeftOut;

/// Type of a cut's instability.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Instability {
    /// The multiplier is -1: the tool repeats itself every other tooth, chatter at odd multiples of half the tooth frequency.
    Flip,
    /// A pair of complex multipliers (secondary Hopf): chatter at a frequency of its own.
    Hopf,
}

/// The largest multiplier of one period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Multiplier {
    /// Real part.
    pub real: f64,
    /// Imaginary part, not negative.
    pub imaginary: f64,
    /// Type of the instability where it leaves the unit circle.
    pub kind: Instability,
    /// Strongest frequency of this vibration at the tool, Hz.
    pub frequency_hz: f64,
}

impl Multiplier {
    /// Modulus: below 1 the cut is stable, and a disturbance shrinks by this factor with each tooth.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.real.hypot(self.imaginary)
    }

    pub(crate) fn new(
        value: Complex64,
        vector: &DVector<Complex64>,
        operator: &Operator<'_>,
        depth: f64,
        receptance: &dyn Fn(f64) -> Matrix3<Complex64>,
    ) -> Self {
        let flip = value.re < 0.0 && value.im.abs() <= 1e-7 * value.norm();
        Self {
            real: value.re,
            imaginary: value.im.abs(),
            kind: match flip {
                true => Instability::Flip,
                false => Instability::Hopf,
            },
            frequency_hz: strongest(value, vector, operator, depth, receptance),
        }
    }
}

/// The frequency at which the tool moves most: `(arg mu + 2 pi k)/tau`, of all k the one with the largest displacement.
fn strongest(
    value: Complex64,
    vector: &DVector<Complex64>,
    operator: &Operator<'_>,
    depth: f64,
    receptance: &dyn Fn(f64) -> Matrix3<Complex64>,
) -> f64 {
    let period = operator.period;
    let states = 2 * period.states.len();
    // Chips of the eigenvector: its displacements less those of one period before. One period later it is `value` times itself.
    let chips = vector.rows(states, vector.len() - states) * (Complex64::from(1.0) - value.inv());
    let fastest = period.states.iter().map(|state| state.root.im);
    let fastest = fastest.fold(0.0, crate::number::larger);
    let most = (1.5 * fastest * period.delay / TAU).ceil() as i64 + 1;
    let mut best = (0.0, 0.0);
    for k in -most..=most {
        let frequency = (value.arg() + TAU * k as f64) / period.delay;
        let mut force = Vector3::from_element(Complex64::default());
        let mut at = 0;
        for cutting in period
            .stretches
            .iter()
            .filter_map(|stretch| stretch.cutting.as_ref())
        {
            for (i, factors) in cutting.factors.iter().enumerate() {
                // Growth over the period does not belong to the frequency.
                let growth = value.norm().powf(-cutting.times[i] / period.delay);
                let turned = cis(-frequency * cutting.times[i]) * growth * cutting.weights[i];
                for (pushed, _) in factors {
                    let share = chips[at] * turned * depth;
                    force += pushed.map(|entry| share * entry);
                    at += 1;
                }
            }
        }
        let moved = (receptance(frequency) * force).norm();
        if moved > best.0 {
            best = (moved, frequency.abs());
        }
    }
    best.1 / TAU
}

/// A depth at which the cut becomes unstable or stable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Crossing {
    /// Depth of cut, m.
    pub depth: f64,
    /// True if the cut is unstable above it.
    pub unstable_above: bool,
    /// Type of the instability.
    pub kind: Instability,
    /// Strongest frequency of the vibration there, Hz.
    pub frequency_hz: f64,
    /// The multiplier there, real and imaginary part.
    pub multiplier: (f64, f64),
    /// Relative change of the depth when the points of collocation were last increased by a third.
    pub resolved: f64,
}

/// Stability of a cut at one spindle speed, from depth 0 to a largest depth.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct SpeedStability {
    /// Spindle speed, rpm.
    pub speed_rpm: f64,
    /// Largest depth that was looked at, m.
    pub up_to: f64,
    /// Changes of stability, from the smallest depth upwards; the first is the limit.
    pub crossings: Vec<Crossing>,
    /// Frequency of the fastest mode that swings in the calculation, Hz; those above are springs.
    pub modes_up_to_hz: f64,
    /// Mode with the largest share among those treated as springs although they contribute ([`crate::Swinging`]).
    pub left_out: Option<LeftOut>,
}

impl SpeedStability {
    /// The smallest depth at which the cut becomes unstable; `None` where it is stable up to the largest depth.
    #[must_use]
    pub fn limit(&self) -> Option<&Crossing> {
        self.crossings.first()
    }

    /// All stretches of depth in which the cut is stable, m: those above the first are islands.
    #[must_use]
    pub fn stable(&self) -> Vec<(f64, f64)> {
        let mut all = Vec::new();
        let mut from = Some(0.0);
        for crossing in &self.crossings {
            match (from, crossing.unstable_above) {
                (Some(low), true) => {
                    all.push((low, crossing.depth));
                    from = None;
                }
                (None, false) => from = Some(crossing.depth),
                _ => {}
            }
        }
        all.extend(from.map(|low| (low, self.up_to)));
        all
    }

    /// True if a depth, m, is stable; `None` beyond the searched depths.
    #[must_use]
    pub fn is_stable(&self, depth: f64) -> Option<bool> {
        let within = (0.0..=self.up_to).contains(&depth);
        let inside = |(low, high): &(f64, f64)| *low <= depth && depth < *high;
        within.then(|| self.stable().iter().any(inside))
    }
}
