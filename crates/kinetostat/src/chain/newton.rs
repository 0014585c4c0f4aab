//! Newton's iteration for one chain at one share of its load, under step control.

use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};

use crate::chain::equilibrium::{Equilibrium, Solution};
use crate::chain::problem::{ChainProblem, Prescribed, is_conservative};
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::scaling::{natural, scales_of, step_limit};
use crate::chain::sweep::factor::STEP_SPRINGS;
use crate::chain::sweep::solve::{Bordered, EndRows};
use crate::chain::sweep::stages::{ChainMethod, Sweep, turned_rows};
use crate::chain::system::{Hessian, System, rounding};
use crate::linalg::saddle::Saddle;
use crate::number::larger;
use crate::settings::Settings;
use crate::spatial::{MotionKind, Pose, Twist, Wrench, on_screw, pose_residual, rotation_rate};

/// A factored linearisation of one state.
enum Tangent<'s> {
    Swept(Box<Bordered<&'s Sweep>>),
    Dense(Saddle),
}

/// Path of the end to its prescribed pose; it has no effect at the whole load.
pub(crate) enum EndPath {
    /// The closure at the start shrinks evenly.
    Straight(Twist),
    /// Path on the screw that leads there from a pose.
    Screw(Pose),
}

/// State of the chain iteration.
pub(crate) struct Attempt<'p, 'a> {
    pub problem: &'p ChainProblem<'a>,
    pub settings: &'p Settings,
    scales: Vec<f64>,
    system: System,
    /// Stages that are not needed at the moment.
    spare: Option<Box<Sweep>>,
    /// Path of the end to its prescribed pose while the load grows.
    pub path: EndPath,
    /// Rotation residual of the end (vector, rad).
    turned: Vector3<f64>,
    /// Norms of the last two corrections, scaled, the last one first.
    corrections: [f64; 2],
}

impl<'p, 'a> Attempt<'p, 'a> {
    pub fn new(
        problem: &'p ChainProblem<'a>,
        settings: &'p Settings,
        method: Option<ChainMethod>,
    ) -> Self {
        let chain = problem.chain;
        let scales = scales_of(chain, &problem.posture);
        let (posture, commands) = (&problem.posture, &problem.commands);
        let system = System::of_chain(chain, &problem.base, posture, commands, &scales, method);
        Self {
            problem,
            settings,
            system,
            scales,
            spare: None,
            path: EndPath::Straight(Twist::zero()),
            turned: Vector3::zeros(),
            corrections: [0.0; 2],
        }
    }

    /// The system at a state and a share of the load.
    fn evaluate_system(&mut self, x: &[f64], wrench: &Wrench, share: f64) {
        let p = self.problem;
        for _ in 0..2 {
            self.system.evaluate_problem(p, x, wrench, share);
            if self.system.sweep.as_ref().is_none_or(|s| s.serial) {
                break;
            }
            self.system.make_dense();
        }
    }

    pub fn evaluate(&mut self, x: &[f64], wrench: &Wrench, share: f64) -> (Twist, Wrench) {
        self.evaluate_system(x, wrench, share);
        let p = self.problem;
        let tip = self.system.kinematics.tip_pose();
        let (target, offset) = match &self.path {
            EndPath::Screw(from) if share < 1.0 => {
                (on_screw(from, &p.end.pose, share), Twist::zero())
            }
            EndPath::Screw(_) => (p.end.pose, Twist::zero()),
            EndPath::Straight(offset) => (p.end.pose, Twist(offset.0 * (1.0 - share))),
        };
        let residual = pose_residual(&target, &tip);
        self.turned = residual.angular();
        let closure = Twist(residual.0 - offset.0);
        let wrench_residual = Wrench(p.end.wrench.0 * share - wrench.0);
        (closure, wrench_residual)
    }

    /// Rows of the end condition: the residual of the closure or of the wrench per direction, scaled.
    pub fn end_rows(&self, closure: &Twist, wrench_residual: &Wrench) -> Vector6<f64> {
        let end = &self.problem.end;
        let inverse = end.axes.inverse();
        let (e, f) = (
            closure.rotated(&inverse).0,
            wrench_residual.rotated(&inverse).0,
        );
        Vector6::from_fn(|k, _| match end.prescribed[k] {
            Prescribed::Pose => e[k],
            Prescribed::Wrench => f[k],
        })
    }

