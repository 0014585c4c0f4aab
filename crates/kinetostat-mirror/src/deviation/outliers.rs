//! Measured points that no neighbour bears out.
//!
//! The deviation of a point is compared with a straight line through those of its neighbours, five to each side along the path (ten to one
//! side at an end) as far as it does not turn by more than 20 degrees, whose slope and height are medians (Theil 1950, Sen 1968): two of
//! ten neighbours may be wrong themselves. It is an outlier if it is farther from the line than six standard deviations, more at the end of
//! a straight stretch, where the line is drawn on from one side. The standard deviation comes from the median of these distances (Rayleigh:
//! the median length of a vector of two directions is 1.177 of one direction's deviation) of all points, or from what three quarters of the
//! sixteen around keep below where these are farther off (the deviation bends there, of which a few points in a row are enough), and no
//! smaller than a thousandth of the deviation that 99 of 100 points keep below, than what the points are known to
//! ([`MeasuredPoints::known_to`](crate::MeasuredPoints::known_to)), or than the rounding of the registration. One point in sixty million of
//! a normal scatter is farther. Beside a corner a point may have its place on the wrong side of it and so be off by the sine of the corner
//! times twice the deviation there: one that is off by no more than that, within twice the deviation, is no outlier, but it does not count:
//! at the end of a leg one such point among thirty would take a thirtieth of the whole deviation. If the path turns between the neighbours,
//! the direction across it turns too, and a line is off by up to half that angle times the deviation.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::alignment::AlignedPoint;
use crate::number::{OF_THREE_QUARTERS, OF_TWO_DIRECTIONS, larger, median, quantile};
use kinetostat_program::NominalPath;

const SIDE: usize = 5;
const AROUND: usize = 8;
const DEVIATIONS: f64 = 6.0;
/// Quantile of the neighbours' distances that sets how far a point may be.
const BORNE_OUT: f64 = 0.75;
const NEGLIGIBLE: f64 = 1e-3;
/// Rounding of points that lie on the path but were moved from another frame, as a share of its length.
const ROUNDING: f64 = 1e-9;
/// Cosine of 20 degrees.
const SAME_DIRECTION: f64 = 0.939_692_620_785_908_4;
/// Minimum number of neighbours for a test of outliers.
const FEWEST: usize = 4;

/// A point that was left out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Outlier {
    /// Row of the measurement, from 1.
    pub row: usize,
    /// Length along the path, mm.
    pub along_mm: f64,
    /// Distance from the path, across it, mm.
    pub distance_mm: f64,
    /// Distance from the value that its neighbours predict, mm.
    pub from_neighbours_mm: f64,
    /// Allowed distance, mm.
    pub allowed_mm: f64,
    /// Deviation of the point, mm.
    #[schemars(with = "[f64; 3]")]
    pub deviation_mm: Vector3<f64>,
}

/// Points that do not count.
#[derive(Default)]
pub(crate) struct TakenOut {
    pub outliers: Vec<Outlier>,
    /// Rows of points beside a corner that may belong to its other leg.
    pub beside_corners: Vec<usize>,
}

/// Takes out of points, in the order along the path, those that do not count.
///
/// Their differences say nothing below the standard deviation to which they are known, mm.
pub(crate) fn take_outliers(
    nominal: &NominalPath<'_>,
    points: &mut Vec<AlignedPoint>,
    known_to_mm: f64,
) -> TakenOut {
    let lines: Vec<Option<Line>> = (0..points.len()).map(|i| from_line(points, i)).collect();
    let apart = |line: &Line| line.apart_mm;
    let known: Vec<f64> = lines.iter().flatten().map(apart).collect();
    if known.is_empty() {
        return TakenOut::default();
    }
    let negligible = NEGLIGIBLE * usual_size(points) / DEVIATIONS;
    let known_to_mm = larger(known_to_mm, ROUNDING * nominal.length_mm());
    let floor = larger(negligible, known_to_mm);
    let of_all = larger(OF_TWO_DIRECTIONS * median(known), floor);
    let mut taken = TakenOut::default();
    let mut kept = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let Some(line) = lines[i] else {
            kept.push(*point);
            continue;
        };
        let around = lines[i.saturating_sub(AROUND)..(i + AROUND + 1).min(lines.len())].iter();
        let around = quantile(around.flatten().map(apart).collect(), BORNE_OUT);
        let around = OF_THREE_QUARTERS * around;
        let beside = 2.0 * line.size_mm;
        let scatter_mm =
            DEVIATIONS * line.spread * larger(of_all, around) + 0.5 * line.size_mm * line.turn;
        let allowed_mm = scatter_mm + beside * sharpest_turn(nominal, point, beside);
        if line.apart_mm > allowed_mm {
            taken.outliers.push(Outlier {
                row: point.row,
                along_mm: point.along_mm,
                distance_mm: point.deviation_mm.norm(),
                from_neighbours_mm: line.apart_mm,
                allowed_mm,
                deviation_mm: point.deviation_mm,
            });
        } else if line.apart_mm > scatter_mm {
            taken.beside_corners.push(point.row);
        } else {
            kept.push(*point);
        }
    }
    *points = kept;
    taken
}

