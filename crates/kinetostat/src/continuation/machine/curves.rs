//! Curves of equilibria of a machine while a load or a motion of its tool grows, with the branches that cross them
//! [R 5.5.3].

use crate::chain::problem::EndCondition;
use crate::continuation::curve::{Branch, CurvePoint, Jump, Special};
use crate::continuation::machine::system::MachineSystem;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::continuation::settings::{CurveSettings, Parameter};
use crate::continuation::tracing::branch_switching::Traced;
use crate::continuation::tracing::jumps::{jumps, points_at};
use crate::continuation::tracing::tracer::Tracer;
use crate::error::Result;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;
use crate::machine::state::check_state;

/// A curve of equilibria of a machine and the branches connected to it.
#[derive(Clone, Debug)]
pub struct MachineCurves<'p> {
    /// The start's own branch first.
    pub branches: Vec<Branch<MechanismEquilibrium>>,
    /// Limit points, bifurcation points and changes of stability, in the order found.
    pub specials: Vec<Special<MechanismEquilibrium>>,
    /// True if connected branches were left out because there were too many.
    pub more_branches: bool,
    posture: &'p Posture,
    parameter: Parameter,
    end: EndCondition,
    settings: CurveSettings,
    first: (MechanismEquilibrium, f64),
}

impl Posture {
    /// Equilibria while the parameter runs through `settings.range`, in both directions from its value nearest to zero:
    /// the tool moved along a twist (m, rad; from the nominal target), or a wrench on it times a factor; and the branches
    /// connected to them as far as [`CurveSettings::branches`] allows. `end` says in which directions the tool is held (at
    /// the nominal target) and which dead wrench acts in the others; `end.pose` is not used.
    ///
    /// Unknowns are the motions of the tool and the load, everything else is condensed: where a limb or another platform
    /// loses its stability while the tool stands still, this is a special point
    /// ([`crate::continuation::SpecialKind::StabilityChange`]). The branches that leave there are followed if it is a limb
    /// that buckles, not if it is a platform. Of the settings `largest_turn` and those of the solver do not count.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let push = Parameter::end_wrench(Wrench::new(vector![-1000.0, 0.0, 0.0], Vector3::zeros()));
    /// let free = EndCondition::wrench(Wrench::zero());
    /// let posture = arm.posture(&home)?;
    /// let curves = posture.curves(&push, &free, &CurveSettings::within(0.0, 10.0))?;
    /// assert!(curves.branches[0].points.len() > 1);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Model`] for loads on nodes, a direction without length, or a driven direction in which the tool is
    /// to be free; those of the first equilibrium.
    pub fn curves<'p>(
        &'p self,
        parameter: &Parameter,
        end: &EndCondition,
        settings: &CurveSettings,
    ) -> Result<MachineCurves<'p>> {
        let conditions = ToolConditions::new(self, parameter, end, settings)?;
        let value = 0.0_f64.clamp(settings.range.0, settings.range.1);
        let first = first_equilibrium(&conditions, value)?;
        let (system, z) = MachineSystem::start(&conditions, &first.0, first.1);
        let mut tracer = Tracer::new(system, settings);
        let mut traced = Traced::default();
        tracer.grow(&z, &mut traced, None)?;
        Ok(MachineCurves {
            specials: tracer.specials,
            branches: traced.branches,
            more_branches: traced.more,
            posture: self,
            parameter: parameter.clone(),
            end: end.clone(),
            settings: settings.clone(),
            first,
        })
    }
}

/// The equilibrium at a value of the parameter, and the factor of the load there.
fn first_equilibrium(
    conditions: &ToolConditions<'_>,
    value: f64,
) -> Result<(MechanismEquilibrium, f64)> {
    let posture = conditions.posture;
    if conditions.by_motion {
        return conditions.first_driven(value);
    }
    // A tool that nothing holds comes to rest along several paths.
    let near = match conditions.held.ncols() {
        0 => {
            let wrench = conditions.dead + conditions.pattern * value;
            posture.rest_under(&wrench, posture.rest_state())?
        }
        _ => posture.rest_state(),
    };
    conditions.first_loaded(value, near)
}

