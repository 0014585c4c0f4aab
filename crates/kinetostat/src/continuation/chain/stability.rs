//! Stability of a chain at a state of a curve: while the motion along the parameter is prescribed, and under a dead load.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::equilibrium::{Equilibrium, Solution};
use crate::chain::problem::ChainProblem;
use crate::chain::residual::ResidualNorms;
use crate::chain::stability::{ShapeStability, stability_within, swept_stability_within};
use crate::chain::sweep::solve::EndMotions;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::settings::Parameter;
use crate::continuation::tracing::system::Corrected;
use crate::linalg::complement::complement;
use crate::linalg::saddle::column_space;
use crate::settings::Settings;

/// Stability of an equilibrium as its end is prescribed: free where a wrench is, held where the pose is. `None`
/// where the problem cannot be looked at.
pub(crate) fn stability_as_prescribed(
    problem: &ChainProblem<'_>,
    settings: &Settings,
    found: &Equilibrium,
) -> Option<ShapeStability> {
    let mut system = ChainSystem::new(problem, None, settings).ok()?.by_sweeps();
    let z = system.state(&found.coordinates, &found.wrench, 0.0);
    let (_, norms, matrix) = system.linearised(&z);
    let iterations = found.residual.iterations;
    let state = Corrected {
        z,
        matrix,
        norms,
        iterations,
    };
    Some(system.stability(&state, false))
}

impl ChainSystem<'_, '_> {
    /// Rows (scaled) of the motions that are held: with the parameter's direction held as well,
    /// or left to a dead load.
    fn held_rows(&self, matrix: &CurveMatrix, motion: bool) -> DMatrix<f64> {
        let (r, n) = (self.reactions(), self.coordinates_count());
        let rows = self.range.transpose() * self.scaled_jacobian();
        let gradient = matrix.gradient();
        match self.parameter {
            Some(Parameter::Displacement(_)) if !motion => {
                let direction = DMatrix::from_fn(r, 1, |i, _| gradient[i]);
                complement(&direction).transpose() * rows
            }
            Some(Parameter::Load(_)) if motion => {
                let mut all = DMatrix::zeros(r + 1, n);
                all.rows_mut(0, r).copy_from(&rows);
                for j in 0..n {
                    all[(r, j)] = gradient[r + j];
                }
                all
            }
            _ => rows,
        }
    }

    /// Motions of the end that are held, scaled, 6 x k; `None` where the load that grows acts
    /// elsewhere too and what it does is held.
    fn held_motions(&self, matrix: &CurveMatrix, motion: bool) -> Option<DMatrix<f64>> {
        let r = self.reactions();
        match self.parameter {
            Some(Parameter::Displacement(_)) if !motion => {
                let gradient = matrix.gradient();
                let direction = DMatrix::from_fn(r, 1, |i, _| gradient[i]);
                Some(&self.range * complement(&direction))
            }
            Some(Parameter::Load(pattern)) if motion => {
                let pushed = Vector6::from_fn(|i, _| self.grown[i] / self.scaling[i]);
                let unit = DVector::from_iterator(6, pushed.normalize().iter().copied());
                let mut all = self.range.clone().insert_column(r, 0.0);
                all.set_column(r, &unit);
                pattern.loads.is_empty().then_some(all)
            }
            _ => Some(self.range.clone()),
        }
    }

    /// Stability at a state, which was evaluated last, with the conjugate motion held (`motion`), or
    /// under a dead load.
    pub fn stability(&mut self, c: &Corrected, motion: bool) -> ShapeStability {
        if let Some(sweep) = &self.equations.sweep {
            let swept = self.held_motions(&c.matrix, motion).and_then(|held| {
                let moved = column_space(&self.scaled_jacobian());
                let ends = EndMotions::held_in(moved, &held);
                swept_stability_within(sweep, &self.scaling, &ends)
            });
            // Without a potential the symmetric part, whose inertia sweeps give, is not the whole.
            let single = match swept {
                Some(swept) if self.conservative || swept.stable => return swept,
                // One motion goes away exactly where the determinant is negative (`divergence.rs`).
                one => one.filter(|s| s.unstable_modes == 1 && self.family.is_none()),
            };
            let dense = self.densely(|own| {
                own.evaluate(&c.z);
                match single {
                    Some(mut one) => {
                        one.stable = !own.determinant_is_negative(&c.matrix, motion);
                        one.unstable_modes = usize::from(!one.stable);
                        one
                    }
                    None => own.dense_stability(&c.matrix, motion),
                }
            });
            self.evaluate(&c.z);
            return dense;
        }
        self.dense_stability(&c.matrix, motion)
    }

