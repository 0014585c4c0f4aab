//! The reach of an arm: one joint after the other, from evenly spread starts.

use kinetostat::model::{Drive, Element, Role};
use kinetostat::number::larger;
use kinetostat::{Limb, Mechanism, MotionKind, Pose};
use nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};

/// Reach of an arm: the largest distances found by a search over the ranges of its joints. A joint without limits makes
/// one turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmReach {
    /// Farthest that the tool's reference point gets from the base's origin, m.
    pub from_base: f64,
    /// Farthest distance from the first axis, if the first actuator turns, m.
    pub from_first_axis: Option<f64>,
    /// Starts of the search.
    pub starts: usize,
    /// Passive joints were searched too.
    pub with_passive_joints: bool,
}

/// A joint of an arm and its range, m or rad.
struct Joint {
    /// A command, or else a passive coordinate.
    command: bool,
    index: usize,
    range: (f64, f64),
}

pub(crate) fn arm_reach(m: &Mechanism, limb: &Limb) -> Result<ArmReach, ReachError> {
    let joints = joints(limb)?;
    let point = |commands: &[f64], coordinates: &[f64]| {
        product(m, limb, commands, coordinates, true)
            .translation
            .vector
    };
    let (from_base, starts) = farthest(limb, &joints, &|u, q| point(u, q).norm());
    let from_first_axis = first_axis(m, limb).map(|(origin, axis)| {
        farthest(limb, &joints, &|u, q| {
            let arm = point(u, q) - origin;
            (arm - axis.into_inner() * arm.dot(&axis)).norm()
        })
        .0
    });
    Ok(ArmReach {
        from_base,
        from_first_axis,
        starts,
        with_passive_joints: joints.iter().any(|j| !j.command),
    })
}

fn joints(limb: &Limb) -> Result<Vec<Joint>, ReachError> {
    let chain = &limb.nominal;
    let turn = std::f64::consts::PI;
    let mut joints = Vec::new();
    for (index, actuator) in chain.actuators().iter().enumerate() {
        let range = match (actuator.limits, actuator.kind) {
            (Some(limits), _) => limits,
            (None, MotionKind::Revolute) => (actuator.home - turn, actuator.home + turn),
            (None, MotionKind::Prismatic) => {
                return Err(ReachError::UnlimitedActuator {
                    actuator: actuator.name.clone(),
                });
            }
        };
        joints.push(Joint {
            command: true,
            index,
            range,
        });
    }
    for (index, c) in chain.coordinates().iter().enumerate() {
        match (c.role, c.kind) {
            (Role::Passive, MotionKind::Revolute) => joints.push(Joint {
                command: false,
                index,
                range: (c.home - turn, c.home + turn),
            }),
            (Role::Passive, MotionKind::Prismatic) => {
                return Err(ReachError::UnlimitedPassiveJoint {
                    joint: c.name.clone(),
                });
            }
            _ => {}
        }
    }
    Ok(joints)
}

/// A point of the first axis and its direction at home, where the first joint is an actuator that turns.
fn first_axis(m: &Mechanism, limb: &Limb) -> Option<(Vector3<f64>, Unit<Vector3<f64>>)> {
    let chain = &limb.nominal;
    let first = chain.elements().iter().find_map(|e| match e {
        // Springs of a link before the first axis are no axis.
        Element::Motion(motion)
            if motion.command.is_some()
                || motion
                    .coordinate
                    .is_some_and(|d| chain.coordinates()[d.index].role == Role::Passive) =>
        {
            Some(motion)
        }
        _ => None,
    });
    let turning =
        first.filter(|motion| motion.command.is_some() && motion.kind == MotionKind::Revolute)?;
    let (commands, coordinates) = (chain.home_commands(), chain.home_coordinates());
    let frame = product(m, limb, &commands, &coordinates, false);
    Some((frame.translation.vector, frame.rotation * turning.axis))
}

/// Pose of the tool for commands and coordinates, or of the first commanded motion.
fn product(m: &Mechanism, limb: &Limb, commands: &[f64], coordinates: &[f64], whole: bool) -> Pose {
    let mut pose = m.platforms()[limb.from].home;
    for element in limb.nominal.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Motion(motion) => {
                if !whole && motion.command.is_some() {
                    return pose;
                }
                let part = |drive: Option<Drive>, values: &[f64]| {
                    drive.map_or(0.0, |d| d.ratio * values[d.index])
                };
                let amount = part(motion.command, commands) + part(motion.coordinate, coordinates);
                match motion.kind {
                    MotionKind::Prismatic => {
                        pose *= Translation3::from(motion.axis.into_inner() * amount);
                    }
                    MotionKind::Revolute => {
                        pose *= UnitQuaternion::from_axis_angle(&motion.axis, amount);
                    }
                }
            }
            Element::Node(_) => {}
        }
    }
    pose * limb.platform_from_tip.inverse()
}

