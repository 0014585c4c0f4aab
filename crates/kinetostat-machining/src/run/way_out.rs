//! The nearest turn of the tool about its own axis with which an arm follows a whole program in one posture.

use kinetostat::{Error, Pose, Posture};
use kinetostat_program::WriteError;
use nalgebra::{Unit, UnitQuaternion, Vector3};
use rayon::prelude::*;

use crate::joints::Arm;
use crate::measured_frame::PartPlace;
use crate::near::{NEAR_SINGULAR, natural_length};
use crate::result::joints::WayOut;
use crate::result::point::PointResult;
use crate::task::{RunError, Task};

/// Turns are tried in steps of this, deg.
const STEP_DEG: i32 = 5;

/// Maximum number of places of a program that are tried.
const MOST_PLACES: usize = 200;

/// Joints turn less than this between two places that are looked at, rad.
const JUMP: f64 = 1.6;

/// Places of a program: line and where the tool should be, base frame, m.
pub(crate) struct Places {
    /// Places at which the program fails, tried first.
    worst: Vec<(usize, Pose)>,
    /// Evenly along the program.
    along: Vec<(usize, Pose)>,
}

impl Places {
    /// Places of a program that was solved.
    pub(crate) fn of_points(
        task: &Task<'_>,
        points: &[PointResult],
        worst: &[&PointResult],
    ) -> Self {
        let at = |point: &PointResult| (point.line, PartPlace::of_point(task, point).pose());
        let stride = points.len().div_ceil(MOST_PLACES).max(1);
        Self {
            worst: worst.iter().map(|point| at(point)).collect(),
            along: points.iter().step_by(stride).map(at).collect(),
        }
    }

    /// Places of a program that could not be solved at a place.
    fn of_path(task: &Task<'_>, line: usize, pose: Pose) -> Self {
        let known = task.path().moves.iter().filter(|m| m.is_known_feed());
        let stride = known.clone().count().div_ceil(MOST_PLACES).max(1);
        // A short program is looked at in more places than its ends.
        let moves = known.clone().count().max(1);
        let pieces = (MOST_PLACES / moves).clamp(1, 16);
        let places = known.step_by(stride).flat_map(|motion| {
            (1..=pieces).map(move |piece| {
                let share = piece as f64 / pieces as f64;
                let orientation = task.placement.orientation_on(motion, share);
                (
                    motion.line,
                    (task.placement.on(motion, share)).pose(&motion.point(share), orientation),
                )
            })
        });
        Self {
            worst: vec![(line, pose)],
            along: places.collect(),
        }
    }
}

/// The nearest turn that keeps limits and configuration at all places.
pub(crate) fn way_out(task: &Task<'_>, arm: &Arm, places: &Places) -> WayOut {
    let steps = 180 / STEP_DEG;
    let turns: Vec<f64> = (1..=steps)
        .flat_map(|step| [step, -step])
        .filter(|step| *step > -steps)
        .map(|step| f64::from(STEP_DEG * step))
        .collect();
    let keeps = |turn: &&f64| keeps(task, arm, places, **turn);
    WayOut {
        turn_about_tool_axis_deg: turns.par_iter().find_first(|turn| keeps(turn)).copied(),
        places: places.worst.len() + places.along.len(),
    }
}

fn keeps(task: &Task<'_>, arm: &Arm, places: &Places, turn_deg: f64) -> bool {
    let path = task.path();
    let axis = match path.moves.iter().any(|motion| motion.tool_turn.is_some()) {
        true => Unit::new_normalize(path.tool_axis),
        false => Vector3::z_axis(),
    };
    let turn = UnitQuaternion::from_axis_angle(&axis, turn_deg.to_radians());
    let posture = |(line, pose): &(usize, Pose)| -> Option<Posture> {
        let posture = task.mechanism_on(*line).posture(&(pose * turn)).ok()?;
        posture.within_limits().ok().map(|()| posture)
    };
    let far = NEAR_SINGULAR.to_degrees();
    let far_mm = 1e3 * NEAR_SINGULAR * natural_length(task.mechanism);
    let mut first: Option<u8> = None;
    let mut one_way = |commands: &[f64]| {
        arm.configuration(commands).is_some_and(|found| {
            found.wrist_from_singular_deg > far
                && found.elbow_from_singular_deg > far
                && found.shoulder_from_singular_mm > far_mm
                && *first.get_or_insert(found.number) == found.number
        })
    };
    let worst = places.worst.iter();
    for place in worst {
        if !posture(place).is_some_and(|found| one_way(&found.commands())) {
            return false;
        }
    }
    let mut last: Option<Vec<f64>> = None;
    for place in &places.along {
        let Some(found) = posture(place) else {
            return false;
        };
        let commands = found.commands();
        let jumps = last.is_some_and(|last| {
            let turns = last.iter().zip(&commands).map(|(from, to)| to - from);
            let full = std::f64::consts::TAU;
            turns
                .map(|turn| turn - full * (turn / full).round())
                .any(|turn| turn.abs() > JUMP)
        });
        if jumps || !one_way(&commands) {
            return false;
        }
        last = Some(commands);
    }
    true
}

/// An error at a place that an arm cannot take, with what helps.
pub(crate) fn with_way_out(task: &Task<'_>, error: RunError) -> RunError {
    let (line, position) = match &error {
        RunError::Point {
            line, position_mm, ..
        } => (*line, Vector3::from(*position_mm)),
        RunError::Write(WriteError::Field {
            line, position_mm, ..
        }) => (*line, *position_mm),
        _ => return error,
    };
    let follows = task.placement.orientation_follows;
    let Some(arm) = Arm::of(task.mechanism).filter(|_| !follows) else {
        return error;
    };
    let pose = nearest_pose(task, line, &position);
    let reached = task
        .mechanism_on(line)
        .posture(&pose)
        .and_then(|posture| posture.within_limits());
    if !matches!(
        reached,
        Err(Error::Unreachable { .. } | Error::OutsideLimits { .. } | Error::NotConverged { .. })
    ) {
        return error;
    }
    RunError::ArmStops {
        way_out: way_out(task, &arm, &Places::of_path(task, line, pose)),
        error: Box::new(error),
    }
}

/// Desired pose of the tool at a place of a line, base frame.
fn nearest_pose(task: &Task<'_>, line: usize, position: &Vector3<f64>) -> Pose {
    let moves = task.path().moves.iter().filter(|m| m.line == line);
    let shares = moves.flat_map(|motion| [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| (motion, share)));
    let off = |(motion, share): &(&kinetostat_program::Move, f64)| {
        (motion.point(*share) - position).norm()
    };
    let nearest = shares.min_by(|a, b| off(a).total_cmp(&off(b)));
    let orientation = nearest.map_or(task.placement.tool_orientation, |(motion, share)| {
        task.placement.orientation_on(motion, share)
    });
    let place = nearest.map_or(task.placement, |(motion, share)| {
        task.placement.on(motion, share)
    });
    place.pose(position, orientation)
}
