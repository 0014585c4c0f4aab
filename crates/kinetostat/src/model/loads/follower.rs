//! Forces that ride on a node: followers, and dead forces on a lever.

use nalgebra::{Matrix6, Vector3};

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::limits::odd_number;
use crate::model::loads::node_load::NodeLoad;
use crate::spatial::{Pose, Wrench, hat, rotational};

/// A wrench with constant components in its node's axes. Its work depends on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    /// Index of the node in whose axes it is constant.
    pub node: usize,
    /// Force (N) and moment (N m) about the node's origin, node's axes.
    pub local: Wrench,
}

impl Follower {
    fn in_base(&self, pose: &Pose) -> Wrench {
        self.local.rotated(&pose.rotation.to_rotation_matrix())
    }
}

impl NodeLoad for Follower {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        let pose = kinematics.node_pose(self.node);
        out.push((self.node, self.in_base(&pose)));
    }

    /// `d[f; m] = omega x [f; m]`: the wrench turns with its node [R 4.22].
    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        let wrench = self.in_base(&kinematics.node_pose(self.node));
        let mut matrix = Matrix6::zeros();
        matrix
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-hat(&wrench.force()));
        matrix
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&-hat(&wrench.moment()));
        out.push(NodeTangent {
            on: self.node,
            by: self.node,
            matrix,
        });
    }

    fn nodes(&self) -> Vec<usize> {
        vec![self.node]
    }

    fn numbers(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }

    fn fault(&self) -> Option<String> {
        odd_number(self.local.0.iter().map(|x| ("wrench of the follower", x)))
    }
}

/// A dead force at a point of a node's frame: a counterweight, a cable on a crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Index of the node that carries the point.
    pub node: usize,
    /// The point, m, node's axes.
    pub point: Vector3<f64>,
    /// Force on it, N, base axes.
    pub force: Vector3<f64>,
}

impl NodeLoad for PointForce {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        let arm = kinematics.node_pose(self.node).rotation * self.point;
        out.push((self.node, Wrench::new(self.force, arm.cross(&self.force))));
    }

    /// `dm = (omega x r) x f = hat(f) hat(r) omega`, `r` the arm from the node to the point.
    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        let arm = kinematics.node_pose(self.node).rotation * self.point;
        out.push(NodeTangent {
            on: self.node,
            by: self.node,
            matrix: rotational(&(hat(&self.force) * hat(&arm))),
        });
    }

    fn energy(&self, kinematics: &Kinematics) -> Option<f64> {
        let pose = kinematics.node_pose(self.node);
        Some(
            -self
                .force
                .dot(&(pose * nalgebra::Point3::from(self.point)).coords),
        )
    }

    fn conservative(&self) -> bool {
        true
    }

    fn nodes(&self) -> Vec<usize> {
        vec![self.node]
    }

    fn numbers(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }

    fn fault(&self) -> Option<String> {
        let point = self.point.iter().map(|x| ("place of the force", x));
        odd_number(point.chain(self.force.iter().map(|x| ("force", x))))
    }
}
