//! The state of all trials, in one file.
//!
//! Smallest deviation that can be resolved with the repeatability of a machine and of its measurement.
//!
//! With the standard deviation `sigma` of one measured deviation in each of the two directions across the path, a smoothed
//! deviation of nothing has the root mean square `sqrt(2) sigma / sqrt(n)` over `n` effective points.
//!
//! From the second trial on the correction has a scatter too, that of the measurements before. A component that the kernel
//! lets through with the share `mu` obeys `x' = (1 - rho mu) x - rho mu noise`: it ends at `rho mu / (2 - rho mu)` of the variance of
//! one measurement, and what is measured of it has `1 + rho mu / (2 - rho mu) = 2 / (2 - rho mu)` times the variance of a
//! measurement alone, at most `2 / (2 - rho)`. That is the floor.
//!
//! Its square scatters as the mean of `nu = 2 L / (2 sqrt(pi) h)` squares that do not depend on each other (path length `L`,
//! smoothing length `h`), by the share `sqrt(2 / nu)`: what is within two of these shares is within the repeatability.

use kinetostat_program::NominalPath;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::deviation::{MeasureSettings, Measurement, PieceMean, Stations, piece_means};
use crate::error::MirrorError;
use crate::number::larger;
use crate::trial::convergence::Convergence;
use crate::trial::machined::{Before, Seen, passed, scatter_mm};
use crate::trial::taking::{MeasuredFile, Trial, are_new, have_places, may_show_the_correction};

/// Version of the form of the state.
const SCHEMA: u32 = 1;

/// A smoothed deviation up to this, mm, is none.
const NOTHING_MM: f64 = 1e-6;

/// Outcome of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Go on with the correction.
    GoOn,
    /// The rest is within the repeatability: the correction is left as it is.
    WithinRepeatability,
    /// The points lie on the path, to less than anyone measures: there is nothing to correct, and the correction is left as it is.
    NothingToCorrect,
    /// The error has risen: the correction is made with what was measured, and the relaxation should be smaller.
    Risen,
}

/// All trials of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MirrorState {
    /// Version of the form.
    pub schema: u32,
    /// SHA-256 of the program as it is drawn.
    pub program_sha256: String,
    /// Settings by which points become deviations.
    pub settings: MeasureSettings,
    /// The trials so far.
    #[serde(default)]
    pub trials: Vec<Trial>,
    /// Stations along the path, mm.
    pub along_mm: Vec<f64>,
    /// Correction at each of them, mm, axes of the program.
    pub correction_mm: Vec<Vector3<f64>>,
    /// Smoothed deviation of the last trial at each of them, mm.
    pub deviation_mm: Vec<Vector3<f64>>,
    /// Means of the points of the last trial, with which those of the next are compared.
    #[serde(default)]
    pub means: Vec<PieceMean>,
    /// Compensation by a model, or none, on top of which the trials are made, by name and value; absent in earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compensation: Option<Vec<(String, String)>>,
}

impl MirrorState {
    /// State of a program without trials.
    ///
    /// # Errors
    /// A smoothing length that this path does not allow ([`Stations::of`]).
    pub fn new(
        nominal: &NominalPath<'_>,
        program_sha256: impl Into<String>,
        settings: MeasureSettings,
    ) -> Result<Self, MirrorError> {
        let stations = Stations::of(nominal, settings.smoothing_mm)?;
        let along_mm = stations.along_mm().to_vec();
        Ok(Self {
            schema: SCHEMA,
            program_sha256: program_sha256.into(),
            settings,
            trials: Vec::new(),
            correction_mm: vec![Vector3::zeros(); along_mm.len()],
            deviation_mm: vec![Vector3::zeros(); along_mm.len()],
            along_mm,
            means: Vec::new(),
            compensation: None,
        })
    }

