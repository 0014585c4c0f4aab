//! One Newton step of a mechanism: every limb condensed to its tip, the platforms solved, the limbs
//! following.
//!
//! A limb may be unable to move in some directions (a planar chain out of its plane); along them it
//! carries any wrench. Those wrenches are further unknowns of the platforms' equations.

use nalgebra::{DMatrix, DVector, Matrix6};

use crate::chain::system::Hessian;
use crate::linalg::sparse::Sparse;
use crate::machine::platform_system::{PlatformSystem, RigidRows, motion_units};
use crate::machine::platforms::parts::{PlatformStep, Tangents, Unknowns};
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::state::MechanismState;
use crate::model::chain::Scale;
use crate::spatial::{Directions, Twist, Wrench, shift_matrix};

/// Conditions on the motions of the platforms besides their equilibrium.
struct Conditions {
    /// Rows by which their units are chosen.
    sizes: RigidRows,
    /// The rows themselves, with the nominal target in the place of what is held.
    rigid: RigidRows,
    /// Motions on which their wrenches work, one row each.
    reactions: Sparse,
    /// Right-hand side of the rows.
    needed: DVector<f64>,
}

/// True if an unknown of the platforms' motions is one of the tool that the target's motion replaces.
fn is_exchanged(exchanged: Directions, tool: usize, unknown: usize) -> bool {
    (tool..tool + 6).contains(&unknown) && exchanged[unknown - tool]
}

