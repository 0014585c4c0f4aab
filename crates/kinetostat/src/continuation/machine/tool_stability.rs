//! Stability of a machine's tool under dead wrenches, and of everything else with it.

use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};

use crate::chain::directions::{Direction, DirectionKind};
use crate::chain::graded::{levels, root_rows};
use crate::chain::stability::{TangentMotions, diverging_motions};
use crate::continuation::curve::{CurveEquilibrium, CurveStability};
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::linalg::complement::complement;
use crate::machine::directions::without;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::spatial::{Pose, Wrench};

/// Stability of the tool under dead wrenches.
pub(crate) struct Holding {
    /// True if the tool does not diverge.
    pub stays: bool,
    /// The symmetric part of its stiffness is positive: it does not swing with growing amplitude either.
    pub definite: bool,
    /// Number of independent motions in which it goes away.
    pub unstable: usize,
}

impl Holding {
    pub fn may_flutter(&self) -> bool {
        self.stays && !self.definite
    }
}

/// Unstable modes of limbs with their ends held, and whether the platforms besides the tool have one while it is held.
pub(crate) fn condensed_modes(e: &MechanismEquilibrium) -> usize {
    let limbs = e.limbs.iter().map(|l| l.stability.unstable_modes);
    limbs.sum::<usize>() + usize::from(!e.others_hold)
}

/// Stability of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MachineStability {
    /// Every shape and every platform stays where it is.
    pub stable: bool,
    /// Number of independent motions in which it goes away.
    pub unstable_modes: usize,
    /// True if, under loads without a potential, it does not diverge but may oscillate with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
}

impl CurveStability for MachineStability {
    fn stable(&self) -> bool {
        self.stable
    }

    fn unstable_modes(&self) -> usize {
        self.unstable_modes
    }

    fn may_flutter(&self) -> bool {
        self.may_flutter
    }
}

impl CurveEquilibrium for MechanismEquilibrium {
    type Stability = MachineStability;

    fn tool(&self) -> &Pose {
        &self.tool
    }

    fn wrench(&self) -> &Wrench {
        &self.wrench
    }

    fn spring_energy(&self) -> f64 {
        self.limbs.iter().map(|limb| limb.energy).sum()
    }

    fn conservative(&self) -> bool {
        self.conservative
    }

    fn stiffness(&self) -> &Matrix6<f64> {
        &self.stiffness.matrix
    }

    fn directions(&self) -> &[Direction] {
        &self.directions
    }

    fn shape_stable(&self) -> bool {
        self.shapes_stable()
    }

    fn share_to_buckling(&self) -> Option<f64> {
        self.share_to_buckling()
    }

    fn buckling_mode(&self) -> &[f64] {
        &[]
    }
}

impl ToolConditions<'_> {
    /// Free motions of the tool that the machine at rest can make, scaled, orthonormal.
    pub(crate) fn free_motions(&self) -> DMatrix<f64> {
        match self.posture.wrench_at(&self.posture.target) {
            Ok(e) => self.possible(&e, &self.free),
            Err(_) => self.free.clone(),
        }
    }

    /// Restricts some motions (scaled) to those that the machine can make.
    pub(crate) fn possible(
        &self,
        e: &MechanismEquilibrium,
        motions: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        self.without(e, motions, DirectionKind::Rigid)
    }

    /// Restricts some motions (scaled) to those across all directions of a kind.
    pub(crate) fn without(
        &self,
        e: &MechanismEquilibrium,
        motions: &DMatrix<f64>,
        kind: DirectionKind,
    ) -> DMatrix<f64> {
        without(&e.directions, kind, self.length, motions)
    }

    pub(crate) fn scaled_stiffness(&self, e: &MechanismEquilibrium) -> DMatrix<f64> {
        let k = &e.stiffness.matrix;
        DMatrix::from_fn(6, 6, |i, j| k[(i, j)] / (self.unit(i) * self.unit(j)))
    }

    /// Stability of the tool in some motions (scaled) under dead wrenches.
    pub(crate) fn holds(&self, e: &MechanismEquilibrium, motions: &DMatrix<f64>) -> Holding {
        let possible = self.possible(e, motions);
        if possible.ncols() == 0 {
            return Holding {
                stays: true,
                definite: true,
                unstable: 0,
            };
        }
        // Uses principal directions: in the matrix stiff motions may have drowned soft ones.
        let rows = root_rows(&e.directions, self.length);
        let unit = Vector6::from_fn(|i, _| self.unit(i));
        let mut back = DMatrix::zeros(rows.len(), possible.ncols());
        let mut inner = DMatrix::zeros(rows.len(), rows.len());
        for (i, (sign, row)) in rows.iter().enumerate() {
            let row = row.component_div(&unit);
            // Components below rounding are zero.
            let least = 1e-13 * row.norm();
            let part = (row.transpose() * &possible).map(|x| if x.abs() > least { x } else { 0.0 });
            back.row_mut(i).copy_from(&part);
            inner[(i, i)] = *sign;
        }
        let below = levels(&back, &inner);
        let below = below.iter().filter(|(value, _)| *value < 0.0).count();
        let unstable = match below > 0 && !self.conservative(e, motions) {
            true => {
                let k = possible.transpose() * self.scaled_stiffness(e) * &possible;
                let motions = TangentMotions::all_if(e.moves_with_its_tool());
                diverging_motions(&k, 1e-9 * k.amax(), motions)
            }
            false => below,
        };
        Holding {
            stays: unstable == 0,
            definite: below == 0,
            unstable,
        }
    }

    /// True if all loads have a potential, with the dead part of the wrench on the tool in some motions (scaled).
    pub(crate) fn conservative(&self, e: &MechanismEquilibrium, motions: &DMatrix<f64>) -> bool {
        let unit = Vector6::from_fn(|i, _| self.unit(i));
        let dead = motions * (motions.transpose() * e.wrench.0.component_div(&unit));
        let moment = Vector3::from_fn(|i, _| dead[3 + i] * self.length);
        // A moment of zero leaves rounding in the projection.
        let moment =
            match moment.norm() > 1e-12 * e.wrench.0.component_div(&unit).norm() * self.length {
                true => moment,
                false => Vector3::zeros(),
            };
        e.conservative && self.posture.mechanism.tool_moment_has_potential(&moment)
    }

    /// Stability while the motion along the parameter is prescribed (`held`; under a growing load: while the tool is held
    /// along the load), or under a dead load.
    pub(crate) fn machine_stability(
        &self,
        e: &MechanismEquilibrium,
        held: bool,
    ) -> MachineStability {
        let along_load = || {
            let pattern = self.free.transpose() * self.pattern.0;
            match pattern.norm() > 0.0 {
                true => &self.free * complement(&DMatrix::from_columns(&[pattern.normalize()])),
                false => self.free.clone(),
            }
        };
        let motions = match (held, self.by_motion) {
            (true, true) => self.free.clone(),
            (true, false) => along_load(),
            (false, _) => self.motions.clone(),
        };
        let holding = self.holds(e, &motions);
        let shapes = e.shapes_stable() && e.others_hold;
        MachineStability {
            stable: shapes && holding.stays,
            unstable_modes: condensed_modes(e) + holding.unstable,
            may_flutter: shapes && holding.may_flutter(),
        }
    }
}
