//! Part of a correction that remains after smoothing.

use nalgebra::Vector3;

use crate::alignment::AlignedPoint;
use crate::deviation::{Kernel, Measurement, Stations, smoothed_along};

/// Part of a correction by these deviations at the stations that the kernel lets through, at the points of a measurement: the part
/// across the path there, smoothed once more.
pub(crate) fn passed(
    stations: &Stations,
    deviation_mm: &[Vector3<f64>],
    measured: &Measurement,
    smoothing_mm: f64,
) -> Vec<Vector3<f64>> {
    let at = |point: &AlignedPoint| {
        let stretch = stations.stretch_of(point.piece);
        let there = between_stations(stations, deviation_mm, (stretch, point.along_mm));
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

/// Value at a place between stations: a stretch and a length along the path, mm.
pub(crate) fn between_stations(
    stations: &Stations,
    at_stations: &[Vector3<f64>],
    (stretch, along_mm): (usize, f64),
) -> Vector3<f64> {
    let along = stations.along_mm();
    let own = &stations.stretches()[stretch].stations;
    let after = along[own.clone()].partition_point(|at| *at <= along_mm);
    let k = own.start + after.clamp(1, own.len() - 1);
    let share = (along_mm - along[k - 1]) / (along[k] - along[k - 1]);
    at_stations[k - 1].lerp(&at_stations[k], share.clamp(0.0, 1.0))
}
