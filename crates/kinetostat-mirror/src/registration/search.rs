//! The search for the motion.

use crate::error::MirrorError;
use crate::points::{MeasuredPoint, MeasuredPoints};
use crate::registration::closest::Closest;
use crate::registration::horn::{Pair, closest_motion};
use crate::registration::motion::{FreeMotion, Motion};
use crate::registration::starts::starts;
use crate::registration::step::step;
use kinetostat_program::NominalPath;
use nalgebra::Vector3;

/// Points by which a start is judged; all of them take part in the end.
const JUDGED: usize = 1000;

/// Steps with closest points from each start.
const COARSE: usize = 30;

/// Steps with distances across the path, at most: from each start, and in the end.
const FINE: [usize; 2] = [20, 100];

/// A start must be nearer than this share of the one before it to be taken instead.
const CLEARLY: f64 = 0.7;

/// Nearer than this share of the size of the points, none is nearer than another: that is rounding.
const SAME: f64 = 1e-9;

/// The way of a step, as a share of the size of the points, below which the search has ended.
const AT_REST: f64 = 1e-13;

/// The fewest places from which a motion can be told.
const FEWEST: usize = 3;

/// Two places are one where they are no farther apart than this, mm.
const SAME_MM: f64 = 1e-6;

/// How a registration is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegistrationOptions {
    /// Seek a scale too: where the part has another temperature than its drawing.
    pub with_scale: bool,
}

/// The motion found.
#[derive(Clone, Debug, PartialEq)]
pub struct Registration {
    /// From the frame of the measurement to that of the program.
    pub motion: Motion,
    /// What the points do not determine; it was left as at the start.
    pub free: Vec<FreeMotion>,
    /// Steps that were taken.
    pub steps: usize,
    /// Whether the last step was below the rounding.
    pub at_rest: bool,
    /// Standard deviation of the distance from the path in one direction, from its median, mm.
    pub deviation_mm: f64,
    /// Points that counted nothing, and rows of them.
    pub rejected_rows: Vec<usize>,
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
/// Points at one or two places only; numbers are lost on the way.
pub fn register(
    nominal: &NominalPath<'_>,
    points: &MeasuredPoints,
    options: RegistrationOptions,
) -> Result<Registration, MirrorError> {
    let points = points.points();
    are_different(points)?;
    let every = points.len().div_ceil(JUDGED);
    let judged: Vec<MeasuredPoint> = points.iter().step_by(every).copied().collect();
    let size = Closest::of(nominal, &judged, &Motion::default()).map(|found| found.size_mm);
    let same = SAME * size.unwrap_or(0.0);
    let mut best: Option<(f64, Motion)> = None;
    for start in starts(nominal, points) {
        let Some((median, motion)) = follow(nominal, &judged, start) else {
            continue;
        };
        if best.is_none_or(|(nearest, _)| nearest > same && median < CLEARLY * nearest) {
            best = Some((median, motion));
        }
    }
    let found = best.and_then(|(_, motion)| refine(nominal, points, motion, (options, FINE[1])));
    found.ok_or_else(|| {
        MirrorError::new(
            "no rigid motion brings the measured points onto the path: give more of them, or do not register them",
        )
    })
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
        "the {} measured points are at {} only, from which no motion onto the path can be told; expected {FEWEST} different ones at least: measure along the path, or do not register the points",
        points.len(),
        match places.len() {
            1 => "one place",
            _ => "two places",
        }
    )))
}

/// Follows a start by closest points, then across the path; the median distance that is left.
fn follow(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    start: Motion,
) -> Option<(f64, Motion)> {
    let mut motion = start;
    let mut closest = Closest::of(nominal, points, &motion)?;
    for _ in 0..COARSE {
        let pairs: Vec<Pair> = points
            .iter()
            .zip(&closest.all)
            .map(|(point, followed)| (point.position_mm, followed.foot.place_mm, followed.weight))
            .collect();
        let next = closest_motion(&pairs, false)?;
        let nearer = Closest::of(nominal, points, &next)?;
        if nearer.median_mm >= closest.median_mm {
            break;
        }
        (motion, closest) = (next, nearer);
    }
    let found = refine(
        nominal,
        points,
        motion,
        (RegistrationOptions::default(), FINE[0]),
    )?;
    let refined = Closest::of(nominal, points, &found.motion)?;
    match refined.median_mm < closest.median_mm {
        true => Some((refined.median_mm, found.motion)),
        false => Some((closest.median_mm, motion)),
    }
}

/// Steps across the path until they rest.
fn refine(
    nominal: &NominalPath<'_>,
    points: &[MeasuredPoint],
    start: Motion,
    (options, most): (RegistrationOptions, usize),
) -> Option<Registration> {
    let mut motion = start;
    let (mut steps, mut at_rest, mut free) = (0, false, Vec::new());
    while steps < most && !at_rest {
        let closest = Closest::of(nominal, points, &motion)?;
        let next = step(&closest, &motion, options.with_scale)?;
        (motion, free) = (next.motion, next.free);
        at_rest = next.way_mm <= AT_REST * closest.size_mm;
        steps += 1;
    }
    let closest = Closest::of(nominal, points, &motion)?;
    let counted = points.iter().zip(&closest.all);
    let rejected = counted.filter(|(_, followed)| followed.weight == 0.0);
    Some(Registration {
        motion,
        free,
        steps,
        at_rest,
        deviation_mm: closest.deviation_mm,
        rejected_rows: rejected.map(|(point, _)| point.row).collect(),
    })
}
