//! Loads on the nodes of a chain [R 4.2, 4.22-4.23].
//!
//! A load answers two questions at given node poses: which wrench acts on which node, and how that
//! wrench changes when nodes move (its tangent). A dead load has no tangent. What touches two limbs
//! is a platform's business, not a load's.

use std::sync::Arc;

use nalgebra::{Matrix6, Vector3};

use crate::chain::Chain;
use crate::kinematics::Kinematics;
use crate::spatial::Wrench;

/// `d(wrench on node "on") = matrix * (twist of node "by")`, base axes, each at its node's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeTangent {
    /// Node on which the wrench acts.
    pub on: usize,
    /// Node whose motion changes it.
    pub by: usize,
    /// 6 x 6 (N/m, N/rad, N m/m, N m/rad).
    pub matrix: Matrix6<f64>,
}

/// A load that a user brings along: follower forces, compensators, fields.
pub trait NodeLoad: Send + Sync + std::fmt::Debug {
    /// Appends `(node, wrench)`: base axes, about the node's origin, applied to the chain.
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>);

    /// Appends the derivatives of those wrenches by the motion of nodes.
    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>);
}

/// Something that acts on the nodes of a chain.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Load {
    /// A wrench that keeps its components in base axes while its node moves.
    Dead {
        /// Node it acts on.
        node: usize,
        /// Base axes, about the node's origin.
        wrench: Wrench,
    },
    /// Weight of all bodies of the chain; the vector is gravity in base axes, m/s^2.
    Gravity(Vector3<f64>),
    /// Anything else.
    Custom(Arc<dyn NodeLoad>),
}

impl Load {
    /// Appends the wrenches, multiplied by `factor`.
    pub(crate) fn add_wrenches(
        &self,
        chain: &Chain,
        kinematics: &Kinematics,
        factor: f64,
        out: &mut Vec<(usize, Wrench)>,
    ) {
        match self {
            Self::Dead { node, wrench } => out.push((*node, *wrench * factor)),
            Self::Gravity(gravity) => out.extend(chain.bodies().iter().map(|body| {
                let weight = Wrench::new(gravity * (body.mass * factor), Vector3::zeros());
                (body.node, weight)
            })),
            Self::Custom(load) => {
                let first = out.len();
                load.wrenches(kinematics, out);
                for (_, wrench) in &mut out[first..] {
                    *wrench = *wrench * factor;
                }
            }
        }
    }

    /// Appends the tangents, multiplied by `factor`.
    pub(crate) fn add_tangents(
        &self,
        kinematics: &Kinematics,
        factor: f64,
        out: &mut Vec<NodeTangent>,
    ) {
        if let Self::Custom(load) = self {
            let first = out.len();
            load.tangents(kinematics, out);
            for tangent in &mut out[first..] {
                tangent.matrix *= factor;
            }
        }
    }
}
