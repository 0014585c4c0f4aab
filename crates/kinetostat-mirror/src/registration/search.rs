//! The search for the motion.
//!
//! A step of all points towards the path, along which they may slide.
//!
//! Motions that the points do not determine, in a form that one can name.
//!
//! The directions of the unknowns that change no distance from the path are a space of which any basis is as good as another: on
//! a line, a turn about it, a shift along it and a growth along it may come as three mixtures. Here growth is taken out
//! first, then what has no turn (shifts), and what is left are turns.

use kinetostat_program::NominalPath;
use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};

use crate::error::MirrorError;
use crate::number::larger;
use crate::points::{MeasuredPoint, MeasuredPoints};
use crate::registration::candidates::{Candidate, ToldBy, chosen};
use crate::registration::closest::{Closest, RegistrationOptions, of_the_same_size};
use crate::registration::motion::{FreeMotion, Motion, Pair, closest_motion};
use crate::registration::starts::{everywhere, starts};

/// Points by which motions are judged; all of them take part in the end.
const JUDGED: usize = 1000;

/// Points with which a start is followed.
const FOLLOWING: usize = 250;

/// Residual of the motion nearest to the start, as a share of the points' size, beyond which others are sought, too.
const NO_GOOD: f64 = 0.01;

/// Steps with closest points from each start.
const COARSE: usize = 30;

/// Steps with distances across the path, at most: from each start, and in the end.
const FINE: [usize; 2] = [20, 100];

/// The way of a step, as a share of the size of the points, below which the search has ended.
const AT_REST: f64 = 1e-13;

/// The fewest places from which a motion can be told.
const FEWEST: usize = 4;

/// Largest distance of two places that are one, mm.
const SAME_MM: f64 = 1e-6;

/// The motion found.
#[derive(Clone, Debug, PartialEq)]
pub struct Registration {
    /// Motion from the frame of the measurement to that of the program.
    pub motion: Motion,
    /// Criterion by which it was chosen.
    pub told_by: ToldBy,
    /// Motions that the points do not determine; they were left as at the start.
    pub free: Vec<FreeMotion>,
    /// Steps that were taken.
    pub steps: usize,
    /// True if the last step was below the rounding.
    pub at_rest: bool,
    /// Standard deviation of the distance from the path in one direction, from what nine of ten points keep below, mm.
    pub deviation_mm: f64,
    /// Points that counted nothing, and rows of them.
    pub rejected_rows: Vec<usize>,
    /// Largest way by which the motion moves a point that counts, mm: deviations of this size may be taken away.
    pub moved_mm: f64,
}

/// Brings measured points onto the path.
///
/// ```
/// use kinetostat_mirror::{MeasuredPoints, NominalPath, RegistrationOptions, register};
/// use kinetostat_program::{Program, ReadOptions, interpret};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X80 F300\nG1 Y50\nG1 X30 Y20 Z10\n";
/// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// let turn = UnitQuaternion::from_euler_angles(0.4, -0.2, 2.0);
/// let away = |p: Vector3<f64>| turn.inverse() * (p - Vector3::new(100.0, -20.0, 7.0));
/// let points: Vec<_> = (0..60).map(|i| away(nominal.point_at(3.0 * f64::from(i)))).collect();
/// let found = register(&nominal, &MeasuredPoints::at(&points)?, RegistrationOptions::default())?;
/// assert!(found.motion.rotation.angle_to(&turn) < 1e-9);
/// assert!(found.free.is_empty() && found.rejected_rows.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Points at three places or fewer; numbers are lost on the way; points of another frame that fit the path in several places,
/// and not in the order of the whole path.
pub fn register(
    nominal: &NominalPath<'_>,
    points: &MeasuredPoints,
    options: RegistrationOptions,
) -> Result<Registration, MirrorError> {
    are_different(points.points())?;
    of_the_same_size(nominal, points, None)?;
    let points = points.points();
    let judged = some_of(points, JUDGED);
    let candidates = candidates(nominal, options, points, &judged);
    let without_scale = RegistrationOptions {
        with_scale: false,
        ..options
    };
    let free = |motion: &Motion| {
        let closest = Closest::of(nominal, points, motion, options.counting(false));
        let next = closest.and_then(|closest| step(&closest, motion, without_scale));
        next.map_or_else(Vec::new, |next| next.free)
    };
    let found = chosen(nominal, &judged, &candidates, &free)?.and_then(|(motion, told_by)| {
        let found = refine(nominal, points, motion, options, &[false, true], FINE[1])?;
        Some(Registration { told_by, ..found })
    });
    found.ok_or_else(|| {
        MirrorError::new(
            "no rigid motion brings the measured points onto the path: give more of them, or do not register them",
        )
    })
}

/// Evenly so many of the points, or all of them.
fn some_of(points: &[MeasuredPoint], most: usize) -> Vec<MeasuredPoint> {
    let every = points.len().div_ceil(most);
    points.iter().step_by(every).copied().collect()
}

