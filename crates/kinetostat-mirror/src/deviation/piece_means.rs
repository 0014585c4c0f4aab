//! Deviations in means over short pieces of the path: all that a state keeps of the points of a trial.
//!
//! A piece is the way from one station to the next, a quarter of the smoothing length at most. A mean stands at the mean place of
//! its points, so that it keeps what is straight; of a wave of the length `l` over a piece of the length `b` it loses
//! `(pi b / l)^2 / 6`: a hundredth where the wave is three smoothing lengths long, of which a smoothed deviation keeps a tenth.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::deviation::measure::Measurement;
use crate::deviation::stations::Stations;

/// The mean of the points on a piece of the path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Row", into = "Row")]
pub struct PieceMean {
    /// Index of its stretch ([`Stations::stretches`]).
    pub stretch: usize,
    /// Mean place of the points, length along the path, mm.
    pub along_mm: f64,
    /// Mean deviation across the path, mm.
    pub deviation_mm: Vector3<f64>,
    /// Number of points of equal weight that would scatter as little.
    pub points: f64,
}

/// Short row of a mean in a file.
type Row = (usize, f64, Vector3<f64>, f64);

impl From<Row> for PieceMean {
    fn from((stretch, along_mm, deviation_mm, points): Row) -> Self {
        Self {
            stretch,
            along_mm,
            deviation_mm,
            points,
        }
    }
}

impl From<PieceMean> for Row {
    fn from(mean: PieceMean) -> Self {
        (mean.stretch, mean.along_mm, mean.deviation_mm, mean.points)
    }
}

/// Means of all points of several measurements, in the order along the path.
pub(crate) fn piece_means<'m>(
    stations: &Stations,
    measured: impl Iterator<Item = &'m Measurement>,
) -> Vec<PieceMean> {
    let mut points: Vec<_> = measured.flat_map(|found| &found.points).collect();
    points.sort_by(|a, b| {
        let by_place = a.along_mm.total_cmp(&b.along_mm);
        a.piece.cmp(&b.piece).then(by_place)
    });
    let mut means = Vec::new();
    let mut rest = points.as_slice();
    while let Some(first) = rest.first() {
        let stretch = stations.stretch_of(first.piece);
        let of_stretch = &stations.stretches()[stretch];
        let along = &stations.along_mm()[of_stretch.stations.clone()];
        let piece = |at: f64| along[1..along.len() - 1].partition_point(|station| *station <= at);
        let own = piece(first.along_mm);
        let same = rest
            .iter()
            .take_while(|p| of_stretch.pieces.contains(&p.piece) && piece(p.along_mm) == own);
        let (on_piece, others) = rest.split_at(same.count().max(1));
        let weight: f64 = on_piece.iter().map(|p| p.weight).sum();
        let squares: f64 = on_piece.iter().map(|p| p.weight * p.weight).sum();
        let deviation: Vector3<f64> = on_piece.iter().map(|p| p.deviation_mm * p.weight).sum();
        means.push(PieceMean {
            stretch,
            along_mm: on_piece.iter().map(|p| p.along_mm * p.weight).sum::<f64>() / weight,
            deviation_mm: deviation / weight,
            points: weight * weight / squares,
        });
        rest = others;
    }
    means
}
