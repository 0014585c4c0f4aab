//! Matrices and residuals of a chain at one state, dense or in stages, and the units in which they
//! are scaled.

use nalgebra::{DMatrix, Matrix6, Matrix6xX};

use crate::chain::problem::ChainProblem;
use crate::chain::scaling::disparate;
use crate::chain::sweep::stages::{ChainMethod, Form, SWEEP_FROM, Sweep};
use crate::model::chain::Chain;
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::loads::load::Load;
use crate::number::larger;
use crate::spatial::{Pose, Wrench};

/// Treatment of the loads' Hessian in a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hessian {
    /// Newton's matrix.
    Kept,
    /// Matrix of the report's iteration [R 4.15].
    LeftOut,
}

impl Hessian {
    /// Kept from the iteration on that comes after `picard` without it.
    pub(crate) fn at(iteration: usize, picard: usize) -> Self {
        match iteration < picard {
            true => Self::LeftOut,
            false => Self::Kept,
        }
    }

    /// Form of the tangent in a sweep.
    pub(crate) fn form(self) -> Form {
        match self {
            Self::Kept => Form::Exact,
            Self::LeftOut => Form::Lagged,
        }
    }
}

/// Matrices and residuals of a chain at one state; buffers are reused between iterations.
pub struct System {
    /// Poses and motions of the joints.
    pub kinematics: Kinematics,
    /// 6 x (n + r \[+ 6\]) at the tip.
    pub jacobian: Matrix6xX<f64>,
    /// Generalised torque of all loads, the end wrench included.
    pub torque: Vec<f64>,
    /// Derivative of the torque.
    pub hessian: DMatrix<f64>,
    /// Gradient of the springs' energy, n.
    pub spring_torque: Vec<f64>,
    /// Derivative of the springs' torque, n x n.
    pub spring_tangent: DMatrix<f64>,
    /// Sum of the magnitudes of what the coordinates contribute to the gradient by its derivative, n: its rounding
    /// is a few units of the last place of these.
    pub spring_turnover: Vec<f64>,
    /// Change of the tangent since rest, per block of six coordinates: first coordinate, matrix.
    pub spring_geometric: Vec<(usize, Matrix6<f64>)>,
    /// Energy of the springs and loads, J.
    pub energy: f64,
    /// Loads that grow along a curve, on top of those given to [`Self::evaluate`], and their factor.
    pub pattern: (Vec<Load>, f64),
    /// Stages of a long chain. Where they are, the torque, the Hessian and the springs' tangent of
    /// all velocities are theirs: `hessian` and `spring_tangent` are empty.
    pub sweep: Option<Box<Sweep>>,
    wrenches: Vec<(usize, Wrench)>,
    tangents: Vec<NodeTangent>,
}

impl System {
    /// Dense, at the commanded posture.
    pub fn new(
        chain: &Chain,
        base: &Pose,
        posture: &[f64],
        commands: &[f64],
        base_moves: bool,
    ) -> Self {
        let kinematics = Kinematics::of_limb(chain, base, posture, commands, base_moves);
        let (n, all) = (chain.coordinate_count(), kinematics.velocity_count());
        Self {
            jacobian: kinematics.jacobian(chain.tip()),
            torque: vec![0.0; all],
            hessian: DMatrix::zeros(all, all),
            spring_torque: vec![0.0; n],
            spring_turnover: vec![0.0; n],
            spring_tangent: DMatrix::zeros(n, n),
            spring_geometric: Vec::new(),
            energy: 0.0,
            pattern: (Vec::new(), 0.0),
            sweep: None,
            wrenches: Vec::new(),
            tangents: Vec::new(),
            kinematics,
        }
    }

    /// A chain on a base that does not move: with sweeps where it is long enough and a sequence of
    /// stages. `scales` are those of [`crate::chain::scaling::scales_of`]; `method` overrides the choice, for comparisons.
    pub fn of_chain(
        chain: &Chain,
        base: &Pose,
        posture: &[f64],
        commands: &[f64],
        scales: &[f64],
        method: Option<ChainMethod>,
    ) -> Self {
        let long = chain.coordinate_count() >= SWEEP_FROM || disparate(scales, chain);
        let wanted = method.map_or(long, |method| method == ChainMethod::Sweep);
        let Some(sweep) = wanted.then(|| Sweep::new(chain, posture, scales)).flatten() else {
            return Self::new(chain, base, posture, commands, false);
        };
        let kinematics = Kinematics::new(chain, base, posture, commands);
        let (n, all) = (chain.coordinate_count(), kinematics.velocity_count());
        Self {
            jacobian: kinematics.jacobian(chain.tip()),
            torque: vec![0.0; all],
            hessian: DMatrix::zeros(0, 0),
            spring_torque: vec![0.0; n],
            spring_turnover: vec![0.0; n],
            spring_tangent: DMatrix::zeros(0, 0),
            spring_geometric: Vec::new(),
            energy: 0.0,
            pattern: (Vec::new(), 0.0),
            sweep: Some(Box::new(sweep)),
            wrenches: Vec::new(),
            tangents: Vec::new(),
            kinematics,
        }
    }

    /// Gives sweeps up; what was evaluated must be evaluated again.
    pub fn make_dense(&mut self) {
        let (n, all) = (self.spring_torque.len(), self.torque.len());
        self.sweep = None;
        self.hessian = DMatrix::zeros(all, all);
        self.spring_tangent = DMatrix::zeros(n, n);
    }

    /// Method that solves this system.
    pub fn method(&self) -> ChainMethod {
        match self.sweep {
            Some(_) => ChainMethod::Sweep,
            None => ChainMethod::Dense,
        }
    }

