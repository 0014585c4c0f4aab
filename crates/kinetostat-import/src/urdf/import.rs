//! The whole way from the text of a URDF to the text of a model file.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::MotionKind;
use kinetostat_model::schema::Section;
use kinetostat_model::{Model, ModelError, Problem};
use nalgebra::Vector3;

use crate::log::{At, Log, refusal, some_names};
use crate::stiffness::{self, JointStiffness};
use crate::urdf::chain::{Plan, Written, unique};
use crate::urdf::close::frames;
use crate::urdf::graph::graph;
use crate::urdf::loops::{self, LoopFile, Loops};
use crate::urdf::question::{
    closed, closings, ends, followers, homes, known_stiffnesses, used, variables,
};
use crate::urdf::remarks::{
    in_metres, left_out, moving_base, one_limb_each, reach, several_platforms, singular, standing,
};
use crate::urdf::tree::{Step, tree};
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
    /// Joints that do not stand at zero at home, besides those of the loop file: whether the value
    /// is an angle (rad) or a distance (m), and the value. The kind must be the joint's. A joint
    /// whose limits leave zero out stands in the middle of them.
    pub home: BTreeMap<String, (MotionKind, f64)>,
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
    let for_all = one_for_all(&options.stiffness, file)?;
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
    left_out(&robot, &placed, &mut log);
    let reach = reach(&graph, base);
    in_metres(&robot, reach, &mut log);
    log.stop()?;
    inertial::look(&robot, &moving, reach, &mut log);
    standing(&robot, &tree, &variables, &home, &mut log);
    if graph.ways.len() == 1 {
        singular(&plan, &graph, &frames, reach, &mut log);
    } else if graph.ways.iter().any(|w| w.from != base || w.to != tip) {
        several_platforms(&robot, &graph, &mut log);
    }
    let mut names = BTreeSet::from(["base".to_owned()]);
    let named: BTreeMap<usize, String> = graph
        .platforms
        .iter()
        .map(|l| (*l, unique(&mut names, &robot.links[*l].name, "link")))
        .chain([(base, "base".to_owned())])
        .collect();
    let gravity = (frames[tree.root].rotation * Vector3::new(0.0, 0.0, -9.81))
        .map(|x| if x.abs() < 1e-12 { 0.0 } else { x });
    if !tree.steps(&robot, base, tree.root).iter().all(still) {
        moving_base(&robot, base, &mut log);
    }
    let one = chains.len() == 1;
    let mut limb_names = BTreeSet::new();
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
            Err(told) => told,
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
