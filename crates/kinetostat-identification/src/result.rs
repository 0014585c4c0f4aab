//! What an identification found, with units in the names.

use nalgebra::{DMatrix, DVector, Vector3};
use schemars::JsonSchema;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::compliance_matrix::{entry_size, index_of};
use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, ReadingOf, by_posture};
use crate::findings::{Finding, exchanged_markers, findings, scale};
use crate::fit::{Fit, FitOptions, identify};
use crate::geometry::is_geometry;
use crate::identifiability::{Identifiability, Knowledge};
use crate::identified::{DirectionResiduals, IdentifiedNumber, PostureResiduals};
use crate::unknown::{Form, Unknown, Unknowns};

/// Result of an identification.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Identification {
    /// Number of postures.
    pub postures: usize,
    /// Number of readings.
    pub readings: usize,
    /// Combinations of the numbers that the readings see.
    pub rank: usize,
    /// Readings less the rank.
    pub degrees_of_freedom: usize,
    /// Scatter about the fit, in stated standard deviations.
    pub sigma_factor: f64,
    /// Root mean square of the readings of lengths, mm; of a place its distance from where the model as it was has it.
    pub rms_reading_mm: f64,
    /// Root mean square of what the model as it was leaves of them, mm.
    pub rms_before_mm: f64,
    /// The same for the identified model.
    pub rms_after_mm: f64,
    /// The same, each posture predicted by a fit to all others; null where these do not determine it.
    pub rms_left_out_mm: Option<f64>,
    /// Steps of the fit.
    pub steps: usize,
    /// The numbers.
    pub numbers: Vec<IdentifiedNumber>,
    /// Covariance of the numbers in their units, in their order.
    pub covariance: Vec<Vec<f64>>,
    /// Residuals posture by posture.
    pub residuals: Vec<PostureResiduals>,
    /// Residuals of the displacements along the axes of the base.
    pub directions: Vec<DirectionResiduals>,
    /// What must be known.
    pub findings: Vec<Finding>,
    /// Fits to resampled postures between which the intervals lie; 0 where these are Student's.
    pub resamples: usize,
    /// The fit itself.
    #[serde(skip)]
    pub(crate) fit: Fit,
    /// Covariance of its unknowns, SI.
    #[serde(skip)]
    pub(crate) covariance_in_si: DMatrix<f64>,
    /// Readings far from the fit count less.
    #[serde(skip)]
    pub(crate) robust: bool,
}