    pub fn measure(&self, rows: &Vector6<f64>, wrench: &Wrench) -> ResidualNorms {
        let mut closure = 0.0;
        let (mut torque, mut loads) = self.system.unbalanced_torques(&self.scales);
        for k in 0..6 {
            let (s, pose) = (
                self.scales[k],
                self.problem.end.prescribed[k] == Prescribed::Pose,
            );
            if pose {
                closure += (rows[k] * s).powi(2);
            } else {
                torque += (rows[k] / s).powi(2);
            }
            loads = larger(loads, (wrench.0[k] / s).abs());
        }
        ResidualNorms {
            closure: closure.sqrt(),
            torque: torque.sqrt(),
            loads,
            rounding: rounding(self.problem.chain, &self.system, &self.scales),
        }
    }

    fn converged(&self, b: &ResidualNorms) -> bool {
        let unit = natural(self.problem.chain);
        // Squares of absurdly large numbers are infinite, on either side.
        b.torque.is_finite()
            && b.closure <= self.settings.closure * unit
            && b.exceeding() <= self.settings.torque * b.loads + 1e-16 * unit
    }

    /// Change of the closure (base axes) with the motion of the end. Where all rotations are held
    /// the closure vanishes, and with it what differs from one; where some are free, the rotation
    /// vector of the residual stays large and does not change by the motion alone.
    fn closure_rate(&self) -> Option<Matrix6<f64>> {
        let held = |k: usize| self.problem.end.prescribed[k] == Prescribed::Pose;
        let some = (3..6).any(held) && !(3..6).all(held);
        // Half a turn has no one direction to go.
        let near = self.turned.norm() < 0.9 * std::f64::consts::PI;
        (some && near).then(|| turned_rows(&rotation_rate(&self.turned)))
    }

    /// Rows of the end condition over motion and wrench of the end, base axes.
    fn end_matrices(&self) -> EndRows {
        let end = &self.problem.end;
        let turn = crate::spatial::turn_matrix(&end.axes).transpose();
        let motion = turn * self.closure_rate().unwrap_or_else(Matrix6::identity);
        let mut held = EndRows {
            motion: Matrix6::zeros(),
            wrench: Matrix6::zeros(),
        };
        // Three directions of one kind have one unit, so that turned axes stay scaled.
        for k in 0..6 {
            if end.prescribed[k] == Prescribed::Pose {
                held.motion.set_row(k, &motion.row(k));
            } else {
                held.wrench.set_row(k, &turn.row(k));
            }
        }
        held
    }

    /// Correction by one linearisation of the residual at the state evaluated last: wrench (6) and
    /// coordinates (n). `None` if a sweep lost a pivot.
    fn correction(&self, tangent: &Tangent<'_>, rows: &Vector6<f64>) -> Option<Vec<f64>> {
        let n = self.system.spring_torque.len();
        match tangent {
            Tangent::Swept(bordered) => {
                let right = Vector6::from_fn(|k, _| match self.problem.end.prescribed[k] {
                    Prescribed::Pose => rows[k] * self.scales[k],
                    Prescribed::Wrench => rows[k] / self.scales[k],
                });
                let torque: Vec<f64> = (0..n)
                    .map(|i| -self.system.unbalanced(i) * self.scales[6 + i])
                    .collect();
                let (wrench, x) = bordered.solve(&torque, &right)?;
                let scaled = wrench.iter().chain(&x);
                Some(scaled.zip(&self.scales).map(|(v, f)| v * f).collect())
            }
            Tangent::Dense(saddle) => Some(self.dense_correction(saddle, rows)),
        }
    }

    fn dense_correction(&self, saddle: &Saddle, rows: &Vector6<f64>) -> Vec<f64> {
        let n = self.system.spring_torque.len();
        let mut b = DMatrix::zeros(6 + n, 1);
        for k in 0..6 {
            b[(k, 0)] = rows[k];
        }
        for i in 0..n {
            b[(6 + i, 0)] = -self.system.unbalanced(i);
        }
        saddle.solve(&mut b);
        b.as_slice().to_vec()
    }

