//! Problem of one chain's equilibrium: its commands, its loads with their potential, and its end condition.

use crate::error::{Error, Result};
use crate::model::chain::Chain;
use crate::model::kinematics::Kinematics;
use crate::model::limits::check_number;
use crate::model::loads::check::{check_load, common_axis, dead_moment_is_conservative, fits};
use crate::model::loads::load::Load;
use crate::spatial::{Pose, Wrench};
use nalgebra::{Rotation3, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Refuses what cannot be solved: before the iteration starts, and in debug builds with a look at
/// every tangent.
pub(crate) fn check_loads(problem: &ChainProblem<'_>) -> Result<()> {
    let (chain, base) = (problem.chain, &problem.base);
    let place = chain.place();
    let end = &problem.end;
    let of_pose = |pose: &Pose| {
        let (p, r) = (pose.translation.vector, pose.rotation.coords);
        [p.x, p.y, p.z, r.x, r.y, r.z, r.w]
    };
    let checked: [(&str, &[f64]); 4] = [
        ("pose of the base", &of_pose(base)),
        ("pose of the end condition", &of_pose(&end.pose)),
        ("wrench of the end condition", end.wrench.0.as_slice()),
        ("axes of the end condition", end.axes.matrix().as_slice()),
    ];
    for (what, numbers) in checked {
        for &value in numbers {
            check_number(&place, || format!("the {what}"), value)?;
        }
    }
    let (x, commands) = (&problem.posture, &problem.commands);
    let kinematics = Kinematics::new(chain, base, x, commands);
    problem
        .loads
        .iter()
        .try_for_each(|load| check_load(chain, &kinematics, base, x, commands, load))
}

/// Prescribed quantity in one direction of the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Prescribed {
    /// The pose: the wrench follows.
    Pose,
    /// The wrench: the motion follows.
    Wrench,
}

/// Condition at the end of a chain.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
/// # let chain = Chain::builder("bar").link("bar", &bar, length).build()?;
/// // A propped cantilever: its end stands on a prop across, may move along and turn, and carries a moment.
/// let mut end = EndCondition::pose(Pose::translation(length, 0.0, 0.0));
/// for free in [0, 3, 4, 5] {
///     end.prescribed[free] = Prescribed::Wrench;
/// }
/// end.wrench = Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 12.0]); // N m
/// let found = solve_chain(&ChainProblem::new(&chain, end), &Settings::default())?;
/// // The prop answers with 3 M / 2 L, and the end turns by a quarter of M L / E I.
/// assert!((found.wrench.force().y / (-1.5 * 12.0 / length) - 1.0).abs() < 1e-4);
/// let turn = 12.0 * length / (4.0 * 2.1e11 * bar.second_moment_z); // rad
/// assert!((found.tip.rotation.scaled_axis().z / turn - 1.0).abs() < 1e-4);
/// assert!(found.tip.translation.y.abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EndCondition {
    /// Axes of the six directions, base from these axes.
    pub axes: Rotation3<f64>,
    /// Prescribed quantity per direction `x y z rx ry rz` of those axes.
    pub prescribed: [Prescribed; 6],
    /// Target where the pose is prescribed, base from tip.
    pub pose: Pose,
    /// Wrench where it is prescribed: on the end, about its origin, base axes.
    pub wrench: Wrench,
}

impl EndCondition {
    /// The end is held at a pose.
    #[must_use]
    pub fn pose(pose: Pose) -> Self {
        Self {
            axes: Rotation3::identity(),
            prescribed: [Prescribed::Pose; 6],
            pose,
            wrench: Wrench::zero(),
        }
    }

    /// A dead wrench acts on the end.
    #[must_use]
    pub fn wrench(wrench: Wrench) -> Self {
        Self {
            axes: Rotation3::identity(),
            prescribed: [Prescribed::Wrench; 6],
            pose: Pose::identity(),
            wrench,
        }
    }
}

/// Everything that decides the equilibrium of one chain.
#[derive(Clone, Debug)]
pub struct ChainProblem<'a> {
    /// Chain with its springs and masses; what is commanded, what acts and what is prescribed follows.
    pub chain: &'a Chain,
    /// Pose of its base in the outer base.
    pub base: Pose,
    /// Actuator commands, m or rad.
    pub commands: Vec<f64>,
    /// Coordinates of the commanded, unloaded posture (m, rad): start of the iteration and the
    /// place where posture-dependent springs are evaluated.
    pub posture: Vec<f64>,
    /// Loads on nodes.
    pub loads: Vec<Load>,
    /// Prescribed quantity at the end in each of six directions, its motion or its wrench.
    pub end: EndCondition,
}

impl<'a> ChainProblem<'a> {
    /// The chain at home, unloaded, with the given end condition.
    #[must_use]
    pub fn new(chain: &'a Chain, end: EndCondition) -> Self {
        Self {
            chain,
            base: Pose::identity(),
            commands: chain.home_commands(),
            posture: chain.home_coordinates(),
            loads: Vec::new(),
            end,
        }
    }
}

/// Checks lengths, nodes and that all numbers of a problem are finite.
pub(crate) fn check_problem(problem: &ChainProblem<'_>) -> Result<()> {
    let chain = problem.chain;
    chain.check(&problem.posture, &problem.commands)?;
    let numbers = problem
        .end
        .wrench
        .0
        .iter()
        .chain(problem.end.pose.translation.vector.iter());
    if let Some(value) = numbers.copied().find(|v| !v.is_finite()) {
        return Err(Error::NotFinite {
            place: chain.place(),
            what: "the end condition".into(),
            value,
        });
    }
    check_loads(problem)
}

pub(crate) fn check_numbers(
    problem: &ChainProblem<'_>,
    what: &str,
    v: &Vector6<f64>,
) -> Result<()> {
    let place = problem.chain.place();
    let mut numbers = v.iter();
    numbers.try_for_each(|x| check_number(&place, || what.to_owned(), *x))
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
