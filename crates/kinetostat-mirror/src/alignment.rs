//! Assignment of measured points to places of the path.
//!
//! Both rules look no farther than a window: the tool leaves its path by no more. Places within it belong to one stretch where
//! the path between them is no longer than four windows; stretches that come by a second time are others: the neighbouring
//! line of a zigzag, the end of a contour beside its start, the pass before.
//!
//! - **Nearest** ([`Alignment::Nearest`]): the nearest place of the only stretch within the window. A point with several is
//!   not given to any of them: it is named and left out. A `line` in the measurement tells them apart.
//! - **Along the arc length** ([`Alignment::ArcLength`]): points in the order in which the tool went. Of all ways through the
//!   stretches along which no foot goes back by more than a window, that with the least sum of `(d / window)^2` and
//!   `((way along the path - way between the points) / (way between the points + window))^2`, the latter 4 at most (a
//!   rapid between passes was not measured). Found as the shortest way through a graph (Viterbi 1967), not point by point.
//!
//! A deviation is measured from its foot and is that part of it which is across the path: how far the tool has come along it
//! is not seen.

use kinetostat_program::{Foot, NominalPath, WhyLeftOut, in_order};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::points::MeasuredPoint;

/// The rule by which points are given to places of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alignment {
    /// The nearest place, where only one stretch of the path comes by.
    #[default]
    Nearest,
    /// Order of the points, along the path.
    ArcLength,
}

/// A point with its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
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
    #[schemars(with = "[f64; 3]")]
    pub tangent: Vector3<f64>,
    /// Deviation of the point from the path, across the path, mm.
    #[schemars(with = "[f64; 3]")]
    pub deviation_mm: Vector3<f64>,
    /// Weight in means.
    pub weight: f64,
}

/// A point without a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// Row of the measurement, from 1.
    pub row: usize,
    /// Distance from the path, mm; `None` if there is no number.
    pub distance_mm: Option<f64>,
    /// Reason of the omission.
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
            Ok(foot) => {
                let foot = on_the_better_side(nominal, moved, foot);
                aligned.push(aligned_point(nominal, point, moved, &foot));
            }
            Err(why) => {
                let distance_mm = nominal.nearest(moved).map(|foot| foot.distance_mm);
                let is_beside = distance_mm.is_some_and(|off| off <= window_mm);
                let why = match (why, point.program_line) {
                    (WhyLeftOut::BeyondWindow, Some(_)) if is_beside => WhyLeftOut::NotOnItsLine,
                    _ => why,
                };
                left_out.push(LeftOut {
                    row: point.row,
                    distance_mm,
                    why,
                });
            }
        }
    }
    // Sorted by pieces, too: the end of one is the beginning of the next.
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

/// Chooses the leg at a corner, outside which the same place is the nearest of both: the point belongs to the leg that it is
/// beside, the one whose end it is less far beyond, along the leg.
fn on_the_better_side(nominal: &NominalPath<'_>, moved: &Vector3<f64>, foot: Foot) -> Foot {
    let own = nominal.passes()[nominal.pieces()[foot.piece].pass]
        .pieces
        .clone();
    let other = match (foot.share >= 1.0, foot.share <= 0.0) {
        (true, _) if foot.piece + 1 < own.end => (foot.piece + 1, 0.0),
        (_, true) if foot.piece > own.start => (foot.piece - 1, 1.0),
        _ => return foot,
    };
    let (piece, share) = other;
    let Some(tangent) = nominal.motion(&nominal.pieces()[piece]).tangent(share) else {
        return foot;
    };
    let away = moved - foot.place_mm;
    match tangent.dot(&away).abs() < foot.tangent.dot(&away).abs() {
        true => Foot {
            piece,
            share,
            tangent,
            ..foot
        },
        false => foot,
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
