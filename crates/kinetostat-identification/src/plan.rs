//! Choice of the postures in which a machine is measured.
//!
//! Postures are drawn evenly within the limits of the joints; those that cannot be taken, leave the room or hide a marker are passed
//! over. Of the rest, with each of the loads, the set is chosen whose readings leave the least error after compensation at the test
//! poses, or the least uncertainty of the numbers ([`crate::design`]). How good it is is told against the best that any set could be.

use kinetostat::number::{larger, smaller};
use kinetostat::{Mechanism, Posture, PostureRequest, Wrench};
use kinetostat_model::Model;
use nalgebra::{DMatrix, DVector, Vector3};
use sobol_burley::sample;

use crate::axes::Axes;
use crate::design::{Criterion, DesignError, DesignSettings, evaluate, exact};
use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, TestLoad};
use crate::identifiability::Identifiability;
use crate::least_squares::PostureRows;
use crate::prediction::{Prediction, Theory, predict, predict_each};
use crate::unknown::Unknowns;

/// What the measurement is for.
#[derive(Clone, Debug)]
pub enum Purpose {
    /// Least error after compensation in these postures under these loads (test poses).
    Compensation(Vec<Observation>),
    /// Least mean variance of the numbers, relative to their sizes.
    Average,
    /// Least volume of their region of confidence.
    Determinant,
    /// Least variance of the worst combination of them.
    WorstDirection,
}

/// Room in which the tool may be measured.
#[derive(Clone, Debug, Default)]
pub struct Room {
    /// Lowest and highest place of the tool along x, y and z, m, base axes.
    pub bounds: [Option<(f64, f64)>; 3],
    /// Place of a tracker (m, base axes): every marker must be seen from it past the machine.
    pub tracker: Option<Vector3<f64>>,
}

/// A measurement to plan.
#[derive(Clone, Debug)]
pub struct PlanTask<'a> {
    /// The machine.
    pub model: &'a Model,
    /// What is to be identified.
    pub unknowns: &'a Unknowns,
    /// Loads that can be put on the tool, one at a time.
    pub loads: Vec<TestLoad>,
    /// Markers that are read, m, in the tool's frame.
    pub markers: Vec<Vector3<f64>>,
    /// Standard deviation of a reading, m.
    pub deviation: f64,
    /// Number of measurements.
    pub count: usize,
    /// Commands (m or rad) of the postures to choose from; where there are none, postures are drawn.
    pub given: Vec<Vec<f64>>,
    /// Number of postures that are drawn.
    pub candidates: usize,
    /// Other numbers draw other postures.
    pub seed: u32,
    /// Where the tool may be.
    pub room: Room,
    /// What it is for.
    pub purpose: Purpose,
    /// How readings are predicted.
    pub theory: Theory,
}

/// A posture of a plan.
#[derive(Clone, Debug)]
pub struct PlannedMeasurement {
    /// What the axes show, m or rad.
    pub shown: Vec<f64>,
    /// Place of the tool, m, base axes.
    pub position: Vector3<f64>,
    /// The load.
    pub load: TestLoad,
    /// Largest displacement of a marker that the model expects, m.
    pub expected: f64,
}

/// A plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The measurements, in an order in which neighbours are near.
    pub measurements: Vec<PlannedMeasurement>,
    /// Postures that were chosen from.
    pub candidates: usize,
    /// Postures that were passed over, because they cannot be taken, or not be seen.
    pub passed_over: usize,
    /// Value of the criterion over the best that any set of as many measurements could have, at most 1; none for the worst direction.
    pub efficiency: Option<f64>,
    /// Value of the criterion of the median of random sets, over that of the plan.
    pub gain: Option<f64>,
    /// Standard deviation that each number will have, relative to its size; none where no reading sees it.
    pub deviations: Vec<Option<f64>>,
    /// Root mean square of the error that the readings' noise leaves after compensation at the test poses, m.
    pub left_error: Option<f64>,
}

/// Trials for each candidate that is wanted; in a narrow room few postures can be taken.
const TRIALS: usize = 40;
/// Random sets with which a plan is compared.
const RANDOM_SETS: usize = 21;
/// Distance that a line of sight keeps from the machine, m.
const CLEARANCE: f64 = 0.15;
/// Length before the marker in which the line of sight is not judged: the hand, m.
const HAND: f64 = 0.5;

