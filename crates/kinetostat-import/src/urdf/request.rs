//! Checks the options and the loop file against the robot: base and tip, passive joints, home values, stiffnesses.

use std::collections::BTreeSet;

use kinetostat::{MotionKind, number};
use kinetostat_model::ModelError;
use nalgebra::Vector3;

use crate::log::{At, Log, refusal, some_names, suggestion};
use crate::stiffness::Stiffnesses;
use crate::urdf::chain::Variable;
use crate::urdf::close::{Free, close};
use crate::urdf::graph::{Graph, closing_steps};
use crate::urdf::loops::{Loops, UrdfOptions};
use crate::urdf::robot::{Closure, Joint, JointType, Robot};
use crate::urdf::tree::{Tree, TreeStep};

/// Base and tip.
pub(crate) fn ends(
    robot: &Robot,
    tree: &Tree,
    options: &UrdfOptions,
    file: &str,
) -> Result<(usize, usize), ModelError> {
    let find = |option: &str, name: &str| {
        let names = robot.links.iter().map(|l| l.name.as_str());
        robot
            .links
            .iter()
            .position(|l| l.name == name)
            .ok_or_else(|| {
                refusal(
                    file,
                    format!("{option}: there is no link '{name}'"),
                    suggestion(name, names),
                )
            })
    };
    let base = match &options.base {
        Some(name) => find("--base", name)?,
        None => tree.root,
    };
    let tip = match &options.tip {
        Some(name) => find("--tip", name)?,
        None => {
            let parents: BTreeSet<usize> = tree.ends.iter().map(|e| e.0).collect();
            let leaves: Vec<usize> = (0..robot.links.len())
                .filter(|l| !parents.contains(l) && *l != base)
                .collect();
            match leaves[..] {
                [only] => only,
                _ => {
                    let names: Vec<&str> = leaves
                        .iter()
                        .map(|l| robot.links[*l].name.as_str())
                        .collect();
                    return Err(refusal(
                        file,
                        "which link carries the tool?",
                        format!(
                            "name it: --tip LINK; links at the ends of the tree are: {}",
                            some_names(&names)
                        ),
                    ));
                }
            }
        }
    };
    Ok((base, tip))
}

/// All coordinates: the joints, then those of the closing joints.
pub(crate) fn variables(
    robot: &Robot,
    options: &UrdfOptions,
    loops: &Loops,
    log: &mut Log,
) -> Vec<Variable> {
    let mut variables: Vec<Variable> = robot
        .joints
        .iter()
        .map(|j| Variable {
            name: j.name.clone(),
            kind: match j.kind {
                JointType::Moving(kind) => kind,
                _ => MotionKind::Revolute,
            },
            at: j.at.clone(),
            moves: false,
            passive: false,
            limits: j.limits,
        })
        .collect();
    let options = options
        .passive
        .iter()
        .map(|n| (robot.at.clone(), n.clone()));
    for (at, name) in loops.passive.iter().cloned().chain(options) {
        let Some(joint) = robot.joints.iter().position(|j| j.name == name) else {
            log.error(
                &at,
                format!("passive joints: there is no joint '{name}'"),
                suggestion(&name, robot.joints.iter().map(|j| j.name.as_str())),
            );
            continue;
        };
        if robot.joints[joint].mimic.is_some() {
            log.error(
                &robot.joints[joint].at,
                "the joint is said to be passive, but it follows another one",
                "remove <mimic>, or take it off the list of passive joints",
            );
        }
        variables[joint].passive = true;
    }
    for c in &robot.constraints {
        let count = match c.closure {
            Closure::Single(_) => 1,
            Closure::Universal => 2,
            Closure::Spherical => 3,
        };
        for _ in 0..count {
            variables.push(Variable {
                name: c.name.clone(),
                kind: match c.closure {
                    Closure::Single(kind) => kind,
                    _ => MotionKind::Revolute,
                },
                at: c.at.clone(),
                moves: true,
                passive: true,
                limits: None,
            });
        }
    }
    variables
}

