//! The answer of `frf`, stable names with units.

use kinetostat_dynamics::Receptance;
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::frf::arguments::{AXES, QuantityWord};
use crate::frf::fit::FitAnswer;
use crate::place::query::AnswerHead;

#[derive(Serialize, JsonSchema)]
pub(crate) struct FrfAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) hold: Option<String>,
    /// Damping in words.
    pub(crate) damping: String,
    /// `modes`, or `direct` where damping couples modes or loads have no potential.
    pub(crate) solution: &'static str,
    pub(crate) quantity: &'static str,
    /// Undamped natural frequencies, signed; where loads have no potential those of complex pairs; ascending.
    pub(crate) natural_frequencies_hz: Vec<f64>,
    /// Growth of each of these pairs, positive where it grows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) natural_growth_per_s: Option<Vec<f64>>,
    pub(crate) frequencies_hz: Vec<f64>,
    pub(crate) curves: Vec<Curve>,
    /// Names of the measured responses that are drawn beside them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) measured: Vec<String>,
    /// Modes that were found in them, beside those of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) fit: Option<FitAnswer>,
    pub(crate) warnings: Vec<Warning>,
}

/// One entry over the frequency.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Curve {
    /// Motion of the tip, base axes.
    pub(crate) to: &'static str,
    /// Force or moment on the tip, base axes.
    pub(crate) from: &'static str,
    pub(crate) unit: String,
    pub(crate) real: Vec<f64>,
    pub(crate) imaginary: Vec<f64>,
    /// Largest magnitude, and where.
    pub(crate) peak: f64,
    pub(crate) peak_hz: f64,
}

pub(crate) fn curves(
    entries: &[(usize, usize)],
    quantity: QuantityWord,
    frequencies: &[f64],
    found: &[Receptance],
) -> Vec<Curve> {
    let one = |&(to, from): &(usize, usize)| {
        let values: Vec<_> = found.iter().map(|matrix| matrix[(to, from)]).collect();
        let mut peak_index = 0;
        for (i, value) in values.iter().enumerate() {
            if value.norm() > values[peak_index].norm() {
                peak_index = i;
            }
        }
        Curve {
            to: AXES[to],
            from: AXES[from],
            unit: unit(to, from, quantity),
            real: values.iter().map(|v| v.re).collect(),
            imaginary: values.iter().map(|v| v.im).collect(),
            peak: values.get(peak_index).map_or(f64::NAN, |v| v.norm()),
            peak_hz: frequencies.get(peak_index).copied().unwrap_or(f64::NAN),
        }
    };
    entries.iter().map(one).collect()
}

fn unit(to: usize, from: usize, quantity: QuantityWord) -> String {
    let motion = if to < 3 { "m" } else { "rad" };
    let by = if from < 3 { "N" } else { "(N m)" };
    let per = match quantity {
        QuantityWord::Receptance => "",
        QuantityWord::Mobility => "/s",
        QuantityWord::Accelerance => "/s^2",
    };
    format!("{motion}{per}/{by}")
}
