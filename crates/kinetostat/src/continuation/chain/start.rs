//! The regular system of a chain's equilibrium, set up: reactions that can exist, motions that change nothing, units.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::chain::equilibrium::{System, scales_of};
use crate::chain::problem::{
    ChainProblem, Prescribed, check_numbers, check_problem, is_conservative,
};
use crate::chain::scaling::{natural, nudged};
use crate::chain::sweep::stages::ChainMethod;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::settings::Parameter;
use crate::error::{Error, Result};
use crate::linalg::saddle::{RANK_TOLERANCE, column_space};
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::Role;
use crate::number::larger;
use crate::settings::Settings;
use crate::spatial::{Wrench, turn_matrix};

/// Largest part of `v` (in the given scaling) that lies in directions that are prescribed
/// otherwise.
fn misplaced(v: &Vector6<f64>, turn: &Matrix6<f64>, wrong: impl Fn(usize) -> bool) -> bool {
    let local = turn.transpose() * v;
    let most = local.amax();
    (0..6).any(|k| wrong(k) && local[k].abs() > 1e-9 * most)
}

impl<'p, 'a> ChainSystem<'p, 'a> {
    pub fn new(
        problem: &'p ChainProblem<'a>,
        parameter: Option<&'p Parameter>,
        settings: &Settings,
    ) -> Result<Self> {
        check_problem(problem)?;
        let chain = problem.chain;
        settings.check(&chain.place())?;
        let scales = scales_of(chain, &problem.posture);
        let mut equations = System::new(
            chain,
            &problem.base,
            &problem.posture,
            &problem.commands,
            false,
        );
        let turn = turn_matrix(&problem.end.axes);
        let is_pose = |k: usize| problem.end.prescribed[k] == Prescribed::Pose;
        let projector = |wanted: &dyn Fn(usize) -> bool| {
            let mut sum = Matrix6::zeros();
            for k in (0..6).filter(|&k| wanted(k)) {
                sum += turn.column(k) * turn.column(k).transpose();
            }
            sum
        };
        let mut grown = Vector6::zeros();
        let mut conservative = is_conservative(problem);
        match parameter {
            Some(Parameter::Displacement(twist)) => {
                check_numbers(problem, "the direction of a curve", &twist.0)?;
                if twist.0.amax() == 0.0 || misplaced(&twist.0, &turn, |k| !is_pose(k)) {
                    return Err(Error::model(
                        chain.place(),
                        "the direction of a displacement must not vanish and must lie in directions in which the end condition prescribes the pose",
                    ));
                }
            }
            Some(Parameter::Load(pattern)) => {
                check_numbers(problem, "the load pattern", &pattern.end.0)?;
                if misplaced(&pattern.end.0, &turn, is_pose) {
                    return Err(Error::model(
                        chain.place(),
                        "the end wrench of a load pattern must lie in directions in which the end condition prescribes the wrench",
                    ));
                }
                let mut loaded = problem.clone();
                loaded.loads.clone_from(&pattern.loads);
                loaded.end.wrench = pattern.end;
                check_problem(&loaded)?;
                conservative &= is_conservative(&loaded);
                grown = pattern.end.0;
                equations.pattern.0.clone_from(&pattern.loads);
            }
            None => {}
        }
        let given = projector(&|k| !is_pose(k)) * problem.end.wrench.0;
        let mut system = Self {
            problem,
            parameter,
            settings: *settings,
            scaling: scales,
            equations,
            other: None,
            dense: false,
            range: DMatrix::zeros(6, 0),
            frame: DMatrix::zeros(6, 0),
            given,
            grown,
            neutral: 0,
            sigma: 1.0,
            unit: natural(chain),
            turned: Vector3::zeros(),
            conservative,
            reference: Vec::new(),
            family: None,
        };
        system.find_range(&turn);
        system.find_neutral();
        Ok(system)
    }

    /// Evaluates by sweeps along the chain where it is long and no passive motion is redundant. What
    /// needs whole matrices (special points, families) still has them.
    pub fn by_sweeps(mut self) -> Self {
        if self.neutral > 0 {
            return self;
        }
        let p = self.problem;
        let (posture, commands) = (&p.posture, &p.commands);
        let scales = &self.scaling;
        let mut swept = System::of_chain(p.chain, &p.base, posture, commands, scales, None);
        if swept.method() == ChainMethod::Sweep {
            swept.pattern.0.clone_from(&self.equations.pattern.0);
            self.other = Some(Box::new(swept));
        }
        self
    }

