//! Remarks on a robot that can be imported, and on masses that were never meant: missing, equal everywhere, unit matrices, too
//! heavy or too light for the robot's size. They are imported as written and noticed.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};

use crate::log::{Log, some_names};
use crate::urdf::chain::{Variable, Written};
use crate::urdf::graph::Graph;
use crate::urdf::request::with_unit;
use crate::urdf::robot::{Inertial, Robot};
use crate::urdf::tree::{Tree, TreeStep};

/// A joint that moves parts of two limbs would be two drives.
pub(crate) fn one_limb_each(
    robot: &Robot,
    variables: &[Variable],
    chains: &[Written],
    log: &mut Log,
) {
    let mut seen: BTreeSet<usize> = BTreeSet::new();
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

/// Length of the arm from its second joint on, m: the first one only turns it about its foot. In a machine with loops
/// it is measured along the fewest limbs from the base to the tip, on the longest of those paths.
pub(crate) fn reach(graph: &Graph, base: usize) -> f64 {
    // Length and number of joints of the path to each link known so far.
    let mut known: BTreeMap<usize, (f64, usize)> = BTreeMap::from([(base, (0.0, 0))]);
    for _ in &graph.platforms {
        let before = known.clone();
        for path in &graph.paths {
            for (from, to, backward) in [(path.from, path.to, false), (path.to, path.from, true)] {
                let Some(&(mut sum, mut joints)) = before.get(&from) else {
                    continue;
                };
                if before.contains_key(&to) {
                    continue;
                }
                let mut step = |step: &TreeStep| match step {
                    TreeStep::Move { .. } => joints += 1,
                    TreeStep::Offset { origin, .. } if joints >= 2 => {
                        sum += Vector3::from(origin.xyz).norm();
                    }
                    _ => {}
                };
                if backward {
                    path.steps.iter().rev().for_each(&mut step);
                } else {
                    path.steps.iter().for_each(&mut step);
                }
                if known.get(&to).is_none_or(|(other, _)| sum > *other) {
                    known.insert(to, (sum, joints));
                }
            }
        }
    }
    let tip = graph.platforms.last().and_then(|tip| known.get(tip));
    tip.map_or(0.0, |(sum, _)| *sum)
}

/// Implausible length of an arm, m.
const LONGEST: f64 = 300.0;

/// Refuses an arm that is written in millimetres.
pub(crate) fn in_metres(robot: &Robot, reach: f64, log: &mut Log) {
    if reach > LONGEST {
        log.error(
            &robot.at,
            format!("the offsets of the arm add up to {reach:.0} m"),
            "lengths of a URDF are metres, and these look like millimetres: divide all lengths by 1000 (and inertias by a million if they are kg mm^2)",
        );
    }
}

/// Joints beside the path that carry mass and stand still.
pub(crate) fn standing(
    robot: &Robot,
    tree: &Tree,
    variables: &[Variable],
    home: &[f64],
    log: &mut Log,
) {
    for (i, joint) in robot.joints.iter().enumerate() {
        let own = tree.follows[i].variable == Some(i);
        if own && !variables[i].moves {
            log.notice(
                &joint.at,
                format!(
                    "the joint is not between the base and the tip: it is at rest at {}",
                    with_unit(home[i], variables[i].kind)
                ),
                "masses behind it are carried along in that position; choose another tip, or say how it is held by a loop file (--loops)",
            );
        }
    }
}

/// Masses that no chain could take.
pub(crate) fn left_out(robot: &Robot, placed: &[bool], log: &mut Log) {
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
}

/// Platforms between base and tip, which not every command can use.
pub(crate) fn several_platforms(robot: &Robot, graph: &Graph, log: &mut Log) {
    let names: Vec<&str> = graph
        .platforms
        .iter()
        .map(|p| robot.links[*p].name.as_str())
        .collect();
    log.notice(
        &robot.at,
        format!(
            "the loops make {} platforms: {}",
            names.len(),
            names.join(", ")
        ),
        "the model has them all, and `check` tells mobility, over-constraint and reach of the whole; where actuators are redundant, the commands nearest to home are taken",
    );
}

/// A base that the URDF's own joints move.
pub(crate) fn moving_base(robot: &Robot, base: usize, log: &mut Log) {
    let link = &robot.links[base];
    log.notice(
        &link.at,
        format!(
            "the base '{}' is above a moving joint in the URDF: it is taken as the ground, with gravity as it is when the robot is at home",
            link.name
        ),
        "choose a base that does not move, or correct gravity_m_per_s2",
    );
}

/// Looks at the inertials of the links that move; `reach` is the length of the moving arm, m.
pub(crate) fn look_at_masses(robot: &Robot, moving: &[usize], reach: f64, log: &mut Log) {
    let named = |links: &[usize]| {
        let names: Vec<&str> = links
            .iter()
            .map(|l| robot.links[*l].name.as_str())
            .collect();
        some_names(&names)
    };
    let of = |l: &usize| robot.links[*l].inertial.as_ref();
    // Frames such as 'flange' and 'tool0' have neither mass nor shape.
    let without: Vec<usize> = moving
        .iter()
        .copied()
        .filter(|l| of(l).is_none() && !robot.links[*l].meshes.is_empty())
        .collect();
    let with: Vec<usize> = moving.iter().copied().filter(|l| of(l).is_some()).collect();
    if with.is_empty() {
        log.notice(
            &robot.at,
            "no moving link has a mass: the model bends under loads, but not under its own weight",
            "add { body = ... } elements to the chain, or <inertial> to the URDF",
        );
        return;
    }
    if !without.is_empty() {
        log.notice(
            &robot.links[without[0]].at,
            format!("links with a shape but without a mass: {}", named(&without)),
            "their weight is left out; add { body = ... } elements to the chain",
        );
    }
    for &link in &with {
        let Some(inertial) = of(&link) else { continue };
        look_at_mass(inertial, reach, log);
    }
}

/// Checks one inertial by itself.
fn look_at_mass(inertial: &Inertial, reach: f64, log: &mut Log) {
    let at = &inertial.at;
    let m = &inertial.inertia;
    if inertial.mass == 0.0 {
        log.notice(
            at,
            "the mass is zero",
            "its weight is left out; write the true mass into the URDF or the model",
        );
        return;
    }
    if *m == Matrix3::identity() {
        log.notice(
            at,
            "the inertia is the unit matrix: a placeholder",
            "statics does not use it; is the mass a placeholder too?",
        );
    }
    let centre = Vector3::from(inertial.origin.xyz).norm();
    if reach > 0.05 && centre > 2.0 * reach {
        log.notice(
            at,
            format!("the centre of mass lies {centre:.2} m away from the link's frame"),
            "lengths of a URDF are metres; are these millimetres?",
        );
    }
    let gyration = (m.diagonal().max() / inertial.mass).sqrt();
    if reach > 0.05 && gyration > 2.0 * reach && *m != Matrix3::identity() {
        log.notice(
            at,
            format!(
                "the inertia belongs to a body of about {gyration:.1} m, the arm has {reach:.1} m"
            ),
            "check its unit: kg m^2 (CAD programs like kg mm^2); statics does not use it",
        );
    }
}
