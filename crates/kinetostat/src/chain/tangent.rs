//! The tangents of a chain at a state, for dynamics and other linear analyses: as dense matrices with all coordinates kept
//! (`ChainTangent`), or piece by piece (`ChainPieces`), with cost and memory that grow with the number of coordinates and no faster.

use nalgebra::{DMatrix, Matrix6};

use crate::chain::problem::{ChainProblem, check_problem};
use crate::chain::system::System;
use crate::error::Result;
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::spatial::Wrench;

/// Tangents of one chain at one state, dense.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ChainTangent {
    /// Frames of the chain, with six motions of its base where that moves.
    pub kinematics: Kinematics,
    /// Second derivative of the springs' energy, n x n: material and geometric (links that bow).
    pub springs: DMatrix<f64>,
    /// The geometric part of it by blocks of six coordinates: first coordinate, matrix.
    pub geometric: Vec<(usize, Matrix6<f64>)>,
    /// Derivative of the torques of all loads, the wrench on the end included, by all generalised velocities
    /// ([`Kinematics`]): `H` [R 4.21]. The tangent is `springs - loads`.
    pub loads: DMatrix<f64>,
    /// Torque of the loads less that of the springs, n (N, N m): zero in equilibrium.
    pub unbalanced: Vec<f64>,
}

impl ChainTangent {
    /// Takes the tangent from an evaluated dense system.
    pub(crate) fn of(system: System) -> Self {
        let n = system.spring_torque.len();
        Self {
            unbalanced: (0..n).map(|i| system.unbalanced(i)).collect(),
            kinematics: system.kinematics,
            springs: system.spring_tangent,
            geometric: system.spring_geometric,
            loads: system.hessian,
        }
    }

    /// Evaluates a chain at coordinates (m, rad) under a wrench on its end; nothing is solved. The end condition of the
    /// problem is ignored.
    ///
    /// # Errors
    /// Those of [`crate::solve_chain`] for wrong input.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat::chain::ChainTangent;
    ///
    /// let lever = Chain::builder("lever")
    ///     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    ///     .translation(vector![0.4, 0.0, 0.0])
    ///     .build()?;
    /// let pull = Wrench::new(vector![300.0, 0.0, 0.0], Vector3::zeros()); // N, along the lever
    /// let problem = ChainProblem::new(&lever, EndCondition::wrench(pull));
    /// let tangent = ChainTangent::at(&problem, &[0.0], &pull)?;
    /// // A pull holds the lever as a weight holds a pendulum.
    /// assert!((tangent.springs[(0, 0)] - tangent.loads[(0, 0)] - (500.0 + 300.0 * 0.4)).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn at(problem: &ChainProblem<'_>, coordinates: &[f64], wrench: &Wrench) -> Result<Self> {
        check_problem(problem)?;
        let (chain, commands) = (problem.chain, &problem.commands);
        chain.check(coordinates, commands)?;
        let mut system = System::new(chain, &problem.base, &problem.posture, commands, false);
        system.evaluate_problem(problem, coordinates, wrench, 1.0);
        Ok(Self::of(system))
    }
}

/// Springs and loads of one chain at one state, each by itself.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ChainPieces {
    /// Frames of the chain, its base at rest.
    pub kinematics: Kinematics,
    /// Second derivative of the energy of every spring, in the chain's order, by its own coordinates: material and
    /// geometric (links that bow).
    pub springs: Vec<DMatrix<f64>>,
    /// The geometric part of it: first coordinate, matrix.
    pub geometric: Vec<(usize, Matrix6<f64>)>,
    /// Wrenches of all loads on nodes, that on the end included: node, wrench about it, base axes.
    pub wrenches: Vec<(usize, Wrench)>,
    /// Derivatives of these by motions of nodes, where they change.
    pub tangents: Vec<NodeTangent>,
}

impl ChainPieces {
    /// Evaluates a chain at coordinates (m, rad) under a wrench on its end; nothing is solved. The end condition of the
    /// problem is ignored.
    ///
    /// # Errors
    /// Those of [`crate::solve_chain`] for wrong input.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat::chain::ChainPieces;
    ///
    /// let lever = Chain::builder("lever")
    ///     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    ///     .translation(vector![0.4, 0.0, 0.0])
    ///     .build()?;
    /// let pull = Wrench::new(vector![300.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let problem = ChainProblem::new(&lever, EndCondition::wrench(pull));
    /// let pieces = ChainPieces::at(&problem, &[0.0], &pull)?;
    /// assert_eq!(pieces.springs[0][(0, 0)], 500.0);
    /// assert_eq!(pieces.wrenches, [(lever.tip(), pull)]);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn at(problem: &ChainProblem<'_>, coordinates: &[f64], wrench: &Wrench) -> Result<Self> {
        check_problem(problem)?;
        let (chain, commands) = (problem.chain, &problem.commands);
        chain.check(coordinates, commands)?;
        let kinematics = Kinematics::new(chain, &problem.base, coordinates, commands);
        let (mut wrenches, mut tangents) = (Vec::new(), Vec::new());
        for load in &problem.loads {
            load.add_wrenches(chain, &kinematics, 1.0, &mut wrenches);
            load.add_tangents(chain, &kinematics, 1.0, &mut tangents);
        }
        wrenches.push((chain.tip(), *wrench));
        let mut torque = vec![0.0; chain.coordinate_count()];
        let mut geometric = Vec::new();
        let springs = chain.springs().iter().map(|block| {
            let mut own = DMatrix::zeros(block.len(), block.len());
            let mut entry = |i: usize, j: usize, value: f64| own[(i, j)] += value;
            let posture = &problem.posture;
            block.add(
                coordinates,
                posture,
                1.0,
                &mut torque,
                &mut entry,
                &mut geometric,
            );
            own
        });
        let springs = springs.collect();
        Ok(Self {
            kinematics,
            springs,
            geometric,
            wrenches,
            tangents,
        })
    }
}
