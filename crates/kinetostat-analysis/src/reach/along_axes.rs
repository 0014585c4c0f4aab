//! The reach of a machine with loops: along the base's axes from home, and a box that the tool fills.

use std::fmt;

use kinetostat::{Mechanism, MotionKind, Pose, Posture, PostureRequest};
use kinetostat_machining::natural_length;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::reach::arm::ReachError;

/// Reach of the tool from home by inverse kinematics, within the limits of the actuators.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachAlongAxes {
    /// The tool turns on these paths as the machine turns it, kept as near to its orientation at home as can
    /// be; if not, it does not turn.
    pub orientation_follows: bool,
    /// Reach from home along -x, +x, -y, +y, -z, +z of the base, mm.
    pub along_axes_mm: [[f64; 2]; 3],
    /// Reasons why these paths end.
    pub ends: [[ReachEnd; 2]; 3],
    /// Two corners of a box around home of which corners, edges and faces were reached, mm, base axes; none
    /// if even a small one has gaps.
    pub box_mm: Option<[[f64; 3]; 2]>,
    /// Reach over all commands with free orientation, of a machine that moves only while its tool turns.
    pub by_commands: Option<CommandReach>,
}

/// Reason why a path of the tool ends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReachEnd {
    /// No end within ten times the machine.
    NotFollowedFarther,
    /// The limbs cannot follow.
    #[default]
    Limbs,
    /// An actuator of this name is at its limit.
    Limit(String),
    /// The machine does not move this way at all.
    Immovable,
}

impl fmt::Display for ReachEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFollowedFarther => f.write_str("nothing: it was not followed farther"),
            Self::Limbs => f.write_str("the limbs cannot follow"),
            Self::Limit(actuator) => write!(f, "limit of '{actuator}'"),
            Self::Immovable => f.write_str("the machine does not move this way"),
        }
    }
}

pub(crate) fn reach_along_axes(home: &Posture) -> Result<ReachAlongAxes, ReachError> {
    if let Some((name, _, _)) = home.limit_violations().first() {
        return Err(ReachError::HomeOutsideLimits {
            actuator: name.clone(),
        });
    }
    let m = home.mechanism();
    let length = natural_length(m);
    let follows = m.turns_as_it_moves();
    let mut along = [[0.0; 2]; 3];
    let mut ends = <[[ReachEnd; 2]; 3]>::default();
    let path = |path: usize| {
        let mut direction = Vector3::zeros();
        direction[path / 2] = if path.is_multiple_of(2) { -1.0 } else { 1.0 };
        march(home, follows, &direction, length)
    };
    let (paths, by_commands) = rayon::join(
        || (0..6).into_par_iter().map(path).collect::<Vec<_>>(),
        || follows.then(|| reach_by_commands(m).ok()),
    );
    for (path, (far, end)) in paths.into_iter().enumerate() {
        along[path / 2][path % 2] = 1e3 * far;
        ends[path / 2][path % 2] = end;
    }
    let unlimited = || {
        let mut actuators = m.limbs().iter().flat_map(|l| l.nominal.actuators());
        actuators.all(|a| a.limits.is_none())
    };
    let unbounded = |end: &ReachEnd| *end == ReachEnd::NotFollowedFarther;
    if ends.iter().flatten().any(unbounded) && unlimited() {
        return Err(ReachError::NoLimits);
    }
    Ok(ReachAlongAxes {
        orientation_follows: follows,
        along_axes_mm: along,
        ends,
        box_mm: filled_box(home, follows, &along),
        by_commands: by_commands.flatten(),
    })
}

/// The posture at a place near another one, or what forbids it.
fn at(
    from: &Posture,
    follows: bool,
    shift: &Vector3<f64>,
    home: &Pose,
) -> Result<Posture, ReachEnd> {
    let mut target = *home;
    target.translation.vector += shift;
    let (m, place) = (from.mechanism(), &target.translation.vector);
    let posture = match follows {
        true => m.posture(PostureRequest::position(place, &home.rotation).straight_from(from)),
        false => m.posture(PostureRequest::pose(&target).near(from)),
    };
    let posture = posture.map_err(|_| ReachEnd::Limbs)?;
    match posture.limit_violations().first() {
        Some((name, _, _)) => Err(ReachEnd::Limit(name.clone())),
        None => Ok(posture),
    }
}

/// Follows a direction; returns the reach (m) and the reason of its end.
fn march(home: &Posture, follows: bool, direction: &Vector3<f64>, length: f64) -> (f64, ReachEnd) {
    let origin = *home.target();
    let mut last = home.clone();
    let (mut good, mut step) = (0.0, 0.02 * length);
    let (mut bad, mut end) = loop {
        let next = good + step;
        match at(&last, follows, &(direction * next), &origin) {
            Ok(posture) => {
                last = posture;
                good = next;
                step *= 1.3;
            }
            Err(reason) => break (next, reason),
        }
        if good > 10.0 * length {
            return (good, ReachEnd::NotFollowedFarther);
        }
    };
    // A place that follows costs many times as much as one with its orientation held.
    for _ in 0..if follows { 10 } else { 14 } {
        let middle = 0.5 * (good + bad);
        match at(&last, follows, &(direction * middle), &origin) {
            Ok(posture) => {
                last = posture;
                good = middle;
            }
            Err(reason) => (bad, end) = (middle, reason),
        }
    }
    if good < 1e-4 * length {
        return (0.0, ReachEnd::Immovable);
    }
    (good, end)
}