    /// Reactions that can exist: the union of the Jacobian's range over several postures.
    fn find_range(&mut self, turn: &Matrix6<f64>) {
        let problem = self.problem;
        let chain = problem.chain;
        let held: Vec<usize> = (0..6)
            .filter(|&k| problem.end.prescribed[k] == Prescribed::Pose)
            .collect();
        let frame = DMatrix::from_fn(6, held.len(), |i, k| turn[(i, held[k])]);
        let n = chain.coordinate_count();
        let sizes = [0.0, 0.4, -0.9, 1.7];
        let mut all = DMatrix::zeros(held.len(), n * sizes.len());
        for (k, size) in sizes.into_iter().enumerate() {
            let x = nudged(chain, &problem.posture, size);
            self.equations
                .kinematics
                .update(chain, &problem.base, &x, &problem.commands);
            self.equations.jacobian = self.equations.kinematics.jacobian(chain.tip());
            all.columns_mut(k * n, n)
                .copy_from(&(frame.transpose() * self.scaled_jacobian()));
        }
        self.range = &frame * column_space(&all);
        self.frame = frame;
    }

    /// Passive motions that change nothing, wherever the chain is and whatever its reactions are.
    fn find_neutral(&mut self) {
        let problem = self.problem;
        let passive = problem.chain.indices_of(Role::Passive).len();
        let mut least = passive;
        for (k, size) in [0.3, -0.7, 1.3].into_iter().enumerate() {
            if least == 0 {
                break;
            }
            let x = nudged(problem.chain, &problem.posture, size);
            let mut z = self.state(&x, &Wrench::zero(), 0.0);
            for i in 0..self.reactions() {
                z[i] = 0.2 * ((i + k) as f64 + 0.4).sin();
            }
            z[self.count()] = 0.3;
            self.evaluate(&z);
            let columns = self.passive_columns();
            if !columns.iter().all(|v| v.is_finite()) {
                continue;
            }
            let rank = SingularValues::of(&columns).rank(100.0 * RANK_TOLERANCE);
            least = least.min(passive.saturating_sub(rank));
        }
        self.neutral = least;
    }

    /// Chooses the parameter's unit and the reference of displacements at the start of a curve.
    pub fn start(
        &mut self,
        coordinates: &[f64],
        wrench: &Wrench,
        value: f64,
    ) -> Result<DVector<f64>> {
        self.sigma = 1.0;
        let z = self.state(coordinates, wrench, value);
        self.evaluate(&z);
        let scaled = |v: &Vector6<f64>, power: i32| {
            DVector::from_fn(6, |i, _| v[i] * self.scaling[i].powi(power) / self.unit)
        };
        let size = match self.parameter {
            Some(Parameter::Displacement(twist)) => {
                let moved = scaled(&twist.0, 1);
                let within = self.range.transpose() * &moved;
                if within.norm() < (1.0 - 1e-9) * moved.norm() {
                    return Err(Error::model(
                        self.problem.chain.place(),
                        "the end of this chain can never move in the direction of the curve",
                    ));
                }
                moved.norm()
            }
            Some(Parameter::Load(pattern)) => {
                let mut wrenches = vec![(0, Wrench(self.grown))];
                for load in &pattern.loads {
                    let chain = self.problem.chain;
                    load.add_wrenches(chain, &self.equations.kinematics, 1.0, &mut wrenches);
                }
                let sizes = wrenches.iter().map(|(_, w)| scaled(&w.0, -1).norm());
                sizes.fold(0.0, larger)
            }
            None => 1.0,
        };
        if !(size.is_finite() && size > 0.0) {
            return Err(Error::model(
                self.problem.chain.place(),
                "the load pattern of the curve is zero",
            ));
        }
        self.sigma = 1.0 / size;
        self.reference = (0..self.problem.chain.nodes().len())
            .map(|i| self.equations.kinematics.node_pose(i))
            .collect();
        Ok(self.state(coordinates, wrench, value))
    }
}
