//! The whole way from the text of a URDF to the text of a model file.

use std::collections::{BTreeMap, HashMap, HashSet};

use kinetostat::{MotionKind, Pose, pose_residual};
use kinetostat_model::schema::Section;
use kinetostat_model::{Model, ModelError, Problem};
use nalgebra::{DMatrix, Vector3};

use crate::log::{At, Log, refusal, some_names, suggestion};
use crate::stiffness::{self, JointStiffness, Stiffnesses};
use crate::urdf::chain::{Plan, Variable, Written, unique};
use crate::urdf::close::{Free, close, frames};
use crate::urdf::graph::{Graph, closing_steps, graph, link_at};
use crate::urdf::loops::{self, LoopFile, Loops};
use crate::urdf::robot::{Closure, JointType, Robot};
use crate::urdf::tree::{Step, Tree, tree};
use crate::urdf::write::{Parts, text};
use crate::urdf::{inertial, read, xml};

/// Name of the section of all links.
const SECTION: &str = "links";

/// What to make of a URDF.
#[derive(Clone, Debug, Default)]
pub struct UrdfOptions {
    /// Link that stands; the root of the tree if not given.
    pub base: Option<String>,
    /// Link that carries the tool; needed unless only one link ends the tree.
    pub tip: Option<String>,
    /// Closed loops.
    pub loops: Option<LoopFile>,
    /// Joints that nothing drives, besides those of the loop file.
    pub passive: Vec<String>,
    /// Joints that do not stand at zero at home, rad or m, besides those of the loop file. A joint
    /// whose limits leave zero out stands in the middle of them.
    pub home: BTreeMap<String, f64>,
    /// Stiffness of the drives.
    pub stiffness: JointStiffness,
    /// Section of all links: straight beams from joint to joint. Rigid if not given.
    pub section: Option<Section>,
}

/// A robot as a model file, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model file.
    pub toml: String,
    /// The same, as it is read again.
    pub model: Model,
    /// What was skipped, replaced, or looks wrong, in the order of the work.
    pub notices: Vec<Problem>,
    /// Name of the robot.
    pub name: String,
    /// Base link.
    pub base: String,
    /// Tip link.
    pub tip: String,
    /// Commanded joints, in the model's order.
    pub actuators: Vec<String>,
    /// Those of them without a stiffness: to be filled in.
    pub rigid_drives: Vec<String>,
    /// Joints that nothing drives, closing joints included.
    pub passive_joints: Vec<String>,
    /// Joints that follow others (`<mimic>`).
    pub coupled_joints: Vec<String>,
    /// Bodies with their masses, kg.
    pub bodies: Vec<(String, f64)>,
    /// Number of closed loops.
    pub loops: usize,
}

