//! A limb of a mechanism linearised about a state: wrench and coordinates by the residual and by the
//! motions of its ends.
//!
//! Long limbs from the base are solved by sweeps along them, as chains are: cost and memory grow with
//! the number of coordinates and no faster. What a sweep cannot do falls back on dense matrices.

use nalgebra::{DMatrix, Vector6};

use crate::chain::directions::scaled_jacobian;
use crate::chain::equilibrium::System;
use crate::chain::sweep::factor::{END_SPRINGS, STEP_SPRINGS};
use crate::chain::sweep::solve::{Bordered, EndRows, unit_motions_of};
use crate::chain::sweep::stages::Sweep;
use crate::chain::system::Hessian;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{Saddle, column_space, rows_certainly_independent};
use crate::spatial::Twist;

/// Factors of a limb's bordered system.
enum Tangent {
    Dense(Saddle),
    Swept(Box<Bordered<Box<Sweep>>>),
}

/// Conditions at the tip.
enum Tip {
    /// The motions that it can make, orthonormal, scaled.
    Held(DMatrix<f64>),
    /// Six conditions on its motion and its wrench, see [`EndRows`].
    Loaded,
}

/// A limb linearised about a state: scaled system solved for closure, motions of its end, of its
/// commands and of its base.
pub(crate) struct Linear {
    /// (6 + n) x (1 + 6 + r \[+ 6\]): wrench and coordinates; without the columns of the commands
    /// where a sweep was used.
    pub solution: DMatrix<f64>,
    /// Factors of the bordered system, kept while its tangent still serves.
    tangent: Option<(Tangent, Tip)>,
    /// Wrenches on the tip that the limb carries without any motion, 6 x k: the tip cannot move
    /// along them. Empty for a limb that can be strained in every direction.
    pub rigid: DMatrix<f64>,
    /// Rows of the reaction on a moving base before substitution: torque, d/dx, d/dF, d/dbase.
    pub system: System,
    pub closure: Twist,
}

/// Orthonormal basis of the wrenches that a limb carries rigidly, see [`Linear::rigid`].
fn rigid_wrenches(system: &System, scales: &[f64]) -> DMatrix<f64> {
    let jacobian = scaled_jacobian(system, scales);
    if rows_certainly_independent(&jacobian) {
        return DMatrix::zeros(6, 0);
    }
    let mut blocked = complement(&column_space(&jacobian));
    for (mut row, factor) in blocked.row_iter_mut().zip(scales) {
        row *= *factor;
    }
    blocked
}

impl Linear {
    pub fn new(system: System) -> Self {
        Self {
            solution: DMatrix::zeros(0, 0),
            tangent: None,
            rigid: DMatrix::zeros(6, 0),
            system,
            closure: Twist::zero(),
        }
    }

    /// Closure and unbalanced torques as first column.
    fn right_hand_side(&self, b: &mut DMatrix<f64>) {
        for k in 0..6 {
            b[(k, 0)] = self.closure.0[k];
        }
        for row in 0..self.system.spring_torque.len() {
            b[(6 + row, 0)] = -self.system.unbalanced(row);
        }
    }

    /// Linearises with the loads' Hessian or without; `false` where a sweep lost a pivot: then the
    /// system must be made dense and evaluated again.
    pub fn linearise(&mut self, hessian: Hessian, scales: &[f64]) -> bool {
        if let Some(sweep) = &self.system.sweep {
            let form = hessian.form();
            let range = column_space(&scaled_jacobian(&self.system, scales));
            let swept = END_SPRINGS.into_iter().find_map(|spring| {
                let rows = EndRows::held(&range);
                let bordered = Bordered::new(sweep.clone(), form, rows, spring)?;
                let units = unit_motions_of(&bordered, &range)?;
                let own =
                    self.swept_residual(&bordered, &self.free_closure(&range, scales), scales)?;
                Some((bordered, own, units))
            });
            let Some((bordered, own, units)) = swept else {
                return false;
            };
            let mut solution = DMatrix::zeros(scales.len(), 7);
            for (i, factor) in scales.iter().enumerate() {
                solution[(i, 0)] = own[i];
                for k in 0..6 {
                    solution[(i, 1 + k)] = units[(i, k)] * factor * scales[k];
                }
            }
            self.solution = solution;
            self.tangent = Some((Tangent::Swept(Box::new(bordered)), Tip::Held(range)));
        } else {
            self.linearise_densely(hessian, scales);
        }
        self.rigid = rigid_wrenches(&self.system, scales);
        true
    }

