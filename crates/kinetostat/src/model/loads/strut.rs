//! Compensators: what acts along the line between two points, as the distance of the points says.
//! Springs, gas springs and ropes between two nodes (across joints) or a node and the base.

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::limits::odd_number;
use crate::model::loads::length_law::{LengthLaw, LengthResponse};
use crate::model::loads::node_load::NodeLoad;
use crate::spatial::{Pose, Wrench, hat, rotational, shift_matrix};

/// Attachment of a strut.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let lever = Chain::builder("lever") // a joint about z on a spring, and an arm of 0.4 m
/// #     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
/// #     .translation(vector![0.4, 0.0, 0.0])
/// #     .build()?;
/// let post = Anchor::Base(vector![0.1, 0.5, 0.0]); // m
/// let eye = Anchor::Node { node: lever.tip(), point: vector![-0.1, 0.05, 0.0] }; // beside the end, m
/// assert_eq!(Anchor::node(0), Anchor::Node { node: 0, point: Vector3::zeros() });
/// let mut problem = ChainProblem::new(&lever, EndCondition::wrench(Wrench::zero()));
/// problem.loads.push(Load::constant_tension(post, eye, 200.0)); // N
/// let found = solve_chain(&problem, &Settings::default())?;
/// // Pull along the line between the two points, times its distance from the joint.
/// let at = (found.tip * nalgebra::Point3::new(-0.1, 0.05, 0.0)).coords;
/// let pull = (vector![0.1, 0.5, 0.0] - at).normalize() * 200.0;
/// assert!((500.0 * found.coordinates[0] - at.cross(&pull).z).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    /// A point that does not move, m, base axes.
    Base(Vector3<f64>),
    /// A point of a node's frame.
    Node {
        /// Index of the node.
        node: usize,
        /// The point, m, node's axes.
        point: Vector3<f64>,
    },
}

impl Anchor {
    /// The origin of a node, by its index in the chain.
    #[must_use]
    pub fn node(node: usize) -> Self {
        Self::Node {
            node,
            point: Vector3::zeros(),
        }
    }

    /// A point (m, platform axes) of a platform of a mechanism, by its index; 0 is the base.
    #[must_use]
    pub fn on_platform(platform: usize, point: Vector3<f64>) -> Self {
        match platform {
            0 => Self::Base(point),
            node => Self::Node { node, point },
        }
    }

    /// The node that carries it; `None` for the base.
    pub(crate) fn on(&self) -> Option<usize> {
        match self {
            Self::Base(_) => None,
            Self::Node { node, .. } => Some(*node),
        }
    }

    /// Place in base axes, and arm from the node's origin; `None` for the base.
    fn place(
        &self,
        pose_of: &impl Fn(usize) -> Pose,
    ) -> (Vector3<f64>, Option<(usize, Vector3<f64>)>) {
        match *self {
            Self::Base(point) => (point, None),
            Self::Node { node, point } => {
                let pose = pose_of(node);
                let arm = pose.rotation * point;
                (pose.translation.vector + arm, Some((node, arm)))
            }
        }
    }

    fn point(&self) -> &Vector3<f64> {
        match self {
            Self::Base(point) | Self::Node { point, .. } => point,
        }
    }
}

/// A massless strut between two points with a law of length. Conservative.
#[derive(Clone, Debug)]
pub struct Strut {
    /// Anchor of the first end.
    pub from: Anchor,
    /// Anchor of the second end.
    pub to: Anchor,
    /// Tension (N) by the distance of both ends (m).
    pub law: LengthLaw,
}

/// State of a strut: response, force on its first point (N) and the derivative of that force by
/// the vector from first to second point (N/m).
struct Line {
    response: LengthResponse,
    force: Vector3<f64>,
    tangent: Matrix3<f64>,
}