    /// The linearisation at `(x, wrench)`, where the system was evaluated, and its correction.
    /// `held` keeps the stages while others are tried.
    fn linearised<'s>(
        &mut self,
        held: Option<&'s Sweep>,
        rows: &Vector6<f64>,
        hessian: Hessian,
        x: &[f64],
        wrench: &Wrench,
        share: f64,
    ) -> (Tangent<'s>, Vec<f64>) {
        if let Some(sweep) = held {
            let form = hessian.form();
            let ends = self.end_matrices();
            // A pivot may be lost by accident far from equilibrium: not with every spring at the end.
            let found = STEP_SPRINGS.into_iter().find_map(|spring| {
                let tangent = Tangent::Swept(Box::new(Bordered::new(sweep, form, ends, spring)?));
                let step = self.correction(&tangent, rows)?;
                Some((tangent, step))
            });
            if let Some(found) = found {
                return found;
            }
            self.system.make_dense();
            self.evaluate_system(x, wrench, share);
        }
        let saddle = self.dense_tangent(hessian);
        let step = self.dense_correction(&saddle, rows);
        (Tangent::Dense(saddle), step)
    }

    fn dense_tangent(&self, hessian: Hessian) -> Saddle {
        let n = self.system.spring_torque.len();
        let end = &self.problem.end;
        let mut a = self.system.bordered(hessian);
        let turn = crate::spatial::turn_matrix(&end.axes);
        let turned = match self.closure_rate() {
            Some(rate) => turn.transpose() * (rate * &self.system.jacobian),
            None => turn.transpose() * &self.system.jacobian,
        };
        let mut row_scale = self.scales.clone();
        for k in 0..6 {
            match end.prescribed[k] {
                Prescribed::Pose => {
                    for j in 0..n {
                        a[(k, 6 + j)] = turned[(k, j)];
                    }
                }
                Prescribed::Wrench => {
                    row_scale[k] = 1.0 / self.scales[k];
                    for j in 0..n {
                        a[(k, 6 + j)] = 0.0;
                    }
                    for j in 0..6 {
                        a[(k, j)] = turn[(j, k)];
                    }
                }
            }
        }
        Saddle::new(a, &row_scale, &self.scales)
    }

    /// Size of the motion in a correction: root of the sum of squares of turns (rad) and slides (in
    /// natural lengths). Forces do not count: they are as stiff as the stiffest spring.
    fn extent(&self, step: impl Iterator<Item = f64>) -> f64 {
        let length = self.problem.chain.scale().length;
        let own = self.problem.chain.coordinates().iter().zip(step.skip(6));
        own.map(|(c, dx)| match c.kind {
            MotionKind::Revolute => dx * dx,
            MotionKind::Prismatic => (dx / length).powi(2),
        })
        .sum::<f64>()
        .sqrt()
    }

    /// Newton from `(x, wrench)` at one share of the load; updates them. Returns iterations and the
    /// last residual, `Err` if it did not converge.
    ///
    /// Steps are assessed by motion, not by residual: after a share `l` of the step `d`, the same
    /// linearisation wants `(1 - l) d` more if it still holds. What it wants otherwise may be at
    /// most `l / 2` of `d` (Deuflhard, Newton Methods for Nonlinear Problems, 3.3: restricted natural
    /// monotonicity). Residuals mislead: a residual of the load is weighed against the chain's natural
    /// stiffness, which grows with the number of segments, what bending changes to second order is
    /// not. So the more segments, the shorter the steps would be.
    pub fn newton(
        &mut self,
        x: &mut [f64],
        wrench: &mut Wrench,
        share: f64,
        mut picard: usize,
    ) -> std::result::Result<(usize, ResidualNorms), (usize, ResidualNorms)> {
        let (mut closure, mut wrench_residual) = self.evaluate(x, wrench, share);
        let mut rows = self.end_rows(&closure, &wrench_residual);
        let mut now = self.measure(&rows, wrench);
        self.corrections = [0.0; 2];
        for iteration in 0..self.settings.iterations {
            if self.converged(&now) && iteration > 0 {
                return Ok((iteration, now));
            }
            // Trials are evaluated elsewhere, for the linearisation refers to this state's stages.
            let other = self.spare.take().or_else(|| self.system.sweep.clone());
            let held = std::mem::replace(&mut self.system.sweep, other);
            let hessian = Hessian::at(iteration, picard);
            let (tangent, step) =
                self.linearised(held.as_deref(), &rows, hessian, x, wrench, share);
            if step.iter().any(|v| !v.is_finite()) {
                return Err((iteration, now));
            }
            let extent = self.extent(step.iter().copied());
            let own = step.iter().zip(&self.scales).skip(6);
            let size = own.map(|(v, f)| (v / f).powi(2)).sum::<f64>().sqrt();
            self.corrections = [size, self.corrections[0]];
            let mut length = step_limit(self.problem.chain, step[6..].iter().copied());
            let merit = now.closure.powi(2) + now.torque.powi(2);
            let (x0, w0) = (x.to_vec(), *wrench);
            loop {
                for (i, value) in x.iter_mut().enumerate() {
                    *value = x0[i] + length * step[6 + i];
                }
                for block in self.problem.chain.springs() {
                    block.follow(&x0, share, x);
                }
                wrench.0 = w0.0 + length * Vector6::from_column_slice(&step[..6]);
                (closure, wrench_residual) = self.evaluate(x, wrench, share);
                rows = self.end_rows(&closure, &wrench_residual);
                now = self.measure(&rows, wrench);
                // The report's own steps are taken as they are, but for the last one, which leads
                // over to Newton.
                if self.converged(&now) || iteration + 1 < picard {
                    break;
                }
                // Near the end both corrections are rounding.
                let better =
                    now.closure.powi(2) + now.torque.powi(2) <= merit * (1.0 - 0.1 * length);
                if better && extent < 1e-6 {
                    break;
                }
                let bent = self
                    .correction(&tangent, &rows)
                    .map_or(f64::INFINITY, |again| {
                        let off = again.iter().zip(&step);
                        self.extent(off.map(|(a, s)| a - (1.0 - length) * s))
                    });
                if bent <= 0.5 * length * extent {
                    break;
                }
                let wanted = 0.5 * length * length * extent / bent;
                length = wanted.max(0.1 * length).min(0.5 * length);
                if length < 1e-3 {
                    if iteration >= picard {
                        return Err((iteration, now));
                    }
                    // Loads lagged lead nowhere from here: Newton at once.
                    picard = 0;
                    x.copy_from_slice(&x0);
                    *wrench = w0;
                    (closure, wrench_residual) = self.evaluate(x, wrench, share);
                    rows = self.end_rows(&closure, &wrench_residual);
                    now = self.measure(&rows, wrench);
                    break;
                }
            }
            self.spare = held;
        }
        if self.converged(&now) {
            Ok((self.settings.iterations, now))
        } else {
            Err((self.settings.iterations, now))
        }
    }
}

impl Attempt<'_, '_> {
    pub fn finish(mut self, solution: Solution, found_by: FoundBy) -> (Equilibrium, ChainMethod) {
        let (x, wrench) = (&solution.coordinates, &solution.wrench);
        self.evaluate_system(x, wrench, 1.0);
        let (chain, scales) = (self.problem.chain, &self.scales);
        let conservative = is_conservative(self.problem);
        let swept = self
            .system
            .swept_stiffness_and_stability(chain, scales, None);
        let (stiffness, stability) = match swept.filter(|(_, s)| conservative || s.stable) {
            Some(found) => found,
            None => {
                if self.system.sweep.is_some() {
                    self.system.make_dense();
                    self.evaluate_system(x, wrench, 1.0);
                }
                self.system
                    .dense_stiffness_and_stability(chain, &self.scales, conservative)
            }
        };
        let mut equilibrium =
            (self.system).described(chain, solution, conservative, stiffness, stability);
        equilibrium.found_by = found_by;
        let [last, before] = self.corrections;
        equilibrium.residual.rate = (before > 0.0).then(|| last / before);
        (equilibrium, self.system.method())
    }
}
