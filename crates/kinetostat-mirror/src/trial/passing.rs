//! What is seen again of a correction after it was smoothed.

use nalgebra::Vector3;

use crate::alignment::AlignedPoint;
use crate::deviation::{Kernel, Measurement, Stations, smoothed_along};

/// What the kernel lets through of a correction by these deviations at the stations, at the points of a measurement: what is across
/// the path there, smoothed once more.
pub(crate) fn passed(
    stations: &Stations,
    deviation_mm: &[Vector3<f64>],
    measured: &Measurement,
    smoothing_mm: f64,
) -> Vec<Vector3<f64>> {
    let along = stations.along_mm();
    let at = |point: &AlignedPoint| {
        let own = &stations.stretches()[stations.stretch_of(point.piece)].stations;
        let after = along[own.clone()].partition_point(|at| *at <= point.along_mm);
        let k = own.start + after.clamp(1, own.len() - 1);
        let share = (point.along_mm - along[k - 1]) / (along[k] - along[k - 1]);
        let there = deviation_mm[k - 1].lerp(&deviation_mm[k], share.clamp(0.0, 1.0));
        AlignedPoint {
            deviation_mm: there - point.tangent * point.tangent.dot(&there),
            ..*point
        }
    };
    let points: Vec<AlignedPoint> = measured.points.iter().map(at).collect();
    let kernel = Kernel {
        length_mm: smoothing_mm,
    };
    let [_, passed] = smoothed_along(stations, kernel, &points);
    passed
        .iter()
        .map(|smoothed| smoothed.deviation_mm)
        .collect()
}
