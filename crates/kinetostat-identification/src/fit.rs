//! The fit: Gauss-Newton steps, each a linear least squares, from the model's own numbers.

use kinetostat::number::larger;
use nalgebra::{DMatrix, DVector};

use crate::error::IdentificationError;
use crate::experiment::{Observation, by_posture};
use crate::gauge::Gauge;
use crate::least_squares::{HUBER, LinearFit, PostureRows, Start, fit};
use crate::prediction::{Prediction, Theory, predict};
use crate::unknown::Unknowns;

/// Choices of a fit.
#[derive(Clone, Copy, Debug)]
pub struct FitOptions {
    /// How readings are predicted.
    pub theory: Theory,
    /// Readings far from the fit count less (Huber).
    pub robust: bool,
    /// Standard deviation of what the model says of the unknowns, relative to their sizes; none where nothing is believed of it.
    pub prior: Option<f64>,
}

/// The fit to all readings.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The last linear fit: estimate, covariance, residuals by posture.
    pub linear: LinearFit,
    /// Its rows, posture by posture.
    pub postures: Vec<PostureRows>,
    /// Rows of what was believed before.
    pub prior: Option<PostureRows>,
    /// Names of the postures.
    pub names: Vec<String>,
    /// Readings of the model as it was, less what was read, in standard deviations, posture by posture.
    pub before: Vec<DVector<f64>>,
    /// The readings themselves, in standard deviations, posture by posture; of a place the distance from where the model as it was has it.
    pub readings: Vec<DVector<f64>>,
    /// Steps.
    pub steps: usize,
    /// Directions of the geometry that are free; none where no place was read, or nothing of the geometry is asked for.
    pub gauge: Option<Gauge>,
}

/// Most steps of the fit; four are usual.
const MOST_STEPS: usize = 50;
/// Largest change of a number, relative to its size, at which the fit has settled.
const SETTLED: f64 = 1e-10;

/// Largest change of a reading, in its standard deviations, at which the fit has settled.
const UNNOTICED: f64 = 1e-8;

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
    let constraints = unknowns.constraints();
    let prior = options.prior.map(|share| belief(&nominal, &sizes, share));
    let start = Start {
        from: &nominal,
        sizes: &sizes,
        constraints: &constraints,
    };
    let gauge = match options.theory {
        Theory::Loaded => Gauge::of(unknowns, observations)?,
        Theory::SmallLoads => None,
    };
    let rows_at = |values: &DVector<f64>| -> Result<Vec<PostureRows>, IdentificationError> {
        let mut predictions = predict(unknowns, values, observations, options.theory)?;
        if let Some(gauge) = &gauge {
            let derivatives = predictions.iter_mut().map(|p| &mut p.derivatives);
            derivatives.for_each(|own| gauge.restrict(own));
        }
        let own = groups.iter();
        Ok(own
            .map(|(_, members)| rows(members, observations, &predictions, values))
            .collect())
    };
    let misfit = |postures: &[PostureRows], values: &DVector<f64>| -> f64 {
        let all = postures.iter().chain(prior.as_ref());
        all.map(|p| loss(&(&p.values - &p.rows * values), options.robust))
            .sum()
    };
    let mut postures = rows_at(&values)?;
    let residuals = postures.iter().map(|p| &p.values - &p.rows * &values);
    let before: Vec<DVector<f64>> = residuals.collect();
    if gauge.is_some() {
        refuse_far_places(&groups, observations, &before)?;
    }
    let mut change = f64::NAN;
    for steps in 1..=MOST_STEPS {
        let with_prior: Vec<PostureRows> = postures.iter().chain(prior.as_ref()).cloned().collect();
        let mut linear = fit(&with_prior, &start, options.robust)?;
        if let Some(gauge) = gauge.as_ref().filter(|_| prior.is_none()) {
            gauge.hold(&mut linear, &nominal);
        }
        let next = unknowns.buildable(&linear.estimate);
        change = (&next - &values).component_div(&sizes).amax();
        let step = &next - &values;
        // What the readings do not see may go on changing in its last digits.
        let effects = postures.iter().map(|p| (&p.rows * &step).amax());
        let effect = effects.fold(0.0, larger);
        if change <= SETTLED * next.component_div(&sizes).amax().max(1.0) || effect <= UNNOTICED {
            linear.estimate = next;
            let readings = groups
                .iter()
                .zip(&before)
                .map(|((_, members), before)| readings(members, observations, before))
                .collect();
            return Ok(Fit {
                linear,
                postures,
                prior,
                names: groups.iter().map(|(name, _)| (*name).to_owned()).collect(),
                before,
                readings,
                steps,
                gauge,
            });
        }
        (values, postures) = downhill(&values, &next, &postures, &rows_at, &misfit)?;
    }
    let left = |p: &PostureRows| (&p.values - &p.rows * &values).norm();
    let named = groups.iter().zip(&postures);
    let farthest = named.max_by(|(_, a), (_, b)| left(a).total_cmp(&left(b)));
    Err(IdentificationError::NotConverged {
        steps: MOST_STEPS,
        change,
        posture: farthest.map_or_else(String::new, |((name, _), _)| (*name).to_owned()),
    })
}

