//! Joints that turn on and on in a cut until they meet a limit: a solution takes of all values that are whole turns apart one inside the
//! limits, and an arm has the one to which it has turned.

use kinetostat::number::{larger, smaller};
use kinetostat::{Mechanism, MotionKind};

use crate::joints::JointFigures;
use crate::result::point::{PointKind, PointResult, place};
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// A joint along feed motions without a stop between them, values as it has turned to them, deg.
#[derive(Clone, Copy)]
struct Turned {
    first_line: usize,
    start: f64,
    /// Present value.
    value: f64,
    low: f64,
    high: f64,
    /// The first point beyond a limit.
    beyond: Option<usize>,
}

/// The first joint that comes to a limit in this way, with what helps.
pub(crate) fn whole_turns(task: &Task<'_>, points: &[PointResult]) -> Option<Warning> {
    if task.placement.orientation_follows {
        return None;
    }
    let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
    let joints = figures.kinds().zip(figures.limits()).enumerate();
    let turning = joints.filter_map(|(joint, (kind, limits))| match kind {
        MotionKind::Revolute => Some((joint, limits?)),
        MotionKind::Prismatic => None,
    });
    let found = turning.filter_map(|(joint, [low, high])| {
        let (turned, point) = along(task, points, joint, [low, high])?;
        Some((point, joint, turned, [low, high]))
    });
    let (point, joint, turned, limits) = found.min_by_key(|found| found.0)?;
    Some(warning(task, &points[point], joint, &turned, limits))
}

/// The first stretch on which a joint leaves its limits by whole turns, and where.
fn along(
    task: &Task<'_>,
    points: &[PointResult],
    joint: usize,
    [low, high]: [f64; 2],
) -> Option<(Turned, usize)> {
    // Less than a turn between the limits: no two values of it are whole turns apart.
    if high - low < 360.0 {
        return None;
    }
    let machine = |point: &PointResult| -> *const Mechanism { task.mechanism_on(point.line) };
    let number = |point: &PointResult| point.configuration.map(|c| c.number);
    let mut stretch: Option<Turned> = None;
    for (index, point) in points.iter().enumerate() {
        let own = *point.actuator_command.get(joint)?;
        let before = index.checked_sub(1).map(|before| &points[before]);
        let goes_on = before.is_some_and(|before| {
            point.kind != PointKind::Rapid
                && std::ptr::eq(machine(before), machine(point))
                && number(before) == number(point)
        });
        match &mut stretch {
            Some(turned) if goes_on => {
                let turn = own - turned.value;
                turned.value += turn - 360.0 * (turn / 360.0).round();
                turned.low = smaller(turned.low, turned.value);
                turned.high = larger(turned.high, turned.value);
                let is_beyond = turned.value < low - 1e-6 || turned.value > high + 1e-6;
                if is_beyond && turned.beyond.is_none() {
                    turned.beyond = Some(index);
                }
            }
            _ => {
                if let Some((turned, at)) =
                    stretch.and_then(|turned| Some((turned, turned.beyond?)))
                {
                    return Some((turned, at));
                }
                stretch = Some(Turned {
                    first_line: point.line,
                    start: own,
                    value: own,
                    low: own,
                    high: own,
                    beyond: None,
                });
            }
        }
    }
    let turned = stretch?;
    Some((turned, turned.beyond?))
}

fn warning(
    task: &Task<'_>,
    point: &PointResult,
    joint: usize,
    turned: &Turned,
    [low, high]: [f64; 2],
) -> Warning {
    let names = task.mechanism.actuator_names();
    let name = names.get(joint).map_or("", String::as_str);
    // Whole turns off the start with which the whole stretch stays inside, the fewest first.
    let fits =
        |turns: &f64| turned.low + 360.0 * turns >= low && turned.high + 360.0 * turns <= high;
    let other = [1.0, -1.0, 2.0, -2.0].into_iter().find(fits);
    let out = match other {
        Some(turns) => format!(
            "begin the cut on line {} with '{name}' at {:.1} deg instead of {:.1} deg",
            turned.first_line,
            turned.start + 360.0 * turns,
            turned.start
        ),
        None => format!(
            "it turns by {:.0} deg in all, and its limits are {:.0} deg apart: lift the tool before line {} and turn '{name}' back there, or choose turns of a round tool that need less (`kinetostat convert --free-turn`)",
            turned.high - turned.low,
            high - low,
            point.line
        ),
    };
    let limit = match turned.low < low {
        true => low,
        false => high,
    };
    Warning::at_line(
        WarningCode::JointTurnsOn,
        point.line,
        format!(
            "{} '{name}' meets its limit of {limit:.0} deg: in feed motions since line {} it has turned on and on without a rapid in which it could turn back; {out}",
            place(point),
            turned.first_line
        ),
    )
}