/// The largest of some boxes of the proportions of `along` (mm) whose corners, edges and faces can
/// be reached; none if even a small one has gaps.
fn filled_box(home: &Posture, follows: bool, along: &[[f64; 2]; 3]) -> Option<[[f64; 3]; 2]> {
    if along.iter().flatten().all(|x| *x == 0.0) {
        return None;
    }
    let origin = *home.target();
    let reached = |scale: f64| {
        let mut shifts: Vec<Vector3<f64>> = Vec::new();
        for code in 0..27_usize {
            let part = |axis: usize| match (code / 3_usize.pow(axis as u32)) % 3 {
                0 => -along[axis][0],
                1 => 0.0,
                _ => along[axis][1],
            };
            let shift = Vector3::new(part(0), part(1), part(2)) * (1e-3 * scale);
            if shift.norm() > 0.0 && !shifts.contains(&shift) {
                shifts.push(shift);
            }
        }
        // Goes in steps, so that every limb keeps its assembly mode.
        shifts.par_iter().all(|shift| {
            let mut last = home.clone();
            [0.35, 0.7, 1.0].into_iter().all(|share| {
                let next = at(&last, follows, &(shift * share), &origin);
                next.map(|posture| last = posture).is_ok()
            })
        })
    };
    let (mut good, mut bad) = (0.0, 1.0);
    if reached(1.0) {
        good = 1.0;
    }
    for _ in 0..if follows { 5 } else { 7 } {
        if good >= 1.0 {
            break;
        }
        let middle = 0.5 * (good + bad);
        if reached(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    let centre = Point3::from(origin.translation.vector * 1e3);
    (good > 0.0).then(|| {
        let corner = |side: usize, sign: f64| -> [f64; 3] {
            std::array::from_fn(|k| centre[k] + sign * good * along[k][side])
        };
        [corner(0, -1.0), corner(1, 1.0)]
    })
}

/// Result of the search, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandReach {
    /// Farthest that the tool's origin gets from the base's origin.
    pub from_base: f64,
    /// Smallest and largest coordinates of the tool's origin, base axes.
    pub span: [Vector3<f64>; 2],
}

/// Maximum number of postures that are solved.
const MOST: usize = 400;

/// The commands are spread over their ranges first, then the best of them are pushed on, one
/// actuator after the other. An actuator that turns without limits makes one turn.
///
/// # Errors
/// An actuator slides without limits, or the loops do not close at home.
pub fn reach_by_commands(m: &Mechanism) -> Result<CommandReach, ReachError> {
    let ranges = ranges(m)?;
    let home: Vec<f64> = m
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.home_commands())
        .collect();
    let tool = |commands: &[f64]| {
        let posture = m.posture(PostureRequest::commands(commands)).ok()?;
        Some(posture.target().translation.vector)
    };
    let Some(start) = tool(&home) else {
        return Err(ReachError::OpenLoops);
    };
    // Objectives: the distance, and both ways along each axis.
    let value = |goal: usize, p: &Vector3<f64>| match goal {
        0 => p.norm(),
        k if k % 2 == 1 => p[(k - 1) / 2],
        k => -p[(k - 1) / 2],
    };
    let mut best: Vec<(Vec<f64>, Vector3<f64>)> = vec![(home.clone(), start); 7];
    let look = |commands: &[f64], best: &mut [(Vec<f64>, Vector3<f64>)]| {
        if let Some(p) = tool(commands) {
            for (goal, own) in best.iter_mut().enumerate() {
                if value(goal, &p) > value(goal, &own.1) {
                    *own = (commands.to_vec(), p);
                }
            }
        }
    };
    let mut solved = 0;
    for sample in 0..MOST / 4 {
        look(&spread(&ranges, sample), &mut best);
        solved += 1;
    }
    let mut step = 0.25;
    while solved < MOST && step > 1e-3 {
        for goal in 0..7 {
            for (k, (low, high)) in ranges.iter().enumerate() {
                for sign in [-1.0, 1.0] {
                    let mut commands = best[goal].0.clone();
                    let moved = commands[k] + sign * step * (high - low);
                    commands[k] = moved.clamp(*low, *high);
                    if solved >= MOST || commands[k] == best[goal].0[k] {
                        continue;
                    }
                    look(&commands, &mut best);
                    solved += 1;
                }
            }
        }
        step *= 0.5;
    }
    let end = |goal: usize| value(goal, &best[goal].1);
    Ok(CommandReach {
        from_base: end(0),
        span: [
            Vector3::new(-end(2), -end(4), -end(6)),
            Vector3::new(end(1), end(3), end(5)),
        ],
    })
}

/// Ranges of all commands, m or rad.
fn ranges(m: &Mechanism) -> Result<Vec<(f64, f64)>, ReachError> {
    let turn = std::f64::consts::PI;
    let actuators = m.limbs().iter().flat_map(|l| l.nominal.actuators());
    actuators
        .map(|actuator| match (actuator.limits, actuator.kind) {
            (Some(limits), _) => Ok(limits),
            (None, MotionKind::Revolute) => Ok((actuator.home - turn, actuator.home + turn)),
            (None, MotionKind::Prismatic) => Err(ReachError::UnlimitedActuator {
                actuator: actuator.name.clone(),
            }),
        })
        .collect()
}

/// Commands spread over their ranges.
fn spread(ranges: &[(f64, f64)], sample: usize) -> Vec<f64> {
    ranges
        .iter()
        .enumerate()
        .map(|(k, (low, high))| {
            // A third of them on the limits, where the extremes mostly are.
            let share = ((sample + 1) as f64 * (2.0 + k as f64).sqrt()).fract();
            let share = match sample % 3 {
                0 => share.round(),
                _ => share,
            };
            low + share * (high - low)
        })
        .collect()
}
