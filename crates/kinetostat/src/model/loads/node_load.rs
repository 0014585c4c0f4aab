//! What a load on the nodes of a chain answers at given node poses [R 4.2, 4.22-4.23].

use nalgebra::Vector3;

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::spatial::Wrench;

/// A load that a user brings along: fields, controllers, anything that node poses decide.
pub trait NodeLoad: Send + Sync + std::fmt::Debug {
    /// Appends `(node, wrench)`: base axes, about the node's origin, applied to the chain.
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>);

    /// Appends the derivatives of those wrenches by the motion of nodes. Debug builds compare them
    /// with differences before a chain is solved (see [`check_tangents`](crate::model::check_tangents)).
    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>);

    /// Potential energy (J) at these poses: what the load loses when it does work. `None` where
    /// there is none or nobody knows it.
    fn energy(&self, _kinematics: &Kinematics) -> Option<f64> {
        None
    }

    /// The work on any closed path is zero, so that statements about energy hold. `false` unless
    /// the load knows better.
    fn conservative(&self) -> bool {
        false
    }

    /// Nodes it reads or acts on; a chain without them refuses the load.
    fn nodes(&self) -> Vec<usize> {
        Vec::new()
    }

    /// What is wrong with the load's own numbers, in words.
    fn fault(&self) -> Option<String> {
        None
    }

    /// All its numbers as text: loads with the same text are equal. `None` where numbers do not
    /// tell everything (a function): such a load equals its own clones only.
    fn numbers(&self) -> Option<String> {
        None
    }

    /// The two points between which it acts, base axes, m: for drawings. `None` where there is no
    /// such line.
    fn line(&self, _kinematics: &Kinematics) -> Option<[Vector3<f64>; 2]> {
        None
    }

    /// What is wrong with its answers at these poses, in words.
    fn fault_at(&self, _kinematics: &Kinematics) -> Option<String> {
        None
    }
}
