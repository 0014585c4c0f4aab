//! Points with their feet, and which of them count.

use nalgebra::Vector3;

use crate::number::{OF_TWO_DIRECTIONS, median};
use crate::points::MeasuredPoint;
use crate::registration::motion::Motion;
use kinetostat_program::{Foot, NominalPath};

/// Standard deviations beyond which a point counts nothing.
pub(crate) const FARTHEST_DEVIATIONS: f64 = 6.0;

/// A share of the size of the points below which no distance is an outlier's: the rounding of the search.
const ROUNDING: f64 = 1e-9;

/// A point as it is moved, and its foot.
#[derive(Clone, Copy)]
pub(crate) struct Followed {
    pub moved: Vector3<f64>,
    pub foot: Foot,
    /// Of the point, 0 where it is an outlier.
    pub weight: f64,
}

/// All points moved, with their feet.
pub(crate) struct Closest {
    pub all: Vec<Followed>,
    /// Standard deviation of the distance in one direction, mm.
    pub deviation_mm: f64,
    /// Median distance, mm.
    pub median_mm: f64,
    /// The weighted middle of what counts, mm, and the mean distance from it.
    pub middle: Vector3<f64>,
    pub size_mm: f64,
}

impl Closest {
    /// `None` where a point has no foot: it is no place any more.
    pub(crate) fn of(
        nominal: &NominalPath<'_>,
        points: &[MeasuredPoint],
        motion: &Motion,
    ) -> Option<Self> {
        let follow = |point: &MeasuredPoint| {
            let moved = motion.of(&point.position_mm);
            let foot = nominal.nearest(&moved)?;
            Some(Followed {
                moved,
                foot,
                weight: point.weight,
            })
        };
        let mut all: Vec<Followed> = points.iter().map(follow).collect::<Option<_>>()?;
        let median_mm = median(all.iter().map(|point| point.foot.distance_mm).collect());
        let deviation_mm = OF_TWO_DIRECTIONS * median_mm;
        let spread = middle_and_size(&all);
        let farthest = (FARTHEST_DEVIATIONS * deviation_mm).max(ROUNDING * spread.1);
        for point in &mut all {
            if point.foot.distance_mm > farthest {
                point.weight = 0.0;
            }
        }
        let (middle, size_mm) = middle_and_size(&all);
        Some(Self {
            all,
            deviation_mm,
            median_mm,
            middle,
            size_mm,
        })
    }
}

fn middle_and_size(all: &[Followed]) -> (Vector3<f64>, f64) {
    let total: f64 = all.iter().map(|point| point.weight).sum();
    let sum: Vector3<f64> = all.iter().map(|point| point.moved * point.weight).sum();
    let middle = sum / total;
    let squares = all
        .iter()
        .map(|point| point.weight * (point.moved - middle).norm_squared());
    (middle, (squares.sum::<f64>() / total).sqrt())
}