/// Reads a URDF; `file` names it in messages and in the model.
///
/// # Errors
/// [`ModelError`] with every problem found, each with its file, line, element and what to do.
pub fn import_urdf(urdf: &str, file: &str, options: &UrdfOptions) -> Result<Imported, ModelError> {
    let urdf = urdf.strip_prefix('\u{feff}').unwrap_or(urdf);
    let mut log = Log::default();
    let index = log.file(file, urdf);
    let document = xml::parse(urdf, file, index, &mut log)?;
    let mut robot = read::read(&document, index, &mut log);
    log.stop()?;
    let loops = match &options.loops {
        Some(written) => loops::read(written, &mut robot, &mut log),
        None => Loops::default(),
    };
    let stiffnesses = stiffness::table(&options.stiffness, &mut log)?;
    log.stop()?;
    let tree = stopped(tree(&robot, &mut log), &mut log)?;
    let (base, tip) = ends(&robot, &tree, options, file)?;
    let mut variables = variables(&robot, options, &loops, &mut log);
    let closings = closings(&robot, &mut log);
    log.stop()?;
    let graph = graph(&robot, &tree, &closings, [base, tip], &mut log);
    let graph = stopped(graph, &mut log)?;
    used(&graph, &mut variables);
    followers(&robot, &tree, &mut variables, &mut log);
    let mut home = homes(&robot, &mut variables, options, &loops, &mut log);
    log.stop()?;
    closed(
        &robot, &tree, base, &closings, &variables, &mut home, &mut log,
    );
    log.stop()?;
    let frames = frames(&robot, &tree, base, &home);
    known_stiffnesses(&robot, &variables, &stiffnesses, &mut log);
    log.stop()?;
    let for_all = match options.stiffness {
        JointStiffness::All(value) if !(value > 0.0 && value.is_finite()) => {
            return Err(refusal(
                file,
                format!("the joint stiffness {value} N m/rad is no number above zero"),
                "leave it out for rigid drives",
            ));
        }
        JointStiffness::All(value) => Some(value),
        _ => None,
    };
    let plan = Plan {
        robot: &robot,
        tree: &tree,
        variables: &variables,
        home: &home,
        stiffnesses: &stiffnesses,
        for_all,
        section: options.section.as_ref().map(|_| SECTION),
    };
    // What is fixed to the base does not move.
    let still = |s: &Step| s.variable().is_none_or(|v| !variables[v].moves);
    let mut placed: Vec<bool> = (0..robot.links.len())
        .map(|l| tree.steps(&robot, base, l).iter().all(still))
        .collect();
    let moving: Vec<usize> = (0..robot.links.len())
        .filter(|l| !tree.steps(&robot, base, *l).iter().all(still))
        .collect();
    let chains: Vec<Written> = graph
        .ways
        .iter()
        .map(|way| plan.chain(way, &mut placed))
        .collect();
    one_limb_each(&robot, &variables, &chains, &mut log);
    log.stop()?;
    let left: Vec<&str> = (0..robot.links.len())
        .filter(|l| !placed[*l] && robot.links[*l].has_inertial)
        .map(|l| robot.links[l].name.as_str())
        .collect();
    if !left.is_empty() {
        log.notice(
            &robot.at,
            format!(
                "the weight of {} is left out: it moves with joints of several limbs",
                some_names(&left)
            ),
            "describe it as a limb of its own, by a <constraint> or in the loop file",
        );
    }
    let reach = reach(&graph);
    inertial::look(&robot, &moving, reach, &mut log);
    standing(&robot, &tree, &variables, &home, &mut log);
    if graph.ways.len() == 1 {
        singular(&plan, &graph, &frames, reach, &mut log);
    } else if graph.ways.iter().any(|w| w.from != base || w.to != tip) {
        log.notice(
            &robot.at,
            format!(
                "the loops make {} platforms: {}",
                graph.platforms.len(),
                graph
                    .platforms
                    .iter()
                    .map(|p| robot.links[*p].name.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            "the model has them all; the search for joint values of a pose needs limbs that run from the base to the tool, so commands that ask for a pose may refuse this machine",
        );
    }
    let mut names = HashSet::from(["base".to_owned()]);
    let named: HashMap<usize, String> = graph
        .platforms
        .iter()
        .map(|l| (*l, unique(&mut names, &robot.links[*l].name, "link")))
        .chain([(base, "base".to_owned())])
        .collect();
    let gravity = (frames[tree.root].rotation * Vector3::new(0.0, 0.0, -9.81))
        .map(|x| if x.abs() < 1e-12 { 0.0 } else { x });
    if !tree.steps(&robot, base, tree.root).iter().all(still) {
        log.notice(
            link_at(&robot, base),
            format!(
                "the base '{}' is above a moving joint in the URDF: it is taken as the ground, with gravity as it is when the robot is at home",
                robot.links[base].name
            ),
            "choose a base that stands, or correct gravity_m_per_s2",
        );
    }
    let one = chains.len() == 1;
    let mut limb_names = HashSet::new();
    let summed = |of: fn(&Written) -> &Vec<String>| -> Vec<String> {
        chains.iter().flat_map(of).cloned().collect()
    };
    let mut imported = Summary {
        actuators: summed(|c| &c.actuators),
        rigid_drives: summed(|c| &c.rigid_drives),
        passive_joints: summed(|c| &c.passive),
        coupled_joints: summed(|c| &c.coupled),
        bodies: chains.iter().flat_map(|c| c.bodies.clone()).collect(),
    };
    imported.coupled_joints.dedup();
    if !imported.rigid_drives.is_empty() {
        log.notice(
            &robot.at,
            format!(
                "drives without a stiffness: {}",
                some_names(&imported.rigid_drives)
            ),
            "they are rigid in the model; fill in their stiffness where it says FILL IN, or give --joint-stiffness",
        );
    }
    let limbs = graph
        .ways
        .iter()
        .zip(chains)
        .map(|(way, chain)| {
            let (from, to) = (named[&way.from].clone(), named[&way.to].clone());
            let name = match one {
                true => "arm".to_owned(),
                false => unique(&mut limb_names, &format!("{from} to {to}"), "limb"),
            };
            (name, from, to, chain.lines)
        })
        .collect();
    let toml = text(&Parts {
        name: &robot.name.chars().take(100).collect::<String>(),
        file,
        base: &robot.links[base].name,
        tip: &robot.links[tip].name,
        gravity: gravity.into(),
        platforms: graph
            .platforms
            .iter()
            .map(|l| (named[l].clone(), frames[*l]))
            .collect(),
        section: options.section.as_ref().map(|s| (SECTION, s)),
        limbs,
        rigid_drives: !imported.rigid_drives.is_empty(),
        masses: !imported.bodies.is_empty(),
    })
    .map_err(|e| refusal(file, format!("the model cannot be written: {e}"), ""))?;
    let model = Model::from_toml(&toml, "the imported model")?;
    Ok(Imported {
        toml,
        model,
        notices: log.notices,
        name: robot.name.clone(),
        base: robot.links[base].name.clone(),
        tip: robot.links[tip].name.clone(),
        actuators: imported.actuators,
        rigid_drives: imported.rigid_drives,
        passive_joints: imported.passive_joints,
        coupled_joints: imported.coupled_joints,
        bodies: imported.bodies,
        loops: robot.constraints.len(),
    })
}

/// Section of links from a file of its own: the keys of a `[section.NAME]` table of a model file.
///
/// # Errors
/// [`ModelError`] with the line where it is no section.
pub fn read_section(text: &str, file: &str) -> Result<Section, ModelError> {
    let mut log = Log::default();
    let index = log.file(file, text);
    toml::from_str(text).map_err(|e| {
        let at = At {
            file: index,
            span: e.span().unwrap_or_default(),
            element: String::new(),
        };
        log.error(
            &at,
            format!("this is no section: {}", e.message()),
            "write the keys of a section, as in: tube = { outer_diameter_mm = 300, inner_diameter_mm = 260 }, youngs_modulus_gpa = 210, poissons_ratio = 0.3, each on a line of its own",
        );
        match log.stop() {
            Err(told) => told,
            Ok(()) => refusal(file, "this is no section", ""),
        }
    })
}

/// Lists over all limbs.
struct Summary {
    actuators: Vec<String>,
    rigid_drives: Vec<String>,
    passive_joints: Vec<String>,
    coupled_joints: Vec<String>,
    bodies: Vec<(String, f64)>,
}

/// The value, or the errors that explain why there is none.
fn stopped<T>(found: Option<T>, log: &mut Log) -> Result<T, ModelError> {
    log.stop()?;
    found.ok_or_else(|| {
        refusal(
            "URDF",
            "the robot could not be read",
            "please report this file",
        )
    })
}

/// Base and tip.
fn ends(
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
            let parents: HashSet<usize> = tree.ends.iter().map(|e| e.0).collect();
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
fn variables(robot: &Robot, options: &UrdfOptions, loops: &Loops, log: &mut Log) -> Vec<Variable> {
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
fn closings(robot: &Robot, log: &mut Log) -> Vec<([usize; 2], Vec<Step>)> {
    let mut closings = Vec::new();
    let mut first = robot.joints.len();
    let mut names: HashSet<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
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
fn used(graph: &Graph, variables: &mut [Variable]) {
    for step in graph.ways.iter().flat_map(|w| &w.steps) {
        if let Some(v) = step.variable() {
            variables[v].moves = true;
        }
    }
}

/// Limits of joints that follow others hold for the joints that lead them.
fn followers(robot: &Robot, tree: &Tree, variables: &mut [Variable], log: &mut Log) {
    for (joint, follow) in robot.joints.iter().zip(&tree.follows) {
        let (Some(v), Some((low, high)), Some(_)) = (follow.variable, joint.limits, &joint.mimic)
        else {
            continue;
        };
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

/// Values at home: as told, else zero, else the middle of the limits.
fn homes(
    robot: &Robot,
    variables: &mut [Variable],
    options: &UrdfOptions,
    loops: &Loops,
    log: &mut Log,
) -> Vec<f64> {
    let mut home: Vec<f64> = variables
        .iter()
        .map(|v| match v.limits {
            Some((low, high)) if !(low <= 0.0 && 0.0 <= high) => {
                let middle = 0.5 * (low + high);
                if v.moves {
                    log.notice(
                        &v.at,
                        format!("zero lies outside the limits: at home the joint stands in their middle, {middle:.4}"),
                        "choose another home with --home if you like",
                    );
                }
                middle
            }
            _ => 0.0,
        })
        .collect();
    let told = loops
        .home
        .iter()
        .map(|(at, n, v, turning)| (at.clone(), n.clone(), *v, Some(*turning)))
        .chain(
            options
                .home
                .iter()
                .map(|(n, v)| (robot.at.clone(), n.clone(), *v, None)),
        );
    for (at, name, value, turning) in told {
        let Some(joint) = robot.joints.iter().position(|j| j.name == name) else {
            log.error(
                &at,
                format!("home: there is no joint '{name}'"),
                suggestion(&name, robot.joints.iter().map(|j| j.name.as_str())),
            );
            continue;
        };
        let j = &robot.joints[joint];
        if j.mimic.is_some() || !matches!(j.kind, JointType::Moving(_)) {
            log.error(
                &at,
                format!("home: the joint '{name}' does not move by itself"),
                "name the joint that it follows",
            );
        } else if turning.is_some_and(|t| t != (variables[joint].kind == MotionKind::Revolute)) {
            log.error(
                &at,
                format!("home: the joint '{name}' is {}", j.word),
                "turning joints go under home_rad, sliding ones under home_m",
            );
        } else if !value.is_finite()
            || j.limits
                .is_some_and(|(low, high)| !(low <= value && value <= high))
        {
            log.error(
                &at,
                format!("home: {value} is outside the limits of the joint '{name}'"),
                "choose a value within them",
            );
        } else {
            home[joint] = value;
        }
    }
    home
}

/// Closes the loops at home by the passive joints.
fn closed(
    robot: &Robot,
    tree: &Tree,
    base: usize,
    closings: &[([usize; 2], Vec<Step>)],
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
    let stands: Vec<String> = free
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
        format!("at home the loops close with {}", stands.join(", ")),
        "where loops close in several ways, passive joints stay near their start: give other starts by home_rad and home_m in the loop file, or --home",
    );
}

/// Names in the table of stiffnesses that no drive has.
fn known_stiffnesses(
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
        } else if !variables[joint].moves && robot.joints[joint].mimic.is_none() {
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

/// A joint that moves parts of two limbs would be two drives.
fn one_limb_each(robot: &Robot, variables: &[Variable], chains: &[Written], log: &mut Log) {
    let mut seen: HashSet<usize> = HashSet::new();
    for v in chains.iter().flat_map(Written::variables) {
        if !seen.insert(v) {
            let follower = robot.joints.iter().find(|j| {
                j.mimic
                    .as_ref()
                    .is_some_and(|m| m.joint == variables[v].name)
            });
            log.error(
                follower.map_or(&variables[v].at, |j| &j.at),
                format!(
                    "'{}' moves joints of two limbs, which a model cannot say",
                    variables[v].name
                ),
                "replace <mimic> by the loop that makes the joint follow (a <constraint> or the loop file)",
            );
        }
    }
}

/// Length of the longest way from its second joint on, m: the first one only turns the arm about its
/// foot.
fn reach(graph: &Graph) -> f64 {
    let length = |steps: &[Step]| {
        let mut joints = 0;
        let mut sum = 0.0;
        for step in steps {
            match step {
                Step::Move { .. } => joints += 1,
                Step::Offset { origin, .. } if joints >= 2 => {
                    sum += Vector3::from(origin.xyz).norm();
                }
                _ => {}
            }
        }
        sum
    };
    graph
        .ways
        .iter()
        .map(|w| length(&w.steps))
        .fold(0.0, f64::max)
}

/// Joints beside the way that carry mass and stand still.
fn standing(robot: &Robot, tree: &Tree, variables: &[Variable], home: &[f64], log: &mut Log) {
    for (i, joint) in robot.joints.iter().enumerate() {
        let own = tree.follows[i].variable == Some(i);
        if own && !variables[i].moves {
            log.notice(
                &joint.at,
                format!(
                    "the joint is not between the base and the tip: it stands at {}",
                    home[i]
                ),
                "masses behind it are carried along in that position; choose another tip, or say how it is held by a loop file (--loops)",
            );
        }
    }
}

/// Whether the arm at home has lost a direction.
fn singular(plan: &Plan<'_>, graph: &Graph, frames: &[Pose], reach: f64, log: &mut Log) {
    let Some(way) = graph.ways.first() else {
        return;
    };
    let mut moving: Vec<usize> = way.steps.iter().filter_map(Step::variable).collect();
    moving.sort_unstable();
    moving.dedup();
    if moving.len() < 6 || reach < 1e-3 {
        return;
    }
    let step = 1e-6;
    let mut jacobian = DMatrix::zeros(6, moving.len());
    for (column, &v) in moving.iter().enumerate() {
        let mut values = plan.home.to_vec();
        values[v] += step;
        let ahead = crate::urdf::close::product(&way.steps, frames[way.from], &values);
        let change = pose_residual(&ahead, &frames[way.to]).0 / step;
        for i in 0..6 {
            let unit = if i < 3 { reach } else { 1.0 };
            jacobian[(i, column)] = change[i] / unit;
        }
    }
    let values = jacobian.singular_values();
    if values.min() < 1e-4 * values.max() {
        log.notice(
            &plan.robot.at,
            "the arm is singular at home: two of its axes do the same there",
            "choose a home that is not, as in --home joint_5=30deg; `check` and the search for joint values start from it",
        );
    }
}
