//! Points with their feet, which of them count, and a check that they are about as large as the path.

use kinetostat_program::{Foot, NominalPath};
use nalgebra::Vector3;

use crate::error::MirrorError;
use crate::number::{OF_NINE_IN_TEN, larger, median, quantile};
use crate::points::{MeasuredPoint, MeasuredPoints};
use crate::registration::motion::Motion;

/// Standard deviations beyond which a point counts nothing.
pub(crate) const FARTHEST_DEVIATIONS: f64 = 6.0;

/// A share of the size of the points below which no distance is an outlier's: the rounding of the search.
const ROUNDING: f64 = 1e-9;

/// The scatter is told by the distance that this share of the points keep below.
const TOLD_BY: f64 = 0.9;

/// Fits compete by this share of the points, the closest: a place that one point in three is far from is no fit, however well the
/// others lie on it (trimmed squares: Rousseeuw 1984; of closest points: Chetverikov and others 2002).
const COMPETING: f64 = 0.9;

/// Neighbours to each side that may bear a point out, and as which share of its distance they may differ from it.
const SIDE: usize = 4;
const BORNE_OUT: f64 = 0.5;

/// Rule by which points are left out.
///
/// Deviations are smooth: where most points lie on a line, a turn about it costs nothing, and a fit that lets go of points for being
/// farther off than most lets go of the few that tell the turn. Within the window a point therefore counts, unless it is an outlier
/// that no neighbour bears out; and these are only looked for when all others have come to rest.
#[derive(Clone, Copy)]
pub(crate) struct Counting {
    /// Maximum distance of the tool from its path, mm.
    pub window_mm: f64,
    /// True to leave out points that are farther off than six standard deviations and than their neighbours.
    pub without_outliers: bool,
}

/// A point as it is moved, and its foot.
#[derive(Clone, Copy)]
pub(crate) struct Followed {
    pub moved: Vector3<f64>,
    pub foot: Foot,
    /// Weight of the point, 0 for an outlier.
    pub weight: f64,
}

/// All points moved, with their feet.
pub(crate) struct Closest {
    pub all: Vec<Followed>,
    /// Standard deviation of the distance in one direction, mm.
    pub deviation_mm: f64,
    /// Root mean square of the distances of nine in ten points, the closest, mm.
    pub left_mm: f64,
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
        counting: Counting,
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
        let distances: Vec<f64> = all.iter().map(|point| point.foot.distance_mm).collect();
        let left_mm = closest_rms(distances.clone());
        let deviation_mm = OF_NINE_IN_TEN * quantile(distances, TOLD_BY);
        let spread = middle_and_size(&all);
        let scatter = larger(FARTHEST_DEVIATIONS * deviation_mm, ROUNDING * spread.1);
        let farthest = larger(scatter, counting.window_mm);
        if counting.without_outliers {
            for index in outliers(&all, scatter) {
                all[index].weight = 0.0;
            }
        }
        for point in &mut all {
            if point.foot.distance_mm > farthest {
                point.weight = 0.0;
            }
        }
        let (middle, size_mm) = middle_and_size(&all);
        Some(Self {
            all,
            deviation_mm,
            left_mm,
            middle,
            size_mm,
        })
    }
}

/// Points that are farther from the path than so, and that their neighbours along it do not bear out: neither those before them nor
/// those after.
fn outliers(all: &[Followed], farther_mm: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|a, b| all[*a].foot.along_mm.total_cmp(&all[*b].foot.along_mm));
    let off = |index: &usize| all[*index].moved - all[*index].foot.place_mm;
    let is_outlier = |k: &usize| {
        let own = off(&order[*k]);
        let agree = |side: &[usize]| {
            let middle = Vector3::from_fn(|axis, _| {
                median(side.iter().map(|index| off(index)[axis]).collect())
            });
            side.len() >= 2 && (own - middle).norm() <= BORNE_OUT * own.norm()
        };
        let before = &order[k.saturating_sub(SIDE)..*k];
        let after = &order[k + 1..(k + 1 + SIDE).min(order.len())];
        own.norm() > farther_mm && !agree(before) && !agree(after)
    };
    let places = (0..order.len()).filter(is_outlier);
    places.map(|k| order[k]).collect()
}

/// Root mean square of the smallest that compete.
fn closest_rms(mut distances: Vec<f64>) -> f64 {
    let count = (distances.len() as f64 * COMPETING).ceil().max(1.0) as usize;
    distances.sort_unstable_by(f64::total_cmp);
    let squares = distances
        .iter()
        .take(count)
        .map(|distance| distance * distance);
    (squares.sum::<f64>() / count as f64).sqrt()
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

/// Options of a registration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegistrationOptions {
    /// Seek a scale too: where the part has another temperature than its drawing.
    pub with_scale: bool,
    /// Seek a shift only: no turn, and no scale.
    pub only_shift: bool,
    /// Maximum distance of the tool from its path, mm: points within that are not outliers.
    pub window_mm: f64,
}

impl Default for RegistrationOptions {
    fn default() -> Self {
        Self {
            with_scale: false,
            only_shift: false,
            window_mm: 1.0,
        }
    }
}

impl RegistrationOptions {
    pub(crate) fn counting(self, without_outliers: bool) -> Counting {
        Counting {
            window_mm: self.window_mm,
            without_outliers,
        }
    }
}

/// Points that span less of the extent of the path than this, or so many times more, are laid onto something else.
const SMALLEST: f64 = 0.05;
/// Places of the path that say how large it is.
const PLACES: usize = 1000;

/// Refuses to register points of another size: a cloud in a wrong unit lies well on a piece of one line. Points in the frame of
/// the program may be of a small piece of it, but not within the smoothing length, `within_mm`: there they are of one place.
///
/// # Errors
/// Points that span less than a twentieth of the path, or more than twenty times as much.
pub(crate) fn of_the_same_size(
    nominal: &NominalPath<'_>,
    measured: &MeasuredPoints,
    within_mm: Option<f64>,
) -> Result<(), MirrorError> {
    let along = |k: usize| nominal.length_mm() * k as f64 / PLACES as f64;
    let path_mm = diagonal((0..=PLACES).map(|k| nominal.point_at(along(k))));
    let points_mm = diagonal(measured.points().iter().map(|point| point.position_mm));
    let share = points_mm / path_mm;
    let is_of_a_piece = within_mm.is_some_and(|within_mm| points_mm >= within_mm);
    if (SMALLEST..=1.0 / SMALLEST).contains(&share) || is_of_a_piece {
        return Ok(());
    }
    Err(MirrorError::new(format!(
        "the measured points span {points_mm:.3} mm and the path {path_mm:.3} mm: they fit a small piece of it in many places, or none. Check the unit of their columns (inches or metres taken for millimetres), measure more of the path, or give points of one feature in the frame of the program, do not register them, and smooth over less than they span"
    )))
}

/// Diagonal of the box around points, mm.
fn diagonal(points: impl Iterator<Item = Vector3<f64>>) -> f64 {
    let around = |corners: Option<[Vector3<f64>; 2]>, point: Vector3<f64>| {
        let [low, high] = corners.unwrap_or([point, point]);
        Some([low.inf(&point), high.sup(&point)])
    };
    let corners = points.fold(None, around);
    corners.map_or(0.0, |[low, high]| (high - low).norm())
}
