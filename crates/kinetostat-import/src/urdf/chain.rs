//! A path as the elements of a chain, with the masses that hang on it.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::{MotionKind, Pose};
use kinetostat_model::schema::{
    ActuatorElement, ActuatorKind, Axis, AxisName, BodyElement, CoupledElement, Element, JointKind,
    LinkElement, NodeElement, PassiveElement, PassiveKind, Placement, RigidElement,
};
use nalgebra::{Matrix3, Vector3};

use crate::log::At;
use crate::stiffness::Stiffnesses;
use crate::urdf::close::product;
use crate::urdf::graph::LinkPath;
use crate::urdf::robot::{Origin, Robot};
use crate::urdf::tree::{Follow, Tree, TreeStep};

/// A coordinate of the robot: a joint of the URDF that moves by itself, or one of a closing joint.
#[derive(Clone, Debug)]
pub(crate) struct Variable {
    pub(crate) name: String,
    pub(crate) kind: MotionKind,
    pub(crate) at: At,
    /// Lies between base and tip; the others stand still at home.
    pub(crate) moves: bool,
    pub(crate) passive: bool,
    pub(crate) limits: Option<(f64, f64)>,
}

/// Everything that the chains are made from.
pub(crate) struct Plan<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) tree: &'a Tree,
    pub(crate) variables: &'a [Variable],
    /// Values at home, m or rad.
    pub(crate) home: &'a [f64],
    pub(crate) stiffnesses: &'a Stiffnesses,
    /// Common stiffness of all drives that turn.
    pub(crate) for_all: Option<f64>,
    /// Name of the section of links, if they bend.
    pub(crate) section: Option<&'a str>,
}

/// One line of a chain.
pub(crate) struct Line {
    /// Written above it.
    pub(crate) comment: String,
    pub(crate) element: Element,
    /// Written behind it.
    pub(crate) remark: &'static str,
}

/// A chain as far as it has been written.
#[derive(Default)]
pub(crate) struct Written {
    pub(crate) lines: Vec<Line>,
    pub(crate) actuators: Vec<String>,
    pub(crate) rigid_drives: Vec<String>,
    pub(crate) passive: Vec<String>,
    /// Joints that follow others, side branches included.
    pub(crate) coupled: Vec<String>,
    pub(crate) bodies: Vec<(String, f64)>,
    /// Variables by the coordinate that stands for them: its name, and `coordinate = scale * variable
    /// + offset`.
    defined: BTreeMap<usize, (String, f64, f64)>,
    names: BTreeSet<String>,
    body_names: BTreeSet<String>,
    comment: String,
}

impl Written {
    fn push(&mut self, element: Element, remark: &'static str) {
        self.lines.push(Line {
            comment: std::mem::take(&mut self.comment),
            element,
            remark,
        });
    }

    pub(crate) fn variables(&self) -> impl Iterator<Item = usize> + '_ {
        self.defined.keys().copied()
    }
}

/// The name, or the name with a word or a number behind it where it is taken.
pub(crate) fn unique(taken: &mut BTreeSet<String>, name: &str, word: &str) -> String {
    let mut choice = name.to_owned();
    let mut number = 1;
    while !taken.insert(choice.clone()) {
        choice = match number {
            1 => format!("{name} ({word})"),
            n => format!("{name} ({word} {n})"),
        };
        number += 1;
    }
    choice
}

pub(crate) fn axis(v: &[f64; 3]) -> Axis {
    let named = match v {
        [1.0, 0.0, 0.0] => AxisName::X,
        [0.0, 1.0, 0.0] => AxisName::Y,
        [0.0, 0.0, 1.0] => AxisName::Z,
        [-1.0, 0.0, 0.0] => AxisName::MinusX,
        [0.0, -1.0, 0.0] => AxisName::MinusY,
        [0.0, 0.0, -1.0] => AxisName::MinusZ,
        _ => return Axis::Vector(*v),
    };
    Axis::Named(named)
}

fn joint_kind(kind: MotionKind) -> JointKind {
    match kind {
        MotionKind::Prismatic => JointKind::Prismatic,
        MotionKind::Revolute => JointKind::Revolute,
    }
}

fn given<const N: usize>(v: [f64; N]) -> Option<[f64; N]> {
    v.iter().any(|x| *x != 0.0).then_some(v)
}

/// A pose as a file writes it; `None` for the identity.
pub(crate) fn placement(pose: &Pose) -> Option<Placement> {
    let translation_m = given(pose.translation.vector.into());
    let q = pose.rotation.quaternion();
    let turned = q.imag().norm() > 0.0;
    let quaternion_wxyz = turned.then_some([q.w, q.i, q.j, q.k]);
    (translation_m.is_some() || turned).then(|| Placement {
        translation_m,
        quaternion_wxyz,
        ..Placement::default()
    })
}