/// Plans a measurement.
///
/// # Errors
/// No posture that can be taken; loads that show none of the numbers; the errors of a prediction.
pub fn plan(task: &PlanTask<'_>) -> Result<Plan, PlanError> {
    let mechanism = &task.model.mechanism;
    let axes = Axes::of(task.model);
    let (postures, passed_over) = match task.given.is_empty() {
        true => drawn(task, mechanism)?,
        false => possible(task, mechanism)?,
    };
    let observations = task.observations(&postures);
    let sizes = task.unknowns.sizes();
    let nominal = task.unknowns.nominal();
    // A load under which the machine has no equilibrium cannot be chosen.
    let each = predict_each(task.unknowns, &nominal, &observations, task.theory)?;
    let possible = observations.into_iter().zip(each);
    let possible = possible.filter_map(|(o, p)| Some((o, p.ok()?)));
    let (observations, predictions): (Vec<Observation>, Vec<Prediction>) = possible.unzip();
    if predictions.is_empty() {
        return Err(PlanError::NothingSeen);
    }
    let all = sizes.len();
    let scaled = |p: &Prediction, deviation: f64| {
        DMatrix::from_fn(p.derivatives.nrows(), all, |i, j| {
            p.derivatives[(i, j)] * sizes[j] / deviation
        })
    };
    let rows = predictions.iter().map(|p| scaled(p, task.deviation));
    let rows: Vec<DMatrix<f64>> = rows.collect();
    // A number that no reading shows is no matter of choice.
    let shown = shown(&rows, all);
    if shown.is_empty() {
        return Err(PlanError::NothingSeen);
    }
    let rows: Vec<DMatrix<f64>> = rows.iter().map(|a| a.select_columns(&shown)).collect();
    let seen_alone = seen_alone(&rows, shown.len());
    let criterion = match &task.purpose {
        Purpose::Compensation(test) => {
            let predictions = predict(task.unknowns, &nominal, test, task.theory)?;
            let each = predictions
                .iter()
                .map(|p| scaled(p, 1.0).select_columns(&shown));
            mean_information(each).ok_or(IdentificationError::NoReadings)?
        }
        Purpose::Average if seen_alone.contains(&false) => of_seen(&seen_alone),
        Purpose::Average => Criterion::Average,
        Purpose::Determinant => Criterion::Determinant,
        Purpose::WorstDirection => Criterion::WorstDirection,
    };
    let none = DMatrix::zeros(shown.len(), shown.len());
    // The parts of a combination are taken to be known to their sizes, so that the rest can be planned.
    let settings = DesignSettings {
        fixed_information: (seen_alone.contains(&false))
            .then(|| DMatrix::identity(shown.len(), shown.len())),
        seed: u64::from(task.seed),
        ..DesignSettings::default()
    };
    let found = exact(&rows, &criterion, task.count.min(rows.len()), &settings)?;
    let mut information = settings.fixed_information.clone().unwrap_or(none);
    for chosen in &found.postures {
        information += rows[*chosen].tr_mul(&rows[*chosen]);
    }
    let covariance = information.try_inverse().ok_or(PlanError::NothingSeen)?;
    let mut deviations = vec![None; all];
    for (k, variance) in covariance
        .diagonal()
        .iter()
        .enumerate()
        .filter(|(k, _)| seen_alone[*k])
    {
        deviations[shown[k]] = Some(variance.max(0.0).sqrt());
    }
    let chosen = found.postures.iter();
    let chosen = chosen.map(|i| task.planned(&axes, &observations[*i], &predictions[*i]));
    let mut measurements: Vec<PlannedMeasurement> = chosen.collect();
    in_short_ways(&mut measurements);
    Ok(Plan {
        measurements,
        candidates: postures.len(),
        passed_over,
        efficiency: found.efficiency,
        gain: gain(&rows, &criterion, task, &settings, found.value),
        deviations,
        left_error: match &criterion {
            Criterion::TestPoses(l) if matches!(task.purpose, Purpose::Compensation(_)) => {
                Some((l * &covariance).trace().max(0.0).sqrt())
            }
            _ => None,
        },
    })
}

/// Reason why there is no plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Of the prediction.
    #[error(transparent)]
    Identification(#[from] IdentificationError),
    /// Of the choice.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// An actuator without limits.
    #[error(
        "joint {0} has no limits in the model, so that no postures can be drawn; write its limits"
    )]
    NoLimits(String),
    /// No posture is left.
    #[error(
        "none of {tried} postures can be taken, lies in the room and shows its markers; widen the room, or move the tracker"
    )]
    NoPosture {
        /// Number of postures that were tried.
        tried: usize,
    },
    /// No reading depends on any number.
    #[error("no reading depends on any of the numbers: load the tool in other directions")]
    NothingSeen,
}

