//! The whole way from the text of a URDF to the text of a model file.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::Pose;
use kinetostat_model::schema::Section;
use kinetostat_model::{Model, ModelError, Problem};
use nalgebra::Vector3;

use crate::log::{At, Log, refusal, some_names};
use crate::stiffness;
use crate::stiffness::{JointStiffness, Stiffnesses};
use crate::urdf::chain::{Plan, Variable, Written, unique};
use crate::urdf::close::frames;
use crate::urdf::flange::{remark_flange, tip_in_tool, tool_frame};
use crate::urdf::graph::{Graph, LinkPath, graph};
use crate::urdf::loops::{Loops, UrdfOptions};
use crate::urdf::remarks::{
    in_metres, left_out, look_at_masses, moving_base, one_limb_each, reach, several_platforms,
    standing,
};
use crate::urdf::request::{
    closed, closings, ends, followers, homes, known_stiffnesses, used, variables,
};
use crate::urdf::robot::Robot;
use crate::urdf::tree::{Tree, TreeStep, doubts, tree};
use crate::urdf::write::{Parts, text};
use crate::urdf::{loops, read, xml};

/// Name of the section of all links.
const SECTION: &str = "links";

/// A robot as a model file, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model file.
    pub toml: String,
    /// Model read again from that file.
    pub model: Model,
    /// Skipped, replaced and suspicious elements, in the order of the work.
    pub notices: Vec<Problem>,
    /// Name of the robot.
    pub name: String,
    /// Base link.
    pub base: String,
    /// Tip link.
    pub tip: String,
    /// Commanded joints, in the model's order.
    pub actuators: Vec<String>,
    /// Commanded joints without a stiffness: to be filled in.
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
    let mut log = Log::default();
    let (robot, loops, stiffnesses) = read_all(urdf, file, options, &mut log)?;
    let home = AtHome::new(&robot, &loops, options, file, &mut log)?;
    known_stiffnesses(&robot, &home.variables, &stiffnesses, &mut log);
    log.stop()?;
    let plan = Plan {
        robot: &robot,
        tree: &home.tree,
        variables: &home.variables,
        home: &home.values,
        stiffnesses: &stiffnesses,
        for_all: one_for_all(&options.stiffness, file)?,
        section: options.section.as_ref().map(|_| SECTION),
    };
    // Links fixed to the base do not move.
    let mut placed: Vec<bool> = (0..robot.links.len())
        .map(|l| home.is_fixed(&robot, l))
        .collect();
    let paths = home.graph.paths.iter();
    let chains: Vec<Written> = paths.map(|path| plan.chain(path, &mut placed)).collect();
    remark(options, &plan, &home, &chains, &placed, &mut log)?;
    let lists = Lists::of(&chains);
    if !lists.rigid_drives.is_empty() {
        log.notice(
            &robot.at,
            format!(
                "drives without a stiffness: {}",
                some_names(&lists.rigid_drives)
            ),
            "they are rigid in the model; fill in their stiffness where it says FILL IN, or give --joint-stiffness",
        );
    }
    let toml = model_text(file, options, &robot, &home, chains, &lists)?;
    let model = Model::from_toml(&toml, "the imported model")?;
    Ok(Imported {
        toml,
        model,
        notices: log.notices,
        name: robot.name.clone(),
        base: robot.links[home.base].name.clone(),
        tip: robot.links[home.tip].name.clone(),
        actuators: lists.actuators,
        rigid_drives: lists.rigid_drives,
        passive_joints: lists.passive_joints,
        coupled_joints: lists.coupled_joints,
        bodies: lists.bodies,
        loops: robot.constraints.len(),
    })
}

/// The files of a robot: its URDF, the loop file and the table of stiffnesses.
fn read_all(
    urdf: &str,
    file: &str,
    options: &UrdfOptions,
    log: &mut Log,
) -> Result<(Robot, Loops, Stiffnesses), ModelError> {
    let urdf = urdf.strip_prefix('\u{feff}').unwrap_or(urdf);
    let index = log.file(file, urdf);
    let document = xml::parse(urdf, file, index, log)?;
    let mut robot = read::read(&document, index, log);
    log.stop()?;
    robot.add_missing_links();
    let loops = match &options.loops {
        Some(written) => loops::read(written, &mut robot, log),
        None => Loops::default(),
    };
    let stiffnesses = stiffness::table(&options.stiffness, log)?;
    log.stop()?;
    Ok((robot, loops, stiffnesses))
}

/// The robot at home, with its loops closed.
struct AtHome {
    tree: Tree,
    base: usize,
    tip: usize,
    graph: Graph,
    variables: Vec<Variable>,
    /// Values of the variables, m or rad.
    values: Vec<f64>,
    /// Poses of the links in the base.
    frames: Vec<Pose>,
}

impl AtHome {
    fn new(
        robot: &Robot,
        loops: &Loops,
        options: &UrdfOptions,
        file: &str,
        log: &mut Log,
    ) -> Result<Self, ModelError> {
        let tree = stopped(tree(robot, log), log)?;
        let (base, tip) = ends(robot, &tree, options, file)?;
        doubts(robot, &tree, [base, tip], log);
        log.stop()?;
        let mut variables = variables(robot, options, loops, log);
        let closings = closings(robot, log);
        log.stop()?;
        let graph = graph(robot, &tree, &closings, [base, tip], log);
        let graph = stopped(graph, log)?;
        used(&graph, &mut variables);
        followers(robot, &tree, &mut variables, log);
        let mut values = homes(robot, &mut variables, options, loops, log);
        log.stop()?;
        closed(robot, &tree, base, &closings, &variables, &mut values, log);
        log.stop()?;
        Ok(Self {
            frames: frames(robot, &tree, base, &values),
            tree,
            base,
            tip,
            graph,
            variables,
            values,
        })
    }

