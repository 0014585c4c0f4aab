//! From the tree and its closing joints to platforms and paths between them: what does not lie
//! between base and tip is cut away, links that are fixed to each other are one.

use std::collections::{BTreeMap, VecDeque};

use crate::log::Log;
use crate::urdf::robot::{Closure, Constraint, JointType, Robot};
use crate::urdf::tree::{Follow, Tree, TreeStep};

use kinetostat::MotionKind;

/// A path between two platforms.
#[derive(Clone, Debug)]
pub(crate) struct LinkPath {
    /// Links that stand for the platforms.
    pub(crate) from: usize,
    pub(crate) to: usize,
    /// Steps from the frame of `from` to that of `to`.
    pub(crate) steps: Vec<TreeStep>,
}

/// Platforms and paths of the model.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    /// Links that stand for moving platforms; the tip is the last one.
    pub(crate) platforms: Vec<usize>,
    pub(crate) paths: Vec<LinkPath>,
}

/// A joint between two groups of links that are fixed to each other.
struct Edge {
    ends: [usize; 2],
    links: [usize; 2],
    /// Steps from the first link to the second, without its arrival.
    steps: Vec<TreeStep>,
}

/// Coordinates of closing joints are numbered after the joints of the tree.
pub(crate) fn closing_steps(constraint: &Constraint, first_variable: usize) -> Vec<TreeStep> {
    let name = &constraint.name;
    let x = [1.0, 0.0, 0.0];
    let offset = |origin, inverse| TreeStep::Offset {
        joint: name.clone(),
        origin,
        inverse,
    };
    let single = |kind, joint: String, axis, k| TreeStep::Move {
        joint,
        kind,
        axis,
        follow: Follow {
            variable: Some(first_variable + k),
            ratio: 1.0,
            offset: 0.0,
        },
        sign: 1.0,
    };
    let turn =
        |letter: &str, axis, k| single(MotionKind::Revolute, format!("{name}.{letter}"), axis, k);
    let parent_axis = constraint.parent.axis.unwrap_or(x);
    let mut steps = vec![offset(constraint.parent.origin, false)];
    match constraint.closure {
        Closure::Single(kind) => steps.push(single(kind, name.clone(), parent_axis, 0)),
        Closure::Universal => {
            let child_axis = constraint.child.axis.unwrap_or([0.0, 1.0, 0.0]);
            steps.push(turn("1", parent_axis, 0));
            steps.push(turn("2", child_axis, 1));
        }
        Closure::Spherical => {
            for (k, letter) in ["x", "y", "z"].into_iter().enumerate() {
                let mut axis = [0.0; 3];
                axis[k] = 1.0;
                steps.push(turn(letter, axis, k));
            }
        }
    }
    steps.push(offset(constraint.child.origin, true));
    steps
}

/// Platforms and paths, or `None` with errors in the log. `closings` are the constraints' links and
/// steps.
pub(crate) fn graph(
    robot: &Robot,
    tree: &Tree,
    closings: &[([usize; 2], Vec<TreeStep>)],
    [base, tip]: [usize; 2],
    log: &mut Log,
) -> Option<Graph> {
    let group = groups(robot, tree);
    let mut edges: Vec<Edge> = Vec::new();
    for (i, joint) in robot.joints.iter().enumerate() {
        let links = [tree.ends[i].0, tree.ends[i].1];
        if tree.follows[i].variable.is_some() {
            edges.push(Edge {
                ends: links.map(|l| group[l]),
                links,
                steps: tree.joint_steps(robot, i),
            });
        } else if matches!(joint.kind, JointType::Several(_)) {
            // Groups of both sides are one unless it lies on a path: looked at below.
            continue;
        }
    }
    for (constraint, (links, steps)) in robot.constraints.iter().zip(closings) {
        let ends = links.map(|l| group[l]);
        if ends[0] == ends[1] {
            log.error(
                &constraint.at,
                "the loop joins two links that are fixed to each other",
                "name two links that move against each other, or remove it",
            );
            return None;
        }
        edges.push(Edge {
            ends,
            links: *links,
            steps: steps.clone(),
        });
    }
    if group[base] == group[tip] {
        log.error(
            &robot.links[tip].at,
            format!(
                "nothing moves between the base '{}' and the tip '{}'",
                robot.links[base].name, robot.links[tip].name
            ),
            "name the link that does not move and the one that carries the tool: --base LINK --tip LINK",
        );
        return None;
    }
    let kept = prune(
        &edges,
        group.iter().max().map_or(0, |m| m + 1),
        [group[base], group[tip]],
    );
    several_freedoms(robot, tree, &kept, &edges, [base, tip], log)?;
    Some(paths(robot, tree, &group, &edges, &kept, [base, tip]))
}

/// Links that are fixed to each other have the same number.
fn groups(robot: &Robot, tree: &Tree) -> Vec<usize> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); robot.links.len()];
    for (i, (parent, _)) in tree.ends.iter().enumerate() {
        children[*parent].push(i);
    }
    let mut group = vec![0; robot.links.len()];
    let mut count = 1;
    let mut open = vec![tree.root];
    while let Some(link) = open.pop() {
        for &joint in &children[link] {
            let child = tree.ends[joint].1;
            group[child] = match tree.follows[joint].variable {
                None => group[link],
                Some(_) => {
                    count += 1;
                    count - 1
                }
            };
            open.push(child);
        }
    }
    group
}