/// Identifies numbers of a model and says how well they are known.
///
/// # Errors
/// As [`identify`].
pub fn identification(
    unknowns: &Unknowns,
    observations: &[Observation],
    options: &FitOptions,
) -> Result<Identification, IdentificationError> {
    let fit = identify(unknowns, observations, options)?;
    let seen = Identifiability::of(&fit.postures, &unknowns.sizes());
    let covariance = covariance(&fit);
    let deviations = covariance.diagonal().map(|v| v.max(0.0).sqrt());
    let estimate = &fit.linear.estimate;
    // Numbers of a matrix are compared with its diagonal, those of geometry with 1 mm or 1 mrad, all others with themselves.
    let sizes = DVector::from_fn(estimate.len(), |i, _| match unknowns.list()[i].form {
        Form::MatrixEntry(..) | Form::Geometry | Form::Marker(..) => unknowns.list()[i].size,
        _ => estimate[i].abs(),
    });
    let knowledge = seen.knowledge(&deviations.component_div(&sizes));
    let in_file = unknowns.in_file(estimate);
    let slopes = unknowns.slopes_in_file(estimate);
    let in_units = &slopes * &covariance * slopes.transpose();
    let quantile = student_95(fit.names.len(), fit.linear.degrees_of_freedom());
    let number = |(i, unknown): (usize, &Unknown)| {
        let own = || estimate[i] / unknown.parameter.in_si;
        let value = in_file.get(i).copied().unwrap_or_else(own);
        let deviation = in_units[(i, i)].max(0.0).sqrt();
        let relative = match unknown.form {
            Form::MatrixEntry(row, column) => {
                deviation / size_in_file(unknowns, i, row, column, &in_file)
            }
            _ => deviations[i] / sizes[i],
        };
        let is_seen = knowledge[i] != Knowledge::Unseen;
        let is_entry = matches!(unknown.form, Form::MatrixEntry(..));
        let at_bound = fit.linear.at_bound.contains(&i);
        let is_zero = at_bound && !is_entry;
        // What no reading sees is as sure as it was believed to be.
        let is_known = (is_seen || fit.prior.is_some()) && !is_zero;
        let of_known = |x: f64| Some(x).filter(|x| is_known && x.is_finite());
        let is_possible = unknown.form != Form::Compliance || estimate[i] > 0.0;
        IdentifiedNumber {
            number: unknown.parameter.path.clone(),
            unit: unknown.parameter.unit.to_owned(),
            before: unknown.parameter.value,
            identified: Some(value).filter(|x| x.is_finite() && is_possible),
            deviation_percent: of_known(100.0 * relative)
                .filter(|_| !is_geometry(&unknown.parameter.path)),
            deviation: of_known(deviation),
            interval: (is_seen && !is_entry && !is_zero)
                .then(|| interval(unknown, estimate[i], quantile * deviations[i])),
            at_bound,
            is_of_model: unknown.form.is_of_model(),
            acts_beside_joints: unknown.form == Form::Parallel,
            knowledge: knowledge[i],
            explains_mm: 0.0,
            known_combination: match is_seen {
                true => None,
                false => combination_of(i, &seen, unknowns),
            },
        }
    };
    let mut numbers: Vec<IdentifiedNumber> =
        unknowns.list().iter().enumerate().map(number).collect();
    let left_out = fit.linear.left_out(&fit.postures);
    let rms = |r: &DVector<f64>| (r.norm_squared() / r.len() as f64).sqrt();
    let residuals: Vec<PostureResiduals> = (0..fit.names.len())
        .map(|i| PostureResiduals {
            posture: fit.names[i].clone(),
            readings: fit.postures[i].values.len(),
            before: rms(&fit.before[i]),
            after: rms(&fit.linear.residuals[i]),
            left_out: left_out[i].as_ref().map(rms),
        })
        .collect();
    let lengths = Lengths::of(observations);
    for (k, number) in numbers.iter_mut().enumerate() {
        let unknown = &unknowns.list()[k];
        // A spring moves the tool by all of its compliance, a length by its change.
        let change = match unknown.form {
            Form::Compliance | Form::MatrixEntry(..) | Form::Parallel => estimate[k],
            _ => estimate[k] - unknown.nominal,
        };
        let own = fit.postures.iter().map(|p| p.rows.column(k) * change);
        number.explains_mm = lengths.rms(&own.collect::<Vec<_>>());
    }
    let mut findings = findings(&numbers, &residuals, &fit.linear);
    findings.extend(exchanged_markers(&fit, observations));
    findings.splice(
        0..0,
        fit.gauge.as_ref().map(|gauge| Finding::Geometry {
            numbers: gauge.numbers,
            directions: gauge.directions,
        }),
    );
    findings.splice(0..0, scale(&fit));
    Ok(Identification {
        postures: fit.names.len(),
        readings: fit.postures.iter().map(|p| p.values.len()).sum(),
        rank: fit.linear.rank,
        degrees_of_freedom: fit.linear.degrees_of_freedom(),
        sigma_factor: fit.linear.sigma_factor(),
        rms_reading_mm: lengths.rms(&fit.readings),
        rms_before_mm: lengths.rms(&fit.before),
        rms_after_mm: lengths.rms(&fit.linear.residuals),
        rms_left_out_mm: left_out
            .iter()
            .cloned()
            .collect::<Option<Vec<_>>>()
            .map(|all| lengths.rms(&all)),
        steps: fit.steps,
        covariance: rows_of(&in_units),
        directions: lengths.directions(&fit),
        numbers,
        residuals,
        findings,
        resamples: 0,
        covariance_in_si: covariance,
        robust: options.robust,
        fit,
    })
}

/// The covariance by postures where there are more of them than numbers, else that of independent readings that scatter as about the
/// fit.
fn covariance(fit: &Fit) -> DMatrix<f64> {
    let factor = fit.linear.sigma_factor().max(1.0);
    let independent = &fit.linear.normal_inverse * (factor * factor);
    let enough = fit.names.len() > fit.linear.rank;
    match fit
        .linear
        .covariance_by_postures(&fit.postures, fit.prior.as_ref())
        .filter(|_| enough)
    {
        Some(by_postures) => by_postures,
        None => independent,
    }
}