/// Motions from all starts. Points that lie on the path about where they are need not be sought all over it.
fn candidates(
    nominal: &NominalPath<'_>,
    options: RegistrationOptions,
    points: &[MeasuredPoint],
    judged: &[MeasuredPoint],
) -> Vec<Candidate> {
    let following = some_of(points, FOLLOWING);
    // Growth is sought at the place that was found.
    let options = RegistrationOptions {
        with_scale: false,
        ..options
    };
    let counting = options.counting(false);
    let candidate = |start: Motion, near: bool| {
        let motion = follow(nominal, options, &following, start)?;
        let closest = Closest::of(nominal, judged, &motion, counting)?;
        Some(Candidate {
            motion,
            closest,
            near,
        })
    };
    let starts = starts(nominal, points, counting, options.only_shift);
    let near = starts.near.then(|| candidate(Motion::default(), true));
    let near = near.flatten();
    let is_good = |c: &Candidate| c.closest.left_mm <= NO_GOOD * c.closest.size_mm;
    let seek = !near.as_ref().is_some_and(is_good);
    let mut all: Vec<Candidate> = near.into_iter().collect();
    let of_whole = starts.of_whole.into_iter();
    all.extend(of_whole.filter_map(|start| candidate(start, false)));
    let size = all.first().map(|c| c.closest.size_mm);
    if let Some(size) = size.filter(|_| seek && !options.only_shift) {
        let elsewhere = everywhere(nominal, &following, size).into_iter();
        all.extend(elsewhere.filter_map(|start| candidate(start, false)));
    }
    all
}

/// Points at three places at least: two lie on any path.
fn are_different(points: &[MeasuredPoint]) -> Result<(), MirrorError> {
    let mut places: Vec<Vector3<f64>> = Vec::new();
    for point in points {
        let at = point.position_mm;
        if places.iter().all(|place| (place - at).norm() > SAME_MM) {
            places.push(at);
        }
        if places.len() == FEWEST {
            return Ok(());
        }
    }
    Err(MirrorError::new(format!(
        "the {} measured points are at {} only, which some motion brings onto every path, whatever the machine does; expected {FEWEST} different ones at least: measure along the path, or do not register the points",
        points.len(),
        match places.len() {
            1 => "one place",
            2 => "two places",
            _ => "three places",
        }
    )))
}

/// Follows a start by closest points, then across the path.
fn follow(
    nominal: &NominalPath<'_>,
    options: RegistrationOptions,
    points: &[MeasuredPoint],
    start: Motion,
) -> Option<Motion> {
    let counting = options.counting(false);
    let mut motion = start;
    let mut closest = Closest::of(nominal, points, &motion, counting)?;
    for _ in 0..COARSE {
        let pairs: Vec<Pair> = points
            .iter()
            .zip(&closest.all)
            .map(|(point, followed)| (point.position_mm, followed.foot.place_mm, followed.weight))
            .collect();
        let next = closest_motion(&pairs, options.only_shift)?;
        let nearer = Closest::of(nominal, points, &next, counting)?;
        if nearer.left_mm >= closest.left_mm {
            break;
        }
        (motion, closest) = (next, nearer);
    }
    let found = refine(nominal, points, motion, options, &[false], FINE[0])?;
    let refined = Closest::of(nominal, points, &found.motion, counting)?;
    Some(match refined.left_mm < closest.left_mm {
        true => found.motion,
        false => motion,
    })
}

/// Steps across the path until they rest, in turns without and with a look for outliers.
fn refine(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    start: Motion,
    options: RegistrationOptions,
    turns: &[bool],
    most: usize,
) -> Option<Registration> {
    let mut motion = start;
    let (mut steps, mut at_rest, mut free) = (0, false, Vec::new());
    let mut counting = options.counting(false);
    for without_outliers in turns {
        counting = options.counting(*without_outliers);
        at_rest = false;
        for _ in 0..most {
            let closest = Closest::of(nominal, points, &motion, counting)?;
            let next = step(&closest, &motion, options)?;
            (motion, free) = (next.motion, next.free);
            steps += 1;
            at_rest = next.way_mm <= AT_REST * closest.size_mm;
            if at_rest {
                break;
            }
        }
    }
    let closest = Closest::of(nominal, points, &motion, counting)?;
    let counted = points.iter().zip(&closest.all);
    let rejected = counted.clone().filter(|(_, f)| f.weight == 0.0);
    let counted_ways = counted
        .filter(|(_, f)| f.weight > 0.0)
        .map(|(point, f)| (f.moved - point.position_mm).norm());
    Some(Registration {
        motion,
        told_by: ToldBy::Frame,
        free,
        steps,
        at_rest,
        deviation_mm: closest.deviation_mm,
        rejected_rows: rejected.map(|(point, _)| point.row).collect(),
        moved_mm: counted_ways.fold(0.0, larger),
    })
}

/// Eigenvalues of the normal equations below this share of the largest determine nothing.
const UNDETERMINED: f64 = 1e-6;

