//! The largest multiplier, and what the vibration is that it stands for.

use std::f64::consts::TAU;

use nalgebra::{DVector, Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{Complex64, cis};
use crate::stability::operator::Operator;

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
