//! The kernel along a whole path, stretch by stretch.

use crate::alignment::AlignedPoint;
use crate::deviation::kernel::{Kernel, Smoothed};
use crate::deviation::stations::Stations;

/// Deviations smoothed at the points themselves and at the stations, stretch by stretch.
pub(crate) fn smoothed_along(
    stations: &Stations,
    kernel: Kernel,
    points: &[AlignedPoint],
) -> [Vec<Smoothed>; 2] {
    let (mut at_points, mut at_stations) = (Vec::new(), Vec::new());
    for stretch in stations.stretches() {
        let first = points.partition_point(|point| point.piece < stretch.pieces.start);
        let end = points.partition_point(|point| point.piece < stretch.pieces.end);
        let own = &points[first..end];
        let places: Vec<f64> = own.iter().map(|point| point.along_mm).collect();
        let along = &stations.along_mm()[stretch.stations.clone()];
        let smoothed = |places: &[f64]| match stretch.closed {
            true => kernel.smoothed_around(own, places, [along[0], along[along.len() - 1]]),
            false => kernel.smoothed(own, places),
        };
        at_points.extend(smoothed(&places));
        at_stations.extend(smoothed(along));
    }
    [at_points, at_stations]
}
