//! Test that the measured program had the last correction in it.
//!
//! A trial that found the smoothed deviation `a` corrected the program by `-rho a`. A machine that answers with the share `beta` of a
//! correction shows `e - beta rho a` in the next trial, with the `e` that the points of the trial before had there; of the program before,
//! run or measured once more, `beta` is 0. The change from trial to trial is therefore fitted by `-beta rho a` (weighted least squares, the
//! weight of a place by how many points its change rests on), and `beta` is known to the standard deviation `s` by three things that add
//! up:
//!
//! - the scatter of the points, as it goes through the interpolation of those before to the places of those now;
//! - what the fit leaves beyond it (drift, an answer that differs along the path): alike over a smoothing length, so that it
//!   averages out only over the pieces of the path that are smoothed apart;
//! - half of what straight interpolation in place of the cubic one would change: an upper bound of what the cubic one misses
//!   of waves longer than four ways between points.
//!
//! By how much the fit is worse (`-2 ln` of its likelihood) with `beta = 0` is `(beta / s)^2`; with an answer that a machine may have, from `b` on,
//! `((b - beta) / s)^2`, nothing where `beta` is larger. The smaller one explains the measurement better, clearly if it is a hundred times as likely
//! (the ratio of likelihoods, Neyman and Pearson 1933).
//!
//! Two trials compared place by place: what the points of one say where the other was measured.
//!
//! The points before stand at other places. Their means are interpolated by the polynomial through the two nearest to each side (Lagrange), as
//! far as none is farther from the next than the smoothing length: what bends between such points is not seen.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::Vector3;

use crate::alignment::AlignedPoint;
use crate::deviation::{Kernel, Measurement, PieceMean, Stations, smoothed_along};
use crate::number::larger;

/// A machine may answer with this share of a correction: ten trials then leave a tenth of the error. A machine that answers with
/// less is not worth correcting by trials.
const LEAST_ANSWER: f64 = 0.2;

/// A hundred times as likely: `2 ln 100`, three standard deviations.
const CLEARLY: f64 = 9.210_340_371_976_184;

/// Share to which a correction is known from points without any scatter: sums of numbers of sixteen digits.
const ROUNDING: f64 = 1e-9;

/// The trial before, whose correction is looked for.
pub(crate) struct Before<'a> {
    /// Smoothed deviation at the stations, mm.
    pub deviation_mm: &'a [Vector3<f64>],
    /// Means of its points.
    pub means: &'a [PieceMean],
    pub relaxation: f64,
    pub smoothing_mm: f64,
}

/// Estimate of a correction's response.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Share of it, NaN where no place was measured before and now.
    pub answer: f64,
    /// Standard deviation of that.
    pub known_to: f64,
}

/// Standard deviation to which a point of a measurement is known, mm.
pub(crate) fn scatter_mm(measured: &Measurement) -> f64 {
    larger(measured.figures.scatter_mm, measured.known_to_mm)
}

impl Seen {
    /// Estimate from the means of a trial of the correction of the trial before; points before and now scatter by
    /// `scatter_mm`.
    pub(crate) fn of(
        stations: &Stations,
        before: &Before<'_>,
        now: &[PieceMean],
        scatter_mm: f64,
    ) -> Self {
        let smoothing_mm = before.smoothing_mm;
        let places = now.iter().filter_map(|mean| {
            let (stretch, along_mm) = (mean.stretch, mean.along_mm);
            let there = between_stations(stations, before.deviation_mm, stretch, along_mm);
            let sent = there * before.relaxation;
            Place::of(mean, before.means, sent, smoothing_mm)
        });
        Self::in_places(
            &places.collect::<Vec<_>>(),
            before.means,
            scatter_mm,
            smoothing_mm,
        )
    }

    fn in_places(
        places: &[Place<'_>],
        before: &[PieceMean],
        scatter_mm: f64,
        smoothing_mm: f64,
    ) -> Self {
        let of_all = |one: &dyn Fn(&Place<'_>) -> f64| places.iter().map(one).sum::<f64>();
        let sent_square = of_all(&|p| p.weight * p.sent_mm.norm_squared());
        let answer = -of_all(&|p| p.weight * p.change_mm.dot(&p.sent_mm)) / sent_square;
        let straight = -of_all(&|p| p.weight * p.straight_mm.dot(&p.sent_mm)) / sent_square;
        let mut carried = vec![Vector3::zeros(); before.len()];
        for place in places {
            for (index, share) in &place.before {
                carried[*index] += place.sent_mm * (place.weight * share);
            }
        }
        let of_now = of_all(&|p| (p.weight * p.sent_mm).norm_squared() / p.now.points);
        let of_before = carried.iter().zip(before);
        let of_before: f64 = of_before
            .map(|(sum, mean)| sum.norm_squared() / mean.points)
            .sum();
        let of_points = scatter_mm.powi(2) * (of_now + of_before) / sent_square.powi(2);

        let count = places.len() as f64;
        let left = of_all(&|p| p.weight * (p.change_mm + p.sent_mm * answer).norm_squared());
        let beyond = left / (2.0 * count - 1.0) - scatter_mm.powi(2);
        let apart_mm = std::f64::consts::PI.sqrt() * smoothing_mm;
        let pieces = places
            .iter()
            .map(|p| (p.now.stretch, (p.now.along_mm / apart_mm) as u64));
        let pieces = pieces.collect::<BTreeSet<_>>().len() as f64;
        let of_rest = larger(beyond, 0.0) * count / (pieces * sent_square);
        let of_interpolation = (0.5 * (answer - straight)).powi(2);
        Self {
            answer,
            known_to: larger((of_points + of_rest + of_interpolation).sqrt(), ROUNDING),
        }
    }

    /// Excess of `-2 ln` of the likelihood for a machine without the correction, and for one with it.
    fn worse(&self) -> [f64; 2] {
        let below = larger(LEAST_ANSWER - self.answer, 0.0);
        [self.answer, below].map(|off| (off / self.known_to).powi(2))
    }

    /// True if a run without the correction explains the measurement, and clearly better than one with it.
    pub(crate) fn is_missing(&self) -> bool {
        let [without, with] = self.worse();
        let explains = without < CLEARLY || self.answer.abs() < 0.5 * LEAST_ANSWER;
        explains && with - without > CLEARLY
    }

    /// True if a run with the correction explains the measurement clearly better.
    pub(crate) fn is_there(&self) -> bool {
        let [without, with] = self.worse();
        without - with > CLEARLY
    }
}

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
        let there = between_stations(stations, deviation_mm, stretch, point.along_mm);
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
    stretch: usize,
    along_mm: f64,
) -> Vector3<f64> {
    let along = stations.along_mm();
    let own = &stations.stretches()[stretch].stations;
    let after = along[own.clone()].partition_point(|at| *at <= along_mm);
    let k = own.start + after.clamp(1, own.len() - 1);
    let share = (along_mm - along[k - 1]) / (along[k] - along[k - 1]);
    at_stations[k - 1].lerp(&at_stations[k], share.clamp(0.0, 1.0))
}
