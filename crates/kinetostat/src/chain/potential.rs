//! Potential energy of the loads of a chain and its end condition.

use nalgebra::Vector3;

use crate::chain::problem::{ChainProblem, Prescribed};
use crate::error::Result;
use crate::model::kinematics::Kinematics;
use crate::model::loads::check::{common_axis, dead_moment_is_conservative, fits};
use crate::model::loads::load::Load;
use crate::spatial::Wrench;

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

/// True if statements about energy are valid for a problem: every load and the prescribed end wrench is conservative.
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
    let kinematics = Kinematics::new(chain, &problem.base, coordinates, commands);
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
                    .chain(
                        (chain.segment_masses().iter())
                            .map(|s| s.weight_energy(&kinematics, gravity)),
                    )
                    .sum(),
            ),
            Load::Custom(load) => load.energy(&kinematics),
        };
        sum = sum.zip(own).map(|(a, b)| a + b);
    }
    Ok(sum)
}
