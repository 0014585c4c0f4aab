//! Residual and derivatives of a chain's equilibrium at a state of a curve.

use nalgebra::{DMatrix, DVector};

use crate::chain::equilibrium::{disparate, rounding};
use crate::chain::graded::{MaterialUnits, material_springs};
use crate::chain::residual::ResidualNorms;
use crate::chain::sweep::stages::{ChainMethod, turned_rows};
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::curve_sweep::CurveSweep;
use crate::continuation::linear::tangent::{NullDirections, StateUnits, Whole};
use crate::continuation::settings::Parameter;
use crate::model::chain::Role;
use crate::number::larger;
use crate::spatial::{Twist, Wrench, moved, pose_residual, rotation_rate};

impl ChainSystem<'_, '_> {
    /// Takes the system that serves: dense where a family is followed or where it is wanted.
    pub(super) fn choose(&mut self) {
        let wanted = match self.dense || self.family.is_some() {
            true => ChainMethod::Dense,
            false => ChainMethod::Sweep,
        };
        if self.equations.method() != wanted
            && let Some(other) = &mut self.other
        {
            std::mem::swap(&mut self.equations, other);
        }
    }

    /// Works with dense matrices, whatever the chain; the evaluated system is dense afterwards.
    pub fn densely<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.dense, true);
        let answer = work(self);
        self.dense = before;
        answer
    }

    /// Evaluates the system at a state; returns the residual of equilibrium, scaled, and its measure.
    pub fn evaluate(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms) {
        self.choose();
        let p = self.problem;
        let value = self.value(z);
        let (x, wrench) = (self.coordinates(z), self.wrench(z));
        self.equations.pattern.1 = value;
        self.equations.evaluate_problem(p, &x, &wrench, 1.0);
        let target = match self.parameter {
            Some(Parameter::Displacement(twist)) => moved(&p.end.pose, &Twist(twist.0 * value)),
            _ => p.end.pose,
        };
        let closure_error = pose_residual(&target, &self.equations.kinematics.tip_pose());
        self.turned = closure_error.angular();
        let scaled = DVector::from_fn(6, |i, _| -closure_error.0[i] * self.scaling[i] / self.unit);
        let closure = self.range.transpose() * &scaled;
        let (r, m) = (self.reactions(), self.count());
        let mut loads = 0.0_f64;
        let residual = DVector::from_fn(m, |i, _| {
            if i < r {
                closure[i]
            } else {
                let s = self.scaling[6 + i - r] / self.unit;
                loads = larger(loads, (self.equations.torque[i - r] * s).abs());
                loads = larger(loads, (self.equations.spring_torque[i - r] * s).abs());
                self.equations.unbalanced(i - r) * s
            }
        });
        for i in 0..6 {
            loads = larger(loads, (wrench.0[i] / (self.scaling[i] * self.unit)).abs());
        }
        let norms = ResidualNorms {
            closure: (self.frame.transpose() * &scaled).norm(),
            torque: residual.rows(r, m - r).norm(),
            loads,
            rounding: rounding(p.chain, &self.equations, &self.scaling) / self.unit,
        };
        (residual, norms)
    }

    pub fn converged(&self, b: &ResidualNorms) -> bool {
        b.torque.is_finite()
            && b.closure <= self.settings.closure
            && b.exceeding() <= self.settings.torque * b.loads + 1e-14
    }

    /// Conjugate of the parameter at the state where the system was evaluated.
    pub fn conjugate(&self, z: &DVector<f64>) -> f64 {
        match self.parameter {
            Some(Parameter::Displacement(twist)) => twist.0.dot(&self.wrench(z).0),
            Some(Parameter::Load(pattern)) => {
                let chain = self.problem.chain;
                let mut wrenches = vec![(chain.tip(), Wrench(self.grown))];
                for load in &pattern.loads {
                    load.add_wrenches(chain, &self.equations.kinematics, 1.0, &mut wrenches);
                }
                wrenches
                    .iter()
                    .map(|(node, wrench)| {
                        let here = self.equations.kinematics.node_pose(*node);
                        self.reference
                            .get(*node)
                            .map_or(0.0, |start| pose_residual(&here, start).dot(wrench))
                    })
                    .sum()
            }
            None => 0.0,
        }
    }

    pub(super) fn hessian(&self, i: usize, j: usize) -> f64 {
        self.equations.hessian[(i, j)] * self.scaling[6 + i] * self.scaling[6 + j]
    }

    pub(super) fn scaled_jacobian(&self) -> DMatrix<f64> {
        crate::chain::directions::scaled_jacobian(&self.equations, &self.scaling)
    }

    /// Columns of the passive joints in `[R^T J; H]`, scaled.
    pub(super) fn passive_columns(&self) -> DMatrix<f64> {
        let passive = self.problem.chain.indices_of(Role::Passive);
        let (n, r) = (self.coordinates_count(), self.reactions());
        let rows = self.range.transpose() * self.scaled_jacobian();
        DMatrix::from_fn(r + n, passive.len(), |i, j| {
            if i < r {
                rows[(i, passive[j])]
            } else {
                self.hessian(i - r, passive[j])
            }
        })
    }

    /// Change of the closure with the coordinates, scaled, r x n. Where some rotations are free,
    /// the rotation vector of the residual does not change by the motion alone.
    fn closure_rows(&self) -> DMatrix<f64> {
        let mut jacobian = self.scaled_jacobian();
        let own = rotation_rate(&self.turned);
        let turned = own * jacobian.fixed_rows::<3>(3);
        jacobian.fixed_rows_mut::<3>(3).copy_from(&turned);
        self.range.transpose() * jacobian
    }

    /// Derivative of the conditions by `(a, x)` where the system was evaluated, m x m.
    pub fn matrix(&self) -> DMatrix<f64> {
        self.assembled(true)
    }

    /// Matrix with lagged loads and Jacobians: without the loads' Hessian [R 4.15].
    pub fn lagged_matrix(&self) -> DMatrix<f64> {
        self.assembled(false)
    }

    fn assembled(&self, with_hessian: bool) -> DMatrix<f64> {
        let (n, r) = (self.coordinates_count(), self.reactions());
        let rows = self.reaction_rows();
        let mut a = DMatrix::zeros(r + n, r + n);
        a.view_mut((0, r), (r, n)).copy_from(&self.closure_rows());
        a.view_mut((r, 0), (n, r)).copy_from(&rows.transpose());
        a.view_mut((r, r), (n, n))
            .copy_from(&-self.spring_tangent());
        if with_hessian {
            let mut block = a.view_mut((r, r), (n, n));
            block += self.load_hessian();
        }
        if let Some(v) = self.neutral_motions() {
            let mut block = a.view_mut((r, r), (n, n));
            block -= &v * v.transpose();
        }
        a
    }

    /// Motions of the end that reactions hold, scaled, r x n.
    pub fn reaction_rows(&self) -> DMatrix<f64> {
        self.range.transpose() * self.scaled_jacobian()
    }

    /// Hessian of all loads, scaled, n x n; symmetric only where the loads allow it.
    pub fn load_hessian(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        DMatrix::from_fn(n, n, |i, j| self.hessian(i, j))
    }

    /// Tangent of the springs, scaled, n x n.
    pub fn spring_tangent(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        DMatrix::from_fn(n, n, |i, j| {
            self.equations.spring_tangent[(i, j)] * self.scaling[6 + i] * self.scaling[6 + j]
        })
    }

    /// `H - K`, symmetric part, scaled, n x n.
    pub fn curvature(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        let k = &self.equations.spring_tangent;
        DMatrix::from_fn(n, n, |i, j| {
            let h = 0.5 * (self.hessian(i, j) + self.hessian(j, i));
            h - k[(i, j)] * self.scaling[6 + i] * self.scaling[6 + j]
        })
    }

    /// Orthonormal passive motions that change nothing here, n x neutral.
    pub fn neutral_motions(&self) -> Option<DMatrix<f64>> {
        if self.neutral == 0 {
            return None;
        }
        let columns = self.passive_columns();
        if !columns.iter().all(|v| v.is_finite()) {
            return None;
        }
        let gram = (columns.transpose() * &columns).symmetric_eigen();
        let mut order: Vec<usize> = (0..gram.eigenvalues.len()).collect();
        order.sort_by(|&i, &j| gram.eigenvalues[i].total_cmp(&gram.eigenvalues[j]));
        let passive = self.problem.chain.indices_of(Role::Passive);
        let mut v = DMatrix::zeros(self.coordinates_count(), self.neutral);
        for k in 0..self.neutral {
            for (j, &index) in passive.iter().enumerate() {
                v[(index, k)] = gram.eigenvectors[(j, order[k])];
            }
        }
        Some(v)
    }

    /// Units in which the springs' own stiffness is one at the state that was evaluated last (densely); none
    /// where no spring is very much stiffer than another.
    fn state_units(&self) -> Option<StateUnits> {
        let chain = self.problem.chain;
        disparate(&self.scaling, chain).then(|| StateUnits {
            first: self.reactions(),
            count: self.coordinates_count(),
            material: MaterialUnits::of(chain, &material_springs(&self.equations, &self.scaling)),
        })
    }

    /// Size of a motion of the state that was evaluated last: where some springs are very much stiffer than others
    /// by what the springs store, as stiff coordinates go far without strain.
    pub fn size_of_motion(&self, motion: &DVector<f64>) -> f64 {
        let chain = self.problem.chain;
        if !disparate(&self.scaling, chain) {
            return motion.norm();
        }
        let own = motion.rows(self.reactions(), self.coordinates_count());
        let x: Vec<f64> = own.iter().copied().collect();
        let stored: f64 = if let Some(sweep) = &self.equations.sweep {
            let mut torques = vec![0.0; x.len()];
            sweep.spring_product(&x, &mut torques);
            x.iter().zip(&torques).map(|(x, t)| x * t).sum()
        } else {
            let springs = material_springs(&self.equations, &self.scaling);
            own.dot(&(springs * own))
        };
        let passive = chain.indices_of(Role::Passive).into_iter();
        let passive: f64 = passive.map(|i| x[i] * x[i]).sum();
        let rest = motion.norm_squared() - own.norm_squared();
        (rest.max(0.0) + passive + stored.max(0.0)).sqrt()
    }

    /// `[dG/du dG/dlambda]` at the state that was evaluated last (densely), with its units.
    pub fn whole(&self, matrix: DMatrix<f64>) -> CurveMatrix {
        let units = self.state_units();
        CurveMatrix::Dense(Whole { matrix, units })
    }

    /// Null directions of `[dG/du dG/dlambda]` (more rows or columns may follow) at the state that was evaluated
    /// last (densely).
    pub fn null_directions(&self, matrix: &DMatrix<f64>) -> NullDirections {
        let Some(units) = self.state_units() else {
            return NullDirections::of(matrix);
        };
        let mut found = NullDirections::of(&units.both(matrix.clone()));
        found.map(|vectors| units.directions(vectors));
        found
    }

    /// `[dG/du dG/dlambda]` at a state, with the residual there.
    pub fn linearised(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms, CurveMatrix) {
        let (residual, norms, gradient) = self.gradient(z);
        if let Some(sweep) = &self.equations.sweep {
            let turned = turned_rows(&rotation_rate(&self.turned));
            if let Some(swept) = CurveSweep::new(sweep, &self.range, &turned, gradient) {
                return (residual, norms, CurveMatrix::Swept(Box::new(swept)));
            }
            let (residual, norms, matrix) = self.linearised_densely(z);
            let matrix = self.whole(matrix);
            return (residual, norms, matrix);
        }
        let matrix = self.with_gradient(&gradient);
        let matrix = self.whole(matrix);
        (residual, norms, matrix)
    }

    /// The derivative as a dense matrix, with the residual of equilibrium.
    pub fn linearised_densely(
        &mut self,
        z: &DVector<f64>,
    ) -> (DVector<f64>, ResidualNorms, DMatrix<f64>) {
        let (residual, norms, gradient) = self.densely(|own| own.gradient(z));
        let matrix = self.with_gradient(&gradient);
        (residual, norms, matrix)
    }

    /// `[dG/du dG/dlambda]` where the (dense) system was evaluated.
    fn with_gradient(&self, gradient: &DVector<f64>) -> DMatrix<f64> {
        let m = self.count();
        let mut a = DMatrix::zeros(m, m + 1);
        a.columns_mut(0, m).copy_from(&self.matrix());
        a.column_mut(m).copy_from(gradient);
        a
    }

    /// `dG/dlambda` at a state, with the residual there; evaluates the system.
    pub fn gradient(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms, DVector<f64>) {
        let m = self.count();
        let r = self.reactions();
        let mut gradient = DVector::zeros(m);
        // All conditions are linear in the factor of loads: elsewhere first, here last.
        let step = (1.0 / self.sigma).abs().min(1.0);
        let ahead = match self.parameter {
            Some(Parameter::Load(pattern)) if !pattern.loads.is_empty() => {
                let mut ahead = z.clone();
                ahead[m] += step;
                Some(self.evaluate(&ahead).0)
            }
            _ => None,
        };
        let (residual, norms) = self.evaluate(z);
        match (self.parameter, ahead) {
            (Some(Parameter::Displacement(twist)), _) => {
                // A finite turn about a fixed axis keeps its axis; the end's origin moves straight.
                let turning = rotation_rate(&-self.turned) * twist.angular();
                let rate = Twist::new(twist.linear(), turning).0;
                let part = DVector::from_fn(6, |i, _| {
                    -rate[i] * self.scaling[i] / self.unit * self.sigma
                });
                gradient
                    .rows_mut(0, r)
                    .copy_from(&(self.range.transpose() * part));
            }
            (Some(Parameter::Load(_)), Some(more)) => gradient = (more - &residual) / step,
            (Some(Parameter::Load(_)), None) => {
                for i in 0..m - r {
                    let pushed = self.equations.jacobian.column(i).dot(&self.grown);
                    gradient[r + i] = pushed * self.scaling[6 + i] / self.unit * self.sigma;
                }
            }
            (None, _) => {}
        }
        (residual, norms, gradient)
    }
}