    /// Checks that it belongs to this program and these settings.
    ///
    /// # Errors
    /// Names the first field that differs, with both values.
    pub fn fits(
        &self,
        nominal: &NominalPath<'_>,
        program_sha256: &str,
        settings: &MeasureSettings,
    ) -> Result<(), MirrorError> {
        let fresh = Self::new(nominal, program_sha256, *settings)?;
        let (own, other) = (&self.settings, settings);
        let fields = [
            ("schema", self.schema.to_string(), fresh.schema.to_string()),
            (
                "program_sha256",
                self.program_sha256.clone(),
                fresh.program_sha256.clone(),
            ),
            (
                "smoothing_mm",
                own.smoothing_mm.to_string(),
                other.smoothing_mm.to_string(),
            ),
            (
                "window_mm",
                own.window_mm.to_string(),
                other.window_mm.to_string(),
            ),
            (
                "align",
                format!("{:?}", own.align),
                format!("{:?}", other.align),
            ),
            (
                "register",
                own.register.word().to_owned(),
                other.register.word().to_owned(),
            ),
            ("scale", own.scale.to_string(), other.scale.to_string()),
        ];
        if let Some((field, own, other)) = fields.iter().find(|(_, own, other)| own != other) {
            return Err(MirrorError::new(format!(
                "the state has {field} = {own}, this run {other}: go on with the same program and settings, or begin with a new state"
            )));
        }
        let count = fresh.along_mm.len();
        let apart = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-6;
        let lists = [
            self.along_mm.len(),
            self.correction_mm.len(),
            self.deviation_mm.len(),
        ];
        let moved = self.along_mm.iter().zip(&fresh.along_mm).any(apart);
        let all = self.correction_mm.iter().chain(&self.deviation_mm);
        let lost = all.flat_map(Vector3::iter).any(|x| !x.is_finite());
        match lists != [count; 3] || moved || lost {
            true => Err(MirrorError::new(format!(
                "the state's along_mm, correction_mm and deviation_mm do not fit the {count} stations of this path: the file was changed, or the program is read with other options; begin with a new state"
            ))),
            false => Ok(()),
        }
    }

    /// Takes the measurements of one more trial, and mirrors the mean of their deviations unless it is within the repeatability.
    ///
    /// # Errors
    /// A relaxation that is not above 0 and below 2; no measurement, one of another path, or one that an earlier trial has taken
    /// or that comes twice; one of which most points have no place on the path; one that shows nothing of the last correction.
    pub fn take(
        &mut self,
        nominal: &NominalPath<'_>,
        measured: &[(MeasuredFile, Measurement)],
        relaxation: f64,
        repeatability: Option<Repeatability>,
    ) -> Result<Outcome, MirrorError> {
        self.taken(nominal, measured, relaxation, repeatability, false)
    }

    /// Variant of [`Self::take`] for a measured program that is the last one for certain: measurements that show nothing of its
    /// correction are taken too, and the trial says so ([`Trial::shows_correction`]).
    ///
    /// # Errors
    /// As [`Self::take`], but for the last.
    pub fn take_of_last_program(
        &mut self,
        nominal: &NominalPath<'_>,
        measured: &[(MeasuredFile, Measurement)],
        relaxation: f64,
        repeatability: Option<Repeatability>,
    ) -> Result<Outcome, MirrorError> {
        self.taken(nominal, measured, relaxation, repeatability, true)
    }

