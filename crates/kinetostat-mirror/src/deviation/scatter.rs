//! Scatter of a point, from the differences between neighbours.
//!
//! Distances from the smoothed deviation have in them what the smoothing does not let through. Differences of a higher order have
//! next to nothing of it: of the deviations of `m + 1` neighbours at the lengths `x_i` along the path the sum `sum c_i e_i`,
//! `c_i = (-1)^i prod_{j < k; j, k != i} (x_k - x_j)`, is none for every polynomial below the order `m` (the divided difference
//! times Vandermonde's determinant, so that two points at one place do no harm). If the `e_i` scatter with the standard deviation
//! `sigma`, it has `sigma |c|` (von Neumann 1941; of a higher order Gasser, Sroka and Jennen-Steinmetz 1986). The median of its
//! length over all neighbours does not follow outliers (Rayleigh, two directions).
//!
//! A wave that turns by the angle `a` from point to point leaves about `a^m / sqrt((2 m)! / m!^2)` of its height: a high order sees
//! less of it. An outlier spoils `m + 1` of them: a low order sees less of that. Each can only add to the scatter, so that
//! the smaller of two orders is nearer to it.

use nalgebra::Vector3;

use crate::alignment::AlignedPoint;
use crate::deviation::stations::Stations;
use crate::number::{OF_TWO_DIRECTIONS, median, smaller};

/// Orders of the differences: of a wave of ten points they leave a 19th and a 176th of its height.
const ORDERS: [usize; 2] = [3, 5];

/// Minimum number of values for a median: that of five which do not depend on each other is twice the true one once in 450
/// times.
const FEWEST: usize = 5;

/// The standard deviation of a point in one direction, mm, from neighbours that are no farther apart than this; `None` where
/// there are too few of them.
pub(crate) fn scatter_mm(
    stations: &Stations,
    points: &[AlignedPoint],
    apart_mm: f64,
) -> Option<f64> {
    let of_orders = ORDERS.map(|order| of_order(stations, points, apart_mm, order));
    let known = of_orders.into_iter().flatten();
    known.reduce(smaller)
}

fn of_order(
    stations: &Stations,
    points: &[AlignedPoint],
    apart_mm: f64,
    order: usize,
) -> Option<f64> {
    let mut lengths = Vec::new();
    for stretch in stations.stretches() {
        let first = points.partition_point(|point| point.piece < stretch.pieces.start);
        let end = points.partition_point(|point| point.piece < stretch.pieces.end);
        let groups = points[first..end].windows(order + 1);
        lengths.extend(groups.filter_map(|group| difference_mm(group, apart_mm)));
    }
    (lengths.len() >= FEWEST).then(|| OF_TWO_DIRECTIONS * median(lengths))
}

/// The length of the difference of neighbours, as large as the scatter of one of them; `None` where two are too far apart,
/// or so many at one place that nothing is left of it.
fn difference_mm(group: &[AlignedPoint], apart_mm: f64) -> Option<f64> {
    let near = |pair: &[AlignedPoint]| pair[1].along_mm - pair[0].along_mm <= apart_mm;
    let span = group.last()?.along_mm - group.first()?.along_mm;
    if !group.windows(2).all(near) || span <= 0.0 {
        return None;
    }
    let (mut sum, mut squares) = (Vector3::zeros(), 0.0);
    for (i, own) in group.iter().enumerate() {
        let mut share = if i % 2 == 0 { 1.0 } else { -1.0 };
        for (k, upper) in group.iter().enumerate().filter(|(k, _)| *k != i) {
            for (_, lower) in group[..k].iter().enumerate().filter(|(j, _)| *j != i) {
                share *= (upper.along_mm - lower.along_mm) / span;
            }
        }
        sum += own.deviation_mm * share;
        squares += share * share;
    }
    (squares > 0.0).then(|| sum.norm() / squares.sqrt())
}
