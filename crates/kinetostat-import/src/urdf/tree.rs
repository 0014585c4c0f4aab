//! The tree of links: names resolved, one root, no cycles; and what every joint follows.

use std::collections::BTreeMap;

use kinetostat::{MotionKind, Pose};
use nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};

use crate::log::{At, Log, some_names, suggestion};
use crate::urdf::robot::{JointType, Origin, Robot};

/// Displacement of a joint: `ratio * variable + offset` (m or rad), in the direction of its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Follow {
    /// Index of the joint that moves by itself; `None` for a joint that stands still.
    pub(crate) variable: Option<usize>,
    pub(crate) ratio: f64,
    pub(crate) offset: f64,
}

impl Follow {
    pub(crate) const STILL: Self = Self {
        variable: None,
        ratio: 0.0,
        offset: 0.0,
    };
}

/// One factor on a path from link to link.
#[derive(Clone, Debug)]
pub(crate) enum TreeStep {
    /// Offset of the joint of this name, or its inverse.
    Offset {
        joint: String,
        origin: Origin,
        inverse: bool,
    },
    /// Motion of a joint, forward (`sign` 1) or backward (-1).
    Move {
        joint: String,
        kind: MotionKind,
        axis: [f64; 3],
        follow: Follow,
        sign: f64,
    },
    /// The frame reached is that of this link.
    Arrive(usize),
}

impl TreeStep {
    pub(crate) fn reversed(&self) -> Self {
        let mut step = self.clone();
        match &mut step {
            Self::Offset { inverse, .. } => *inverse = !*inverse,
            Self::Move { sign, .. } => *sign = -*sign,
            Self::Arrive(_) => {}
        }
        step
    }

    /// Pose of the step for these values of the variables.
    pub(crate) fn pose(&self, values: &[f64]) -> Pose {
        match self {
            Self::Offset {
                origin, inverse, ..
            } => match inverse {
                true => origin.pose().inverse(),
                false => origin.pose(),
            },
            Self::Move {
                kind,
                axis,
                follow,
                sign,
                ..
            } => motion(*kind, axis, sign * displacement(follow, values)),
            Self::Arrive(_) => Pose::identity(),
        }
    }

    /// The variable that it moves with.
    pub(crate) fn variable(&self) -> Option<usize> {
        match self {
            Self::Move { follow, .. } => follow.variable,
            _ => None,
        }
    }
}

/// Displacement along or about a unit axis.
pub(crate) fn motion(kind: MotionKind, axis: &[f64; 3], amount: f64) -> Pose {
    let axis = Unit::new_normalize(Vector3::from(*axis));
    match kind {
        MotionKind::Prismatic => {
            Translation3::from(axis.into_inner() * amount) * UnitQuaternion::identity()
        }
        MotionKind::Revolute => Pose::from_parts(
            Translation3::identity(),
            UnitQuaternion::from_axis_angle(&axis, amount),
        ),
    }
}

pub(crate) fn displacement(follow: &Follow, values: &[f64]) -> f64 {
    follow.offset + follow.variable.map_or(0.0, |v| follow.ratio * values[v])
}

/// Links and joints as indices of the robot's lists.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) root: usize,
    /// Parent and child link of every joint.
    pub(crate) ends: Vec<(usize, usize)>,
    /// The joint above every link.
    pub(crate) above: Vec<Option<usize>>,
    /// Number of joints up to the root.
    depth: Vec<usize>,
    pub(crate) follows: Vec<Follow>,
    /// Faults of joints, which matter only between base and tip.
    doubts: Vec<Doubt>,
}

/// Something wrong with a joint.
#[derive(Clone, Debug)]
struct Doubt {
    joint: usize,
    at: At,
    message: String,
    help: String,
}

impl Tree {
    /// The factors from one link to another along the tree, each joint followed by the link that it
    /// leads to.
    pub(crate) fn steps(&self, robot: &Robot, from: usize, to: usize) -> Vec<TreeStep> {
        let (mut a, mut b) = (from, to);
        let (mut up, mut down) = (Vec::new(), Vec::new());
        while a != b {
            // Both have a joint above them: they differ and the root is common.
            if self.depth[a] >= self.depth[b] {
                let Some(joint) = self.above[a] else { break };
                up.push(joint);
                a = self.ends[joint].0;
            } else {
                let Some(joint) = self.above[b] else { break };
                down.push(joint);
                b = self.ends[joint].0;
            }
        }
        let mut steps = Vec::new();
        for joint in up {
            let forward = self.joint_steps(robot, joint);
            steps.extend(forward.iter().rev().map(TreeStep::reversed));
            steps.push(TreeStep::Arrive(self.ends[joint].0));
        }
        for joint in down.into_iter().rev() {
            steps.extend(self.joint_steps(robot, joint));
            steps.push(TreeStep::Arrive(self.ends[joint].1));
        }
        steps
    }

