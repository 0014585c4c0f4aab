//! What an identification found, with units in the names.

use std::fmt;

use kinetostat_model::{Model, NumberEdit};
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::IdentificationError;
use crate::experiment::Observation;
use crate::fit::{Fit, FitOptions, identify};
use crate::identifiability::{Identifiability, Knowledge};
use crate::least_squares::{LinearFit, SCATTER};
use crate::unknown::{Form, Unknown, Unknowns};

/// A number of the model as it was identified.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct IdentifiedNumber {
    /// Path of the number in the model file.
    pub number: String,
    /// Unit of its key; empty without one.
    pub unit: String,
    /// What the model said.
    pub before: f64,
    /// What the readings say; null where its compliance vanishes.
    pub identified: Option<f64>,
    /// Standard deviation relative to the value, percent; of a stiffness that of its compliance. Null where nothing is known.
    pub deviation_percent: Option<f64>,
    /// Bounds with a confidence of 95 %; the upper one of a stiffness is null where it may be rigid.
    pub interval: Option<[Option<f64>; 2]>,
    /// It is zero, its bound: the compliance of a spring that the readings do not tell from rigid.
    pub at_bound: bool,
    /// A number of the model file; friction is none.
    pub is_of_model: bool,
    /// A spring that acts as a load beside the joints (a gravity compensator).
    pub acts_beside_joints: bool,
    /// How well the readings know it.
    pub knowledge: Knowledge,
    /// The combination that is known where the number alone is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known_combination: Option<String>,
}

/// Readings of one posture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PostureResiduals {
    /// Name.
    pub posture: String,
    /// Readings.
    pub readings: usize,
    /// Root mean square of what was read less what the model as it was says, in standard deviations.
    pub before: f64,
    /// The same for the identified model.
    pub after: f64,
    /// The same for a model identified from all other postures; null where these do not determine it.
    pub left_out: Option<f64>,
}

/// Something that a reader of the result must know.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "finding", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// No reading sees a number alone.
    Unseen {
        /// Path of the number.
        number: String,
        /// The combination that is seen, if it takes part in one.
        known: Option<String>,
    },
    /// Noise hides a number.
    Weak {
        /// Path of the number.
        number: String,
        /// Its standard deviation, percent.
        deviation_percent: f64,
    },
    /// A spring beside the joints came out without stiffness.
    Absent {
        /// Path of the number.
        number: String,
    },
    /// A compliance came out at zero, its bound: the readings do not tell it from rigid.
    Rigid {
        /// Path of the number.
        number: String,
    },
    /// A posture that fits far worse than the others.
    Outlier {
        /// Name of the posture.
        posture: String,
        /// Its residual against the fit to all others, in those of the median posture.
        times: f64,
    },
    /// Readings scatter more about the fit than they should.
    Scatter {
        /// Standard deviation about the fit, in stated ones.
        times: f64,
    },
    /// Nothing is left to tell how well the model fits.
    NoRedundancy,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unseen {
                number,
                known: None,
            } => write!(
                f,
                "{number}: no reading depends on it; it keeps the value of the model"
            ),
            Self::Unseen {
                number,
                known: Some(known),
            } => {
                write!(
                    f,
                    "{number}: not seen alone, only in {known}; its own value is the one nearest to the model"
                )
            }
            Self::Weak {
                number,
                deviation_percent,
            } => write!(
                f,
                "{number}: weakly known, to {deviation_percent:.0} %; load the machine so that more of the deflection comes from it, or read more often"
            ),
            Self::Absent { number } => write!(
                f,
                "{number}: the readings do not tell it from none; the force of such a spring shows in absolute positions and torques, hardly in how stiff the machine is"
            ),
            Self::Rigid { number } => write!(
                f,
                "{number}: the readings do not tell it from rigid; with less than no compliance they would fit still better, so that noise hides it, or another part that yields is missing in the model"
            ),
            Self::Outlier { posture, times } => write!(
                f,
                "posture '{posture}' is {times:.1} times as far from the fit to all others as the median posture: look at its joints, load and markers, or use --robust"
            ),
            Self::Scatter { times } => write!(
                f,
                "the readings scatter {times:.1} times as much about the fit as their standard deviations say: the model lacks something that yields, or the readings are less exact than stated; all deviations here are {times:.1} times larger for it"
            ),
            Self::NoRedundancy => write!(
                f,
                "there are as many unknowns as readings: nothing tells how well the model fits"
            ),
        }
    }
}

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
    /// Root mean square of the readings of lengths, mm.
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
    /// Covariance of the numbers relative to their values, in their order: of compliances where numbers are stiffnesses.
    pub relative_covariance: Vec<Vec<f64>>,
    /// Residuals posture by posture.
    pub residuals: Vec<PostureResiduals>,
    /// What must be known.
    pub findings: Vec<Finding>,
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
    let knowledge = seen.knowledge(&fit.linear, &deviations);
    let in_file = unknowns.in_file(&fit.linear.estimate);
    let numbers: Vec<IdentifiedNumber> = unknowns
        .list()
        .iter()
        .enumerate()
        .map(|(i, unknown)| {
            let known = knowledge[i];
            let combination = (known == Knowledge::Unseen)
                .then(|| combination_of(i, &seen, unknowns))
                .flatten();
            let number = number_of(
                unknown,
                fit.linear.estimate[i],
                in_file.get(i).copied().unwrap_or(fit.linear.estimate[i]),
                deviations[i],
                known,
            );
            let at_bound = fit.linear.at_bound.contains(&i);
            let is_zero = at_bound && !matches!(unknown.form, Form::MatrixEntry(..));
            IdentifiedNumber {
                at_bound,
                known_combination: combination,
                deviation_percent: number.deviation_percent.filter(|_| !is_zero),
                interval: number.interval.filter(|_| !is_zero),
                ..number
            }
        })
        .collect();
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
    let lengths = Lengths::of(&fit, observations);
    let findings = findings(&numbers, &residuals, &fit.linear);
    let estimate = &fit.linear.estimate;
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
        relative_covariance: relative(&covariance, estimate),
        numbers,
        residuals,
        findings,
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
        .covariance_by_postures(&fit.postures)
        .filter(|_| enough)
    {
        Some(by_postures) => by_postures,
        None => independent,
    }
}

