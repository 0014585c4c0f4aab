//! Curves of equilibria of a machine while a load or a motion of its tool grows, with the branches that cross them
//! [R 5.5.3].

use crate::chain::problem::EndCondition;
use crate::continuation::branch_switching::Traced;
use crate::continuation::curve::{Branch, CurvePoint, Jump, Special};
use crate::continuation::jumps::{crossings, jumps};
use crate::continuation::machine_system::MachineSystem;
use crate::continuation::parameter::Parameter;
use crate::continuation::settings::CurveSettings;
use crate::continuation::tool_conditions::ToolConditions;
use crate::continuation::tracer::Tracer;
use crate::error::Result;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;

/// A curve of equilibria of a machine and the branches connected to it.
#[derive(Clone, Debug)]
pub struct MachineCurves<'p> {
    /// The start's own branch first.
    pub branches: Vec<Branch<MechanismEquilibrium>>,
    /// Limit points, bifurcation points and changes of stability, in the order found.
    pub specials: Vec<Special<MechanismEquilibrium>>,
    /// True if connected branches were left out because there were too many.
    pub more_branches: bool,
    /// Index of the start among the points of the first branch.
    pub start: usize,
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
    /// ([`crate::continuation::SpecialKind::StabilityChange`]), but the branch that leaves there is not followed. Of the settings
    /// `largest_turn` and those of the solver do not count.
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
        let first = conditions.first_equilibrium(value)?;
        let (system, z) = MachineSystem::start(&conditions, &first.0, first.1);
        let mut tracer = Tracer::new(system, settings);
        let mut traced = Traced::default();
        tracer.grow(&z, &mut traced, None)?;
        let points = &traced.branches[0].points;
        let apart = |p: &CurvePoint<MechanismEquilibrium>| (&p.z - &z).norm();
        let start =
            (0..points.len()).min_by(|a, b| apart(&points[*a]).total_cmp(&apart(&points[*b])));
        Ok(MachineCurves {
            start: start.unwrap_or(0),
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

impl MachineCurves<'_> {
    /// Equilibria at one value of the parameter, on all branches.
    ///
    /// # Errors
    /// None in practice: the question was accepted when the curve was followed.
    pub fn at(&self, value: f64) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        self.crossings(value, true)
    }

    /// Equilibria at one value of the conjugate (force along the displacement, or displacement along the load pattern),
    /// on all branches.
    ///
    /// # Errors
    /// None in practice: the question was accepted when the curve was followed.
    pub fn at_conjugate(&self, value: f64) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        self.crossings(value, false)
    }

    fn crossings(
        &self,
        value: f64,
        parameter: bool,
    ) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        let conditions = self.conditions()?;
        let (mut system, _) = MachineSystem::start(&conditions, &self.first.0, self.first.1);
        Ok(crossings(&mut system, &self.branches, value, parameter))
    }

    /// Where the machine goes from every limit point that a stable part of a branch runs into: stable equilibria on the
    /// computed branches at the same dead load (load limits) or at the same displacement (displacement limits), nearest
    /// first.
    ///
    /// # Errors
    /// None in practice: the question was accepted when the curve was followed.
    pub fn jumps(&self) -> Result<Vec<Jump<MechanismEquilibrium>>> {
        let conditions = self.conditions()?;
        let (mut system, _) = MachineSystem::start(&conditions, &self.first.0, self.first.1);
        Ok(jumps(&mut system, &self.branches, &self.specials))
    }

    /// Where the machine comes to rest under the load of a special point if it is let go at a branch's ends.
    pub(crate) fn let_go(
        &self,
        branch: &Branch<MechanismEquilibrium>,
        special: &Special<MechanismEquilibrium>,
    ) -> Result<Vec<CurvePoint<MechanismEquilibrium>>> {
        let conditions = self.conditions()?;
        let (mut system, _) = MachineSystem::start(&conditions, &self.first.0, self.first.1);
        let load = special.point.load(&self.parameter);
        let ends = branch
            .points
            .first()
            .into_iter()
            .chain(branch.points.last());
        let mut to: Vec<CurvePoint<MechanismEquilibrium>> = Vec::new();
        for end in ends {
            if let Some(p) = system.let_go(end, load)
                && p.dead.stable
                && (&p.z - &special.point.z).norm() > 1e-3
                && to.iter().all(|q| (&p.z - &q.z).norm() > 1e-7)
            {
                to.push(p);
            }
        }
        let apart = |p: &CurvePoint<MechanismEquilibrium>| (&p.z - &special.point.z).norm();
        to.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
        Ok(to)
    }

    fn conditions(&self) -> Result<ToolConditions<'_>> {
        ToolConditions::new(self.posture, &self.parameter, &self.end, &self.settings)
    }
}
