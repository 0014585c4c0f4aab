//! Which loads have a potential, and what it is.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::chain::equilibrium::{ChainProblem, Prescribed};
use crate::error::Result;
use crate::model::chain::{Chain, Element, MotionKind};
use crate::model::kinematics::Kinematics;
use crate::model::loads::check::fits;
use crate::model::loads::load::Load;
use crate::spatial::Wrench;

/// The one axis about which everything before a node turns, in the axes of the chain's base:
/// `Some(None)` if nothing turns, `None` if axes differ. Parallel axes stay parallel.
fn common_axis(chain: &Chain, node: usize) -> Option<Option<Unit<Vector3<f64>>>> {
    let mut rotation = UnitQuaternion::identity();
    let mut common: Option<Unit<Vector3<f64>>> = None;
    for element in chain.elements() {
        match element {
            Element::Rigid(pose) => rotation *= pose.rotation,
            Element::Node(index) if *index == node => break,
            Element::Motion(motion) if motion.kind == MotionKind::Revolute => {
                let axis = rotation * motion.axis;
                match common {
                    Some(first) if first.cross(&axis).norm() > 1e-12 => return None,
                    Some(_) => {}
                    None => common = Some(axis),
                }
            }
            Element::Node(_) | Element::Motion(_) => {}
        }
    }
    Some(common)
}

/// All turns before a node share one axis: dead moments on it have a potential.
pub(crate) fn moments_have_potential(chain: &Chain, node: usize) -> bool {
    common_axis(chain, node).is_some()
}

/// A dead moment has a potential only where all turns share one axis.
fn dead_moment_is_conservative(chain: &Chain, node: usize, moment: &Vector3<f64>) -> bool {
    *moment == Vector3::zeros() || moments_have_potential(chain, node)
}

impl Load {
    /// The load's work on any closed path of this chain is zero: statements about energy hold.
    /// Dead moments are conservative only where everything turns about one axis.
    #[must_use]
    pub fn conservative(&self, chain: &Chain) -> bool {
        match self {
            Self::Dead { node, wrench } => {
                dead_moment_is_conservative(chain, *node, &wrench.moment())
            }
            Self::Gravity(_) => true,
            Self::Custom(load) => load.conservative(),
        }
    }
}

/// The wrench that the end condition prescribes, zero in the directions of prescribed pose.
pub(crate) fn prescribed_wrench(problem: &ChainProblem<'_>) -> Wrench {
    let end = &problem.end;
    let mut own = end.wrench.rotated(&end.axes.inverse());
    for k in 0..6 {
        if end.prescribed[k] == Prescribed::Pose {
            own.0[k] = 0.0;
        }
    }
    own.rotated(&end.axes)
}

/// Whether statements about energy hold for a problem: every load and what its end condition
/// prescribes is conservative.
#[must_use]
pub fn is_conservative(problem: &ChainProblem<'_>) -> bool {
    let (chain, end) = (problem.chain, prescribed_wrench(problem));
    problem.loads.iter().all(|load| load.conservative(chain))
        && dead_moment_is_conservative(chain, chain.tip(), &end.moment())
}

/// Potential energy (J) of all loads at coordinates (m, rad): node loads, and the dead wrench that
/// the end condition prescribes. With the springs' energy it is what an equilibrium makes
/// stationary. The zero is arbitrary but the same for all shapes of a problem. `None` where a load
/// has no potential.
///
/// # Errors
/// Coordinates of the wrong length or not finite, loads that do not fit the chain.
pub fn load_energy(problem: &ChainProblem<'_>, coordinates: &[f64]) -> Result<Option<f64>> {
    let (chain, commands) = (problem.chain, &problem.commands);
    chain.check(coordinates, commands)?;
    let kinematics = Kinematics::new(chain, &problem.base, coordinates, commands, false);
    let dead = |node: usize, wrench: &Wrench| {
        let forces = -wrench.force().dot(&kinematics.node_position(node));
        if wrench.moment() == Vector3::zeros() {
            return Some(forces);
        }
        common_axis(chain, node)?;
        // One axis: angles add, whole turns included.
        let jacobian = kinematics.jacobian(node);
        let turned: f64 = coordinates
            .iter()
            .chain(commands)
            .enumerate()
            .map(|(i, x)| wrench.moment().dot(&jacobian.fixed_view::<3, 1>(3, i)) * x)
            .sum();
        Some(forces - turned)
    };
    let mut sum = dead(chain.tip(), &prescribed_wrench(problem));
    for load in &problem.loads {
        fits(chain, &kinematics, load)?;
        let own = match load {
            Load::Dead { node, wrench } => dead(*node, wrench),
            Load::Gravity(gravity) => Some(
                chain
                    .bodies()
                    .iter()
                    .map(|b| -b.mass * gravity.dot(&kinematics.node_position(b.node)))
                    .sum(),
            ),
            Load::Custom(load) => load.energy(&kinematics),
        };
        sum = sum.zip(own).map(|(a, b)| a + b);
    }
    Ok(sum)
}
