//! Response of a load on the nodes of a chain at given node poses [R 4.2, 4.22-4.23].

use nalgebra::Vector3;

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::spatial::Wrench;

/// A load that a user brings along: fields, controllers, anything that node poses decide.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat::model::{Kinematics, NodeTangent};
/// use nalgebra::Matrix6;
///
/// /// A magnet on the node pulls it up, the more the higher it is: `f = c z`.
/// #[derive(Debug)]
/// struct Magnet(usize, f64); // N/m
///
/// impl NodeLoad for Magnet {
///     fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
///         let force = vector![0.0, 0.0, self.1 * kinematics.node_pose(self.0).translation.z];
///         out.push((self.0, Wrench::new(force, Vector3::zeros())));
///     }
///     fn tangents(&self, _: &Kinematics, out: &mut Vec<NodeTangent>) {
///         let mut matrix = Matrix6::zeros();
///         matrix[(2, 2)] = self.1;
///         out.push(NodeTangent { on: self.0, by: self.0, matrix });
///     }
/// }
///
/// let slide = Chain::builder("slide")
///     .spring("spring", MotionKind::Prismatic, Vector3::z(), 5e3, 0.0) // N/m
///     .translation(vector![0.1, 0.0, 0.2])
///     .build()?;
/// let mut problem = ChainProblem::new(&slide, EndCondition::wrench(Wrench::zero()));
/// problem.loads.push(Load::custom(Magnet(slide.tip(), 1e3)));
/// let found = solve_chain(&problem, &Settings::default())?;
/// assert!((found.coordinates[0] - 1e3 * 0.2 / (5e3 - 1e3)).abs() < 1e-12); // k x = c (0.2 + x)
/// let stiffness = found.stiffness.cartesian.matrix[(2, 2)];
/// assert!((stiffness - 4e3).abs() < 1e-6, "the magnet takes from the spring");
/// # Ok::<(), Error>(())
/// ```
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

    /// Describes the fault of the load's own numbers.
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

    /// Describes the fault of its response at these poses.
    fn fault_at(&self, _kinematics: &Kinematics) -> Option<String> {
        None
    }
}