/// A step, and what it left as it was.
pub(crate) struct Step {
    pub motion: Motion,
    /// Motion of the points by it, mm: the shift and the turn at the mean distance from the middle.
    pub way_mm: f64,
    pub free: Vec<FreeMotion>,
}

/// The step from a motion to the next, by Gauss-Newton with the distances across the path; `None` where numbers are lost.
fn step(closest: &Closest, before: &Motion, options: RegistrationOptions) -> Option<Step> {
    let size = closest.size_mm.max(f64::MIN_POSITIVE);
    let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    let mut right = Unknowns::zeros();
    for point in closest.all.iter().filter(|point| point.weight > 0.0) {
        let lever = (point.moved - closest.middle) / size;
        let tangent = point.foot.tangent;
        let across = Matrix3::identity() - tangent * tangent.transpose();
        // Columns: turn about x, y, z, shift along x, y, z, and growth; all as ways in mm.
        let mut ways = SMatrix::<f64, 3, UNKNOWNS>::zeros();
        if !options.only_shift {
            ways.view_mut((0, 0), (3, 3))
                .copy_from(&(-lever.cross_matrix()));
        }
        ways.view_mut((0, 3), (3, 3))
            .copy_from(&Matrix3::identity());
        if options.with_scale {
            ways.set_column(6, &lever);
        }
        let gap = across * (point.foot.place_mm - point.moved);
        let seen = across * ways;
        normal += seen.transpose() * seen * point.weight;
        right += seen.transpose() * gap * point.weight;
    }
    if !normal
        .iter()
        .chain(right.iter())
        .all(|entry| entry.is_finite())
    {
        return None;
    }
    let eigen = normal.symmetric_eigen();
    let largest = eigen.eigenvalues[eigen.eigenvalues.imax()];
    let mut solution = Unknowns::zeros();
    let mut open = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        match *value > UNDETERMINED * largest {
            true => solution += vector * (vector.dot(&right) / value),
            false => open += vector * vector.transpose(),
        }
    }
    if options.only_shift {
        // Turns are not sought, so that none is open.
        let shifts =
            SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_diagonal(&Unknowns::from_fn(|i, _| {
                f64::from(u8::from((3..6).contains(&i)))
            }));
        open = shifts * open * shifts;
    }
    let turn = Vector3::new(solution[0], solution[1], solution[2]) / size;
    let shift = Vector3::new(solution[3], solution[4], solution[5]);
    let growth = 1.0 + solution[6] / size;
    let rotation = UnitQuaternion::from_scaled_axis(turn);
    let motion = Motion {
        rotation: rotation * before.rotation,
        shift_mm: rotation * (before.shift_mm - closest.middle) * growth + closest.middle + shift,
        scale: before.scale * growth,
    };
    Some(Step {
        motion,
        way_mm: solution.norm(),
        free: free_motions(open, closest, options.with_scale),
    })
}

/// Turn, shift and growth.
const UNKNOWNS: usize = 7;

pub(crate) type Unknowns = SVector<f64, UNKNOWNS>;

type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// The unknown that is growth; turns about x, y and z stand first, then shifts.
const GROWTH: usize = 6;

/// A direction with so small a square of its turn (a way at the mean distance from the middle, of a whole of 1) is a shift, and
/// one with so small a square of its growth has none.
const NONE: f64 = 0.01;

/// Free motions from the projection onto the directions that the points leave open.
fn free_motions(mut open: Square, closest: &Closest, with_scale: bool) -> Vec<FreeMotion> {
    let mut free = Vec::new();
    let growth: Unknowns = open.column(GROWTH).into_owned();
    // A projection: the square of its length is its own entry.
    if growth[GROWTH] > NONE {
        open -= growth * growth.transpose() / growth[GROWTH];
        // Growth is not determined if no scale is sought.
        free.extend(with_scale.then_some(FreeMotion::Growth));
    }
    let turns = Square::from_diagonal(&Unknowns::from_fn(|i, _| f64::from(u8::from(i < 3))));
    // Open directions by the square of their turn, from 0 to 1; all others at 2.
    let eigen = (open * turns * open + (Square::identity() - open) * 2.0).symmetric_eigen();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        let way = Vector3::new(vector[0], vector[1], vector[2]);
        let shift = Vector3::new(vector[3], vector[4], vector[5]);
        match *value {
            value if value < NONE => {
                free.extend(direction(shift).map(|along| FreeMotion::Shift { along }))
            }
            value if value < 1.5 => free.extend(direction(way).map(|along| {
                let turn = way / closest.size_mm;
                FreeMotion::Turn {
                    through_mm: closest.middle + turn.cross(&shift) / turn.norm_squared(),
                    along,
                }
            })),
            _ => {}
        }
    }
    free
}

/// Returns the one of two opposite directions whose largest component is positive.
fn direction(of: Vector3<f64>) -> Option<Vector3<f64>> {
    let direction = of.try_normalize(f64::MIN_POSITIVE)?;
    Some(match direction[direction.iamax()] < 0.0 {
        true => -direction,
        false => direction,
    })
}