/// Links and factors of the closing joints.
pub(crate) fn closings(robot: &Robot, log: &mut Log) -> Vec<([usize; 2], Vec<TreeStep>)> {
    let mut closings = Vec::new();
    let mut first = robot.joints.len();
    let mut names: BTreeSet<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    for c in &robot.constraints {
        if !names.insert(&c.name) {
            log.error(
                &c.at,
                "there is another joint or constraint of this name",
                "rename one of them",
            );
        }
        let mut find = |at: &At, name: &str| {
            let found = robot.links.iter().position(|l| l.name == name);
            if found.is_none() {
                log.error(
                    at,
                    format!("there is no link '{name}'"),
                    suggestion(name, robot.links.iter().map(|l| l.name.as_str())),
                );
            }
            found
        };
        let (parent, child) = (
            find(&c.parent.at, &c.parent.link),
            find(&c.child.at, &c.child.link),
        );
        if let (Closure::Single(_), Some(one), Some(other)) =
            (c.closure, c.parent.axis, c.child.axis)
        {
            let (one, other) = (
                Vector3::from(one).normalize(),
                Vector3::from(other).normalize(),
            );
            if (one - other).norm() > 1e-6 {
                log.error(
                    &c.child.at,
                    "the two axes differ, in the axes of their origins",
                    "turn one of the origins so that the axes agree, or leave the child's axis out",
                );
            }
        }
        if let (Some(parent), Some(child)) = (parent, child) {
            let steps = closing_steps(c, first);
            first += steps.iter().filter(|s| s.variable().is_some()).count();
            closings.push(([parent, child], steps));
        }
    }
    closings
}

/// Marks what lies between base and tip.
pub(crate) fn used(graph: &Graph, variables: &mut [Variable]) {
    for step in graph.paths.iter().flat_map(|w| &w.steps) {
        if let Some(v) = step.variable() {
            variables[v].moves = true;
        }
    }
}

/// Limits of joints that follow others hold for the joints that lead them.
pub(crate) fn followers(robot: &Robot, tree: &Tree, variables: &mut [Variable], log: &mut Log) {
    for (joint, follow) in robot.joints.iter().zip(&tree.follows) {
        let (Some(v), Some((low, high)), Some(_)) = (follow.variable, joint.limits, &joint.mimic)
        else {
            continue;
        };
        if !variables[v].moves {
            continue;
        }
        let of = |x: f64| (x - follow.offset) / follow.ratio;
        let (low, high) = (of(low).min(of(high)), of(low).max(of(high)));
        let own = variables[v]
            .limits
            .unwrap_or((-f64::INFINITY, f64::INFINITY));
        let both = (own.0.max(low), own.1.min(high));
        let at = joint.limit_at.as_ref().unwrap_or(&joint.at);
        if both.0 >= both.1 {
            log.error(
                at,
                format!(
                    "these limits leave nothing of those of '{}', which it follows",
                    variables[v].name
                ),
                "correct the limits, or multiplier and offset of <mimic>",
            );
        } else if both.0 > own.0 + 1e-6 || both.1 < own.1 - 1e-6 {
            log.notice(
                at,
                format!(
                    "these limits are narrower than those of '{}', which it follows: there they are {:.4} .. {:.4}",
                    variables[v].name, both.0, both.1
                ),
                "the model has the narrower ones",
            );
            variables[v].limits = Some(both);
        }
    }
}