/// The deviation that 99 of 100 points keep below, mm.
fn usual_size(points: &[AlignedPoint]) -> f64 {
    let mut sizes: Vec<f64> = points.iter().map(|p| p.deviation_mm.norm()).collect();
    let at = (sizes.len() * 99 / 100).min(sizes.len() - 1);
    *sizes.select_nth_unstable_by(at, f64::total_cmp).1
}

/// Sine of the sharpest turn of the path within a way of a point's place, 1 from a right angle on.
fn sharpest_turn(nominal: &NominalPath<'_>, point: &AlignedPoint, within_mm: f64) -> f64 {
    let pieces = nominal.pieces();
    let own = &nominal.passes()[point.pass].pieces;
    let turn = |before: usize| {
        let end = nominal.motion(&pieces[before]).tangent(1.0);
        let start = nominal.motion(&pieces[before + 1]).tangent(0.0);
        end.zip(start).map_or(1.0, |(end, start)| {
            if end.dot(&start) > 0.0 {
                end.cross(&start).norm()
            } else {
                1.0
            }
        })
    };
    let back = (own.start..point.piece).rev();
    let back = back.take_while(|k| point.along_mm - pieces[k + 1].from_mm <= within_mm);
    let on = (point.piece..own.end - 1)
        .take_while(|k| pieces[k + 1].from_mm - point.along_mm <= within_mm);
    back.chain(on).map(turn).fold(0.0, larger)
}

/// A point beside the line of its neighbours.
#[derive(Clone, Copy)]
struct Line {
    /// Distance from the line, mm.
    apart_mm: f64,
    /// Median deviation of the neighbours, mm.
    size_mm: f64,
    /// Sine of the largest angle between its direction and theirs.
    turn: f64,
    /// Scatter over that of a point amid its neighbours.
    spread: f64,
}

/// Scatter of a point's distance from a line through its neighbours over that amid ten of them evenly to both sides, by
/// least squares.
fn spread(near: &[&AlignedPoint], along_mm: f64) -> f64 {
    let count = near.len() as f64;
    let middle = near.iter().map(|p| p.along_mm).sum::<f64>() / count;
    let squares = near.iter().map(|p| (p.along_mm - middle).powi(2));
    let lever = (along_mm - middle).powi(2) / squares.sum::<f64>();
    let lever = if lever.is_finite() { lever } else { 0.0 };
    ((1.0 + 1.0 / count + lever) / (1.0 + 0.5 / SIDE as f64)).sqrt()
}

/// The line of a point's neighbours; `None` without enough of them.
fn from_line(points: &[AlignedPoint], i: usize) -> Option<Line> {
    let own = &points[i];
    let goes_on = |other: &&AlignedPoint| {
        other.pass == own.pass && other.tangent.dot(&own.tangent) >= SAME_DIRECTION
    };
    let before = points[..i].iter().rev().take(2 * SIDE).take_while(goes_on);
    let after = points[i + 1..].iter().take(2 * SIDE).take_while(goes_on);
    let [before, after]: [Vec<&AlignedPoint>; 2] = [before.collect(), after.collect()];
    // Each side makes up for points that the other lacks.
    let of_before = before.len().min(2 * SIDE - after.len().min(SIDE));
    let of_after = after.len().min(2 * SIDE - of_before.min(SIDE));
    let near: Vec<&AlignedPoint> = before
        .into_iter()
        .take(of_before)
        .chain(after.into_iter().take(of_after))
        .collect();
    if near.len() < FEWEST {
        return None;
    }
    let off = Vector3::from_fn(|axis, _| {
        let slopes = near.iter().enumerate().flat_map(|(k, a)| {
            near[k + 1..].iter().filter_map(move |b| {
                let way = b.along_mm - a.along_mm;
                let rise = b.deviation_mm[axis] - a.deviation_mm[axis];
                (way != 0.0).then_some(rise / way)
            })
        });
        let slopes: Vec<f64> = slopes.collect();
        let slope = if slopes.is_empty() {
            0.0
        } else {
            median(slopes)
        };
        let height = |p: &&AlignedPoint| p.deviation_mm[axis] - slope * (p.along_mm - own.along_mm);
        own.deviation_mm[axis] - median(near.iter().map(height).collect())
    });
    let turns = near.iter().map(|p| p.tangent.cross(&own.tangent).norm());
    Some(Line {
        turn: turns.fold(0.0, larger),
        spread: spread(&near, own.along_mm),
        apart_mm: off.norm(),
        size_mm: median(near.iter().map(|p| p.deviation_mm.norm()).collect()),
    })
}
