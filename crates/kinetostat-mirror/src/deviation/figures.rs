//! Sizes of the deviations of a measurement.

use serde::{Deserialize, Serialize};

use crate::alignment::AlignedPoint;
use crate::deviation::kernel::Smoothed;
use crate::deviation::stations::Stations;
use crate::number::{OF_TWO_DIRECTIONS, larger, median};

/// Sizes of deviations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviationFigures {
    /// Points that count.
    pub points: usize,
    /// Root of the mean square of their deviations, mm.
    pub rms_mm: f64,
    /// The largest of them, mm.
    pub largest_mm: f64,
    /// Root of the mean square along the path after smoothing, mm.
    pub smoothed_rms_mm: f64,
    /// The largest after smoothing, mm.
    pub smoothed_largest_mm: f64,
    /// Root of the mean product of deviation and smoothed deviation, mm: what the proof of convergence is about.
    pub passing_rms_mm: f64,
    /// Standard deviation of a point in one direction, mm, from what differs between neighbours no farther apart than the
    /// smoothing length.
    pub scatter_mm: f64,
    /// True if there are too few such neighbours: the scatter is that about the smoothed deviation, with all in it that
    /// bends within a smoothing length. The true one is no larger.
    #[serde(default)]
    pub scatter_has_bends: bool,
    /// Mean number of points that a smoothed deviation rests on.
    pub effective_points: f64,
}

/// Sizes of deviations at the points and at the stations, with the scatter that neighbours tell.
pub(crate) fn figures(
    points: &[AlignedPoint],
    at_points: &[Smoothed],
    stations: &Stations,
    at_stations: &[Smoothed],
    scatter_mm: Option<f64>,
) -> DeviationFigures {
    let mean = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
        let (mut sum, mut total) = (0.0, 0.0);
        for (value, weight) in pairs {
            sum += value * weight;
            total += weight;
        }
        sum / total
    };
    let both = || points.iter().zip(at_points);
    let squares = points
        .iter()
        .map(|p| (p.deviation_mm.norm_squared(), p.weight));
    let passing = both().map(|(p, smoothed)| {
        let product = p.deviation_mm.dot(&smoothed.deviation_mm);
        (product, p.weight * smoothed.support)
    });
    let off = both().map(|(p, smoothed)| (p.deviation_mm - smoothed.deviation_mm).norm());
    let lengths = stations.lengths_mm();
    let seen = || {
        let all = at_stations.iter().zip(&lengths);
        all.filter(|(smoothed, _)| smoothed.effective_points > 0.0)
    };
    let smoothed = seen().map(|(smoothed, length)| (smoothed.deviation_mm.norm_squared(), *length));
    DeviationFigures {
        points: points.len(),
        rms_mm: mean(&mut squares.into_iter()).sqrt(),
        largest_mm: points
            .iter()
            .map(|p| p.deviation_mm.norm())
            .fold(0.0, larger),
        smoothed_rms_mm: mean(&mut smoothed.into_iter()).sqrt(),
        smoothed_largest_mm: at_stations
            .iter()
            .map(|s| s.deviation_mm.norm())
            .fold(0.0, larger),
        passing_rms_mm: larger(mean(&mut passing.into_iter()), 0.0).sqrt(),
        scatter_mm: scatter_mm.unwrap_or_else(|| OF_TWO_DIRECTIONS * median(off.collect())),
        scatter_has_bends: scatter_mm.is_none(),
        effective_points: mean(&mut seen().map(|(s, length)| (s.effective_points, *length))),
    }
}