impl PlatformSolver<'_> {
    /// Solves every limb's bordered system for closure, end, command and base motions.
    pub fn linearise(&mut self, hessian: Hessian) {
        for i in 0..self.linear.len() {
            if !self.linear[i].linearise(hessian, &self.scales[i]) {
                self.linear[i].system.make_dense();
                self.evaluate_limb(i);
                self.linear[i].linearise(hessian, &self.scales[i]);
            }
        }
    }

    /// New residuals with the tangents as they are; `false` if one does not serve.
    pub fn renew_residuals(&mut self) -> bool {
        self.linear
            .iter_mut()
            .zip(&self.scales)
            .all(|(linear, scales)| {
                let Some(own) = linear.residual(scales) else {
                    return false;
                };
                linear.solution.column_mut(0).copy_from(&own.column(0));
                true
            })
    }

    /// A Newton step for the residual: of the platforms, and of wrench and coordinates of all limbs.
    /// With new tangents, or with those at a state where the limbs were linearised before; `None` if
    /// there is no step, or the old tangents do not serve.
    pub fn newton(
        &mut self,
        unbalanced: &[Wrench],
        at: &MechanismState,
        tangents: Tangents,
    ) -> Option<(PlatformStep, Vec<DVector<f64>>)> {
        if self.is_one_chain() {
            return self.step_of_chain(unbalanced, tangents);
        }
        match tangents {
            Tangents::New { hessian } => {
                self.linearise(hessian);
                if matches!(self.unknowns, Unknowns::Target(_)) {
                    self.refresh_rates();
                }
            }
            Tangents::Old => {
                if !self.renew_residuals() {
                    return None;
                }
            }
        }
        let step = self.platform_step(unbalanced, at)?;
        let limbs = self.limb_steps(&step, at);
        Some((step, limbs))
    }

    /// `K_i`, 6 x 6, of a linearised limb at its tip.
    fn limb_stiffness(&self, limb: usize) -> Matrix6<f64> {
        self.linear[limb]
            .solution
            .fixed_view::<6, 6>(0, 1)
            .into_owned()
    }

    /// Tangent of the wrench on every moving platform by the motions of all moving platforms,
    /// 6P x 6P, and by the nominal target's motion, 6P x 6; arms and loads as at a state.
    pub fn tangents(&self, at: &MechanismState) -> (Sparse, DMatrix<f64>) {
        let m = self.mechanism;
        let p = m.platforms().len() - 1;
        let mut by_pose = Sparse::zeros(6 * p, 6 * p);
        let mut by_target = DMatrix::zeros(6 * p, 6);
        let add = |matrix: &mut Sparse, row: usize, column: usize, block: &Matrix6<f64>| {
            matrix.add(6 * (row - 1), 6 * (column - 1), block);
        };
        let mut add_target = |row: usize, block: &Matrix6<f64>| {
            let mut view = by_target.view_mut((6 * (row - 1), 0), (6, 6));
            view += block;
        };
        for (i, limb) in m.limbs().iter().enumerate() {
            let arm = self.arm(i, at);
            let t = shift_matrix(&arm);
            let k = self.limb_stiffness(i);
            let own = t.transpose() * k * t + self.turned_force(i, at);
            add(&mut by_pose, limb.to, limb.to, &own);
            let solution = &self.linear[i].solution;
            let r = limb.actual.actuators().len();
            if !self.rates.is_empty() {
                let sensitivity = solution.view((0, 7), (6, r)) * &self.rates[i];
                let block = t.transpose() * sensitivity;
                add_target(limb.to, &block.fixed_view::<6, 6>(0, 0).into_owned());
            }
            if limb.from != 0 {
                let base_columns = solution.view(
                    (0, 7 + r),
                    (6 + self.linear[i].system.spring_torque.len(), 6),
                );
                let by_base: Matrix6<f64> = base_columns.fixed_view::<6, 6>(0, 0).into_owned();
                let on_to = t.transpose() * by_base;
                add(&mut by_pose, limb.to, limb.from, &on_to);
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
                    add_target(limb.from, &block.fixed_view::<6, 6>(0, 0).into_owned());
                }
                let by_base = through(base_columns.as_view()) + direct;
                let by_end = through(solution.view((0, 1), (6 + n, 6)).as_view()) * t;
                let by_base = -by_base.fixed_view::<6, 6>(0, 0);
                let by_end = -by_end.fixed_view::<6, 6>(0, 0);
                add(&mut by_pose, limb.from, limb.from, &by_base);
                add(&mut by_pose, limb.from, limb.to, &by_end);
            }
        }
        self.add_platform_loads(at, |on, by, block| add(&mut by_pose, on, by, block));
        (by_pose, by_target)
    }

    /// Motions that no limb can follow: rows `N^T (motion of the tip)` over the platforms' motions,
    /// and what they must be, k.
    pub fn rigid_rows(&self, at: &MechanismState) -> (RigidRows, DVector<f64>) {
        let m = self.mechanism;
        let mut rows = RigidRows::none(m.platforms().len() - 1);
        let count = self.linear.iter().map(|l| l.rigid.ncols()).sum();
        let mut needed = DVector::zeros(count);
        for (i, limb) in m.limbs().iter().enumerate() {
            let linear = &self.linear[i];
            let k = linear.rigid.ncols();
            if k == 0 {
                continue;
            }
            let row = rows.grow(limb.to - 1, k);
            let normal = linear.rigid.transpose();
            let t = shift_matrix(&self.arm(i, at));
            rows.matrix.add(row, 6 * (limb.to - 1), &(&normal * t));
            if limb.from != 0 {
                let first = linear.system.kinematics.velocity_count() - 6;
                let by_base = &normal * linear.system.jacobian.columns(first, 6);
                rows.matrix.add(row, 6 * (limb.from - 1), &-by_base);
            }
            needed
                .rows_mut(row, k)
                .copy_from(&-(&normal * linear.closure.0));
        }
        (rows, needed)
    }

    /// Motion of the tips, by the nominal target's motion, along directions that they cannot strain: rows as those of
    /// [`Self::rigid_rows`], k x 6.
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

    /// One Newton step, arms and loads as at a state: the present one, or the one where the limbs
    /// were linearised. `unbalanced` is the residual wrench of every platform.
    pub fn platform_step(
        &self,
        unbalanced: &[Wrench],
        at: &MechanismState,
    ) -> Option<PlatformStep> {
        let m = self.mechanism;
        let p = m.platforms().len() - 1;
        if self.unknowns == Unknowns::Displacement && p == 1 {
            return Some(PlatformStep {
                motions: vec![Twist::zero()],
                target: Twist::zero(),
                carried: vec![Wrench::zero(); m.limbs().len()],
                push: Wrench::zero(),
            });
        }
        let (mut a, by_target) = self.tangents(at);
        let mut b = self.condensed_residuals(unbalanced, at);
        let tool = 6 * (m.tool() - 1);
        let exchanged = self.exchanged();
        a.entries
            .retain(|(_, j, _)| !is_exchanged(exchanged, tool, *j));
        for k in (0..6).filter(|&k| exchanged[k]) {
            a.add(0, tool + k, &by_target.column(k));
        }
        if self.damping > 0.0 {
            self.damp(&mut a);
        }
        let mut conditions = self.conditions(at, exchanged);
        if self.unknowns == Unknowns::Displacement {
            self.hold_tool(&mut a, &mut b, &mut conditions);
        }
        let count = conditions.rigid.count();
        b = b.resize(6 * p + count, 1, 0.0);
        b.view_mut((6 * p, 0), (count, 1))
            .copy_from(&conditions.needed);
        let scale = Scale {
            length: self.length,
            stiffness: self.stiffness,
        };
        let Conditions {
            sizes,
            rigid,
            reactions,
            ..
        } = &conditions;
        PlatformSystem::with_reactions(a, sizes, rigid, reactions, scale).solve(&mut b);
        let finite = b.iter().all(|x| x.is_finite());
        finite.then(|| self.step_from(&b, exchanged))
    }

    /// Adds the damping to the tangent of the platforms, and more where that is negative.
    fn damp(&self, tangent: &mut Sparse) {
        let (length, stiffness) = (self.length, self.stiffness);
        let units = motion_units(tangent.rows, Scale { length, stiffness });
        let dense = tangent.dense();
        let scaled = DMatrix::from_fn(tangent.rows, tangent.rows, |i, j| {
            0.5 * (dense[(i, j)] + dense[(j, i)]) * units[i] * units[j]
        });
        let least = scaled.symmetric_eigenvalues().min();
        let damping = self.damping.max(-2.0 * least);
        let own = units
            .iter()
            .enumerate()
            .map(|(i, unit)| (i, i, damping / (unit * unit)));
        tangent.entries.extend(own);
    }

    /// Directions of the tool that are held while the nominal target moves in their place.
    fn exchanged(&self) -> Directions {
        match self.unknowns {
            Unknowns::Target(held) => held,
            _ => Directions::NONE,
        }
    }

    /// Number of conditions of the guide.
    fn guide_rows(&self) -> usize {
        match self.unknowns {
            Unknowns::Guided => self.guide.hands.ncols(),
            _ => 0,
        }
    }

    /// Unbalanced wrenches of the platforms once every limb has closed its own residuals, 6P x 1.
    fn condensed_residuals(&self, unbalanced: &[Wrench], at: &MechanismState) -> DMatrix<f64> {
        let m = self.mechanism;
        let mut b = DMatrix::zeros(6 * (m.platforms().len() - 1), 1);
        for (k, w) in unbalanced.iter().enumerate().skip(1) {
            b.view_mut((6 * (k - 1), 0), (6, 1)).copy_from(&w.0);
        }
        for (i, limb) in m.limbs().iter().enumerate() {
            let solution = &self.linear[i].solution;
            let t = shift_matrix(&self.arm(i, at));
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
        b
    }

    /// Conditions on the platforms' motions by limbs that cannot move and by the guide of the tool.
    fn conditions(&self, at: &MechanismState, exchanged: Directions) -> Conditions {
        let m = self.mechanism;
        let tool = 6 * (m.tool() - 1);
        let root = self.stiffness.sqrt();
        let (mut sizes, mut needed) = self.rigid_rows(at);
        let (first, guided) = (needed.len(), self.guide_rows());
        if guided > 0 {
            let (pose, from) = (&self.state.platforms[m.tool()], &at.platforms[m.tool()]);
            let row = sizes.grow(m.tool() - 1, guided);
            let rows = self.guide.rows_at(from) * root;
            sizes.matrix.add(row, tool, &rows);
            needed = needed.resize_vertically(first + guided, 0.0);
            needed
                .rows_mut(first, guided)
                .copy_from(&(self.guide.residual(pose) * root));
        }
        let (mut rigid, mut reactions) = (sizes.clone(), sizes.matrix.clone());
        reactions.entries.retain(|(i, _, _)| *i < first);
        reactions.add(first, tool, &(self.guide.hands.transpose() * root));
        let replaced = |j: usize| is_exchanged(exchanged, tool, j);
        rigid.matrix.entries.retain(|(_, j, _)| !replaced(*j));
        let by_target = self.rigid_rows_by_target();
        for k in (0..6).filter(|&k| exchanged[k]) {
            rigid.matrix.add(0, tool + k, &by_target.column(k));
        }
        Conditions {
            sizes,
            rigid,
            reactions,
            needed,
        }
    }

    /// The tool stays; the other platforms find their places.
    fn hold_tool(&self, a: &mut Sparse, b: &mut DMatrix<f64>, conditions: &mut Conditions) {
        let tool = 6 * (self.mechanism.tool() - 1);
        let own = tool..tool + 6;
        a.entries
            .retain(|(i, j, _)| !own.contains(i) && !own.contains(j));
        let (rigid, reactions) = (&mut conditions.rigid.matrix, &mut conditions.reactions);
        for entries in [&mut rigid.entries, &mut reactions.entries] {
            entries.retain(|(_, j, _)| !own.contains(j));
        }
        for k in 0..6 {
            let unit = match k < 3 {
                true => 1.0,
                false => self.length * self.length,
            };
            a.entries.push((tool + k, tool + k, self.stiffness * unit));
            b[(tool + k, 0)] = 0.0;
        }
    }

    /// The step that the solution of the platforms' system stands for.
    fn step_from(&self, solution: &DMatrix<f64>, exchanged: Directions) -> PlatformStep {
        let m = self.mechanism;
        let p = m.platforms().len() - 1;
        let mut motions: Vec<Twist> = (0..p)
            .map(|k| Twist(solution.fixed_view::<6, 1>(6 * k, 0).into_owned()))
            .collect();
        let mut target = Twist::zero();
        for k in (0..6).filter(|&k| exchanged[k]) {
            target.0[k] = motions[m.tool() - 1].0[k];
            motions[m.tool() - 1].0[k] = 0.0;
        }
        let mut at = 6 * p;
        let carried = self.linear.iter().map(|linear| {
            let k = linear.rigid.ncols();
            let wrench = &linear.rigid * solution.view((at, 0), (k, 1));
            at += k;
            Wrench(wrench.fixed_view::<6, 1>(0, 0).into_owned())
        });
        let carried = carried.collect();
        // Reactions of the rows, on the right-hand side; what acts is a share of the wrench.
        let root = self.stiffness.sqrt();
        let reactions = solution.view((at, 0), (self.guide_rows(), 1));
        let push = &self.guide.hands * reactions * (-root / self.share);
        PlatformStep {
            motions,
            target,
            carried,
            push: Wrench(push.fixed_view::<6, 1>(0, 0).into_owned()),
        }
    }

    /// Changes of wrench and coordinates of every limb that follow from a platform step.
    pub fn limb_steps(&self, step: &PlatformStep, at: &MechanismState) -> Vec<DVector<f64>> {
        let m = self.mechanism;
        let PlatformStep {
            motions,
            target,
            carried,
            ..
        } = step;
        let motion = |platform: usize| {
            if platform == 0 {
                Twist::zero()
            } else {
                motions[platform - 1]
            }
        };
        m.limbs()
            .iter()
            .enumerate()
            .map(|(i, limb)| {
                let solution = &self.linear[i].solution;
                let rows = solution.nrows();
                let t = shift_matrix(&self.arm(i, at));
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
