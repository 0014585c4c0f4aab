//! Reach of a machine with loops while its tool turns as it must: a search over the commands of the actuators by
//! forward kinematics.

use kinetostat::{Mechanism, MotionKind, PostureRequest};
use nalgebra::Vector3;

use crate::reach::error::ReachError;

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
