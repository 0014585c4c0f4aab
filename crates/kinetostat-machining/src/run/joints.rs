//! Limits, ratings and configuration along a program, where an arm cannot follow it in one posture, and jumps of a tool whose
//! orientation follows.

use kinetostat::batch::AlongPath;
use kinetostat::number::{larger, smaller};
use kinetostat::{Mechanism, MotionKind};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::checks::refused::share_of_rating;
use crate::joints::JointFigures;
use crate::near::natural_length;
use crate::number::largest_angle;
use crate::postures::neighbour::NEAR;
use crate::result::joints::{JointsResult, LimitPlace, PostureChange};
use crate::result::point::{PointKind, PointResult, place};
use crate::result::summary::Summary;
use crate::run::way_out::{Places, way_out};
use crate::task::{Task, kinds};
use crate::warning::{Warning, WarningCode};

/// A joint that turns farther than this between two neighbours on the path, deg, ...
const TURN_DEG: f64 = 90.0;

/// ... and farther than the tool by this factor, is beside a singular posture.
const TIMES_TOOL: f64 = 3.0;

/// Maximum way, mm, on which such a rotation of a joint is a change of posture.
const SHORT_MM: f64 = 10.0;

/// Limits, ratings and configuration along a program.
pub(crate) fn joints_result(task: &Task<'_>, points: &[PointResult]) -> JointsResult {
    let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
    let mut result = JointsResult {
        ranges: ranges(points),
        nearest_limit: nearest_limit(task, points),
        most_loaded: share_of_rating(task, points),
        configuration: points
            .iter()
            .find(|p| p.kind != PointKind::Rapid)
            .or(points.first())
            .and_then(|p| p.configuration),
        ..JointsResult::default()
    };
    if task.placement.orientation_follows {
        return result;
    }
    let of_joints: Vec<MotionKind> = figures.kinds().collect();
    let mut worst = Vec::new();
    // The first point from which a joint may have turned far on the way to the point that is looked at.
    let mut first = 0;
    for index in 1..points.len() {
        let after = &points[index];
        if after.kind == PointKind::Rapid {
            first = index;
            continue;
        }
        while after.path_mm - points[first].path_mm > SHORT_MM && first + 1 < index {
            first += 1;
        }
        let at_once = change(task, &of_joints, &points[index - 1], after);
        let before = match at_once {
            Some(_) => index - 1,
            None => first,
        };
        let before = &points[before];
        let on_a_short_way = || {
            let found = change(task, &of_joints, before, after);
            found.filter(|_| figures.arm().is_some())
        };
        let Some(change) = at_once.or_else(on_a_short_way) else {
            continue;
        };
        first = index;
        result.change_count += 1;
        if result.changes.len() < JointsResult::MAX_CHANGES {
            result.changes.push(change);
            worst.extend([before, after]);
        }
    }
    if let (Some(arm), false) = (figures.arm(), worst.is_empty()) {
        result.way_out = Some(way_out(task, arm, &Places::of_points(task, points, &worst)));
    }
    result
}

/// Smallest and largest joint values where the program cuts, to a millionth of a millimetre or degree.
fn ranges(points: &[PointResult]) -> Vec<[f64; 2]> {
    let cuts = points.iter().any(|p| p.kind != PointKind::Rapid);
    let counts = |point: &&PointResult| !cuts || point.kind != PointKind::Rapid;
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    for point in points.iter().filter(counts) {
        if ranges.is_empty() {
            ranges = point
                .actuator_command
                .iter()
                .map(|value| [*value; 2])
                .collect();
        }
        for ([low, high], value) in ranges.iter_mut().zip(&point.actuator_command) {
            (*low, *high) = (smaller(*low, *value), larger(*high, *value));
        }
    }
    // Digits below a nanometre are those of the arithmetic.
    let shown = |value: f64| (1e6 * value).round() / 1e6 + 0.0;
    ranges.into_iter().map(|range| range.map(shown)).collect()
}

fn nearest_limit(task: &Task<'_>, points: &[PointResult]) -> Option<LimitPlace> {
    let natural = natural_length(task.mechanism);
    let kinds: Vec<MotionKind> = kinds(task.mechanism).collect();
    let mut nearest: Option<(f64, LimitPlace)> = None;
    for point in points {
        let Some(limit) = point.nearest_limit else {
            continue;
        };
        let far = match kinds.get(limit.actuator) {
            Some(MotionKind::Revolute) => 1e3 * natural * limit.distance.to_radians(),
            _ => limit.distance,
        };
        if nearest.is_none_or(|(least, _)| far < least) {
            let found = LimitPlace {
                line: point.line,
                position_mm: point.position_mm,
                limit,
            };
            nearest = Some((far, found));
        }
    }
    nearest.map(|(_, place)| place)
}