/// Values at home: as given, else zero, else the middle of the limits.
pub(crate) fn homes(
    robot: &Robot,
    variables: &mut [Variable],
    options: &UrdfOptions,
    loops: &Loops,
    log: &mut Log,
) -> Vec<f64> {
    // Nothing is said of where a joint would stand if its home were not given.
    let given = |v: &Variable| {
        loops.home.iter().any(|(_, n, _, _)| *n == v.name) || options.home.contains_key(&v.name)
    };
    let mut home: Vec<f64> = variables
        .iter()
        .map(|v| match v.limits {
            Some((low, high)) if !(low <= 0.0 && 0.0 <= high) => {
                let middle = 0.5 * (low + high);
                if v.moves && !given(v) {
                    log.notice(
                        &v.at,
                        format!(
                            "zero lies outside the limits: at home the joint is in their middle, {}",
                            with_unit(middle, v.kind)
                        ),
                        "choose another home with --home if you like",
                    );
                }
                middle
            }
            _ => 0.0,
        })
        .collect();
    let given = loops
        .home
        .iter()
        .map(|(at, n, v, turning)| (Some(at), n, *v, *turning))
        .chain(
            options
                .home
                .iter()
                .map(|(n, (kind, v))| (None, n, *v, *kind == MotionKind::Revolute)),
        );
    for (written, name, value, turning) in given {
        let from_file = written.is_some();
        let at = written.unwrap_or(&robot.at);
        let source = Given::source(from_file);
        let Some(joint) = robot.joints.iter().position(|j| j.name == *name) else {
            log.error(
                at,
                format!("{source}: there is no joint '{name}'"),
                suggestion(name, robot.joints.iter().map(|j| j.name.as_str())),
            );
            continue;
        };
        let j = &robot.joints[joint];
        // An option has no place of its own: the joint's line says more.
        let at = if from_file { at } else { &j.at };
        let found = Given {
            name,
            value,
            turning,
            from_file,
        };
        if found.check(at, j, variables[joint].kind, log) {
            home[joint] = value;
        }
    }
    home
}

/// A home that the options or the loop file give to a joint.
struct Given<'a> {
    name: &'a str,
    value: f64,
    /// The value is an angle.
    turning: bool,
    from_file: bool,
}

impl Given<'_> {
    fn source(from_file: bool) -> &'static str {
        if from_file { "home" } else { "--home" }
    }

    /// True if the joint can have that value; the reason is logged if it cannot.
    fn check(&self, at: &At, j: &Joint, kind: MotionKind, log: &mut Log) -> bool {
        let Self {
            name,
            value,
            turning,
            ..
        } = *self;
        let source = Self::source(self.from_file);
        if j.mimic.is_some() || !matches!(j.kind, JointType::Moving(_)) {
            log.error(
                at,
                format!("{source}: the joint '{name}' does not move by itself"),
                "name the joint that it follows",
            );
        } else if turning != (kind == MotionKind::Revolute) {
            log.error(
                at,
                format!(
                    "{source}: the joint '{name}' is {}, the value is {}",
                    j.word,
                    if turning { "an angle" } else { "a distance" }
                ),
                match (self.from_file, turning) {
                    (true, _) => "turning joints go under home_rad, sliding ones under home_m",
                    (false, true) => "a joint that slides needs mm or m",
                    (false, false) => "a joint that turns needs deg or rad",
                },
            );
        } else if !value.is_finite()
            || j.limits
                .is_some_and(|(low, high)| !(low <= value && value <= high))
        {
            let (low, high) = j.limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            let (factor, unit) = match turning {
                true => (180.0 / std::f64::consts::PI, "deg"),
                false => (1e3, "mm"),
            };
            let shown = |x: f64| tidy(x * factor);
            log.error(
                at,
                format!(
                    "{source}: {} {unit} is outside the limits of the joint '{name}', {} to {} {unit}",
                    shown(value),
                    shown(low),
                    shown(high)
                ),
                "choose a value within them",
            );
        } else {
            return true;
        }
        false
    }
}

/// A joint's value in degrees or millimetres.
pub(crate) fn with_unit(value: f64, kind: MotionKind) -> String {
    match kind {
        MotionKind::Revolute => format!("{} deg", tidy(value.to_degrees())),
        MotionKind::Prismatic => format!("{} mm", tidy(1e3 * value)),
    }
}

