//! Motions from which the points are followed onto the path.

use kinetostat_program::NominalPath;
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::number::quantile;
use crate::points::MeasuredPoint;
use crate::registration::closest::{Closest, Counting};
use crate::registration::motion::{Motion, Pair, closest_motion};

/// Places of the path for its principal axes.
const PLACES: usize = 1000;

/// Points are about where the path is if what they leave of it is no more than this share of their size.
const ABOUT: f64 = 0.2;

/// Points whose spread across their longest axis is this share of that along it (squares) are on a line: a turn about it is
/// not determined by them.
const LINE: f64 = 1e-6;

/// Motions to start from.
pub(crate) struct Starts {
    /// The points lie about where the path is: where they are is a start, too.
    pub near: bool,
    /// Starts by order, and by principal axes: for points along the whole path.
    pub of_whole: Vec<Motion>,
}

/// Starts of the search.
///
/// From another frame closest points may slide half of the points beyond the end of a straight path, so that where they are is no
/// start.
pub(crate) fn starts(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    counting: Counting,
    only_shift: bool,
) -> Starts {
    let unmoved = Closest::of(nominal, points, &Motion::default(), counting);
    let mut of_whole: Vec<Motion> = in_order(nominal, points, only_shift).into_iter().collect();
    if !only_shift {
        of_whole.extend(by_principal_axes(nominal, points));
    }
    Starts {
        near: unmoved.is_some_and(|found| found.left_mm <= ABOUT * found.size_mm),
        of_whole,
    }
}

/// Points in the order of the path: at the same share of the way.
fn in_order(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    only_shift: bool,
) -> Option<Motion> {
    let places = places_in_order(nominal, points);
    let pairs = points.iter().zip(places);
    let pairs: Vec<Pair> = pairs
        .map(|(point, place)| (point.position_mm, place, point.weight))
        .collect();
    closest_motion(&pairs, only_shift)
}

/// The places of the path at the shares of the way through the points.
pub(crate) fn places_in_order(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
) -> Vec<Vector3<f64>> {
    let mut way = 0.0;
    let mut ways = vec![0.0];
    for pair in points.windows(2) {
        way += (pair[1].position_mm - pair[0].position_mm).norm();
        ways.push(way);
    }
    let whole = nominal.length_mm();
    let share = |at: &f64| nominal.point_at(whole * at / way);
    ways.iter().map(share).collect()
}

/// Principal axes onto those of the path, turned in the four ways that keep right-handed axes.
fn by_principal_axes(nominal: &NominalPath<'_>, points: &[MeasuredPoint]) -> Vec<Motion> {
    let length = nominal.length_mm();
    let places = (0..PLACES).map(|i| nominal.point_at(length * (i as f64 + 0.5) / PLACES as f64));
    let path: Vec<Vector3<f64>> = places.collect();
    let measured: Vec<Vector3<f64>> = points.iter().map(|point| point.position_mm).collect();
    let (Some(from), Some(to)) = (principal(&measured), principal(&path)) else {
        return Vec::new();
    };
    if from.line {
        return ends_of_line(&from, &to).to_vec();
    }
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let turned = signs.map(|[first, second]| {
        let flip = Matrix3::from_diagonal(&Vector3::new(first, second, first * second));
        let matrix = to.axes * flip * from.axes.transpose();
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Motion {
            rotation,
            shift_mm: to.middle - rotation * from.middle,
            scale: 1.0,
        }
    });
    turned.to_vec()
}

/// Points on a line, whose other axes are any: onto the longest axis of the path, either way around, by the least turn.
fn ends_of_line(from: &Principal, to: &Principal) -> [Motion; 2] {
    let (line, longest) = (from.axes.column(0), to.axes.column(0));
    [1.0, -1.0].map(|sign| {
        let rotation = UnitQuaternion::rotation_between(&line, &(longest * sign))
            // Half a turn, about any axis across it.
            .unwrap_or_else(|| {
                let about = Unit::new_normalize(from.axes.column(1).into_owned());
                UnitQuaternion::from_axis_angle(&about, std::f64::consts::PI)
            });
        Motion {
            rotation,
            shift_mm: to.middle - rotation * from.middle,
            scale: 1.0,
        }
    })
}

/// Middle and principal axes, right-handed, the longest first.
struct Principal {
    middle: Vector3<f64>,
    axes: Matrix3<f64>,
    /// True if there is no second axis.
    line: bool,
}

fn principal(points: &[Vector3<f64>]) -> Option<Principal> {
    let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let mut spread = Matrix3::zeros();
    for point in points {
        let out = point - middle;
        spread += out * out.transpose();
    }
    if !spread.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let eigen = spread.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let axis = |i: usize| eigen.eigenvectors.column(order[i]).into_owned();
    let (first, second) = (axis(0), axis(1));
    Some(Principal {
        middle,
        axes: Matrix3::from_columns(&[first, second, first.cross(&second)]),
        line: eigen.eigenvalues[order[1]] <= LINE * eigen.eigenvalues[order[0]],
    })
}

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
///
/// Three points far from one another are looked for among places of the path with the same distances between them; each find is a
/// motion (Horn 1987), and those are kept of which most points come to lie near the path.
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