/// Those of the given postures that can be taken, and the number of those that were passed over.
fn possible(
    task: &PlanTask<'_>,
    mechanism: &Mechanism,
) -> Result<(Vec<Vec<f64>>, usize), PlanError> {
    let is_possible = |commands: &&Vec<f64>| {
        let posture = mechanism.posture(PostureRequest::commands(commands));
        posture.is_ok_and(|p| p.within_limits().is_ok() && task.is_possible(&p))
    };
    let found: Vec<Vec<f64>> = task.given.iter().filter(is_possible).cloned().collect();
    let tried = task.given.len();
    match found.len() {
        0 => Err(PlanError::NoPosture { tried }),
        count => Ok((found, tried - count)),
    }
}

/// Commands within the limits of the actuators, and the number of those that were passed over.
fn drawn(task: &PlanTask<'_>, mechanism: &Mechanism) -> Result<(Vec<Vec<f64>>, usize), PlanError> {
    let actuators = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
    let limits: Vec<(f64, f64)> = actuators
        .zip(mechanism.actuator_names())
        .map(|(a, name)| a.limits.ok_or(PlanError::NoLimits(name)))
        .collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    let tried = TRIALS * task.candidates;
    for i in 0..tried {
        let commands: Vec<f64> = limits
            .iter()
            .enumerate()
            .map(|(d, (low, high))| {
                let share = f64::from(sample(
                    i as u32 % (1 << 16),
                    d as u32,
                    task.seed.wrapping_add((i >> 16) as u32),
                ));
                low + share * (high - low)
            })
            .collect();
        let Ok(posture) = mechanism.posture(PostureRequest::commands(&commands)) else {
            continue;
        };
        if task.is_possible(&posture) {
            found.push(commands);
        }
        if found.len() == task.candidates {
            return Ok((found, i + 1 - task.candidates));
        }
    }
    match found.is_empty() {
        true => Err(PlanError::NoPosture { tried }),
        false => {
            let passed_over = tried - found.len();
            Ok((found, passed_over))
        }
    }
}

/// The criterion of test poses with these rows.
fn mean_information(rows: impl ExactSizeIterator<Item = DMatrix<f64>>) -> Option<Criterion> {
    let count = rows.len() as f64;
    let each = rows.map(|a| a.tr_mul(&a) / count);
    each.reduce(|a, b| a + b).map(Criterion::TestPoses)
}

/// Variances of the numbers that can be known, not of the parts of a combination.
fn of_seen(seen_alone: &[bool]) -> Criterion {
    let weights = seen_alone.iter().map(|seen| f64::from(u8::from(*seen)));
    let weights = DVector::from_iterator(seen_alone.len(), weights);
    Criterion::TestPoses(DMatrix::from_diagonal(&weights))
}

impl PlanTask<'_> {
    /// Each posture under each load, with all markers.
    fn observations(&self, postures: &[Vec<f64>]) -> Vec<Observation> {
        let reading =
            |m: &Vector3<f64>| Reading::displacement(*m, &Vector3::zeros(), self.deviation);
        let readings: Vec<Reading> = self.markers.iter().flat_map(reading).collect();
        let each = postures.iter().enumerate().flat_map(|(i, commands)| {
            let readings = &readings;
            self.loads.iter().map(move |load| Observation {
                posture: i.to_string(),
                commands: commands.clone(),
                load: *load,
                branch: None,
                readings: readings.clone(),
            })
        });
        each.collect()
    }

    fn planned(
        &self,
        axes: &Axes<'_>,
        observation: &Observation,
        prediction: &Prediction,
    ) -> PlannedMeasurement {
        let request = PostureRequest::commands(&observation.commands);
        let position = self.model.mechanism.posture(request);
        let displacements = prediction.values.as_slice().chunks(3);
        let sizes = displacements.map(|d| Vector3::from_column_slice(d).norm());
        PlannedMeasurement {
            shown: axes.shown(&observation.commands).unwrap_or_default(),
            position: position.map_or_else(
                |_| Vector3::repeat(f64::NAN),
                |p| p.target().translation.vector,
            ),
            load: observation.load,
            expected: sizes.fold(0.0, larger),
        }
    }

    /// True if the tool is in the room and every marker is seen.
    fn is_possible(&self, posture: &Posture) -> bool {
        let tool = posture.target();
        let at = tool.translation.vector;
        let bounds = self.room.bounds.iter().zip(at.iter());
        if bounds
            .flat_map(|(b, x)| b.map(|(low, high)| (low, high, *x)))
            .any(|(low, high, x)| x < low || x > high)
        {
            return false;
        }
        let Some(tracker) = self.room.tracker else {
            return true;
        };
        let Ok(rest) = posture.deflected_by(&Wrench::zero()) else {
            return false;
        };
        self.markers.iter().all(|marker| {
            let marker = tool.rotation * marker + at;
            // The hand itself, which carries the marker, is turned so that it is seen.
            let back = (tracker - marker).try_normalize(1e-9).unwrap_or_default();
            let near = marker + back * HAND;
            rest.limbs.iter().all(|limb| {
                let nodes: Vec<Vector3<f64>> =
                    limb.nodes.iter().map(|n| n.translation.vector).collect();
                let pieces = nodes.windows(2);
                pieces
                    .map(|piece| distance(&tracker, &near, &piece[0], &piece[1]))
                    .all(|d| d > CLEARANCE)
            })
        })
    }
}