    /// True if `det V^T (K - H) V` is negative, `V` the free motions: `[0 R; R^T H - K]` with independent rows `R` of
    /// the others has its sign times `(-1)^n`.
    fn determinant_is_negative(&self, matrix: &CurveMatrix, motion: bool) -> bool {
        let rows = self.held_rows(matrix, motion);
        let rows = column_space(&rows).transpose() * rows;
        let (r, n) = rows.shape();
        let mut bordered = DMatrix::zeros(r + n, r + n);
        bordered
            .view_mut((r, 0), (n, r))
            .copy_from(&rows.transpose());
        bordered.view_mut((0, r), (r, n)).copy_from(&rows);
        bordered
            .view_mut((r, r), (n, n))
            .copy_from(&(self.load_hessian() - self.spring_tangent()));
        let factors = bordered.lu();
        // The product itself would leave the range of numbers.
        let turned = factors.u().diagonal().iter().filter(|x| **x < 0.0).count();
        let swapped = usize::from(factors.p().determinant::<f64>() < 0.0);
        (turned + swapped + n) % 2 == 1
    }

    fn dense_stability(&self, matrix: &CurveMatrix, motion: bool) -> ShapeStability {
        let rows = self.held_rows(matrix, motion);
        let rank = column_space(&rows).ncols();
        self.within_family(&rows, rank)
    }

    /// Stability while `rows` (of a rank) are held. The motions of a family are neither stable nor
    /// unstable, whatever rounding says: they are held too, counted as zeros, and named.
    fn within_family(&self, rows: &DMatrix<f64>, rank: usize) -> ShapeStability {
        let held_by = |rows: &DMatrix<f64>| {
            let (chain, conservative) = (self.problem.chain, self.conservative);
            stability_within(chain, &self.equations, &self.scaling, rows, conservative)
        };
        let Some(family) = &self.family else {
            return held_by(rows);
        };
        let (r, n) = (self.reactions(), self.coordinates_count());
        let (first, n_held) = (rows.nrows(), family.motions.ncols());
        let mut held = rows.clone().resize_vertically(first + n_held, 0.0);
        held.rows_mut(first, n_held)
            .copy_from(&family.motions.rows(r, n).transpose());
        let taken = column_space(&held).ncols().saturating_sub(rank);
        let mut stability = held_by(&held);
        // Every motion held adds a positive and a negative eigenvalue in place of its zero.
        let inertia = &mut stability.inertia;
        inertia.positive = inertia.positive.saturating_sub(taken);
        inertia.negative = inertia.negative.saturating_sub(taken);
        inertia.zero += taken;
        if taken > 0 {
            stability.neutral.push("the whole shape".into());
        }
        stability
    }

    /// Everything that is known about a state, which was evaluated last.
    pub fn equilibrium(&mut self, c: &Corrected) -> Equilibrium {
        let raw = ResidualNorms {
            closure: c.norms.closure * self.unit,
            torque: c.norms.torque * self.unit,
            loads: c.norms.loads * self.unit,
            rounding: c.norms.rounding * self.unit,
        };
        let swept = self
            .equations
            .swept_stiffness_and_stability(self.problem.chain, &self.scaling, None)
            .filter(|(_, s)| self.conservative || s.stable);
        if swept.is_none() && self.equations.sweep.is_some() {
            let dense = self.densely(|own| {
                own.evaluate(&c.z);
                own.equilibrium(c)
            });
            self.evaluate(&c.z);
            return dense;
        }
        let mut equilibrium = self.equations.equilibrium(
            self.problem.chain,
            &self.scaling,
            Solution {
                coordinates: self.coordinates(&c.z),
                wrench: self.wrench(&c.z),
                iterations: c.iterations,
                norms: raw,
            },
            self.conservative,
            swept,
        );
        if let Some(family) = &self.family {
            // A family may go on while the whole end is held.
            let rows = self.scaled_jacobian();
            let (r, n) = (self.reactions(), self.coordinates_count());
            if (&rows * family.motions.rows(r, n)).amax() < 1e-6 * rows.amax() {
                let rank = column_space(&rows).ncols();
                equilibrium.stability = self.within_family(&rows, rank);
            }
        }
        equilibrium
    }
}