    /// True if `good` is true of what every joint between two links follows.
    pub(crate) fn between(&self, from: usize, to: usize, good: impl Fn(&Follow) -> bool) -> bool {
        let (mut a, mut b) = (from, to);
        while a != b {
            let lower = if self.depth[a] >= self.depth[b] {
                &mut a
            } else {
                &mut b
            };
            let Some(joint) = self.above[*lower] else {
                return true;
            };
            if !good(&self.follows[joint]) {
                return false;
            }
            *lower = self.ends[joint].0;
        }
        true
    }

    /// Offset and motion of a joint, parent to child.
    pub(crate) fn joint_steps(&self, robot: &Robot, index: usize) -> Vec<TreeStep> {
        let joint = &robot.joints[index];
        let mut steps = vec![TreeStep::Offset {
            joint: joint.name.clone(),
            origin: joint.origin,
            inverse: false,
        }];
        if let JointType::Moving(kind) = joint.kind {
            steps.push(TreeStep::Move {
                joint: joint.name.clone(),
                kind,
                axis: joint.axis,
                follow: self.follows[index],
                sign: 1.0,
            });
        }
        steps
    }
}

/// The tree, or `None` with errors in the log.
pub(crate) fn tree(robot: &Robot, log: &mut Log) -> Option<Tree> {
    let links = names(robot.links.iter().map(|l| (&l.name, &l.at)), "link", log);
    let joints = names(robot.joints.iter().map(|j| (&j.name, &j.at)), "joint", log);
    let mut above: Vec<Option<usize>> = vec![None; robot.links.len()];
    let mut ends = Vec::with_capacity(robot.joints.len());
    for (i, joint) in robot.joints.iter().enumerate() {
        let find = |(_, name): &(At, String)| links.get(name.as_str()).copied();
        let (Some(parent), Some(child)) = (find(&joint.parent), find(&joint.child)) else {
            continue;
        };
        ends.push((parent, child));
        if parent == child {
            log.error(
                &joint.at,
                format!("the joint joins '{}' to itself", joint.parent.1),
                "name two different links",
            );
        } else if let Some(other) = above[child] {
            log.error(
                &joint.child.0,
                format!(
                    "the link '{}' is already the child of the joint '{}'",
                    joint.child.1, robot.joints[other].name
                ),
                "a URDF is a tree: cut the loop here, and close it by a <constraint> or in a loop file (--loops)",
            );
        } else {
            above[child] = Some(i);
        }
    }
    if log.any_errors() || ends.len() != robot.joints.len() {
        return None;
    }
    let depth = depths(robot, &above, &ends, log)?;
    let root = one_root(robot, &above, log)?;
    let mut doubts = Vec::new();
    for missing in &robot.missing {
        doubts.push(Doubt {
            joint: missing.joint,
            at: missing.at.clone(),
            message: format!("there is no link '{}'", missing.name),
            help: missing.help.clone(),
        });
    }
    let follows = follows(robot, &joints, &mut doubts, log)?;
    Some(Tree {
        root,
        ends,
        above,
        depth,
        follows,
        doubts,
    })
}

/// Refuses what is wrong with joints between base and tip; of others it says that they stand still.
pub(crate) fn doubts(robot: &Robot, tree: &Tree, [base, tip]: [usize; 2], log: &mut Log) {
    let steps = tree.steps(robot, base, tip);
    let lies_between = |name: &str| {
        // Loops may go anywhere.
        !robot.constraints.is_empty()
            || (steps.iter())
                .any(|step| matches!(step, TreeStep::Offset { joint, .. } if joint == name))
    };
    for doubt in &tree.doubts {
        match lies_between(&robot.joints[doubt.joint].name) {
            true => log.error(&doubt.at, &doubt.message, &doubt.help),
            false => log.notice(
                &doubt.at,
                &doubt.message,
                "the joint is beside the way from base to tip and stands still in the model; nothing has to be done",
            ),
        }
    }
}

fn names<'r>(
    all: impl Iterator<Item = (&'r String, &'r At)>,
    word: &str,
    log: &mut Log,
) -> BTreeMap<&'r str, usize> {
    let mut seen = BTreeMap::new();
    for (i, (name, at)) in all.enumerate() {
        if seen.insert(name.as_str(), i).is_some() {
            log.error(
                at,
                format!("there is another {word} of this name before it"),
                "rename one of them",
            );
        }
    }
    seen
}

