//! Motions from which the points are followed onto the path.

use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::points::MeasuredPoint;
use crate::registration::closest::{Closest, Counting};
use crate::registration::horn::{Pair, closest_motion};
use crate::registration::motion::Motion;
use kinetostat_program::NominalPath;

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