/// Least distance of two segments, m.
fn distance(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>, d: &Vector3<f64>) -> f64 {
    let to_point = |p: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>| {
        let along = to - from;
        let share = ((p - from).dot(&along) / along.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        (p - from - along * share).norm()
    };
    let ends = [
        to_point(a, c, d),
        to_point(b, c, d),
        to_point(c, a, b),
        to_point(d, a, b),
    ];
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let determinant = uu * vv - uv * uv;
    let (s, t) = (
        (uv * v.dot(&w) - vv * u.dot(&w)) / determinant,
        (uu * v.dot(&w) - uv * u.dot(&w)) / determinant,
    );
    let inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    let between = if inside {
        (w + u * s - v * t).norm()
    } else {
        f64::INFINITY
    };
    ends.into_iter().fold(between, smaller)
}

/// Change of a reading, in its standard deviations, that a number makes which is off by its whole size, and below which no plan
/// knows it: joints behind a load move the tool by what their weights do.
const NOTHING_SHOWN: f64 = 0.1;

/// Numbers on which a reading depends noticeably.
fn shown(rows: &[DMatrix<f64>], unknowns: usize) -> Vec<usize> {
    let largest = |j: usize| rows.iter().map(|a| a.column(j).amax()).fold(0.0, larger);
    (0..unknowns)
        .filter(|j| largest(*j) > NOTHING_SHOWN)
        .collect()
}

fn seen_alone(rows: &[DMatrix<f64>], unknowns: usize) -> Vec<bool> {
    let rows: Vec<PostureRows> = rows
        .iter()
        .map(|a| PostureRows {
            values: DVector::zeros(a.nrows()),
            rows: a.clone(),
        })
        .collect();
    Identifiability::of(&rows, &DVector::repeat(unknowns, 1.0)).seen_alone
}

/// Value of the median of random sets over that of the plan.
fn gain(
    rows: &[DMatrix<f64>],
    criterion: &Criterion,
    task: &PlanTask<'_>,
    settings: &DesignSettings,
    value: f64,
) -> Option<f64> {
    let mut values: Vec<f64> = (0..RANDOM_SETS)
        .filter_map(|set| {
            let mut chosen: Vec<usize> = Vec::new();
            for k in 0..(4 * task.count) {
                let share = f64::from(sample(k as u32, set as u32, task.seed.wrapping_add(1)));
                let i = (share * rows.len() as f64) as usize;
                if chosen.len() < task.count && !chosen.contains(&i) {
                    chosen.push(i);
                }
            }
            evaluate(rows, &chosen, criterion, settings)
                .ok()
                .map(|d| d.value)
        })
        .collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).map(|median| median / value)
}

/// Puts next to each other what is near in its axes, so that the robot goes short ways.
fn in_short_ways(list: &mut [PlannedMeasurement]) {
    let apart = |a: &PlannedMeasurement, b: &PlannedMeasurement| {
        a.shown
            .iter()
            .zip(&b.shown)
            .map(|(x, y)| (x - y).powi(2))
            .sum::<f64>()
    };
    for i in 1..list.len() {
        let near = (i..list.len()).min_by(|a, b| {
            apart(&list[i - 1], &list[*a]).total_cmp(&apart(&list[i - 1], &list[*b]))
        });
        if let Some(near) = near {
            list.swap(i, near);
        }
    }
}