/// Joints up to the root; links that never get there go in circles.
fn depths(
    robot: &Robot,
    above: &[Option<usize>],
    ends: &[(usize, usize)],
    log: &mut Log,
) -> Option<Vec<usize>> {
    let count = robot.links.len();
    let mut depth = vec![0; count];
    for link in 0..count {
        let mut path = vec![link];
        let mut at = link;
        while let Some(joint) = above[at] {
            at = ends[joint].0;
            path.push(at);
            if path.len() > count + 1 {
                // The circle is closed if the path contains a link twice.
                let start = path.iter().position(|l| *l == at).unwrap_or(0);
                let mut circle: Vec<&str> = Vec::new();
                for l in &path[start..] {
                    circle.push(&robot.links[*l].name);
                    if circle.len() > 1 && *l == at {
                        break;
                    }
                }
                circle.reverse();
                circle.truncate(10);
                log.error(
                    &robot.links[at].at,
                    format!("the joints go in a circle: {}", circle.join(" -> ")),
                    "a URDF is a tree: cut the circle at one joint, and close it by a <constraint> or in a loop file (--loops)",
                );
                return None;
            }
        }
        depth[link] = path.len() - 1;
    }
    Some(depth)
}

fn one_root(robot: &Robot, above: &[Option<usize>], log: &mut Log) -> Option<usize> {
    let roots: Vec<usize> = (0..robot.links.len())
        .filter(|l| above[*l].is_none())
        .collect();
    if let [root] = roots[..] {
        return Some(root);
    }
    let named: Vec<&str> = roots
        .iter()
        .map(|r| robot.links[*r].name.as_str())
        .collect();
    let second = roots.get(1).copied().unwrap_or(0);
    for missing in &robot.missing {
        log.error(
            &missing.at,
            format!("there is no link '{}'", missing.name),
            &missing.help,
        );
    }
    if log.any_errors() {
        return None;
    }
    log.error(
        &robot.links[second].at,
        format!(
            "there are {} links without a parent: {}",
            roots.len(),
            some_names(&named)
        ),
        "every link but one is the child of a joint; join the parts by a fixed joint, or remove what does not belong to the robot",
    );
    None
}

/// Mimic joints resolved to the joints that move by themselves.
fn follows(
    robot: &Robot,
    joints: &BTreeMap<&str, usize>,
    doubts: &mut Vec<Doubt>,
    log: &mut Log,
) -> Option<Vec<Follow>> {
    let mut follows = Vec::with_capacity(robot.joints.len());
    for (i, joint) in robot.joints.iter().enumerate() {
        if joint.kind == JointType::Fixed {
            follows.push(Follow::STILL);
            continue;
        }
        let (mut ratio, mut offset) = (1.0, 0.0);
        let mut at = i;
        let mut length = 0;
        let mut doubt = |at: &At, message: String, help: String| {
            let at = at.clone();
            doubts.push(Doubt {
                joint: i,
                at,
                message,
                help,
            });
        };
        let follow = loop {
            let here = &robot.joints[at];
            let Some(mimic) = &here.mimic else {
                break own(robot, at, ratio, offset, log);
            };
            length += 1;
            if length > robot.joints.len() {
                doubt(
                    &mimic.at,
                    "the joints follow each other in a circle".to_owned(),
                    "let one of them move by itself".to_owned(),
                );
                break None;
            }
            let Some(&source) = joints.get(mimic.joint.as_str()) else {
                doubt(
                    &mimic.at,
                    format!("there is no joint '{}'", mimic.joint),
                    suggestion(&mimic.joint, joints.keys().copied()),
                );
                break None;
            };
            if source == at {
                doubt(
                    &mimic.at,
                    "the joint follows itself".to_owned(),
                    "name the joint that it follows, or remove <mimic>".to_owned(),
                );
                break None;
            }
            offset += ratio * mimic.offset;
            ratio *= mimic.multiplier;
            at = source;
            if at == i {
                doubt(
                    &mimic.at,
                    "the joints follow each other in a circle".to_owned(),
                    "let one of them move by itself".to_owned(),
                );
                break None;
            }
        };
        follows.push(follow.unwrap_or(Follow::STILL));
        if let (Some(mimic), Some(Follow { ratio: 0.0, .. })) = (&joint.mimic, follow) {
            log.notice(
                &mimic.at,
                "the joint does not move: what it follows does not move, or its multiplier is 0",
                "nothing has to be done if that is meant",
            );
        }
    }
    (!log.any_errors()).then_some(follows)
}

/// A joint at the end of a row of mimics: moves by itself, or stands still.
fn own(robot: &Robot, index: usize, ratio: f64, offset: f64, log: &mut Log) -> Option<Follow> {
    let joint = &robot.joints[index];
    let still = |value: f64| {
        Some(Follow {
            variable: None,
            ratio: 0.0,
            offset: offset + ratio * value,
        })
    };
    match (joint.kind, joint.limits) {
        (JointType::Fixed, _) => still(0.0),
        (JointType::Several(_), _) => still(0.0),
        (JointType::Moving(_), Some((low, high))) if low == high => {
            if let (Some(at), true) = (&joint.limit_at, ratio == 1.0 && offset == 0.0) {
                log.notice(
                    at,
                    format!("both limits are {low}: the joint does not move"),
                    "nothing has to be done if that is meant",
                );
            }
            still(low)
        }
        _ if ratio == 0.0 => still(0.0),
        _ => Some(Follow {
            variable: Some(index),
            ratio,
            offset,
        }),
    }
}