fn rows_of(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// Size of an entry of an identified stiffness matrix, in the unit of the entry.
fn size_in_file(unknowns: &Unknowns, at: usize, row: usize, column: usize, in_file: &[f64]) -> f64 {
    let in_si = |k: usize| unknowns.list()[k].parameter.in_si;
    let first = at - index_of(row, column);
    let size = entry_size(row, column, |k| {
        let own = first + index_of(k, k);
        in_file[own] * in_si(own)
    });
    size / in_si(at)
}

/// Quantile of Student's distribution for a confidence of 95 %: postures are what is independent, and few of them are less sure.
pub(crate) fn student_95(postures: usize, degrees_of_freedom: usize) -> f64 {
    let freedom = (postures.saturating_sub(1)).min(degrees_of_freedom).max(1);
    StudentsT::new(0.0, 1.0, freedom as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975))
}

/// Bounds of a number, in its unit, for its estimate and how far it may be off.
fn interval(unknown: &Unknown, estimate: f64, off: f64) -> [Option<f64>; 2] {
    let in_si = unknown.parameter.in_si;
    let (low, high) = (estimate - off, estimate + off);
    match unknown.form {
        // The stiffness is largest where the compliance is least.
        Form::Compliance => {
            [high, low].map(|compliance| (compliance > 0.0).then(|| 1.0 / (compliance * in_si)))
        }
        _ => [Some(low / in_si), Some(high / in_si)],
    }
}

/// `A + 0.5 B`, compliances relative to those of the model.
fn combination_of(unknown: usize, seen: &Identifiability, unknowns: &Unknowns) -> Option<String> {
    let combination = seen
        .combinations
        .iter()
        .find(|c| c.parts.iter().any(|(i, _)| *i == unknown))?;
    let part = |(i, factor): &(usize, f64)| {
        let path = &unknowns.list()[*i].parameter.path;
        match (factor - 1.0).abs() < 1e-6 {
            true => path.clone(),
            false => format!("{factor:.3} {path}"),
        }
    };
    const SHOWN: usize = 6;
    let mut parts: Vec<String> = combination.parts.iter().take(SHOWN).map(part).collect();
    if combination.parts.len() > SHOWN {
        parts.push(format!("{} more", combination.parts.len() - SHOWN));
    }
    Some(parts.join(" + "))
}

/// Which rows are lengths: the standard deviation of each, m, and along what it was read.
struct Lengths(Vec<Vec<Option<Length>>>);

struct Length {
    deviation: f64,
    along: Vector3<f64>,
}

/// Cosine of the angle between a reading and the axis along which it counts, at least.
const ALONG: f64 = 0.9;

impl Lengths {
    fn of(observations: &[Observation]) -> Self {
        let length = |reading: &Reading| match reading.of {
            ReadingOf::Along(along) | ReadingOf::Place(along) => Some(Length {
                deviation: reading.deviation,
                along,
            }),
            ReadingOf::About(_) => None,
        };
        let own = |(_, members): (&str, Vec<usize>)| {
            let readings = members.iter().flat_map(|m| &observations[*m].readings);
            readings.map(length).collect()
        };
        Self(by_posture(observations).into_iter().map(own).collect())
    }

    /// Root mean square of the lengths among numbers in standard deviations, mm.
    fn rms(&self, in_deviations: &[DVector<f64>]) -> f64 {
        self.rms_where(in_deviations, |_| true).unwrap_or(0.0)
    }

    /// The same over some of the lengths; none where there are none.
    fn rms_where(
        &self,
        in_deviations: &[DVector<f64>],
        counts: impl Fn(&Length) -> bool,
    ) -> Option<f64> {
        let mut sum = 0.0;
        let mut count = 0;
        for (own, lengths) in in_deviations.iter().zip(&self.0) {
            for (x, length) in own.iter().zip(lengths) {
                if let Some(length) = length.as_ref().filter(|l| counts(l)) {
                    sum += (x * length.deviation).powi(2);
                    count += 1;
                }
            }
        }
        (count > 0).then(|| 1e3 * (sum / f64::from(count)).sqrt())
    }

    /// Residuals along each axis of the base along which something was read.
    fn directions(&self, fit: &Fit) -> Vec<DirectionResiduals> {
        let each = ["x", "y", "z"].into_iter().enumerate();
        each.filter_map(|(k, axis)| {
            let of = |all: &[DVector<f64>]| self.rms_where(all, |l| l.along[k].abs() > ALONG);
            Some(DirectionResiduals {
                axis: axis.to_owned(),
                reading_mm: of(&fit.readings)?,
                before_mm: of(&fit.before)?,
                after_mm: of(&fit.linear.residuals)?,
            })
        })
        .collect()
    }
}