    fn taken(
        &mut self,
        nominal: &NominalPath<'_>,
        measured: &[(MeasuredFile, Measurement)],
        relaxation: f64,
        repeatability: Option<Repeatability>,
        was_run: bool,
    ) -> Result<Outcome, MirrorError> {
        if !(relaxation > 0.0 && relaxation < 2.0) {
            return Err(MirrorError::new(format!(
                "the relaxation is {relaxation}; expected a number above 0 and below 2 (1 mirrors the whole deviation; beyond 2 no machine converges)"
            )));
        }
        let stations = self.along_mm.len();
        let fits = |m: &(MeasuredFile, Measurement)| m.1.at_stations.len() == stations;
        let (Some((_, first)), true) = (measured.first(), measured.iter().all(fits)) else {
            return Err(MirrorError::new(
                "a trial needs a measurement of its own path, smoothed over the same length",
            ));
        };
        are_new(&self.trials, measured)?;
        have_places(measured)?;
        let deviation = mean_deviation(measured, stations);
        let places = Stations::of(nominal, self.settings.smoothing_mm)?;
        let lengths = places.lengths_mm();
        let seen = |k: usize| {
            measured
                .iter()
                .any(|m| m.1.at_stations[k].effective_points > 0.0)
        };
        let lengths = lengths.iter().enumerate();
        let seen_lengths: Vec<f64> = lengths
            .map(|(k, l)| if seen(k) { *l } else { 0.0 })
            .collect();
        let total: f64 = seen_lengths.iter().sum();
        let squares = seen_lengths.iter().zip(&deviation);
        let squares: f64 = squares.map(|(l, d)| l * d.norm_squared()).sum();
        let left_mm = (squares / total).sqrt();
        let averaging = Averaging {
            effective_points: first.figures.effective_points,
            measurements: measured.len(),
            smoothing_mm: self.settings.smoothing_mm,
            length_mm: total,
            relaxation_before: self.trials.last().map_or(0.0, |last| last.relaxation),
        };
        let floor = repeatability.map(|known| floor_mm(known, &averaging));
        let last = self.trials.last().filter(|last| last.mirrored);
        let convergence = last.and_then(|last| {
            let passed = passed(
                &places,
                &self.deviation_mm,
                first,
                self.settings.smoothing_mm,
            );
            let deviations = [&self.deviation_mm, &deviation, &passed].map(Vec::as_slice);
            Convergence::between(deviations, &seen_lengths, last.relaxation)
        });
        let means = piece_means(&places, measured.iter().map(|(_, found)| found));
        let shows_correction = last.map(|last| {
            let scatter = measured.iter().map(|(_, found)| scatter_mm(found));
            let before = Before {
                deviation_mm: &self.deviation_mm,
                means: &self.means,
                relaxation: last.relaxation,
                smoothing_mm: self.settings.smoothing_mm,
            };
            let seen = Seen::of(
                &places,
                &before,
                &means,
                scatter.fold(last.figures.scatter_mm, larger),
            );
            may_show_the_correction(measured, &self.trials, &seen, was_run)
        });
        let shows_correction = shows_correction.transpose()?;
        let outcome = match (floor, convergence) {
            _ if deviation.iter().all(|d| d.norm() <= NOTHING_MM) => Outcome::NothingToCorrect,
            (Some([_, within]), _) if left_mm <= within => Outcome::WithinRepeatability,
            (_, Some(Convergence { risen: true, .. })) => Outcome::Risen,
            _ => Outcome::GoOn,
        };
        let goes_on = matches!(outcome, Outcome::GoOn | Outcome::Risen);
        if goes_on {
            for (correction, deviation) in self.correction_mm.iter_mut().zip(&deviation) {
                *correction -= deviation * relaxation;
            }
        }
        self.trials.push(Trial {
            number: self.trials.len() + 1,
            measured: measured.iter().map(|(file, _)| file.clone()).collect(),
            relaxation,
            mirrored: goes_on,
            figures: first.figures,
            left_mm,
            floor_mm: floor.map(|[floor, _]| floor),
            convergence,
            shows_correction,
        });
        self.deviation_mm = deviation;
        self.means = means;
        Ok(outcome)
    }
}

/// Repeatability of trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Repeatability {
    /// Standard deviation of a measured deviation in each direction, mm.
    OfPoints(f64),
    /// Root mean square of a smoothed deviation about its mean, mm, from several measurements of one trial.
    OfSmoothed(f64),
}