fn relative(covariance: &DMatrix<f64>, estimate: &DVector<f64>) -> Vec<Vec<f64>> {
    let n = estimate.len();
    let entry = |i: usize, j: usize| covariance[(i, j)] / (estimate[i] * estimate[j]);
    (0..n)
        .map(|i| (0..n).map(|j| entry(i, j)).collect())
        .collect()
}

/// Quantile of the normal distribution for a confidence of 95 %.
const NORMAL_95: f64 = 1.959_963_984_540_054;

fn number_of(
    unknown: &Unknown,
    estimate: f64,
    in_file: f64,
    deviation: f64,
    knowledge: Knowledge,
) -> IdentifiedNumber {
    let unseen = knowledge == Knowledge::Unseen;
    let in_si = unknown.parameter.in_si;
    let (low, high) = (
        estimate - NORMAL_95 * deviation,
        estimate + NORMAL_95 * deviation,
    );
    let interval = match unknown.form {
        // The stiffness is largest where the compliance is least.
        Form::Compliance => [
            (high > 0.0).then(|| 1.0 / (high * in_si)),
            (low > 0.0).then(|| 1.0 / (low * in_si)),
        ],
        _ => [Some(low / in_si), Some(high / in_si)],
    };
    let is_entry = matches!(unknown.form, Form::MatrixEntry(..));
    let size = if is_entry {
        unknown.size
    } else {
        estimate.abs()
    };
    IdentifiedNumber {
        number: unknown.parameter.path.clone(),
        unit: unknown.parameter.unit.to_owned(),
        before: unknown.parameter.value,
        identified: Some(in_file)
            .filter(|x| x.is_finite() && (unknown.form != Form::Compliance || estimate > 0.0)),
        deviation_percent: (!unseen)
            .then_some(100.0 * deviation / size)
            .filter(|x| x.is_finite()),
        interval: (!unseen && !is_entry).then_some(interval),
        at_bound: false,
        is_of_model: unknown.form != Form::Friction,
        acts_beside_joints: unknown.form == Form::Parallel,
        knowledge,
        known_combination: None,
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

/// Residual of a posture against those of the median above which it is named.
const FAR: f64 = 4.0;

fn findings(
    numbers: &[IdentifiedNumber],
    residuals: &[PostureResiduals],
    fit: &LinearFit,
) -> Vec<Finding> {
    let mut out = Vec::new();
    for number in numbers {
        let name = || number.number.clone();
        match (
            number.knowledge,
            number.identified,
            number.deviation_percent,
        ) {
            (Knowledge::Unseen, ..) => out.push(Finding::Unseen {
                number: name(),
                known: number.known_combination.clone(),
            }),
            _ if number.at_bound && number.acts_beside_joints => {
                out.push(Finding::Absent { number: name() })
            }
            _ if number.at_bound => out.push(Finding::Rigid { number: name() }),
            (Knowledge::Weak, _, Some(deviation_percent)) => out.push(Finding::Weak {
                number: name(),
                deviation_percent,
            }),
            _ => {}
        }
    }
    let of_posture = |r: &PostureResiduals| r.left_out.unwrap_or(r.after);
    let mut sorted: Vec<f64> = residuals.iter().map(of_posture).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    // Two postures have no median to speak of, and rounding is no outlier.
    let tells = residuals.len() >= 4 && median > 1e-6;
    let outliers = residuals
        .iter()
        .filter(|r| tells && of_posture(r) > FAR * median);
    out.extend(outliers.map(|r| Finding::Outlier {
        posture: r.posture.clone(),
        times: of_posture(r) / median,
    }));
    match fit.degrees_of_freedom() {
        0 => out.push(Finding::NoRedundancy),
        _ if fit.sigma_factor() > SCATTER => out.push(Finding::Scatter {
            times: fit.sigma_factor(),
        }),
        _ => {}
    }
    out
}

/// Which rows are lengths, and the standard deviation of each, m.
struct Lengths(Vec<Vec<Option<f64>>>);

impl Lengths {
    fn of(fit: &Fit, observations: &[Observation]) -> Self {
        let mut by_name: Vec<Vec<Option<f64>>> = vec![Vec::new(); fit.names.len()];
        for observation in observations {
            let Some(at) = fit.names.iter().position(|n| *n == observation.posture) else {
                continue;
            };
            by_name[at].extend(observation.readings.iter().map(|r| match r.of {
                crate::experiment::ReadingOf::Along(_) => Some(r.deviation),
                crate::experiment::ReadingOf::About(_) => None,
            }));
        }
        Self(by_name)
    }

    /// Root mean square of the lengths among numbers in standard deviations, mm.
    fn rms(&self, in_deviations: &[DVector<f64>]) -> f64 {
        let mut sum = 0.0;
        let mut count = 0;
        for (own, deviations) in in_deviations.iter().zip(&self.0) {
            for (x, deviation) in own.iter().zip(deviations) {
                if let Some(deviation) = deviation {
                    sum += (x * deviation).powi(2);
                    count += 1;
                }
            }
        }
        1e3 * (sum / f64::from(count.max(1))).sqrt()
    }
}

/// The model with the identified numbers, each with its source.
///
/// # Errors
/// Numbers with which the model would be refused.
pub fn identified_model(
    model: &Model,
    found: &Identification,
    source: &str,
) -> Result<Model, IdentificationError> {
    let edit = |n: &IdentifiedNumber| {
        if !n.is_of_model {
            return None;
        }
        let words = match n.deviation_percent {
            Some(percent) => format!("identified from {source}, standard deviation {percent:.2} %"),
            None if n.at_bound => format!("identified from {source}: not told from rigid"),
            None => return None,
        };
        Some(NumberEdit {
            path: n.number.clone(),
            value: n.identified?,
            source: Some(words),
        })
    };
    let edits: Vec<NumberEdit> = found.numbers.iter().filter_map(edit).collect();
    Ok(model.edited(&edits)?)
}

/// Relative standard deviation beyond which a normal distribution has machines with negative stiffness among thousands.
const WIDEST: f64 = 0.24;

/// The uncertainty of the identified numbers as a file for `tolerance` and for bands of compensated programs.
#[must_use]
pub fn uncertainty_file(found: &Identification, source: &str) -> String {
    let is_wide = |i: usize| found.relative_covariance[i][i].max(0.0).sqrt() > WIDEST;
    let seen: Vec<usize> = (0..found.numbers.len())
        .filter(|i| {
            found.numbers[*i].is_of_model
                && found.numbers[*i].knowledge != Knowledge::Unseen
                && found.numbers[*i].identified.is_some()
        })
        .collect();
    let (wide, known): (Vec<usize>, Vec<usize>) = seen.into_iter().partition(|i| is_wide(*i));
    let mut out = format!(
        "# Standard deviations and correlations of the numbers that were identified from {source}.\nschema = 1\n"
    );
    for i in wide {
        let percent = 100.0 * found.relative_covariance[i][i].sqrt();
        out += &format!(
            "# {} is known to {percent:.0} % only: no normal distribution of a stiffness is that wide, so it does not vary here.\n",
            found.numbers[i].number
        );
    }
    for i in &known {
        let number = &found.numbers[*i];
        let deviation = number.identified.unwrap_or(0.0).abs()
            * found.relative_covariance[*i][*i].max(0.0).sqrt();
        out += &format!(
            "\n[[uncertain]]\nparameter = {:?}\nnormal = {deviation:e} # {}\n",
            number.number, number.unit
        );
    }
    for (k, i) in known.iter().enumerate() {
        for j in &known[..k] {
            let root =
                (found.relative_covariance[*i][*i] * found.relative_covariance[*j][*j]).sqrt();
            let coefficient = found.relative_covariance[*i][*j] / root;
            if coefficient.abs() > 1e-3 {
                let (one, other) = (&found.numbers[*j].number, &found.numbers[*i].number);
                out += &format!(
                    "\n[[correlation]]\nbetween = [{one:?}, {other:?}]\ncoefficient = {coefficient:.6}\n"
                );
            }
        }
    }
    out
}
