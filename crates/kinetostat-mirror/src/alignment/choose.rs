//! Points with their places, and those that have none.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::points::MeasuredPoint;
use kinetostat_program::WhyLeftOut;
use kinetostat_program::in_order;
use kinetostat_program::{Foot, NominalPath};

/// The rule by which points are given to places of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alignment {
    /// The nearest place, where only one stretch of the path comes by.
    #[default]
    Nearest,
    /// In the order of the points, along the path.
    ArcLength,
}

/// A point with its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AlignedPoint {
    /// Row of the measurement, from 1.
    pub row: usize,
    /// Length along the path, mm.
    pub along_mm: f64,
    /// Index of the piece of the path.
    pub piece: usize,
    /// Pass of the tool.
    pub pass: usize,
    /// Direction of the path.
    pub tangent: Vector3<f64>,
    /// From the path to the point, across the path, mm.
    pub deviation_mm: Vector3<f64>,
    /// Its share in means.
    pub weight: f64,
}

/// A point without a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Row of the measurement, from 1.
    pub row: usize,
    /// How far it is from the path, mm; `None` where there is no number.
    pub distance_mm: Option<f64>,
    /// Why.
    pub why: WhyLeftOut,
}

/// Points (with their moved positions) on the path, in the order along it, and those without a place.
pub(crate) fn align(
    nominal: &NominalPath<'_>,
    points: &[(MeasuredPoint, Vector3<f64>)],
    alignment: Alignment,
    window_mm: f64,
) -> (Vec<AlignedPoint>, Vec<LeftOut>) {
    let feet: Vec<Vec<Foot>> = points
        .iter()
        .map(|(point, moved)| nominal.feet_within(moved, window_mm, point.program_line))
        .collect();
    let chosen: Vec<Result<Foot, WhyLeftOut>> = match alignment {
        Alignment::Nearest => feet.iter().map(|feet| only(feet)).collect(),
        Alignment::ArcLength => {
            let moved: Vec<Vector3<f64>> = points.iter().map(|(_, moved)| *moved).collect();
            in_order(&moved, &feet, window_mm)
        }
    };
    let (mut aligned, mut left_out) = (Vec::new(), Vec::new());
    for ((point, moved), chosen) in points.iter().zip(chosen) {
        match chosen {
            Ok(foot) => aligned.push(aligned_point(nominal, point, moved, &foot)),
            Err(why) => left_out.push(LeftOut {
                row: point.row,
                distance_mm: nominal.nearest(moved).map(|foot| foot.distance_mm),
                why,
            }),
        }
    }
    // By pieces, too: the end of one is the beginning of the next.
    aligned.sort_by(|a, b| {
        a.along_mm
            .total_cmp(&b.along_mm)
            .then(a.piece.cmp(&b.piece))
    });
    (aligned, left_out)
}

fn only(feet: &[Foot]) -> Result<Foot, WhyLeftOut> {
    match feet {
        [] => Err(WhyLeftOut::BeyondWindow),
        [foot] => Ok(*foot),
        _ => Err(WhyLeftOut::SeveralStretches),
    }
}

fn aligned_point(
    nominal: &NominalPath<'_>,
    point: &MeasuredPoint,
    moved: &Vector3<f64>,
    foot: &Foot,
) -> AlignedPoint {
    let away = moved - foot.place_mm;
    AlignedPoint {
        row: point.row,
        along_mm: foot.along_mm,
        piece: foot.piece,
        pass: nominal.pieces()[foot.piece].pass,
        tangent: foot.tangent,
        deviation_mm: away - foot.tangent * foot.tangent.dot(&away),
        weight: point.weight,
    }
}