fn rigid(placement: Placement, name: Option<String>) -> Element {
    Element::Rigid(RigidElement {
        rigid: placement,
        name,
        source: None,
        assumption: None,
    })
}

impl Plan<'_> {
    /// Fixed value of a joint whose variable does not move in the model.
    fn still(&self, follow: &Follow) -> Option<f64> {
        match follow.variable {
            None => Some(follow.offset),
            Some(v) if !self.variables[v].moves => {
                Some(follow.offset + follow.ratio * self.home[v])
            }
            Some(_) => None,
        }
    }

    /// The chain of a path. Links whose mass has been placed are marked in `placed`.
    pub(crate) fn chain(&self, path: &LinkPath, placed: &mut [bool]) -> Written {
        let mut out = Written::default();
        for reserved in ["start", "end"] {
            out.names.insert(reserved.into());
        }
        out.body_names.insert("tip".into());
        let mut here = path.from;
        self.masses(here, &mut out, placed);
        for step in &path.steps {
            match step {
                TreeStep::Offset {
                    joint,
                    origin,
                    inverse,
                } => self.offset(&mut out, joint, origin, *inverse),
                TreeStep::Move { .. } => self.movement(&mut out, step),
                TreeStep::Arrive(link) => {
                    here = *link;
                    self.masses(here, &mut out, placed);
                }
            }
        }
        out
    }

    fn offset(&self, out: &mut Written, joint: &str, origin: &Origin, inverse: bool) {
        if let Some(j) = self.robot.joints.iter().find(|j| j.name == joint) {
            let child = self.robot.links.iter().find(|l| l.name == j.child.1);
            let meshes = child.map_or(&[][..], |l| &l.meshes[..]);
            let mut text = format!("{joint} ({}): {} -> {}", j.word, j.parent.1, j.child.1);
            for mesh in meshes {
                text.push_str(&format!("\nmesh of {}: {mesh}", j.child.1));
            }
            if !out.comment.is_empty() {
                out.comment.push('\n');
            }
            out.comment.push_str(&text);
        }
        let length = Vector3::from(origin.xyz).norm();
        let mut name = || Some(unique(&mut out.names, &format!("{joint} origin"), "again"));
        // A millimetre is an offset of the drawing, no link.
        let bends = self.section.filter(|_| length > 1e-3);
        if inverse {
            let back = origin.pose().inverse();
            let vector: [f64; 3] = back.translation.vector.into();
            match (bends, placement(&back)) {
                (Some(section), Some(all)) => {
                    // Translation before rotation, as in every pose.
                    let name = name();
                    out.push(link(section, name, vector), "");
                    let turn = Placement {
                        translation_m: None,
                        ..all
                    };
                    if turn.quaternion_wxyz.is_some() {
                        out.push(rigid(turn, None), "");
                    }
                }
                (None, Some(all)) => {
                    let name = name();
                    out.push(rigid(all, name), "");
                }
                (_, None) => {}
            }
            return;
        }
        let rpy = given(origin.rpy);
        match bends {
            Some(section) => {
                let name = name();
                out.push(link(section, name, origin.xyz), "");
                if rpy.is_some() {
                    let turn = Placement {
                        roll_pitch_yaw_urdf_rad: rpy,
                        ..Placement::default()
                    };
                    out.push(rigid(turn, None), "");
                }
            }
            None if length > 0.0 || rpy.is_some() => {
                let name = name();
                let offset = Placement {
                    translation_m: given(origin.xyz),
                    roll_pitch_yaw_urdf_rad: rpy,
                    ..Placement::default()
                };
                out.push(rigid(offset, name), "");
            }
            None => {}
        }
    }

    /// A constant motion of a joint that stands still.
    fn constant(&self, out: &mut Written, kind: MotionKind, axis: &[f64; 3], amount: f64) {
        if amount != 0.0 {
            let v: [f64; 3] = (Vector3::from(*axis).normalize() * amount).into();
            let placement = match kind {
                MotionKind::Prismatic => Placement {
                    translation_m: Some(v),
                    ..Placement::default()
                },
                MotionKind::Revolute => Placement {
                    rotation_vector_rad: Some(v),
                    ..Placement::default()
                },
            };
            out.push(rigid(placement, None), "");
        }
    }

    fn movement(&self, out: &mut Written, step: &TreeStep) {
        let TreeStep::Move {
            joint,
            kind,
            axis: along,
            follow,
            sign,
        } = step
        else {
            return;
        };
        if let Some(amount) = self.still(follow) {
            self.constant(out, *kind, along, sign * amount);
            return;
        }
        let Some(variable) = follow.variable else {
            return;
        };
        if let Some((name, scale, shift)) = out.defined.get(&variable).cloned() {
            // On the path to a side branch a joint may be passed backward.
            if *joint != name && !out.coupled.contains(joint) {
                out.coupled.push(joint.clone());
            }
            let ratio = follow.ratio / scale;
            self.constant(out, *kind, along, sign * (follow.offset - ratio * shift));
            out.push(
                Element::Coupled(CoupledElement {
                    coupled: name,
                    motion: joint_kind(*kind),
                    axis: axis(along),
                    ratio: sign * ratio,
                    source: None,
                    assumption: None,
                }),
                "",
            );
            return;
        }
        let name = unique(&mut out.names, joint, "joint");
        out.defined
            .insert(variable, (name.clone(), follow.ratio, follow.offset));
        let towards = axis(&along.map(|x| if *sign < 0.0 && x != 0.0 { -x } else { x }));
        let home = follow.offset + follow.ratio * self.home[variable];
        match self.variables[variable].passive {
            true => {
                out.passive.push(name.clone());
                out.push(passive(name, *kind, towards, home), "");
            }
            false => {
                out.actuators.push(name.clone());
                let limits = self.limits(variable, follow);
                let stiffness = self.stiffness(joint, *kind);
                if stiffness.is_none() {
                    out.rigid_drives.push(name.clone());
                }
                let remark = match (stiffness, kind) {
                    (Some(_), _) => "",
                    (None, MotionKind::Revolute) => {
                        "FILL IN: stiffness_n_m_per_rad = ... instead of rigid_drive"
                    }
                    (None, MotionKind::Prismatic) => {
                        "FILL IN: stiffness_n_per_m = ... instead of rigid_drive"
                    }
                };
                out.push(
                    actuator(name, *kind, towards, home, limits, stiffness),
                    remark,
                );
            }
        }
    }

    /// Stiffness of the drive, N m/rad or N/m.
    fn stiffness(&self, joint: &str, kind: MotionKind) -> Option<f64> {
        match self.stiffnesses.get(joint) {
            Some((value, ..)) => Some(*value),
            None => self.for_all.filter(|_| kind == MotionKind::Revolute),
        }
    }

    /// Limits of `ratio * variable + offset`.
    fn limits(&self, variable: usize, follow: &Follow) -> Option<(f64, f64)> {
        self.variables[variable].limits.map(|(low, high)| {
            let of = |x: f64| follow.offset + follow.ratio * x;
            (of(low).min(of(high)), of(low).max(of(high)))
        })
    }

    /// Masses that can be written now: fixed to the frame reached, or moved by joints that are known.
    fn masses(&self, here: usize, out: &mut Written, placed: &mut [bool]) {
        for link in 0..self.robot.links.len() {
            let known = |f: &Follow| {
                self.still(f).is_some() || f.variable.is_some_and(|v| out.defined.contains_key(&v))
            };
            if placed[link] || !self.tree.between(here, link, known) {
                continue;
            }
            placed[link] = true;
            let steps = self.tree.steps(self.robot, here, link);
            let moving = |s: &TreeStep| match s {
                TreeStep::Move { follow, .. } => self.still(follow).is_none(),
                _ => false,
            };
            match steps.iter().rposition(moving) {
                None => {
                    let pose = product(&steps, Pose::identity(), self.home);
                    self.body(out, link, &pose);
                }
                Some(last) => self.excursion(out, link, &steps, last),
            }
        }
    }

    /// Out along the steps to a mass on a side branch, and back.
    fn excursion(&self, out: &mut Written, link: usize, steps: &[TreeStep], last: usize) {
        let name = &self.robot.links[link].name;
        out.comment = format!("side branch: out to {name} and back");
        for mesh in &self.robot.links[link].meshes {
            out.comment.push_str(&format!("\nmesh of {name}: {mesh}"));
        }
        let (out_there, rest) = steps.split_at(last + 1);
        let rigidly = |out: &mut Written, step: &TreeStep| {
            if let Some(placement) = placement(&step.pose(self.home)) {
                out.push(rigid(placement, None), "");
            }
        };
        let go = |out: &mut Written, step: &TreeStep| match step {
            TreeStep::Move { .. } => self.movement(out, step),
            TreeStep::Offset { .. } => rigidly(out, step),
            TreeStep::Arrive(_) => {}
        };
        for step in out_there {
            go(out, step);
        }
        let pose = product(rest, Pose::identity(), self.home);
        if !self.body(out, link, &pose) {
            self.node(out, link, &pose);
        }
        for step in out_there.iter().rev() {
            match step {
                // A constant and a coupled part of one motion commute.
                TreeStep::Move { .. } | TreeStep::Offset { .. } => go(out, &step.reversed()),
                TreeStep::Arrive(_) => {}
            }
        }
    }

    /// A name for the frame of a link without a mass at `pose`: springs and cylinders attach there.
    fn node(&self, out: &mut Written, link: usize, pose: &Pose) {
        let node = unique(&mut out.body_names, &self.robot.links[link].name, "link");
        for element in [
            placement(pose).map(|p| rigid(p, None)),
            Some(Element::Node(NodeElement { node })),
            placement(&pose.inverse()).map(|p| rigid(p, None)),
        ]
        .into_iter()
        .flatten()
        {
            out.push(element, "");
        }
    }

    /// The mass of a link whose frame is at `pose` in the frame reached; false if it has none.
    fn body(&self, out: &mut Written, link: usize, pose: &Pose) -> bool {
        let Some(inertial) = &self.robot.links[link].inertial else {
            return false;
        };
        if inertial.mass == 0.0 {
            return false;
        }
        let whole = pose * inertial.origin.pose();
        let exact = *pose == Pose::identity();
        let centre: [f64; 3] = match exact {
            true => inertial.origin.xyz,
            false => whole.translation.vector.into(),
        };
        let inertia = match exact && inertial.origin.rpy == [0.0; 3] {
            true => inertial.inertia,
            false => {
                let r = whole.rotation.to_rotation_matrix();
                let turned: Matrix3<f64> = r.matrix() * inertial.inertia * r.matrix().transpose();
                (turned + turned.transpose()) * 0.5
            }
        };
        let name = unique(&mut out.body_names, &self.robot.links[link].name, "link");
        out.bodies.push((name.clone(), inertial.mass));
        out.push(
            Element::Body(BodyElement {
                body: name,
                mass_kg: inertial.mass,
                centre_of_mass_m: given(centre),
                inertia_kg_m2: (inertia != Matrix3::zeros())
                    .then(|| [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[(i, j)]))),
                assumption: inertial.left_out.then(|| {
                    "the inertia of the URDF has a moment below zero and is left out".to_owned()
                }),
                ..BodyElement::default()
            }),
            "",
        );
        true
    }
}

