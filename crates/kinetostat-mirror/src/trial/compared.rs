//! Two trials compared place by place: what the points of one say where the other was measured.
//!
//! The points before stand at other places. Their means are interpolated by the polynomial through the two nearest to each side (Lagrange), as
//! far as none is farther from the next than the smoothing length: what bends between such points is not seen.

use std::ops::Range;

use nalgebra::Vector3;

use crate::deviation::PieceMean;

/// Places up to this share of a smoothing length behind the last point before are still compared with it: the way between stations.
const BESIDE: f64 = 0.25;

/// A place that was measured now, and what the points before say of it.
pub(crate) struct Place<'m> {
    pub now: &'m PieceMean,
    /// Means before, and their shares in the deviation there.
    pub before: Vec<(usize, f64)>,
    /// Deviation now less that before.
    pub change_mm: Vector3<f64>,
    /// Change by straight interpolation.
    pub straight_mm: Vector3<f64>,
    /// The correction, with the opposite sign.
    pub sent_mm: Vector3<f64>,
    pub weight: f64,
}

impl<'m> Place<'m> {
    /// `None` where the points before say nothing.
    pub(crate) fn of(
        now: &'m PieceMean,
        before: &[PieceMean],
        sent_mm: Vector3<f64>,
        smoothing_mm: f64,
    ) -> Option<Self> {
        let first = before.partition_point(|mean| mean.stretch < now.stretch);
        let end = before.partition_point(|mean| mean.stretch <= now.stretch);
        let nodes = around(before.get(first..end)?, now.along_mm, smoothing_mm)?;
        let [straight, cubic] =
            nodes.map(|nodes| shares(before, first + nodes.start..first + nodes.end, now.along_mm));
        let changed = |shares: &[(usize, f64)]| {
            let there = shares
                .iter()
                .map(|(index, share)| before[*index].deviation_mm * *share);
            now.deviation_mm - there.sum::<Vector3<f64>>()
        };
        let scatter = cubic
            .iter()
            .map(|(index, share)| share * share / before[*index].points);
        let weight = 1.0 / (1.0 / now.points + scatter.sum::<f64>());
        (weight > 0.0).then(|| Self {
            now,
            change_mm: changed(&cubic),
            straight_mm: changed(&straight),
            before: cubic,
            sent_mm,
            weight,
        })
    }
}

/// Means around a place for straight and for cubic interpolation; `None` too far from them.
fn around(before: &[PieceMean], along_mm: f64, smoothing_mm: f64) -> Option<[Range<usize>; 2]> {
    let after = before.partition_point(|mean| mean.along_mm <= along_mm);
    let way = |index: usize| before[index].along_mm - before[index - 1].along_mm;
    let goes_on = |index: usize| index > 0 && index < before.len() && way(index) <= smoothing_mm;
    let nearest = match after {
        _ if goes_on(after) => after - 1..after + 1,
        0 => 0..1,
        _ if after == before.len() => after - 1..after,
        _ => return None,
    };
    let beside = before.get(nearest.start)?.along_mm - along_mm;
    if nearest.len() == 1 && beside.abs() > BESIDE * smoothing_mm {
        return None;
    }
    let start = nearest.start - usize::from(goes_on(nearest.start));
    let end = nearest.end + usize::from(goes_on(nearest.end));
    Some([nearest, start..end])
}

/// Shares of the values at some places in that of the polynomial through them.
fn shares(before: &[PieceMean], nodes: Range<usize>, along_mm: f64) -> Vec<(usize, f64)> {
    let of_one = |index: usize| {
        let others = nodes.clone().filter(|other| *other != index);
        let factors = others.map(|other| {
            let at = before[other].along_mm;
            (along_mm - at) / (before[index].along_mm - at)
        });
        (index, factors.product())
    };
    nodes.clone().map(of_one).collect()
}
