//! Places all over the path on which points may lie, whatever part of it was measured and in whatever order.
//!
//! Three points far from one another are looked for among places of the path with the same distances between them; each find is a
//! motion (Horn 1987), and those are kept of which most points come to lie near the path.

use nalgebra::Vector3;

use crate::number::quantile;
use crate::points::MeasuredPoint;
use crate::registration::horn::{Pair, closest_motion};
use crate::registration::motion::Motion;
use kinetostat_program::NominalPath;

/// Spacing of the places, as a share of the size of the points, and how many there are at most.
const SPACING: f64 = 0.03;
const MOST_PLACES: f64 = 400.0;

/// Maximum spacing, as a share of the size: with a larger one a path winds too much to be searched in this way.
const COARSEST: f64 = 0.15;

/// Points far from one another are those that this share of all are nearer than: the farthest of all may be outliers.
const FAR: f64 = 0.95;

/// Points by which a find is looked at, and how many of them may be off.
const LOOKED_AT: usize = 24;
const OFF: usize = 4;

/// A point is near the path within so many spacings.
const NEAR: f64 = 1.5;

/// Number of distinct finds that are followed, the best first.
const FOLLOWED: usize = 16;

/// Motions with which most points lie near the path; none where it winds too much.
pub(crate) fn everywhere(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    size_mm: f64,
) -> Vec<Motion> {
    let length = nominal.length_mm();
    let count = (length / (SPACING * size_mm)).ceil().min(MOST_PLACES);
    let spacing = length / count;
    let Some(three) = three_far(points).filter(|_| spacing <= COARSEST * size_mm) else {
        return Vec::new();
    };
    let places: Vec<Vector3<f64>> = (0..=count as usize)
        .map(|i| nominal.point_at(length * i as f64 / count))
        .collect();
    let every = points.len().div_ceil(LOOKED_AT);
    let looked_at: Vec<Vector3<f64>> = points
        .iter()
        .step_by(every)
        .map(|point| point.position_mm)
        .collect();
    let mut finds: Vec<(f64, Motion)> = Vec::new();
    for image in same_distances(&places, &three, spacing) {
        let pairs: Vec<Pair> = three.iter().zip(image).map(|(p, q)| (*p, q, 1.0)).collect();
        let motion = closest_motion(&pairs, false);
        let looked = motion.and_then(|motion| {
            let off = how_far(nominal, &looked_at, &motion, NEAR * spacing)?;
            Some((off, motion))
        });
        finds.extend(looked);
    }
    finds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<Motion> = Vec::new();
    for (_, motion) in finds {
        let same = |other: &Motion| {
            let apart = looked_at
                .iter()
                .map(|p| (motion.of(p) - other.of(p)).norm());
            apart.fold(0.0, crate::number::larger) < 2.0 * NEAR * spacing
        };
        if !kept.iter().any(same) {
            kept.push(motion);
        }
        if kept.len() == FOLLOWED {
            break;
        }
    }
    kept
}

/// Three points far from one another: from the middle, from the first, and from the line through both.
fn three_far(points: &[MeasuredPoint]) -> Option<[Vector3<f64>; 3]> {
    let all = || points.iter().map(|point| point.position_mm);
    let middle = all().sum::<Vector3<f64>>() / points.len() as f64;
    let far = |from: &dyn Fn(&Vector3<f64>) -> f64| {
        let at = quantile(all().map(|p| from(&p)).collect(), FAR);
        all().find(|p| from(p) >= at)
    };
    let first = far(&|p| (p - middle).norm())?;
    let second = far(&|p| (p - first).norm())?;
    let along = (second - first).try_normalize(f64::MIN_POSITIVE)?;
    let third = far(&|p| (p - first).cross(&along).norm())?;
    Some([first, second, third])
}

/// Triples of places whose distances are those of three points, within a spacing.
fn same_distances(
    places: &[Vector3<f64>],
    [a, b, c]: &[Vector3<f64>; 3],
    spacing: f64,
) -> Vec<[Vector3<f64>; 3]> {
    let [ab, ac, bc] = [(b - a).norm(), (c - a).norm(), (c - b).norm()];
    let fits =
        |p: &Vector3<f64>, q: &Vector3<f64>, apart: f64| ((p - q).norm() - apart).abs() <= spacing;
    let mut found = Vec::new();
    for first in places {
        let third: Vec<&Vector3<f64>> = places.iter().filter(|q| fits(first, q, ac)).collect();
        for second in places.iter().filter(|q| fits(first, q, ab)) {
            let meet = third.iter().filter(|q| fits(second, q, bc));
            found.extend(meet.map(|third| [*first, *second, **third]));
        }
    }
    found
}

/// Mean distance of the points that are near the path; `None` where more are not than may be off.
fn how_far(
    nominal: &NominalPath<'_>,
    points: &[Vector3<f64>],
    motion: &Motion,
    near_mm: f64,
) -> Option<f64> {
    let (mut sum, mut off) = (0.0, 0);
    for point in points {
        let distance = nominal.nearest(&motion.of(point))?.distance_mm;
        if distance <= near_mm {
            sum += distance;
        } else {
            off += 1;
            sum += near_mm;
        }
        if off > OFF {
            return None;
        }
    }
    Some(sum / points.len() as f64)
}
