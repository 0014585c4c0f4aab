//! Curves of equilibria of a chain: followed from a start, and through further ones.

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::ChainProblem;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::curve::{CurvePoint, Curves, Jump, Stop};
use crate::continuation::settings::{CurveSettings, Parameter};
use crate::continuation::tracing::branch_switching::Traced;
use crate::continuation::tracing::jumps::{jumps, points_at};
use crate::continuation::tracing::tracer::Tracer;
use crate::error::Result;
use crate::model::limits::check_number;

/// Follows the equilibrium path through `start` both ways, and the branches connected to it as far
/// as [`CurveSettings::branches`] allows. `value` is the parameter at the start; the problem
/// itself is the one at parameter 0.
///
/// # Errors
/// Wrong numbers or directions, a parameter that changes nothing, or a start that is no
/// equilibrium.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let push = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros()); // N
/// let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
/// let start = solve_chain(&problem, &Settings::default())?;
/// let parameter = Parameter::end_wrench(push);
/// let curves = follow(&problem, &parameter, &start, 0.0, &CurveSettings::within(0.0, 120.0))?;
/// assert!(curves.specials.iter().any(|special| special.kind.is_bifurcation()));
/// # Ok::<(), Error>(())
/// ```
pub fn follow<'a>(
    problem: &ChainProblem<'a>,
    parameter: &Parameter,
    start: &Equilibrium,
    value: f64,
    settings: &CurveSettings,
) -> Result<Curves<'a>> {
    follow_until(problem, parameter, start, value, settings, None)
}

pub(crate) fn follow_until<'a>(
    problem: &ChainProblem<'a>,
    parameter: &Parameter,
    start: &Equilibrium,
    value: f64,
    settings: &CurveSettings,
    stop: Stop<'_>,
) -> Result<Curves<'a>> {
    let place = problem.chain.place();
    settings.check(&place)?;
    check_number(&place, || "the parameter at the start".into(), value)?;
    problem.chain.check(&start.coordinates, &problem.commands)?;
    let mut curves = Curves {
        problem: problem.clone(),
        parameter: parameter.clone(),
        branches: Vec::new(),
        specials: Vec::new(),
        more_branches: false,
        settings: settings.clone(),
        start: (start.coordinates.clone(), start.wrench, value),
    };
    curves.grow(start, value, stop)?;
    Ok(curves)
}

impl Curves<'_> {
    /// Follows the path through a further equilibrium of the same problem, at a value of the
    /// parameter, and the branches connected to it as far as [`CurveSettings::branches`] allows for
    /// each start. False if the equilibrium lies on a branch that is known.
    ///
    /// # Errors
    /// The start is no equilibrium.
    pub fn add(&mut self, start: &Equilibrium, value: f64) -> Result<bool> {
        self.grow(start, value, None)
    }

    /// Equilibria at one value of the parameter, on all branches.
    ///
    /// # Errors
    /// None in practice: the problem was accepted when the curve was followed.
    pub fn at(&self, value: f64) -> Result<Vec<CurvePoint>> {
        Ok(points_at(&mut self.system()?, &self.branches, value, true))
    }

    /// Jumps from every limit point that a stable part of a branch runs into: to stable equilibria on the computed
    /// branches at the same dead load (load limits) or at the same displacement (displacement limits), nearest first.
    ///
    /// # Errors
    /// None in practice: the problem was accepted when the curve was followed.
    pub fn jumps(&self) -> Result<Vec<Jump>> {
        Ok(jumps(&mut self.system()?, &self.branches, &self.specials))
    }

    /// The chain's system in the units of this curve.
    fn system(&self) -> Result<ChainSystem<'_, '_>> {
        let solver = &self.settings.solver;
        let mut system =
            ChainSystem::new(&self.problem, Some(&self.parameter), solver)?.by_sweeps();
        system.start(&self.start.0, &self.start.1, self.start.2)?;
        Ok(system)
    }

    fn grow(&mut self, start: &Equilibrium, value: f64, stop: Stop<'_>) -> Result<bool> {
        let (problem, parameter) = (self.problem.clone(), self.parameter.clone());
        let settings = self.settings.clone();
        let mut system =
            ChainSystem::new(&problem, Some(&parameter), &settings.solver)?.by_sweeps();
        system.start(&self.start.0, &self.start.1, self.start.2)?;
        let z = system.state(&start.coordinates, &start.wrench, value);
        let mut tracer = Tracer::new(system, &settings);
        tracer.specials = std::mem::take(&mut self.specials);
        let mut traced = Traced {
            branches: std::mem::take(&mut self.branches),
            more: self.more_branches,
        };
        let answer = tracer.grow(&z, &mut traced, stop);
        self.specials = tracer.specials;
        (self.branches, self.more_branches) = (traced.branches, traced.more);
        answer
    }
}