/// True for each edge that lies between base and tip or in a loop: dead ends are removed until none is left.
fn prune(edges: &[Edge], groups: usize, keep: [usize; 2]) -> Vec<bool> {
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); groups];
    for (i, e) in edges.iter().enumerate() {
        for g in e.ends {
            at[g].push(i);
        }
    }
    let mut degree: Vec<usize> = at.iter().map(Vec::len).collect();
    let mut kept = vec![true; edges.len()];
    let mut open: VecDeque<usize> = (0..groups).collect();
    while let Some(g) = open.pop_front() {
        if degree[g] != 1 || keep.contains(&g) {
            continue;
        }
        if let Some(&e) = at[g].iter().find(|e| kept[**e]) {
            kept[e] = false;
            for other in edges[e].ends {
                degree[other] -= 1;
                open.push_back(other);
            }
        }
    }
    kept
}

/// Joints of several freedoms stand still beside the path; on it they are refused.
fn several_freedoms(
    robot: &Robot,
    tree: &Tree,
    kept: &[bool],
    edges: &[Edge],
    [base, tip]: [usize; 2],
    log: &mut Log,
) -> Option<()> {
    let mut used: Vec<usize> = vec![base, tip];
    for (e, _) in edges.iter().zip(kept).filter(|(_, k)| **k) {
        used.extend(e.links);
    }
    for (i, joint) in robot.joints.iter().enumerate() {
        let JointType::Several(word) = joint.kind else {
            continue;
        };
        // A joint lies on the path if there are used links on both sides of it.
        let below = |mut link: usize| {
            while let Some(above) = tree.above[link] {
                if above == i {
                    return true;
                }
                link = tree.ends[above].0;
            }
            false
        };
        let under = used.iter().filter(|l| below(**l)).count();
        if under > 0 && under < used.len() {
            log.error(
                &joint.at,
                format!("a {word} joint lies between the base and the tip"),
                "write it as a row of revolute and prismatic joints, or choose a base behind it (--base)",
            );
        } else {
            log.notice(
                &joint.at,
                format!("the {word} joint does not move: it is not between the base and the tip"),
                "nothing has to be done",
            );
        }
    }
    (!log.any_errors()).then_some(())
}

fn paths(
    robot: &Robot,
    tree: &Tree,
    group: &[usize],
    edges: &[Edge],
    kept: &[bool],
    [base, tip]: [usize; 2],
) -> Graph {
    let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, e) in edges.iter().enumerate().filter(|(i, _)| kept[*i]) {
        for g in e.ends {
            at.entry(g).or_default().push(i);
        }
    }
    let none = Vec::new();
    let around = |g: usize| at.get(&g).unwrap_or(&none);
    // Groups that are platforms, each with the link that stands for it.
    let mut link_of: BTreeMap<usize, usize> =
        BTreeMap::from([(group[base], base), (group[tip], tip)]);
    for (link, g) in group.iter().enumerate() {
        if around(*g).len() >= 3 {
            link_of.entry(*g).or_insert(link);
        }
    }
    let mut used = vec![false; edges.len()];
    let mut order = vec![group[base]];
    let mut open = VecDeque::from([group[base]]);
    let mut found = Vec::new();
    while let Some(start) = open.pop_front() {
        for &first in around(start) {
            if used[first] {
                continue;
            }
            // Along joints until the next platform.
            let mut steps = Vec::new();
            let (mut g, mut link, mut edge) = (start, link_of[&start], first);
            let end = loop {
                used[edge] = true;
                let e = &edges[edge];
                let backward = e.ends[0] != g;
                let [near, far] = match backward {
                    true => [e.links[1], e.links[0]],
                    false => e.links,
                };
                steps.extend(tree.steps(robot, link, near));
                match backward {
                    true => steps.extend(e.steps.iter().rev().map(TreeStep::reversed)),
                    false => steps.extend(e.steps.iter().cloned()),
                }
                steps.push(TreeStep::Arrive(far));
                (g, link) = (group[far], far);
                if link_of.contains_key(&g) {
                    break g;
                }
                // A path that would come back to where it started ends half way.
                let next = around(g).iter().copied().find(|i| !used[*i]);
                let back = next.is_some_and(|i| {
                    let far = if edges[i].ends[0] == g { 1 } else { 0 };
                    edges[i].ends[far] == start
                });
                match next {
                    Some(i) if !back => edge = i,
                    _ => {
                        link_of.insert(g, link);
                        break g;
                    }
                }
            };
            let to = link_of[&end];
            steps.extend(tree.steps(robot, link, to));
            if !order.contains(&end) {
                order.push(end);
                open.push_back(end);
            }
            found.push(LinkPath {
                from: link_of[&start],
                to,
                steps,
            });
        }
    }
    let mut platforms: Vec<usize> = order[1..]
        .iter()
        .map(|g| link_of[g])
        .filter(|l| *l != tip)
        .collect();
    platforms.push(tip);
    Graph {
        platforms,
        paths: found,
    }
}
