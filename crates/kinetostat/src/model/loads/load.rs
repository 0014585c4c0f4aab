//! Loads on the nodes of a chain [R 4.2, 4.22-4.23].
//!
//! A load answers at given node poses: which wrench acts on which node, how that wrench changes
//! when nodes move (its tangent, which enters `H`), and, where it has one, its potential energy. A
//! dead load has no tangent. What touches two limbs is a platform's business, not a load's.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::model::chain::Chain;
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::loads::follower::{Follower, PointForce};
use crate::model::loads::function::FunctionLoad;
use crate::model::loads::length_law::LengthLaw;
use crate::model::loads::node_load::NodeLoad;
use crate::model::loads::strut::{Anchor, Strut};
use crate::spatial::Wrench;

/// Something that acts on the nodes of a chain. Preloaded joints are no loads: give their springs
/// a rest position (`theta0`).
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

impl PartialEq for Load {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Dead { node, wrench },
                Self::Dead {
                    node: other_node,
                    wrench: other_wrench,
                },
            ) => node == other_node && wrench == other_wrench,
            (Self::Gravity(one), Self::Gravity(other)) => one == other,
            (Self::Custom(one), Self::Custom(other)) => {
                Arc::ptr_eq(one, other) || one.numbers().is_some_and(|n| Some(n) == other.numbers())
            }
            _ => false,
        }
    }
}

impl Load {
    /// A wrench (N, N m; base axes, about the node's origin) that keeps its components while its
    /// node moves. With a moment it has a potential only if all turns share one axis.
    #[must_use]
    pub fn dead(node: usize, wrench: Wrench) -> Self {
        Self::Dead { node, wrench }
    }

    /// Weight of all bodies; gravity in base axes, m/s^2.
    #[must_use]
    pub fn gravity(gravity: Vector3<f64>) -> Self {
        Self::Gravity(gravity)
    }

    /// A wrench (N, N m) with constant components in the axes of its node, about the node's
    /// origin: a follower. Not conservative.
    #[must_use]
    pub fn follower(node: usize, local: Wrench) -> Self {
        Self::custom(Follower { node, local })
    }

    /// A dead force (N, base axes) at a point of a node's frame (m, node's axes): a lever.
    #[must_use]
    pub fn point_force(node: usize, point: Vector3<f64>, force: Vector3<f64>) -> Self {
        Self::custom(PointForce { node, point, force })
    }

    /// A mass (kg) on a lever: at a point of a node's frame (m, node's axes), under gravity (m/s^2,
    /// base axes).
    #[must_use]
    pub fn counterweight(
        node: usize,
        point: Vector3<f64>,
        mass: f64,
        gravity: Vector3<f64>,
    ) -> Self {
        Self::point_force(node, point, gravity * mass)
    }

    /// A compensator between two points: it pulls or pushes along their line as its length says.
    #[must_use]
    pub fn strut(from: Anchor, to: Anchor, law: LengthLaw) -> Self {
        Self::custom(Strut { from, to, law })
    }

    /// A linear spring (N/m) between two points, without force at `free_length` (m).
    #[must_use]
    pub fn spring_between(from: Anchor, to: Anchor, stiffness: f64, free_length: f64) -> Self {
        let law = LengthLaw::Linear {
            stiffness,
            free_length,
            preload: 0.0,
        };
        Self::strut(from, to, law)
    }

    /// A rope with constant tension (N) between two points: a balancer, a weight over a pulley.
    #[must_use]
    pub fn constant_tension(from: Anchor, to: Anchor, tension: f64) -> Self {
        Self::strut(from, to, LengthLaw::Constant { tension })
    }

    /// A load given as a function of node poses.
    #[must_use]
    pub fn function(function: FunctionLoad) -> Self {
        Self::custom(function)
    }

    /// Any other load.
    #[must_use]
    pub fn custom(load: impl NodeLoad + 'static) -> Self {
        Self::Custom(Arc::new(load))
    }

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
