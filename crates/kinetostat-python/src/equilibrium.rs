//! An equilibrium under load.

use std::sync::{Arc, OnceLock};

use kinetostat::batch::BatchEquilibrium;
use kinetostat::continuation::CurveEquilibrium;
use kinetostat::spatial::pose_residual;
use kinetostat::{MechanismEquilibrium, Pose, Posture, Twist, Wrench};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{array, matrix_of, rows_of};
use crate::errors::{Class, error, of_core};
use crate::stiffness::json_of;

/// Equilibrium of a machine under a wrench on its tool. Results of the kernels are there at once, the rest is computed on
/// request.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Equilibrium {
    by_kernels: Option<(Arc<Posture>, Wrench, BatchEquilibrium)>,
    whole: OnceLock<MechanismEquilibrium>,
}

impl Equilibrium {
    pub(crate) fn of(whole: MechanismEquilibrium) -> Self {
        Self {
            by_kernels: None,
            whole: OnceLock::from(whole),
        }
    }

    pub(crate) fn by_kernels(at: &Arc<Posture>, wrench: Wrench, found: BatchEquilibrium) -> Self {
        Self {
            by_kernels: Some((at.clone(), wrench, found)),
            whole: OnceLock::new(),
        }
    }

    pub(crate) fn whole(&self) -> PyResult<&MechanismEquilibrium> {
        match (self.whole.get(), &self.by_kernels) {
            (None, Some((posture, wrench, _))) => {
                let found = posture.deflected_by(wrench).map_err(|e| of_core(&e))?;
                Ok(self.whole.get_or_init(|| found))
            }
            (found, _) => found.ok_or_else(|| error(Class::Unanswered, "there is no equilibrium")),
        }
    }

    /// Stability, stiffness against a force, share to buckling.
    fn stability(&self) -> PyResult<(bool, f64, Option<f64>)> {
        let quick = self.by_kernels.as_ref();
        if let Some(s) = quick.and_then(|(_, _, found)| found.stability(0)) {
            return Ok((s.stable, s.stiffness_against_force, s.share_to_buckling));
        }
        let s = self.whole()?;
        let share = s.share_to_buckling();
        Ok((s.stable(), s.stiffness_against_force(), share))
    }

    /// Pose of the tool, the motion to it from the commanded pose, and the wrench.
    pub(crate) fn moved(&self) -> PyResult<(Pose, Twist, Wrench)> {
        if let Some((posture, wrench, found)) = &self.by_kernels {
            let tool = found.tool_pose(0);
            return Ok((tool, pose_residual(&tool, posture.target()), *wrench));
        }
        let found = self.whole()?;
        Ok((found.tool, found.displacement, found.wrench))
    }
}

#[pymethods]
impl Equilibrium {
    /// Pose of the tool, (4, 4).
    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, matrix_of(&self.moved()?.0), [4, 4])
    }

    /// (6,): from the commanded pose to that under load, m and rad, base axes.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.moved()?.1.0.as_slice()))
    }

    /// (6,): N and N m on the tool, base axes, about its reference point.
    #[getter]
    fn wrench<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.moved()?.2.0.as_slice()))
    }

    /// (6, 6): tangent stiffness; NaN along what is rigid.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if let Some((_, _, found)) = &self.by_kernels {
            return array(py, found.stiffness.row(0).collect(), [6, 6]);
        }
        let whole = self.whole()?;
        let entries = whole.stiffness.finite_entries(&whole.directions);
        array(py, rows_of(&entries), [6, 6])
    }

    /// (6, 6) within the directions that are neither free nor rigid.
    #[getter]
    fn compliance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, rows_of(&self.whole()?.compliance().springs), [6, 6])
    }

    /// Forces (N) and torques (N m) of the loads on the actuators.
    #[getter]
    fn actuator_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let forces = match &self.by_kernels {
            Some((_, _, found)) => found.actuator_forces.row(0).collect(),
            None => self.whole()?.actuator_forces(),
        };
        Ok(PyArray1::from_vec(py, forces))
    }

    #[getter]
    fn stable(&self) -> PyResult<bool> {
        Ok(self.stability()?.0)
    }

    /// Largest share of the way to buckling of all limbs; `None` if nothing buckles.
    #[getter]
    fn share_to_buckling(&self) -> PyResult<Option<f64>> {
        Ok(self.stability()?.2)
    }

    /// N/m in the softest direction of a force while the tool may turn.
    #[getter]
    fn against_force(&self) -> PyResult<f64> {
        Ok(self.stability()?.1)
    }

    /// Potential of springs, weights and loads on limbs, J, up to a constant; None if a load has no potential.
    #[getter]
    fn energy(&self) -> PyResult<Option<f64>> {
        Ok(self.whole()?.energy)
    }

    /// Energy of all springs, J.
    #[getter]
    fn spring_energy(&self) -> PyResult<f64> {
        Ok(CurveEquilibrium::spring_energy(self.whole()?))
    }

    fn found_by_json(&self) -> PyResult<String> {
        json_of(&self.whole()?.found_by)
    }

    /// Principal directions as JSON.
    fn directions_json(&self) -> PyResult<String> {
        json_of(&self.whole()?.directions)
    }

    fn __repr__(&self) -> PyResult<String> {
        let moved = self.moved()?.1.linear().norm();
        let held = if self.stable()? { "" } else { "NOT " };
        Ok(format!(
            "<Equilibrium: tool moved by {moved:.4e} m, {held}stable>"
        ))
    }
}
