//! Curves of equilibria of a chain: followed from a start, and through further ones.

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::ChainProblem;
use crate::continuation::chain_system::ChainSystem;
use crate::continuation::curve::{Curves, Stop};
use crate::continuation::parameter::Parameter;
use crate::continuation::settings::CurveSettings;
use crate::continuation::tracer::Tracer;
use crate::error::Result;
use crate::model::limits::sensible;

/// Follows the equilibrium path through `start` both ways, and the branches connected to it as far
/// as [`CurveSettings::branches`] allows. `value` is the parameter at the start; the problem
/// itself is the one at parameter 0.
///
/// # Errors
/// Wrong numbers or directions, a parameter that changes nothing, or a start that is no
/// equilibrium.
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
    let place = format!("chain '{}'", problem.chain.name());
    settings.check(&place)?;
    sensible(&place, || "the parameter at the start".into(), value)?;
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

    fn grow(&mut self, start: &Equilibrium, value: f64, stop: Stop<'_>) -> Result<bool> {
        let (problem, parameter) = (self.problem.clone(), self.parameter.clone());
        let settings = self.settings.clone();
        let mut system =
            ChainSystem::new(&problem, Some(&parameter), &settings.solver)?.by_sweeps();
        system.start(&self.start.0, &self.start.1, self.start.2)?;
        let z = system.state(&start.coordinates, &start.wrench, value);
        let mut tracer = Tracer {
            system,
            settings: &settings,
            specials: std::mem::take(&mut self.specials),
        };
        let answer = tracer.grow(&z, &mut self.branches, &mut self.more_branches, stop);
        self.specials = tracer.specials;
        answer
    }
}