impl MachineCurves<'_> {
    /// Follows the curve through a further equilibrium of the same query, and the branches connected to it as far as
    /// [`CurveSettings::branches`] allows for each start. False if the tool's place and its load lie on a branch that is
    /// known.
    ///
    /// # Errors
    /// The start is no equilibrium, or of another machine.
    pub fn add(&mut self, start: &MechanismEquilibrium) -> Result<bool> {
        check_state(&self.posture.mechanism, &start.state)?;
        let (parameter, end, settings) = (&self.parameter, &self.end, &self.settings);
        let conditions = ToolConditions::new(self.posture, parameter, end, settings)?;
        let (mut system, _) = MachineSystem::start(&conditions, &self.first.0, self.first.1);
        let z = system.place(start);
        let mut tracer = Tracer::new(system, settings);
        tracer.specials = std::mem::take(&mut self.specials);
        let mut traced = Traced {
            branches: std::mem::take(&mut self.branches),
            more: self.more_branches,
        };
        let answer = tracer.grow(&z, &mut traced, None);
        self.specials = tracer.specials;
        (self.branches, self.more_branches) = (traced.branches, traced.more);
        answer
    }

    /// Equilibria at one value of the parameter, on all branches.
    ///
    /// # Errors
    /// None in practice: the query was accepted when the curve was followed.
    pub fn at(&self, value: f64) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        self.evaluate(|system| points_at(system, &self.branches, value, true))
    }

    /// Equilibria at one value of the conjugate (force along the displacement, or displacement along the load pattern),
    /// on all branches.
    ///
    /// # Errors
    /// None in practice: the query was accepted when the curve was followed.
    pub fn at_conjugate(&self, value: f64) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        self.evaluate(|system| points_at(system, &self.branches, value, false))
    }

    /// Jumps from every limit point that a stable part of a branch runs into: to stable equilibria on the computed
    /// branches at the same dead load (load limits) or at the same displacement (displacement limits), nearest first.
    /// If no branch has one at the load, the machine is released at the ends of the limit point's branch.
    ///
    /// # Errors
    /// None in practice: the query was accepted when the curve was followed.
    pub fn jumps(&self) -> Result<Vec<Jump<MechanismEquilibrium>>> {
        self.evaluate(|system| {
            let mut list = jumps(system, &self.branches, &self.specials);
            for jump in &mut list {
                let special = &self.specials[jump.from];
                if let (true, true, Some(&own)) =
                    (jump.dead_load, jump.to.is_empty(), special.branches.first())
                {
                    jump.to = self.let_go(system, &self.branches[own], special);
                    jump.branches = vec![own; jump.to.len()];
                }
            }
            list
        })
    }

    /// Equilibria under the load of a special point, after a release at a branch's ends.
    fn let_go(
        &self,
        system: &mut MachineSystem<'_, '_>,
        branch: &Branch<MechanismEquilibrium>,
        special: &Special<MechanismEquilibrium>,
    ) -> Vec<CurvePoint<MechanismEquilibrium>> {
        let load = special.point.load(&self.parameter);
        let mut to: Vec<CurvePoint<MechanismEquilibrium>> = Vec::new();
        for end in [branch.points.first(), branch.points.last()] {
            if let Some(p) = end.and_then(|end| system.let_go(end, load))
                && p.dead_load.stable
                && p.apart(&special.point) > 1e-3
                && to.iter().all(|q| p.apart(q) > 1e-7)
            {
                to.push(p);
            }
        }
        to.sort_by(|a, b| a.apart(&special.point).total_cmp(&b.apart(&special.point)));
        to
    }

    /// Evaluates the machine's system in the units of this curve.
    fn evaluate<R>(&self, query: impl FnOnce(&mut MachineSystem<'_, '_>) -> R) -> Result<R> {
        let (parameter, end) = (&self.parameter, &self.end);
        let conditions = ToolConditions::new(self.posture, parameter, end, &self.settings)?;
        let (mut system, _) = MachineSystem::start(&conditions, &self.first.0, self.first.1);
        Ok(query(&mut system))
    }
}