fn link(section: &str, name: Option<String>, vector: [f64; 3]) -> Element {
    Element::Link(LinkElement {
        link: section.to_owned(),
        name,
        vector_m: Some(vector),
        ..LinkElement::default()
    })
}

fn passive(name: String, kind: MotionKind, axis: Axis, home: f64) -> Element {
    let home = (home != 0.0).then_some(home);
    let turns = kind == MotionKind::Revolute;
    Element::Passive(PassiveElement {
        passive: match kind {
            MotionKind::Prismatic => PassiveKind::Prismatic,
            MotionKind::Revolute => PassiveKind::Revolute,
        },
        name: Some(name),
        axis: Some(axis),
        axes: None,
        home_mm: None,
        home_m: home.filter(|_| !turns),
        home_deg: None,
        home_rad: home.filter(|_| turns),
        homes_deg: None,
        homes_rad: None,
        damping_n_s_per_m: None,
        // Friction of a URDF is that of a simulation.
        damping_n_m_s_per_rad: None,
        source: None,
        assumption: None,
    })
}

fn actuator(
    name: String,
    kind: MotionKind,
    axis: Axis,
    home: f64,
    limits: Option<(f64, f64)>,
    stiffness: Option<f64>,
) -> Element {
    let home = (home != 0.0).then_some(home);
    let limits = limits.map(|(low, high)| [low, high]);
    let turns = kind == MotionKind::Revolute;
    Element::Actuator(ActuatorElement {
        actuator: match kind {
            MotionKind::Prismatic => ActuatorKind::Prismatic,
            MotionKind::Revolute => ActuatorKind::Revolute,
        },
        lead_mm_per_turn: None,
        lead_m_per_turn: None,
        name: Some(name),
        axis,
        rigid_drive: stiffness.is_none().then_some(true),
        stiffness_n_per_m: stiffness.filter(|_| !turns),
        stiffness_n_per_mm: None,
        stiffness_n_m_per_rad: stiffness.filter(|_| turns),
        stiffness_n_mm_per_rad: None,
        rated_force_n: None,
        rated_torque_n_m: None,
        rotor: None,
        damping_n_s_per_m: None,
        damping_n_m_s_per_rad: None,
        rest_mm: None,
        rest_m: None,
        rest_deg: None,
        rest_rad: None,
        home_mm: None,
        home_m: home.filter(|_| !turns),
        home_deg: None,
        home_rad: home.filter(|_| turns),
        limits_mm: None,
        limits_m: limits.filter(|_| !turns),
        limits_deg: None,
        limits_rad: limits.filter(|_| turns),
        source: None,
        assumption: None,
    })
}
