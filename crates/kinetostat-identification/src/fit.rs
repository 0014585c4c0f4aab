//! The fit: Gauss-Newton steps, each a linear least squares, from the model's own numbers.

use nalgebra::{DMatrix, DVector};

use crate::error::IdentificationError;
use crate::experiment::{Observation, by_posture};
use crate::least_squares::{LinearFit, PostureRows, fit};
use crate::prediction::{Prediction, Theory, predict};
use crate::unknown::Unknowns;

/// Choices of a fit.
#[derive(Clone, Copy, Debug)]
pub struct FitOptions {
    /// How readings are predicted.
    pub theory: Theory,
    /// Readings far from the fit count less (Huber).
    pub robust: bool,
}

/// The fit to all readings.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The last linear fit: estimate, covariance, residuals by posture.
    pub linear: LinearFit,
    /// Its rows, posture by posture.
    pub postures: Vec<PostureRows>,
    /// Names of the postures.
    pub names: Vec<String>,
    /// Readings of the model as it was, less what was read, in standard deviations, posture by posture.
    pub before: Vec<DVector<f64>>,
    /// Steps.
    pub steps: usize,
}

/// Most steps of the fit; four are usual.
const MOST_STEPS: usize = 50;
/// Largest change of a number, relative to its size, at which the fit has settled.
const SETTLED: f64 = 1e-10;

/// Identifies the unknowns from the readings.
///
/// # Errors
/// No readings; a posture without an equilibrium; no convergence.
pub fn identify(
    unknowns: &Unknowns,
    observations: &[Observation],
    options: &FitOptions,
) -> Result<Fit, IdentificationError> {
    if observations.iter().all(|o| o.readings.is_empty()) {
        return Err(IdentificationError::NoReadings);
    }
    let groups = by_posture(observations);
    let sizes = unknowns.sizes();
    let mut values = unknowns.nominal();
    let nominal = values.clone();
    let mut before = None;
    let mut change = f64::NAN;
    for steps in 1..=MOST_STEPS {
        let predictions = predict(unknowns, &values, observations, options.theory)?;
        let postures: Vec<PostureRows> = (groups.iter())
            .map(|(_, members)| rows(members, observations, &predictions, &values))
            .collect();
        let before = before.get_or_insert_with(|| {
            postures
                .iter()
                .map(|p| &p.values - &p.rows * &values)
                .collect::<Vec<_>>()
        });
        let linear = fit(&postures, &nominal, &sizes, options.robust);
        change = (&linear.estimate - &values).component_div(&sizes).amax();
        let settled = change <= SETTLED * linear.estimate.component_div(&sizes).amax().max(1.0);
        values = within_reach(&values, &linear.estimate, unknowns);
        if settled {
            return Ok(Fit {
                linear,
                postures,
                names: groups.iter().map(|(name, _)| (*name).to_owned()).collect(),
                before: before.clone(),
                steps,
            });
        }
    }
    Err(IdentificationError::NotConverged {
        steps: MOST_STEPS,
        change,
    })
}

/// A compliance on the way stays positive, so that its machine can be built: a tenth of what it was.
fn within_reach(from: &DVector<f64>, to: &DVector<f64>, unknowns: &Unknowns) -> DVector<f64> {
    DVector::from_fn(from.len(), |i, _| match unknowns.list()[i].form {
        crate::unknown::Form::Compliance if to[i] <= 0.1 * from[i] => 0.1 * from[i],
        _ => to[i],
    })
}

/// The rows of one posture, divided by the standard deviations.
fn rows(
    members: &[usize],
    observations: &[Observation],
    predictions: &[Prediction],
    at: &DVector<f64>,
) -> PostureRows {
    let count = members
        .iter()
        .map(|m| observations[*m].readings.len())
        .sum();
    let mut rows = DMatrix::zeros(count, at.len());
    let mut values = DVector::zeros(count);
    let mut i = 0;
    for member in members {
        let prediction = &predictions[*member];
        for (k, reading) in observations[*member].readings.iter().enumerate() {
            let weight = 1.0 / reading.deviation;
            rows.row_mut(i)
                .copy_from(&(prediction.derivatives.row(k) * weight));
            values[i] = weight * (reading.value - prediction.values[k]);
            i += 1;
        }
    }
    let values = values + &rows * at;
    PostureRows { rows, values }
}
