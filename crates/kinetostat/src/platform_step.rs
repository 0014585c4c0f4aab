//! One Newton step of a mechanism: every limb condensed to its tip, the platforms solved, the limbs
//! following.
//!
//! A limb may be unable to move in some directions (a planar chain out of its plane); along them it
//! carries any wrench. Those wrenches are further unknowns of the platforms' equations.

use nalgebra::{DMatrix, DVector, Matrix6};

use crate::equilibrium::System;
use crate::platform::{PlatformSolver, Unknowns};
use crate::saddle::{Saddle, column_space, complement, rows_certainly_independent};
use crate::spatial::{Twist, Wrench, hat, rotational, shift_matrix};
use crate::stiffness::balanced_jacobian;

/// A limb linearised about a state: balanced system solved for closure, motions of its end, of its
/// commands and of its base.
pub(crate) struct Linear {
    /// (6 + n) x (1 + 6 + r \[+ 6\]): wrench and coordinates.
    pub solution: DMatrix<f64>,
    /// Factors of the bordered system, kept while its tangent still serves.
    pub saddle: Option<Saddle>,
    /// Wrenches on the tip that the limb carries without any motion, 6 x k: the tip cannot move
    /// along them. Empty for a limb that can be strained in every direction.
    pub rigid: DMatrix<f64>,
    /// Rows of the reaction on a moving base before substitution: torque, d/dx, d/dF, d/dbase.
    pub system: System,
    pub closure: Twist,
}