/// A number for people: at most four digits after the point.
fn tidy(x: f64) -> String {
    number::without_zeros(&number::fixed(x, 4)).to_owned()
}

/// Closes the loops at home by the passive joints.
pub(crate) fn closed(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<TreeStep>)],
    variables: &[Variable],
    home: &mut [f64],
    log: &mut Log,
) {
    if closings.is_empty() {
        return;
    }
    let free: Vec<Free> = (0..variables.len())
        .filter(|v| variables[*v].moves && variables[*v].passive)
        .map(|v| Free {
            variable: v,
            turns: variables[v].kind == MotionKind::Revolute,
            limits: variables[v].limits,
            in_tree: v < robot.joints.len(),
        })
        .collect();
    let (distance, angle) = close(robot, tree, base, closings, &free, home);
    if distance > 1e-9 || angle > 1e-9 {
        let mut names: Vec<&str> = free
            .iter()
            .map(|f| variables[f.variable].name.as_str())
            .collect();
        names.dedup();
        log.error(
            &robot.constraints[0].at,
            format!(
                "at home the loops stay open by {:.4} mm and {:.4} degrees, whatever the passive joints do ({})",
                1e3 * distance,
                angle.to_degrees(),
                some_names(&names)
            ),
            "name the joints of the loops that nothing drives (passive = [...] in the loop file, or --passive), and give homes at which the loops can close (home_rad, home_m); check origins and axes of the constraints",
        );
        return;
    }
    let values: Vec<String> = free
        .iter()
        .filter(|f| f.in_tree)
        .map(|f| {
            let v = &variables[f.variable];
            let (value, unit) = match f.turns {
                true => (home[f.variable].to_degrees(), "deg"),
                false => (1e3 * home[f.variable], "mm"),
            };
            format!("{} {value:.3} {unit}", v.name)
        })
        .collect();
    log.notice(
        &robot.constraints[0].at,
        format!("at home the loops close with {}", values.join(", ")),
        "where loops close in several ways, passive joints stay near their start: give other starts by home_rad and home_m in the loop file, or --home",
    );
}

/// Names in the table of stiffnesses that no drive has.
pub(crate) fn known_stiffnesses(
    robot: &Robot,
    variables: &[Variable],
    stiffnesses: &Stiffnesses,
    log: &mut Log,
) {
    for (name, (_, kind, at)) in stiffnesses {
        let joint = robot.joints.iter().position(|j| j.name == *name);
        let Some(joint) = joint else {
            log.error(
                at,
                format!("there is no joint '{name}'"),
                suggestion(name, robot.joints.iter().map(|j| j.name.as_str())),
            );
            continue;
        };
        let JointType::Moving(motion) = robot.joints[joint].kind else {
            log.error(
                at,
                format!(
                    "the joint '{name}' does not move: it is {}",
                    robot.joints[joint].word
                ),
                "take it off the table",
            );
            continue;
        };
        if motion != *kind {
            log.error(
                at,
                format!(
                    "the unit does not fit: the joint '{name}' is {}",
                    robot.joints[joint].word
                ),
                "turning joints have N m/rad, sliding ones N/m",
            );
        } else if variables[joint].passive {
            log.error(
                at,
                format!("the joint '{name}' is passive: nothing drives it"),
                "take it off the table, or off the list of passive joints",
            );
        } else if let Some(mimic) = &robot.joints[joint].mimic {
            log.error(
                at,
                format!(
                    "the joint '{name}' follows the joint '{}' (<mimic>): it has no drive of its own",
                    mimic.joint
                ),
                format!(
                    "take it off the table, and give the stiffness of '{}'",
                    mimic.joint
                ),
            );
        } else if !variables[joint].moves {
            log.notice(
                at,
                format!(
                    "the joint '{name}' is not between base and tip: its stiffness is not used"
                ),
                "nothing has to be done",
            );
        }
    }
}
