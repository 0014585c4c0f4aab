//! Parts of a solution for the platforms: its unknowns, the guide of the tool, one step.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Vector6};

use crate::chain::system::Hessian;
use crate::spatial::{Directions, Pose, Twist, Wrench, hat, pose_residual};

/// Division of the unknowns of the platform equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unknowns {
    /// All platforms move; commands are given.
    Pose,
    /// Displacement control: the tool is held and its wrench follows; other platforms move.
    Displacement,
    /// The tool is held in the directions that are `true` and the nominal target moves there
    /// instead: compensation.
    Target(Directions),
    /// The tool is held where [`crate::machine::platforms::solver::PlatformSolver::guide`] says, and the wrenches that hold it there
    /// follow: a part of [`crate::machine::platforms::solver::PlatformSolver::wrench`]. Everything else moves.
    Guided,
}

/// Conditions on the motion of the tool from a pose, and as many wrenches on it.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    /// Reference pose of the motion.
    pub from: Pose,
    /// Conditions `rows * motion = goals`, k x 6, base axes.
    pub rows: DMatrix<f64>,
    /// See `rows`, k.
    pub goals: DVector<f64>,
    /// Columns: wrenches about the tool's origin, base axes, 6 x k.
    pub hands: DMatrix<f64>,
}

impl Guide {
    /// Guide without conditions.
    pub fn none() -> Self {
        Self {
            from: Pose::identity(),
            rows: DMatrix::zeros(0, 6),
            goals: DVector::zeros(0),
            hands: DMatrix::zeros(6, 0),
        }
    }

    /// Residual of the goals at `pose`.
    pub fn residual(&self, pose: &Pose) -> DVector<f64> {
        &self.goals - &self.rows * pose_residual(pose, &self.from).0
    }

    /// Rows by the motion of the tool at `pose`: the logarithm is no sum.
    pub fn rows_at(&self, pose: &Pose) -> DMatrix<f64> {
        let turned = pose_residual(pose, &self.from).angular();
        let angle = turned.norm();
        let mut rows = self.rows.clone();
        if angle > 1e-9 {
            let cross = hat(&turned);
            let share = (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle);
            let by_turn = Matrix3::identity() - cross * 0.5 + cross * cross * share;
            let turns = rows.columns(3, 3) * by_turn;
            rows.columns_mut(3, 3).copy_from(&turns);
        }
        rows
    }
}

/// Tangents of a step.
#[derive(Clone, Copy)]
pub(crate) enum Tangents {
    /// Tangents at the state evaluated last.
    New { hessian: Hessian },
    /// Tangents of the step before.
    Old,
}

/// One Newton step of the platforms.
pub(crate) struct PlatformStep {
    /// Motions of the moving platforms.
    pub motions: Vec<Twist>,
    /// Motion of the nominal target.
    pub target: Twist,
    /// Wrenches that limbs carry rigidly.
    pub carried: Vec<Wrench>,
    /// Change of the force that holds the tool in one direction.
    pub push: Wrench,
}

/// Equilibrium of the tool, `T^T dF + A dt - hands * dh = unbalanced`, over wrench and motion of the tip, with
/// the unknown hands taken out, and the conditions of the guide.
pub(crate) struct EquilibriumRows {
    /// The first rows: combinations of the equilibrium across the hands, (6 - k) x 6.
    pub across: DMatrix<f64>,
    /// Wrench (natural units) and motion in the equilibrium.
    pub wrench: Matrix6<f64>,
    pub motion: Matrix6<f64>,
    /// Factor of every row, so that its largest scaled entry is one.
    pub sizes: Vector6<f64>,
}