    fn linearise_densely(&mut self, hessian: Hessian, scales: &[f64]) {
        let system = &self.system;
        let n = system.spring_torque.len();
        let extra = system.kinematics.velocity_count() - n;
        let mut b = DMatrix::zeros(6 + n, 7 + extra);
        self.right_hand_side(&mut b);
        for k in 0..6 {
            b[(k, 1 + k)] = 1.0;
            for j in 0..extra {
                b[(k, 7 + j)] = -system.jacobian[(k, n + j)];
            }
        }
        if hessian == Hessian::Kept {
            for row in 0..n {
                for j in 0..extra {
                    b[(6 + row, 7 + j)] = -system.hessian[(row, n + j)];
                }
            }
        }
        let saddle = Saddle::new(system.bordered(hessian), scales, scales);
        saddle.solve(&mut b);
        // The whole tip is held.
        let all = DMatrix::identity(6, 6);
        self.tangent = Some((Tangent::Dense(saddle), Tip::Held(all)));
        self.solution = b;
    }

    /// Linearises like [`Self::linearise`], with six conditions (scaled) on the tip: no solution for motions of the
    /// tip, whose stiffness may differ by many orders of magnitude between directions. `right` is the residual of these
    /// conditions.
    pub fn linearise_loaded(
        &mut self,
        hessian: Hessian,
        rows: EndRows,
        right: &Vector6<f64>,
        scales: &[f64],
    ) -> bool {
        let tangent = if let Some(sweep) = &self.system.sweep {
            let form = hessian.form();
            let swept = STEP_SPRINGS.into_iter().find_map(|spring| {
                let bordered = Bordered::new(sweep.clone(), form, rows, spring)?;
                self.swept_residual(&bordered, right, scales)?;
                Some(bordered)
            });
            let Some(bordered) = swept else {
                return false;
            };
            Tangent::Swept(Box::new(bordered))
        } else {
            let mut a = self.system.bordered(hessian);
            let jacobian = scaled_jacobian(&self.system, scales);
            let moved = rows.motion * jacobian;
            for k in 0..6 {
                for j in 0..6 {
                    a[(k, j)] = rows.wrench[(k, j)] / scales[j];
                }
                for j in 0..moved.ncols() {
                    a[(k, 6 + j)] = moved[(k, j)] / scales[6 + j];
                }
            }
            let mut units = scales.to_vec();
            units[..6].fill(1.0);
            Tangent::Dense(Saddle::new(a, &units, scales))
        };
        self.tangent = Some((tangent, Tip::Loaded));
        true
    }

    /// Change of wrench and coordinates that removes the residual, with the right-hand sides of
    /// the conditions at the tip (scaled), 6 + n. `None` if the tangent does not serve.
    pub fn loaded(&self, right: &Vector6<f64>, scales: &[f64]) -> Option<DMatrix<f64>> {
        let (tangent, _) = self.tangent.as_ref()?;
        let own = match tangent {
            Tangent::Swept(bordered) => self.swept_residual(bordered, right, scales)?,
            Tangent::Dense(saddle) => {
                let mut b = DMatrix::zeros(scales.len(), 1);
                self.right_hand_side(&mut b);
                b.rows_mut(0, 6).copy_from(right);
                saddle.solve(&mut b);
                return b.iter().all(|v| v.is_finite()).then_some(b);
            }
        };
        Some(DMatrix::from_column_slice(own.len(), 1, &own))
    }

    /// Residual of the tip's closure in the motions that it can make, scaled.
    fn free_closure(&self, range: &DMatrix<f64>, scales: &[f64]) -> Vector6<f64> {
        let closure = Vector6::from_fn(|k, _| self.closure.0[k] * scales[k]);
        let moved = range.transpose() * closure;
        Vector6::from_fn(|k, _| if k < moved.len() { moved[k] } else { 0.0 })
    }

    /// Wrench and coordinates that remove the residual, by sweeps, 6 + n; `right` of the
    /// conditions at the tip, scaled.
    fn swept_residual(
        &self,
        bordered: &Bordered<Box<Sweep>>,
        right: &Vector6<f64>,
        scales: &[f64],
    ) -> Option<Vec<f64>> {
        let torque: Vec<f64> = (scales[6..].iter().enumerate())
            .map(|(i, factor)| -self.system.unbalanced(i) * factor)
            .collect();
        let (wrench, x) = bordered.solve(&torque, right)?;
        let scaled = wrench.iter().chain(&x).zip(scales);
        Some(scaled.map(|(value, factor)| value * factor).collect())
    }

    /// Wrench and coordinates that remove the residual, by the tangent as it is; `None` if it
    /// cannot.
    pub fn residual(&self, scales: &[f64]) -> Option<DMatrix<f64>> {
        match self.tangent.as_ref()? {
            (Tangent::Swept(bordered), Tip::Held(range)) => {
                let own =
                    self.swept_residual(bordered, &self.free_closure(range, scales), scales)?;
                Some(DMatrix::from_column_slice(own.len(), 1, &own))
            }
            (Tangent::Dense(saddle), Tip::Held(_)) => {
                let mut b = DMatrix::zeros(self.solution.nrows(), 1);
                self.right_hand_side(&mut b);
                saddle.solve(&mut b);
                Some(b)
            }
            (_, Tip::Loaded) => None,
        }
    }
}