/// Distance of a place from where the model has it beyond which it is one of another machine, unit or frame, m.
const FAR: f64 = 0.1;

fn refuse_far_places(
    groups: &[(&str, Vec<usize>)],
    observations: &[Observation],
    before: &[DVector<f64>],
) -> Result<(), IdentificationError> {
    for ((posture, members), before) in groups.iter().zip(before) {
        let readings = members.iter().flat_map(|m| &observations[*m].readings);
        for (reading, off) in readings.zip(before.iter()) {
            let distance = (off * reading.deviation).abs();
            if reading.is_place() && distance > FAR {
                return Err(IdentificationError::FarPlace {
                    posture: (*posture).to_owned(),
                    distance,
                });
            }
        }
    }
    Ok(())
}

/// Values of the unknowns, and the rows there.
type At = (DVector<f64>, Vec<PostureRows>);

/// Halvings of a step at most: where none fits better, the last one is taken, and the change tells.
const MOST_HALVINGS: usize = 12;

/// The whole step, or the first of its halves that fits better: where numbers are nearly interchangeable, a whole step leads beyond the
/// reach of the derivatives, or to a machine without an equilibrium.
fn downhill(
    from: &DVector<f64>,
    to: &DVector<f64>,
    postures: &[PostureRows],
    rows_at: &impl Fn(&DVector<f64>) -> Result<Vec<PostureRows>, IdentificationError>,
    misfit: &impl Fn(&[PostureRows], &DVector<f64>) -> f64,
) -> Result<At, IdentificationError> {
    let now = misfit(postures, from);
    let mut values = to.clone();
    for halving in 0.. {
        let found = rows_at(&values);
        let is_last = halving == MOST_HALVINGS;
        match found {
            Err(error) if is_last => return Err(error),
            Err(_) => {}
            // Rounding near the optimum is no worse fit.
            Ok(found) if is_last || misfit(&found, &values) <= now * (1.0 + 1e-9) + 1e-12 => {
                return Ok((values, found));
            }
            Ok(_) => {}
        }
        values = (values + from) * 0.5;
    }
    Ok((values, postures.to_vec()))
}

/// Squares of the residuals; of those far out (Huber) their size.
fn loss(residuals: &DVector<f64>, robust: bool) -> f64 {
    let one = |r: f64| match robust && r.abs() > HUBER {
        true => HUBER * (2.0 * r.abs() - HUBER),
        false => r * r,
    };
    residuals.iter().map(|r| one(*r)).sum()
}

/// Rows that say what is believed: each unknown is what the model says, to a share of its size.
fn belief(nominal: &DVector<f64>, sizes: &DVector<f64>, share: f64) -> PostureRows {
    let precision = sizes.map(|size| 1.0 / (share * size));
    PostureRows {
        rows: DMatrix::from_diagonal(&precision),
        values: precision.component_mul(nominal),
    }
}

/// The readings of one posture, in standard deviations.
fn readings(
    members: &[usize],
    observations: &[Observation],
    before: &DVector<f64>,
) -> DVector<f64> {
    let all = members.iter().flat_map(|m| &observations[*m].readings);
    let each = all
        .zip(before.iter())
        .map(|(r, before)| match r.is_place() {
            true => *before,
            false => r.value / r.deviation,
        });
    DVector::from_vec(each.collect())
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