impl Repeatability {
    /// Repeatability from several measurements of the same trial with the same settings; `None` without two that have a
    /// station in common.
    #[must_use]
    pub fn of_repeats<'m>(repeats: impl IntoIterator<Item = &'m Measurement>) -> Option<Self> {
        let repeats: Vec<&Measurement> = repeats.into_iter().collect();
        let stations = repeats.first()?.at_stations.len();
        let (mut sum, mut count) = (0.0, 0_usize);
        for station in 0..stations {
            let all = repeats
                .iter()
                .filter_map(|repeat| repeat.at_stations.get(station));
            let seen = all.filter(|smoothed| smoothed.effective_points > 0.0);
            let seen: Vec<Vector3<f64>> = seen.map(|smoothed| smoothed.deviation_mm).collect();
            if seen.len() < 2 {
                continue;
            }
            let mean = seen.iter().sum::<Vector3<f64>>() / seen.len() as f64;
            sum += seen
                .iter()
                .map(|one| (one - mean).norm_squared())
                .sum::<f64>();
            count += seen.len() - 1;
        }
        (count > 0).then(|| Self::OfSmoothed((sum / count as f64).sqrt()))
    }
}

/// Averaging of the scatter of a smoothed deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averaging {
    /// Effective number of points of one measurement.
    pub effective_points: f64,
    /// Number of measurements of the trial in the mean.
    pub measurements: usize,
    /// Smoothing length, mm.
    pub smoothing_mm: f64,
    /// Length of path that was measured, mm.
    pub length_mm: f64,
    /// Relaxation of the trial before; 0 in the first one, which has no correction with a scatter of its own.
    pub relaxation_before: f64,
}

impl Averaging {
    /// Number of stretches of the path that are smoothed independently.
    pub(crate) fn independent(&self) -> f64 {
        self.length_mm / (std::f64::consts::PI.sqrt() * self.smoothing_mm)
    }
}

/// The root mean square that a smoothed deviation has where nothing but scatter is left, mm, and what is within it.
///
/// ```
/// use kinetostat_mirror::{Averaging, Repeatability, floor_mm};
///
/// let averaging = Averaging {
///     effective_points: 16.0,
///     measurements: 1,
///     smoothing_mm: 5.0,
///     length_mm: 1000.0,
///     relaxation_before: 0.0,
/// };
/// let [floor, within] = floor_mm(Repeatability::OfPoints(0.01), &averaging);
/// assert!((floor - 0.01 * 2.0_f64.sqrt() / 4.0).abs() < 1e-15);
/// assert!(within > floor && within < 1.2 * floor);
/// ```
#[must_use]
pub fn floor_mm(repeatability: Repeatability, averaging: &Averaging) -> [f64; 2] {
    let of_one = match repeatability {
        Repeatability::OfPoints(sigma) => sigma * (2.0 / averaging.effective_points).sqrt(),
        Repeatability::OfSmoothed(rms) => rms,
    };
    let with_correction = (2.0 / (2.0 - averaging.relaxation_before)).sqrt();
    let floor = of_one * with_correction / (averaging.measurements as f64).sqrt();
    let share = (2.0 / averaging.independent().max(1.0)).sqrt();
    [floor, floor * (1.0 + 2.0 * share).sqrt()]
}

/// The mean of the smoothed deviations at each station, of the measurements that see it.
fn mean_deviation(measured: &[(MeasuredFile, Measurement)], stations: usize) -> Vec<Vector3<f64>> {
    let mean = |k: usize| {
        let all = measured.iter().map(|(_, m)| &m.at_stations[k]);
        let seen: Vec<_> = all.filter(|s| s.effective_points > 0.0).collect();
        let sum: Vector3<f64> = seen.iter().map(|s| s.deviation_mm).sum();
        sum / seen.len().max(1) as f64
    };
    (0..stations).map(mean).collect()
}
