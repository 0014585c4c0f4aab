//! Descends the potential from where the tool is held to where it is stable when released: Newton's steps of the tool
//! with its stiffness made positive, everything else in equilibrium at every step.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::DirectionKind;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::platforms::parts::Guide;
use crate::spatial::{Twist, moved, pose_residual};

/// Steps of one descent.
const STEPS: usize = 120;

/// Longest first step, and steps below which a descent ends, as shares of the machine's size.
const FIRST: f64 = 0.05;
const LAST: f64 = 1e-7;

/// Longest step.
const LONGEST: f64 = 0.2;

impl ToolConditions<'_> {
    /// Equilibrium to which the machine moves from a state in which its tool is held, if it is released; `None` where
    /// its loads have no potential.
    pub(crate) fn descend(&self, start: MechanismEquilibrium) -> Option<MechanismEquilibrium> {
        let size = self.posture.mechanism.size();
        let (mut here, mut reach) = (start, FIRST * size);
        for _ in 0..STEPS {
            here.energy?;
            let motions = self.movable(&here);
            if motions.is_empty() {
                break;
            }
            let residual = self.unbalanced_force(&here, &motions);
            let k = motions.transpose() * self.scaled_stiffness(&here) * &motions;
            let own = ((&k + k.transpose()) * 0.5).symmetric_eigen();
            let most = own.eigenvalues.amax();
            if most == 0.0 || residual.norm() <= 1e-6 * most * size {
                break;
            }
            let mut parts = own.eigenvectors.transpose() * &residual;
            for (part, k) in parts.iter_mut().zip(&own.eigenvalues) {
                *part /= k.abs().max(1e-6 * most);
            }
            let step = -(&own.eigenvectors * parts);
            let whole = step.norm();
            let lower = loop {
                let share = (reach / whole).min(1.0);
                if share * whole < LAST * size {
                    break None;
                }
                let next = self.displaced_beside(&here, &motions, &(&step * share));
                match next.filter(|next| self.gained(&here, next) < 0.0) {
                    Some(next) => break Some(next),
                    None => reach = 0.3 * share * whole,
                }
            };
            let Some(next) = lower else { break };
            (here, reach) = (next, (2.0 * reach).min(LONGEST * size));
        }
        self.rest(here.state, &self.dead)
    }

    /// The machine pushed along a direction in which an equilibrium goes away, in both directions.
    pub(crate) fn pushed_off(&self, e: &MechanismEquilibrium) -> Vec<MechanismEquilibrium> {
        let motions = self.movable(e);
        if motions.is_empty() {
            return Vec::new();
        }
        let k = motions.transpose() * self.scaled_stiffness(e) * &motions;
        let own = ((&k + k.transpose()) * 0.5).symmetric_eigen();
        let modes = own.eigenvalues.iter().zip(own.eigenvectors.column_iter());
        let push = 2e-3 * self.posture.mechanism.size();
        modes
            .filter(|(k, _)| **k < 0.0)
            .flat_map(|(_, motion)| [motion * push, motion * -push])
            .filter_map(|motion| self.displaced_beside(e, &motions, &motion))
            .collect()
    }

    /// The machine with its tool held where a motion leads, step by step; as far as it can go there.
    pub(crate) fn displaced_to_end(
        &self,
        start: MechanismEquilibrium,
        motion: &Vector6<f64>,
    ) -> Option<MechanismEquilibrium> {
        let motion = self.scaled(motion);
        let count = (motion.norm() / (FIRST * self.posture.mechanism.size())).ceil();
        let mut here = start;
        for _ in 0..count as usize {
            let motions = self.movable(&here);
            let step =
                motions.transpose() * DVector::from_column_slice((motion / count).as_slice());
            match self.displaced_beside(&here, &motions, &step) {
                Some(next) => here = next,
                None => break,
            }
        }
        Some(here)
    }

    /// Free motions of the tool (scaled, orthonormal) that the machine can make at a cost.
    fn movable(&self, e: &MechanismEquilibrium) -> DMatrix<f64> {
        let possible = self.possible(e, &self.free);
        self.without(e, &possible, DirectionKind::Free)
    }

    /// Holding force of the tool along motions besides the dead wrench, scaled.
    fn unbalanced_force(&self, e: &MechanismEquilibrium, motions: &DMatrix<f64>) -> DVector<f64> {
        motions.transpose() * self.unscaled(&(e.wrench.0 - self.dead.0))
    }

    /// The machine with its tool moved by parts of some motions (scaled), and held in these alone.
    fn displaced_beside(
        &self,
        here: &MechanismEquilibrium,
        motions: &DMatrix<f64>,
        parts: &DVector<f64>,
    ) -> Option<MechanismEquilibrium> {
        let motion = motions * parts;
        let motion = self.unscaled(&Vector6::from_fn(|i, _| motion[i]));
        let mut state = here.state.clone();
        let tool = self.posture.mechanism.tool();
        state.platforms[tool] = moved(&here.tool, &Twist(motion));
        let columns = motions.column_iter().map(|column| {
            let column = self.scaled(&Vector6::from_fn(|i, _| column[i]));
            DVector::from_column_slice(column.as_slice())
        });
        let columns: Vec<_> = columns.collect();
        let (held, k) = (self.held.ncols(), columns.len());
        let mut hands = DMatrix::zeros(6, held + k);
        hands.columns_mut(0, held).copy_from(&self.held);
        for (j, column) in columns.iter().enumerate() {
            hands.set_column(held + j, column);
        }
        let mut goals = DVector::zeros(held + k);
        goals.rows_mut(held, k).copy_from(parts);
        let guide = Guide {
            from: here.tool,
            rows: hands.transpose(),
            goals,
            hands,
        };
        let (next, _) = self.converge(state, here.wrench, guide, false).ok()?;
        // Rejects another one of the shapes at the same place.
        let went = self.scaled(&pose_residual(&next.tool, &here.tool).0).norm();
        (went <= 3.0 * parts.norm()).then_some(next)
    }

    /// Change of the potential from one state to a neighbour.
    fn gained(&self, from: &MechanismEquilibrium, to: &MechanismEquilibrium) -> f64 {
        match (from.energy, to.energy) {
            (Some(a), Some(b)) => b - a - self.dead.0.dot(&pose_residual(&to.tool, &from.tool).0),
            _ => f64::NAN,
        }
    }
}