/// The change of the posture between two neighbours on the path, if it is one that no feed motion can make.
fn change(
    task: &Task<'_>,
    kinds: &[MotionKind],
    before: &PointResult,
    after: &PointResult,
) -> Option<PostureChange> {
    if after.kind == PointKind::Rapid {
        return None;
    }
    let (actuator, turn_deg) = largest_turn(kinds, before, after)?;
    let number = |point: &PointResult| point.configuration.map(|c| c.number);
    let beside =
        turn_deg.abs() > TURN_DEG && turn_deg.abs() > TIMES_TOOL * tool_turn_deg(before, after);
    let same_machine = || {
        let machine = |point: &PointResult| -> *const Mechanism { task.mechanism_on(point.line) };
        std::ptr::eq(machine(before), machine(after))
    };
    let changes = (number(before) != number(after) || beside) && same_machine();
    changes.then_some(PostureChange {
        line_before: before.line,
        line: after.line,
        position_mm: after.position_mm,
        before: before.configuration,
        after: after.configuration,
        actuator,
        turn_deg,
    })
}

/// The joint that turns farthest, and how far, deg; whole turns do not count, for a controller goes on where joint values are counted
/// from -180 deg again.
fn largest_turn(
    kinds: &[MotionKind],
    before: &PointResult,
    after: &PointResult,
) -> Option<(usize, f64)> {
    let values = before.actuator_command.iter().zip(&after.actuator_command);
    values
        .zip(kinds)
        .enumerate()
        .filter(|(_, (_, kind))| **kind == MotionKind::Revolute)
        .map(|(actuator, ((from, to), _))| {
            let turn = to - from;
            (actuator, turn - 360.0 * (turn / 360.0).round())
        })
        .filter(|(_, turn)| turn.is_finite())
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

/// Rotation of the tool between two points of a program that states its orientation, deg.
fn tool_turn_deg(before: &PointResult, after: &PointResult) -> f64 {
    let stated = |point: &PointResult| {
        let [w, i, j, k] = point.tool_orientation?;
        Some(UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k)))
    };
    match (stated(before), stated(after)) {
        (Some(a), Some(b)) => a.angle_to(&b).to_degrees(),
        _ => 0.0,
    }
}

/// One warning about changes of the posture in feed motions, with both lines of the first and what helps.
pub(crate) fn posture_warning(
    task: &Task<'_>,
    points: &[PointResult],
    joints: &JointsResult,
) -> Option<Warning> {
    let first = joints.changes.first()?;
    let names = task.mechanism.actuator_names();
    let name = names.get(first.actuator).map_or("", String::as_str);
    let turn = format!("'{name}' turns by {:.0} deg", first.turn_deg.abs());
    let between = match first.line_before == first.line {
        true => format!("within line {}", first.line),
        false => format!("between lines {} and {}", first.line_before, first.line),
    };
    let at = points
        .iter()
        .find(|p| p.line == first.line && p.position_mm == first.position_mm)
        .map_or_else(String::new, |point| format!(", {},", place(point)));
    let what = match (first.before, first.after) {
        (Some(before), Some(after)) if before.number != after.number => format!(
            "the arm would have to change its configuration from '{before}' to '{after}' ({turn}): on the way it passes a singular posture"
        ),
        _ => format!(
            "{turn} while the tool hardly moves: the machine passes beside a singular posture"
        ),
    };
    let more = match joints.change_count {
        1 => String::new(),
        count => format!("; there are {count} such places"),
    };
    let way = joints
        .way_out
        .as_ref()
        .map_or_else(String::new, |way| format!(". {}", way.description()));
    Some(Warning::at_line(
        WarningCode::PostureChanges,
        first.line,
        format!("{between}{at} {what}{more}{way}"),
    ))
}

/// Rotation vector between two orientations, base axes, deg.
pub(crate) fn turn_deg(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> [f64; 3] {
    let turn = (to * from.inverse()).scaled_axis();
    turn.map(f64::to_degrees).into()
}

/// Neighbours on the path between which a tool whose orientation follows turns farther than the way
/// between them explains: the machine has changed its branch. The line of the second.
pub(crate) fn jump(task: &Task<'_>, points: &[PointResult]) -> Option<usize> {
    let near = NEAR * task.mechanism.size();
    points.windows(2).find_map(|pair| {
        let [a, b] = [pair[0].tool_turn_deg?, pair[1].tool_turn_deg?];
        let distance = Vector3::from(pair[1].position_mm) - Vector3::from(pair[0].position_mm);
        let distance = task.placement.to_metres(&distance).norm();
        let turn = (Vector3::from(b) - Vector3::from(a)).norm().to_radians();
        (distance < near && turn > AlongPath::JUMP).then_some(pair[1].line)
    })
}

/// Warnings about a tool whose orientation follows.
pub(crate) fn following(
    task: &Task<'_>,
    points: &[PointResult],
    summary: &Summary,
) -> Vec<Warning> {
    let code = WarningCode::OrientationFollows;
    let turns = summary.max_tool_turn_deg.map(|turn| {
        let text = format!(
            "the orientation follows: the tool turns by up to {} from the orientation it is kept near to",
            largest_angle(turn)
        );
        Warning::new(code, text)
    });
    let jumps = jump(task, points).map(|line| {
        let text = "the orientation of the tool jumps here: the machine would have to change its branch, or passes close to a singular posture";
        Warning::at_line(code, line, text)
    });
    turns.into_iter().chain(jumps).collect()
}