    /// Evaluates a problem's chain at coordinates and end wrench; `share` as in [`Self::evaluate`].
    pub fn evaluate_problem(
        &mut self,
        problem: &ChainProblem<'_>,
        coordinates: &[f64],
        wrench: &Wrench,
        share: f64,
    ) {
        let p = problem;
        let (posture, commands) = (&p.posture, &p.commands);
        self.evaluate(
            p.chain,
            &p.base,
            posture,
            commands,
            &p.loads,
            coordinates,
            wrench,
            share,
        );
    }

    /// Evaluates at coordinates and end wrench; `factor` scales loads and preloads (1: as given).
    #[allow(clippy::too_many_arguments)] // one internal kernel, called from two places
    pub fn evaluate(
        &mut self,
        chain: &Chain,
        base: &Pose,
        posture: &[f64],
        commands: &[f64],
        loads: &[Load],
        coordinates: &[f64],
        wrench: &Wrench,
        factor: f64,
    ) {
        self.kinematics.update(chain, base, coordinates, commands);
        self.kinematics
            .jacobian_into(chain.tip(), &mut self.jacobian);
        self.wrenches.clear();
        self.tangents.clear();
        let (pattern, grown) = (&self.pattern.0, self.pattern.1);
        let growing = pattern.iter().map(|load| (load, grown));
        for (load, factor) in loads.iter().map(|load| (load, factor)).chain(growing) {
            load.add_wrenches(chain, &self.kinematics, factor, &mut self.wrenches);
            load.add_tangents(chain, &self.kinematics, factor, &mut self.tangents);
        }
        self.wrenches.push((chain.tip(), *wrench));
        if let Some(sweep) = &mut self.sweep {
            sweep.set_loads(
                &self.kinematics,
                &self.jacobian,
                &self.wrenches,
                &self.tangents,
                &mut self.torque,
            );
        } else {
            self.kinematics
                .load_terms(&self.wrenches, &mut self.torque, &mut self.hessian);
            self.kinematics
                .add_tangents(&self.tangents, &mut self.hessian);
        }
        // A load without a tangent here has no equilibrium here whose stability could be assessed.
        let tangents = self.tangents.iter();
        if tangents
            .flat_map(|t| t.matrix.iter())
            .any(|x| !x.is_finite())
        {
            self.torque.fill(f64::NAN);
        }
        self.spring_torque.fill(0.0);
        self.spring_turnover.fill(0.0);
        self.spring_geometric.clear();
        self.energy = 0.0;
        let (energy, torque) = (&mut self.energy, &mut self.spring_torque);
        let (turnover, geometric) = (&mut self.spring_turnover, &mut self.spring_geometric);
        let mut add = |k: usize, entry: &mut dyn FnMut(usize, usize, f64)| {
            let block = &chain.springs()[k];
            let first = block.first;
            *energy += block.add(
                coordinates,
                posture,
                factor,
                torque,
                &mut |i, j, value| {
                    turnover[first + i] += (value * coordinates[first + j]).abs();
                    entry(i, j, value);
                },
                geometric,
            );
        };
        if let Some(sweep) = &mut self.sweep {
            sweep.set_springs(add);
            sweep.set_geometric(&self.spring_geometric);
            return;
        }
        let tangent = &mut self.spring_tangent;
        tangent.fill(0.0);
        for (k, block) in chain.springs().iter().enumerate() {
            let first = block.first;
            add(k, &mut |i, j, value| {
                tangent[(first + i, first + j)] += value
            });
        }
    }

    /// `[0 J; J^T H - K]` over the six wrench components and the `n` coordinates.
    pub fn bordered(&self, hessian: Hessian) -> DMatrix<f64> {
        let n = self.spring_torque.len();
        let mut a = DMatrix::zeros(6 + n, 6 + n);
        for j in 0..n {
            for k in 0..6 {
                a[(k, 6 + j)] = self.jacobian[(k, j)];
                a[(6 + j, k)] = self.jacobian[(k, j)];
            }
            for i in 0..n {
                let h = match hessian {
                    Hessian::Kept => self.hessian[(i, j)],
                    Hessian::LeftOut => 0.0,
                };
                a[(6 + i, 6 + j)] = h - self.spring_tangent[(i, j)];
            }
        }
        a
    }

    /// Sum of the squares of all unbalanced torques and the largest torque on either side, both in
    /// scaled units.
    pub fn unbalanced_torques(&self, scales: &[f64]) -> (f64, f64) {
        let (mut squares, mut largest) = (0.0, 0.0_f64);
        for (i, s) in scales[6..].iter().enumerate() {
            squares += (self.unbalanced(i) * s).powi(2);
            largest = larger(largest, (self.torque[i] * s).abs());
            largest = larger(largest, (self.spring_torque[i] * s).abs());
        }
        (squares, largest)
    }

    /// Unbalanced torques, n.
    pub fn unbalanced(&self, i: usize) -> f64 {
        self.torque[i] - self.spring_torque[i]
    }
}

/// The part of the unbalanced torques (scaled, root of the sum of squares) that the rounding of the
/// coordinates explains where one spring is very much stiffer than another: torques are no better known
/// than that. A spring is strained by the coordinates of its own block only (a link that bows is strained
/// by its rotations, and turned back by its axial force). Zero for all other chains, so that their
/// equilibria are as exact as the settings ask for.
pub(crate) fn rounding(chain: &Chain, system: &System, scales: &[f64]) -> f64 {
    if !disparate(scales, chain) {
        return 0.0;
    }
    let explained = system.spring_turnover.iter().zip(&scales[6..]);
    let explained = explained.enumerate().map(|(i, (turnover, factor))| {
        let most = 4.0 * f64::EPSILON * turnover;
        (system.unbalanced(i).abs().min(most) * factor).powi(2)
    });
    explained.sum::<f64>().sqrt()
}