/// Starts of the search.
const STARTS: usize = 16;

/// Maximum number of elements that one search visits: an arm of six joints needs far fewer, a chain of ninety is not
/// searched from all starts.
const MOST_STEPS: usize = 25_000_000;

/// Largest value over the joints' ranges: one joint after the other, from evenly spread starts; and
/// the number of starts.
fn farthest(limb: &Limb, joints: &[Joint], value: &dyn Fn(&[f64], &[f64]) -> f64) -> (f64, usize) {
    let chain = &limb.nominal;
    let mut best = 0.0_f64;
    let sweep = joints.len() * VALUES * chain.elements().len();
    let mut steps = 0;
    for start in 0..STARTS {
        if start > 0 && steps > MOST_STEPS {
            return (best, start);
        }
        let mut commands = chain.home_commands();
        let mut coordinates = chain.home_coordinates();
        let at = |joint: &Joint, x: f64, commands: &mut [f64], coordinates: &mut [f64]| {
            if joint.command {
                commands[joint.index] = x;
            } else {
                coordinates[joint.index] = x;
            }
            value(commands, coordinates)
        };
        if start > 0 {
            for (k, joint) in joints.iter().enumerate() {
                let share = ((start * (2 * k + 3)) as f64 * 0.618_034 + 0.1 * k as f64).fract();
                let (low, high) = joint.range;
                at(
                    joint,
                    low + share * (high - low),
                    &mut commands,
                    &mut coordinates,
                );
            }
        }
        let mut reached = value(&commands, &coordinates);
        for _ in 0..30 {
            let before = reached;
            steps += sweep;
            for joint in joints {
                let here = if joint.command {
                    commands[joint.index]
                } else {
                    coordinates[joint.index]
                };
                let mut f = |x: f64| at(joint, x, &mut commands, &mut coordinates);
                let (low, high) = joint.range;
                let found = largest_in_range(low, high, here, &mut f);
                reached = f(found);
            }
            if reached <= before * (1.0 + 1e-10) || steps > MOST_STEPS {
                break;
            }
        }
        best = larger(best, reached);
    }
    (best, STARTS)
}

/// Values that one joint's turn takes, about.
const VALUES: usize = 98;

/// Maximises a smooth function over a range: samples, then a ternary search around the best one.
fn largest_in_range(low: f64, high: f64, here: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    const SAMPLES: usize = 12;
    let step = (high - low) / SAMPLES as f64;
    let mut best = (here, f(here));
    for k in 0..=SAMPLES {
        let x = low + step * k as f64;
        let value = f(x);
        if value > best.1 {
            best = (x, value);
        }
    }
    let (mut a, mut b) = ((best.0 - step).max(low), (best.0 + step).min(high));
    for _ in 0..40 {
        let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(c) < f(d) { a = c } else { b = d }
    }
    for x in [0.5 * (a + b), a, b] {
        let value = f(x);
        if value > best.1 {
            best = (x, value);
        }
    }
    best.0
}

/// Reason why there is no reach.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReachError {
    /// The search would take too long.
    #[error("not searched: the machine has more than {most} limbs")]
    TooManyLimbs {
        /// Limbs of the largest machine that is searched.
        most: usize,
    },
    /// An actuator slides without limits.
    #[error("not bounded: the actuator '{actuator}' slides without limits")]
    UnlimitedActuator {
        /// Name of the actuator.
        actuator: String,
    },
    /// A passive joint slides without limits.
    #[error("not bounded: the passive joint '{joint}' slides without limits")]
    UnlimitedPassiveJoint {
        /// Name of the joint.
        joint: String,
    },
    /// The machine is outside its limits where the search would begin.
    #[error("not searched: at home the actuator '{actuator}' is outside its limits")]
    HomeOutsideLimits {
        /// Name of the actuator.
        actuator: String,
    },
    /// No actuator has limits, and the tool goes on and on.
    #[error("not bounded: the actuators have no limits")]
    NoLimits,
    /// The loops do not close at home.
    #[error("not searched: the loops do not close at home")]
    OpenLoops,
}