impl Linear {
    pub fn new(system: System) -> Self {
        Self {
            solution: DMatrix::zeros(0, 0),
            saddle: None,
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

/// See [`Linear::rigid`].
fn rigid_wrenches(system: &System, factors: &[f64]) -> DMatrix<f64> {
    let jacobian = balanced_jacobian(system, factors);
    if rows_certainly_independent(&jacobian) {
        return DMatrix::zeros(6, 0);
    }
    let mut blocked = complement(&column_space(&jacobian));
    for (mut row, factor) in blocked.row_iter_mut().zip(factors) {
        row *= *factor;
    }
    blocked
}

impl PlatformSolver<'_> {
    /// Solves every limb's bordered system for closure, end, command and base motions.
    pub fn linearise(&mut self, with_hessian: bool) {
        for (linear, factors) in self.linear.iter_mut().zip(&self.factors) {
            let system = &linear.system;
            let n = system.spring_torque.len();
            let extra = system.kinematics.velocity_count() - n;
            let mut b = DMatrix::zeros(6 + n, 7 + extra);
            linear.right_hand_side(&mut b);
            for k in 0..6 {
                b[(k, 1 + k)] = 1.0;
                for j in 0..extra {
                    b[(k, 7 + j)] = -system.jacobian[(k, n + j)];
                }
            }
            if with_hessian {
                for row in 0..n {
                    for j in 0..extra {
                        b[(6 + row, 7 + j)] = -system.hessian[(row, n + j)];
                    }
                }
            }
            let saddle = Saddle::new(system.bordered(with_hessian), factors, factors);
            saddle.solve(&mut b);
            linear.rigid = rigid_wrenches(system, factors);
            linear.saddle = Some(saddle);
            linear.solution = b;
        }
    }

    /// New residuals with the tangent as it is.
    pub fn renew_residuals(&mut self) {
        for linear in &mut self.linear {
            let mut b = DMatrix::zeros(linear.solution.nrows(), 1);
            linear.right_hand_side(&mut b);
            if let Some(saddle) = &linear.saddle {
                saddle.solve(&mut b);
            }
            linear.solution.column_mut(0).copy_from(&b.column(0));
        }
    }

    /// `K_i`, 6 x 6, of a linearised limb at its tip.
    fn limb_stiffness(&self, limb: usize) -> Matrix6<f64> {
        self.linear[limb]
            .solution
            .fixed_view::<6, 6>(0, 1)
            .into_owned()
    }

    /// Tangent of the wrench on every moving platform by the motions of all moving platforms,
    /// 6P x 6P, and by the nominal target's motion, 6P x 6.
    pub fn tangents(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        let mut by_pose = DMatrix::zeros(6 * p, 6 * p);
        let mut by_target = DMatrix::zeros(6 * p, 6);
        let add = |matrix: &mut DMatrix<f64>, row: usize, column: usize, block: &Matrix6<f64>| {
            let mut view = matrix.view_mut((6 * (row - 1), column), (6, 6));
            view += block;
        };
        for (i, limb) in m.limbs.iter().enumerate() {
            let arm = self.arm(i);
            let t = shift_matrix(&arm);
            let k = self.limb_stiffness(i);
            let f = self.state.wrenches[i].force();
            let own = t.transpose() * k * t + rotational(&(hat(&f) * hat(&arm)));
            add(&mut by_pose, limb.to, 6 * (limb.to - 1), &own);
            let solution = &self.linear[i].solution;
            let r = limb.actual.actuators().len();
            if !self.rates.is_empty() {
                let sensitivity = solution.view((0, 7), (6, r)) * &self.rates[i];
                let block = t.transpose() * sensitivity;
                add(
                    &mut by_target,
                    limb.to,
                    0,
                    &block.fixed_view::<6, 6>(0, 0).into_owned(),
                );
            }
            if limb.from != 0 {
                let base_columns = solution.view(
                    (0, 7 + r),
                    (6 + self.linear[i].system.spring_torque.len(), 6),
                );
                let by_base: Matrix6<f64> = base_columns.fixed_view::<6, 6>(0, 0).into_owned();
                let on_to = t.transpose() * by_base;
                add(&mut by_pose, limb.to, 6 * (limb.from - 1), &on_to);
                // Reaction on the base: rows of the extended Hessian and Jacobian.
                let system = &self.linear[i].system;
                let n = system.spring_torque.len();
                let rows = n + r;
                let by_x = system.hessian.view((rows, 0), (6, n));
                let by_f = system.jacobian.columns(rows, 6).transpose();
                let direct = system.hessian.view((rows, rows), (6, 6));
                let through = |columns: nalgebra::DMatrixView<'_, f64>| {
                    by_f.clone() * columns.rows(0, 6) + by_x * columns.rows(6, n)
                };
                if !self.rates.is_empty() && r > 0 {
                    let by_commands = through(solution.view((0, 7), (6 + n, r)).as_view())
                        + system.hessian.view((rows, n), (6, r));
                    let block = -(by_commands * &self.rates[i]);
                    add(
                        &mut by_target,
                        limb.from,
                        0,
                        &block.fixed_view::<6, 6>(0, 0).into_owned(),
                    );
                }
                let by_base = through(base_columns.as_view()) + direct;
                let by_end = through(solution.view((0, 1), (6 + n, 6)).as_view()) * t;
                add(
                    &mut by_pose,
                    limb.from,
                    6 * (limb.from - 1),
                    &-by_base.fixed_view::<6, 6>(0, 0),
                );
                add(
                    &mut by_pose,
                    limb.from,
                    6 * (limb.to - 1),
                    &-by_end.fixed_view::<6, 6>(0, 0),
                );
            }
        }
        // A weight keeps its direction while its lever arm turns.
        for (k, platform) in m.platforms.iter().enumerate().skip(1) {
            let weight = m.gravity * (platform.mass * self.share);
            let arm = self.state.platforms[k].rotation * platform.centre_of_mass;
            let block = -rotational(&(hat(&weight) * hat(&arm)));
            add(&mut by_pose, k, 6 * (k - 1), &block);
        }
        (by_pose, by_target)
    }

    /// Motions that no limb can follow: rows `N^T (motion of the tip)` over the platforms' motions,
    /// k x 6P, and what they must be, k.
    pub fn rigid_rows(&self) -> (DMatrix<f64>, DVector<f64>) {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        let count = self.linear.iter().map(|l| l.rigid.ncols()).sum();
        let (mut rows, mut needed) = (DMatrix::zeros(count, 6 * p), DVector::zeros(count));
        let mut at = 0;
        for (i, limb) in m.limbs.iter().enumerate() {
            let linear = &self.linear[i];
            let k = linear.rigid.ncols();
            if k == 0 {
                continue;
            }
            let normal = linear.rigid.transpose();
            let t = shift_matrix(&self.arm(i));
            rows.view_mut((at, 6 * (limb.to - 1)), (k, 6))
                .copy_from(&(&normal * t));
            if limb.from != 0 {
                let first = linear.system.kinematics.velocity_count() - 6;
                let by_base = &normal * linear.system.jacobian.columns(first, 6);
                rows.view_mut((at, 6 * (limb.from - 1)), (k, 6))
                    .copy_from(&-by_base);
            }
            needed
                .rows_mut(at, k)
                .copy_from(&-(&normal * linear.closure.0));
            at += k;
        }
        (rows, needed)
    }

    /// How far the nominal target's motion brings the tips along what they cannot strain: rows as
    /// those of [`Self::rigid_rows`], k x 6.
    fn rigid_rows_by_target(&self) -> DMatrix<f64> {
        let count = self.linear.iter().map(|l| l.rigid.ncols()).sum();
        let mut rows = DMatrix::zeros(count, 6);
        if self.rates.is_empty() {
            return rows;
        }
        let mut at = 0;
        for (linear, rates) in self.linear.iter().zip(&self.rates) {
            let k = linear.rigid.ncols();
            let n = linear.system.spring_torque.len();
            let by_commands = linear.system.jacobian.columns(n, rates.nrows());
            rows.rows_mut(at, k)
                .copy_from(&-(linear.rigid.transpose() * by_commands * rates));
            at += k;
        }
        rows
    }

    /// One Newton step.
    pub fn platform_step(&self, lack: &[Wrench]) -> Option<PlatformStep> {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        if self.unknowns == Unknowns::Held && p == 1 {
            return Some(PlatformStep {
                motions: vec![Twist::zero()],
                target: Twist::zero(),
                carried: vec![Wrench::zero(); m.limbs.len()],
                push: Wrench::zero(),
            });
        }
        let (mut a, by_target) = self.tangents();
        let mut b = DMatrix::zeros(6 * p, 1);
        for (k, w) in lack.iter().enumerate().skip(1) {
            b.view_mut((6 * (k - 1), 0), (6, 1)).copy_from(&w.0);
        }
        for (i, limb) in m.limbs.iter().enumerate() {
            let solution = &self.linear[i].solution;
            let t = shift_matrix(&self.arm(i));
            let change = t.transpose() * solution.fixed_view::<6, 1>(0, 0);
            let mut rows = b.view_mut((6 * (limb.to - 1), 0), (6, 1));
            rows -= change;
            if limb.from != 0 {
                let system = &self.linear[i].system;
                let n = system.spring_torque.len();
                let first = n + limb.actual.actuators().len();
                let reaction = system.jacobian.columns(first, 6).transpose()
                    * solution.view((0, 0), (6, 1))
                    + system.hessian.view((first, 0), (6, n)) * solution.view((6, 0), (n, 1));
                let mut rows = b.view_mut((6 * (limb.from - 1), 0), (6, 1));
                rows += reaction;
            }
        }
        let tool = 6 * (m.tool - 1);
        let held = match self.unknowns {
            Unknowns::Target(held) => held,
            _ => [false; 6],
        };
        for k in (0..6).filter(|&k| held[k]) {
            a.column_mut(tool + k).copy_from(&by_target.column(k));
        }
        if self.unknowns == Unknowns::Held {
            // The tool stays; the other platforms find their places.
            for k in 0..6 {
                let unit = if k < 3 {
                    1.0
                } else {
                    self.length * self.length
                };
                a.column_mut(tool + k).fill(0.0);
                a.row_mut(tool + k).fill(0.0);
                a[(tool + k, tool + k)] = self.stiffness * unit;
                b[(tool + k, 0)] = 0.0;
            }
        }
        let root = self.stiffness.sqrt();
        let mut scale: Vec<f64> = (0..6 * p)
            .map(|i| {
                if i % 6 < 3 {
                    1.0 / root
                } else {
                    1.0 / (root * self.length)
                }
            })
            .collect();
        let (mut rigid, mut needed) = self.rigid_rows();
        if let Unknowns::Along(direction) = self.unknowns {
            let row = rigid.nrows();
            rigid = rigid.insert_row(row, 0.0);
            for k in 0..3 {
                rigid[(row, tool + k)] = direction[k] * root;
            }
            needed = needed.push(0.0);
        }
        let count = rigid.nrows();
        if count > 0 {
            // Constraints of the size of the stiffest direction, so that none is lost in rounding.
            let stiffest = (0..6 * p)
                .map(|i| a[(i, i)].abs() * scale[i] * scale[i])
                .fold(1.0, f64::max);
            let units = scale.clone();
            for row in rigid.row_iter() {
                let size = row.iter().zip(&units).map(|(x, s)| (x * s).powi(2));
                let size = size.sum::<f64>().sqrt();
                scale.push(if size > 0.0 { stiffest / size } else { 1.0 });
            }
            let mut reactions = rigid.transpose();
            let by_target = self.rigid_rows_by_target();
            for k in 0..6 {
                // What is held does not move: its unknown is another, or it asks for nothing.
                if held[k] {
                    let mut column = rigid.column_mut(tool + k);
                    column
                        .rows_mut(0, by_target.nrows())
                        .copy_from(&by_target.column(k));
                } else if self.unknowns == Unknowns::Held {
                    rigid.column_mut(tool + k).fill(0.0);
                    reactions.row_mut(tool + k).fill(0.0);
                }
            }
            a = a.resize(6 * p + count, 6 * p + count, 0.0);
            a.view_mut((6 * p, 0), (count, 6 * p)).copy_from(&rigid);
            a.view_mut((0, 6 * p), (6 * p, count)).copy_from(&reactions);
            b = b.resize(6 * p + count, 1, 0.0);
            b.view_mut((6 * p, 0), (count, 1)).copy_from(&needed);
        }
        Saddle::new(a, &scale, &scale).solve(&mut b);
        if b.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let mut motions: Vec<Twist> = (0..p)
            .map(|k| Twist(b.fixed_view::<6, 1>(6 * k, 0).into_owned()))
            .collect();
        let mut target = Twist::zero();
        for k in (0..6).filter(|&k| held[k]) {
            target.0[k] = motions[m.tool - 1].0[k];
            motions[m.tool - 1].0[k] = 0.0;
        }
        let mut at = 6 * p;
        let carried = self
            .linear
            .iter()
            .map(|linear| {
                let k = linear.rigid.ncols();
                let wrench = &linear.rigid * b.view((at, 0), (k, 1));
                at += k;
                Wrench(wrench.fixed_view::<6, 1>(0, 0).into_owned())
            })
            .collect();
        let push = match self.unknowns {
            // The reaction of the row, on the right-hand side.
            Unknowns::Along(direction) => {
                Wrench::new(direction * (-b[(at, 0)] * root), nalgebra::Vector3::zeros())
            }
            _ => Wrench::zero(),
        };
        Some(PlatformStep {
            motions,
            target,
            carried,
            push,
        })
    }

    /// Changes of wrench and coordinates of every limb that follow from a platform step.
    pub fn limb_steps(
        &self,
        motions: &[Twist],
        target: &Twist,
        carried: &[Wrench],
    ) -> Vec<DVector<f64>> {
        let m = self.mechanism;
        let motion = |platform: usize| {
            if platform == 0 {
                Twist::zero()
            } else {
                motions[platform - 1]
            }
        };
        m.limbs
            .iter()
            .enumerate()
            .map(|(i, limb)| {
                let solution = &self.linear[i].solution;
                let rows = solution.nrows();
                let t = shift_matrix(&self.arm(i));
                let end = t * motion(limb.to).0;
                let mut step = solution.column(0) + solution.view((0, 1), (rows, 6)) * end;
                let mut wrench = step.rows_mut(0, 6);
                wrench += carried[i].0;
                let r = limb.actual.actuators().len();
                if !self.rates.is_empty() && r > 0 {
                    let commands = &self.rates[i] * target.0;
                    step += solution.view((0, 7), (rows, r)) * commands;
                }
                if limb.from != 0 {
                    step += solution.view((0, 7 + r), (rows, 6)) * motion(limb.from).0;
                }
                step
            })
            .collect()
    }
}