impl Strut {
    /// `f = T u`, `df/dd = T' u u^T + (T / l)(1 - u u^T)`. Points that coincide have no line: what
    /// the law would pull there has no direction, its slope acts in all.
    fn line(&self, between: &Vector3<f64>) -> Line {
        let length = between.norm();
        let response = self.law.respond(length);
        if length < 1e-12 {
            return Line {
                force: between * response.slope,
                tangent: Matrix3::identity() * response.slope,
                response,
            };
        }
        let u = between / length;
        let (along, across) = (response.slope, response.tension / length);
        Line {
            force: u * response.tension,
            tangent: Matrix3::identity() * across + u * u.transpose() * (along - across),
            response,
        }
    }

    /// Wrenches on the nodes, whose poses are given.
    pub(crate) fn wrenches_at(
        &self,
        pose_of: &impl Fn(usize) -> Pose,
        out: &mut Vec<(usize, Wrench)>,
    ) {
        let (a, from) = self.from.place(pose_of);
        let (b, to) = self.to.place(pose_of);
        let force = self.line(&(b - a)).force;
        for (end, force) in [(from, force), (to, -force)] {
            if let Some((node, arm)) = end {
                out.push((node, Wrench::new(force, arm.cross(&force))));
            }
        }
    }

    /// Tangents, with `S = [1, -hat(r)]` (twist of a node to motion of its anchor) and `M = df/dd`: `S_i^T (+-M) S_j`,
    /// and `hat(f) hat(r)` for the arm that turns under the force.
    pub(crate) fn tangents_at(&self, pose_of: &impl Fn(usize) -> Pose, out: &mut Vec<NodeTangent>) {
        let (a, from) = self.from.place(pose_of);
        let (b, to) = self.to.place(pose_of);
        let line = self.line(&(b - a));
        let mut block = Matrix6::zeros();
        block.fixed_view_mut::<3, 3>(0, 0).copy_from(&line.tangent);
        let ends = [(from, -1.0), (to, 1.0)];
        for (i, (on, sign_on)) in ends.into_iter().enumerate() {
            let Some((on, arm)) = on else { continue };
            for (j, (by, sign_by)) in ends.into_iter().enumerate() {
                let Some((by, other)) = by else { continue };
                let shift = (shift_matrix(&arm), shift_matrix(&other));
                let mut matrix = shift.0.transpose() * block * shift.1 * (-sign_on * sign_by);
                if i == j {
                    matrix += rotational(&(hat(&line.force) * hat(&arm) * -sign_on));
                }
                out.push(NodeTangent { on, by, matrix });
            }
        }
    }

    /// Energy, J.
    pub(crate) fn energy_at(&self, pose_of: &impl Fn(usize) -> Pose) -> f64 {
        let (a, b) = (self.from.place(pose_of).0, self.to.place(pose_of).0);
        self.line(&(b - a)).response.energy
    }
}

impl NodeLoad for Strut {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        self.wrenches_at(&|node| kinematics.node_pose(node), out);
    }

    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        self.tangents_at(&|node| kinematics.node_pose(node), out);
    }

    fn energy(&self, kinematics: &Kinematics) -> Option<f64> {
        Some(self.energy_at(&|node| kinematics.node_pose(node)))
    }

    fn line(&self, kinematics: &Kinematics) -> Option<[Vector3<f64>; 2]> {
        let pose_of = |node| kinematics.node_pose(node);
        Some([self.from.place(&pose_of).0, self.to.place(&pose_of).0])
    }

    fn conservative(&self) -> bool {
        true
    }

    fn nodes(&self) -> Vec<usize> {
        [self.from.on(), self.to.on()]
            .into_iter()
            .flatten()
            .collect()
    }

    fn numbers(&self) -> Option<String> {
        (!matches!(self.law, LengthLaw::Function(_))).then(|| format!("{self:?}"))
    }

    fn fault(&self) -> Option<String> {
        let points = self.from.point().iter().chain(self.to.point().iter());
        odd_number(points.map(|x| ("place of an end of the strut", x))).or_else(|| self.law.fault())
    }
}
