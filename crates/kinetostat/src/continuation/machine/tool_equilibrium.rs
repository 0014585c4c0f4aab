//! Equilibria of a machine whose tool is held and loaded as conditions say, one by one.

use nalgebra::DMatrix;

use crate::chain::directions::DirectionKind;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::error::Result;
use crate::linalg::complement::complement;
use crate::linalg::saddle::independent_columns;
use crate::machine::directions::without;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::{Guide, Unknowns};
use crate::machine::state::MechanismState;
use crate::model::chain::Role;
use crate::number::largest_size;
use crate::spatial::{MotionKind, Twist, Wrench, moved, pose_residual};

impl ToolConditions<'_> {
    /// Equilibrium from a state, if Newton finds it from there.
    pub(crate) fn rest(
        &self,
        state: MechanismState,
        wrench: &Wrench,
    ) -> Option<MechanismEquilibrium> {
        let converged = self.converge(state, *wrench, self.guide(None), false);
        converged.ok().map(|(e, _)| e)
    }

    /// Deflections of all springs, rad and shares of the natural length.
    pub(crate) fn spring_strains(&self, e: &MechanismEquilibrium) -> Vec<f64> {
        let limbs = self.posture.mechanism.limbs().iter();
        let own = limbs.zip(&e.limbs).flat_map(|(limb, own)| {
            let of_limb = limb.actual.coordinates().iter().zip(&own.coordinates);
            of_limb.filter(|(c, _)| c.role == Role::Spring)
        });
        let scaled = own.map(|(c, x)| match c.kind {
            MotionKind::Revolute => *x,
            MotionKind::Prismatic => x / self.length,
        });
        scaled.collect()
    }

    /// One equilibrium twice: the same place of the tool, but for motions that cost nothing, and the
    /// same torques of all springs. Joints that turn for nothing do not count, nor do stresses that
    /// rigid limbs put on each other.
    pub(crate) fn same(&self, a: &MechanismEquilibrium, b: &MechanismEquilibrium) -> bool {
        let torques = |e: &MechanismEquilibrium| -> Vec<f64> {
            let limbs = e.limbs.iter();
            limbs.flat_map(|l| l.spring_torques.clone()).collect()
        };
        let (x, y) = (torques(a), torques(b));
        let most = largest_size(x.iter().chain(&y));
        let off = self.scaled(&pose_residual(&a.tool, &b.tool).0);
        // In a stretched limb, rounding may be all that holds the tool along a motion.
        let nothing = 1e-15 * self.posture.mechanism.scale().stiffness;
        let mut directions = a.directions.clone();
        let for_nothing = directions
            .iter_mut()
            .filter(|d| d.stiffness_n_per_m.abs() < nothing);
        for_nothing.for_each(|d| d.kind = DirectionKind::Free);
        let all = DMatrix::identity(6, 6);
        let costly = without(&directions, DirectionKind::Free, self.length, &all);
        (costly.transpose() * off).norm() < 1e-6 * self.length
            && (x.iter().zip(&y)).all(|(x, y)| (x - y).abs() <= 1e-5 * most + 1e-9)
    }

    /// Newton from a state under a wrench; the wrench that is left after it is that of the answer.
    pub(crate) fn converge(
        &self,
        state: MechanismState,
        wrench: Wrench,
        guide: Guide,
        robustly: bool,
    ) -> Result<(MechanismEquilibrium, f64)> {
        let mut solver = self.posture.solver(state, Unknowns::Guided);
        solver.guide = guide;
        solver.wrench = wrench;
        let residual = if robustly {
            solver.solve_robustly()?
        } else {
            match solver.solve(1.0, 0) {
                Ok((iterations, norms)) => norms.residual(iterations),
                Err((iterations, norms)) => {
                    return Err(solver.not_converged(iterations, 0.0, &norms));
                }
            }
        };
        let factor = self.factor(&solver.wrench);
        let e = conclude(&mut solver, residual)?;
        Ok((e, factor))
    }

    /// Factor of the load in a wrench on the tool: reactions are across the tool's motions.
    pub(crate) fn factor(&self, wrench: &Wrench) -> f64 {
        let across = complement(&independent_columns(&self.held));
        let part = |w: &Wrench| across.transpose() * w.0;
        let (own, unit) = (part(&Wrench(wrench.0 - self.dead.0)), part(&self.pattern));
        own.dot(&unit) / unit.norm_squared()
    }

    /// The driven tool's equilibrium at a displacement, and the factor of the load there.
    pub(crate) fn first_driven(&self, displacement: f64) -> Result<(MechanismEquilibrium, f64)> {
        let mut state = self.posture.rest_state();
        let tool = self.posture.mechanism.tool();
        let row = self.pattern.0;
        let motion = row * (displacement / row.norm_squared());
        state.platforms[tool] = moved(&self.posture.target, &Twist(motion));
        let guide = self.guide(Some((&row, displacement)));
        self.converge(state, self.dead, guide, true)
    }

    /// The equilibrium at a factor of the load, from a state near it, and that factor.
    pub(crate) fn first_loaded(
        &self,
        factor: f64,
        near: MechanismState,
    ) -> Result<(MechanismEquilibrium, f64)> {
        let wrench = self.dead + self.pattern * factor;
        // A tool that is held away from its command may be far.
        let robustly = self.held.ncols() > 0;
        self.converge(near, wrench, self.guide(None), robustly)
    }
}