    /// True if no joint that moves lies between the base and a link.
    fn is_fixed(&self, robot: &Robot, link: usize) -> bool {
        let still = |s: &TreeStep| s.variable().is_none_or(|v| !self.variables[v].moves);
        self.tree.steps(robot, self.base, link).iter().all(still)
    }
}

/// Remarks on the robot, gravest first: elements that no model can represent are errors.
fn remark(
    options: &UrdfOptions,
    plan: &Plan<'_>,
    home: &AtHome,
    chains: &[Written],
    placed: &[bool],
    log: &mut Log,
) -> Result<(), ModelError> {
    let (robot, graph) = (plan.robot, &home.graph);
    one_limb_each(robot, &home.variables, chains, log);
    log.stop()?;
    left_out(robot, placed, log);
    let reach = reach(graph, home.base);
    in_metres(robot, reach, log);
    log.stop()?;
    let moving: Vec<usize> = (0..robot.links.len())
        .filter(|l| !home.is_fixed(robot, *l))
        .collect();
    look_at_masses(robot, &moving, reach, log);
    standing(robot, &home.tree, &home.variables, &home.values, log);
    if options.flange_z.is_none() {
        remark_flange(robot, home.tip, log);
    }
    let between = |w: &LinkPath| w.from != home.base || w.to != home.tip;
    if graph.paths.len() > 1 && graph.paths.iter().any(between) {
        several_platforms(robot, graph, log);
    }
    if !home.is_fixed(robot, home.tree.root) {
        moving_base(robot, home.base, log);
    }
    Ok(())
}

/// The model file: platforms and limbs under names that are free.
fn model_text(
    file: &str,
    options: &UrdfOptions,
    robot: &Robot,
    home: &AtHome,
    chains: Vec<Written>,
    lists: &Lists,
) -> Result<String, ModelError> {
    let graph = &home.graph;
    let mut names = BTreeSet::from(["base".to_owned()]);
    let named: BTreeMap<usize, String> = graph
        .platforms
        .iter()
        .map(|l| (*l, unique(&mut names, &robot.links[*l].name, "link")))
        .chain([(home.base, "base".to_owned())])
        .collect();
    let gravity = (home.frames[home.tree.root].rotation * Vector3::new(0.0, 0.0, -9.81))
        .map(|x| if x.abs() < 1e-12 { 0.0 } else { x });
    let tip = options.flange_z.and_then(tip_in_tool);
    let one = chains.len() == 1;
    let mut limb_names = BTreeSet::new();
    let limbs = graph
        .paths
        .iter()
        .zip(chains)
        .map(|(path, chain)| {
            let (from, to) = (named[&path.from].clone(), named[&path.to].clone());
            let name = match one {
                true => "arm".to_owned(),
                false => unique(&mut limb_names, &format!("{from} to {to}"), "limb"),
            };
            (name, from, to, chain.lines)
        })
        .collect();
    text(&Parts {
        name: &robot.name.chars().take(100).collect::<String>(),
        file,
        base: &robot.links[home.base].name,
        tip: &robot.links[home.tip].name,
        gravity: gravity.into(),
        platforms: graph
            .platforms
            .iter()
            .map(|l| {
                let turn = tip.as_ref().filter(|_| *l == home.tip);
                let own = home.frames[*l];
                (named[l].clone(), turn.map_or(own, |t| tool_frame(&own, t)))
            })
            .collect(),
        tip_in_tool: tip.as_ref().map(|turn| (named[&home.tip].as_str(), turn)),
        section: options.section.as_ref().map(|s| (SECTION, s)),
        limbs,
        rigid_drives: !lists.rigid_drives.is_empty(),
        masses: !lists.bodies.is_empty(),
    })
    .map_err(|e| refusal(file, format!("the model cannot be written: {e}"), ""))
}

/// Section of links from a file of its own: the keys of a `[section.NAME]` table of a model file.
///
/// # Errors
/// [`ModelError`] with the line where it is no section.
pub fn read_section(text: &str, file: &str) -> Result<Section, ModelError> {
    let mut log = Log::default();
    let index = log.file(file, text);
    kinetostat_model::exact_toml(text).map_err(|e| {
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
            Err(error) => error,
            Ok(()) => refusal(file, "this is no section", ""),
        }
    })
}

/// The one stiffness of all drives that turn, N m/rad.
fn one_for_all(stiffness: &JointStiffness, file: &str) -> Result<Option<f64>, ModelError> {
    match *stiffness {
        JointStiffness::All(value) if !(value > 0.0 && value.is_finite()) => Err(refusal(
            file,
            format!("the joint stiffness {value} N m/rad is no number above zero"),
            "leave it out for rigid drives",
        )),
        JointStiffness::All(value) => Ok(Some(value)),
        _ => Ok(None),
    }
}

/// Lists over all limbs.
struct Lists {
    actuators: Vec<String>,
    rigid_drives: Vec<String>,
    passive_joints: Vec<String>,
    coupled_joints: Vec<String>,
    bodies: Vec<(String, f64)>,
}

impl Lists {
    fn of(chains: &[Written]) -> Self {
        let summed = |of: fn(&Written) -> &Vec<String>| -> Vec<String> {
            chains.iter().flat_map(of).cloned().collect()
        };
        let mut coupled_joints = summed(|c| &c.coupled);
        coupled_joints.dedup();
        Self {
            actuators: summed(|c| &c.actuators),
            rigid_drives: summed(|c| &c.rigid_drives),
            passive_joints: summed(|c| &c.passive),
            coupled_joints,
            bodies: chains.iter().flat_map(|c| c.bodies.clone()).collect(),
        }
    }
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
