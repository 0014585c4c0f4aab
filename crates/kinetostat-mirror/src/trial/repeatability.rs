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

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::deviation::Measurement;

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
