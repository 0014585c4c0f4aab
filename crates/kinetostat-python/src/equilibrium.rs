//! An equilibrium under load.

use kinetostat::MechanismEquilibrium;
use kinetostat::continuation::CurveEquilibrium;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{array, matrix_of, rows_of};
use crate::stiffness::json_of;

/// Equilibrium of a machine under a wrench on its tool.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Equilibrium(pub(crate) MechanismEquilibrium);

#[pymethods]
impl Equilibrium {
    /// Pose of the tool, (4, 4).
    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, matrix_of(&self.0.tool), [4, 4])
    }

    /// (6,): from the commanded pose to that under load, m and rad, base axes.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.displacement.0.as_slice())
    }

    /// (6,): N and N m on the tool, base axes, about its reference point.
    #[getter]
    fn wrench<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.wrench.0.as_slice())
    }

    /// (6, 6): tangent stiffness; NaN along what is rigid.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let entries = self.0.stiffness.finite_entries(&self.0.directions);
        array(py, rows_of(&entries), [6, 6])
    }

    /// (6, 6) within the directions that are neither free nor rigid.
    #[getter]
    fn compliance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, rows_of(&self.0.compliance().springs), [6, 6])
    }

    /// Forces (N) and torques (N m) of the loads on the actuators.
    #[getter]
    fn actuator_forces<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.actuator_forces())
    }

    #[getter]
    fn stable(&self) -> bool {
        self.0.stable()
    }

    /// Largest share of the way to buckling of all limbs; none where nothing buckles.
    #[getter]
    fn share_to_buckling(&self) -> Option<f64> {
        self.0.share_to_buckling()
    }

    /// N/m in the softest direction of a force while the tool may turn.
    #[getter]
    fn against_force(&self) -> f64 {
        self.0.stiffness_against_force()
    }

    /// Of springs, weights and loads on limbs, J, up to a constant; none where a load has no potential.
    #[getter]
    fn energy(&self) -> Option<f64> {
        self.0.energy
    }

    /// In all springs, J.
    #[getter]
    fn spring_energy(&self) -> f64 {
        CurveEquilibrium::spring_energy(&self.0)
    }

    fn found_by_json(&self) -> PyResult<String> {
        json_of(&self.0.found_by)
    }

    /// Principal directions as JSON.
    fn directions_json(&self) -> PyResult<String> {
        json_of(&self.0.directions)
    }

    fn __repr__(&self) -> String {
        let moved = self.0.displacement.linear().norm();
        format!(
            "<Equilibrium: tool moved by {:.4e} m, {}>",
            moved,
            if self.0.stable() {
                "stable"
            } else {
                "NOT stable"
            }
        )
    }
}
