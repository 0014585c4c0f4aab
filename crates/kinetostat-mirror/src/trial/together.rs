//! Mean of several measurements of a trial.

use nalgebra::Vector3;

use crate::deviation::Measurement;
use crate::trial::record::MeasuredFile;

/// The mean of the smoothed deviations at each station, of the measurements that see it.
pub(crate) fn mean_deviation(
    measured: &[(MeasuredFile, Measurement)],
    stations: usize,
) -> Vec<Vector3<f64>> {
    let mean = |k: usize| {
        let all = measured.iter().map(|(_, m)| &m.at_stations[k]);
        let seen: Vec<_> = all.filter(|s| s.effective_points > 0.0).collect();
        let sum: Vector3<f64> = seen.iter().map(|s| s.deviation_mm).sum();
        sum / seen.len().max(1) as f64
    };
    (0..stations).map(mean).collect()
}
