//! Cartesian stiffness of an unloaded posture.

use kinetostat::machine::UnloadedStiffness;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::{array, rows_of};
use crate::errors::{Class, error, of_core};

/// Stiffness of an unloaded posture.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Stiffness(pub(crate) UnloadedStiffness);

impl Stiffness {
    pub(crate) fn of(posture: &kinetostat::Posture) -> PyResult<Self> {
        posture.stiffness().map(Self).map_err(|e| of_core(&e))
    }
}

/// Something of the core as JSON, which the Python package reads.
pub fn json_of(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|e| error(Class::Argument, e.to_string()))
}

#[pymethods]
impl Stiffness {
    /// (6, 6): N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point; NaN along what is rigid.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let entries = self.0.cartesian.finite_entries(&self.0.directions);
        array(py, rows_of(&entries), [6, 6])
    }

    /// (6, 6) within the directions that are neither free nor rigid.
    #[getter]
    fn compliance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, rows_of(&self.0.compliance().springs), [6, 6])
    }

    #[getter]
    fn rank(&self) -> usize {
        self.0.rank()
    }

    /// N/m in the softest direction of a force while the tool may turn; 0 where a direction is free.
    #[getter]
    fn against_force(&self) -> f64 {
        self.0.stiffness_against_force()
    }

    /// Principal directions as JSON.
    fn directions_json(&self) -> PyResult<String> {
        json_of(&self.0.directions)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Stiffness of rank {}, softest against a force {:.4e} N/m>",
            self.0.rank(),
            self.0.stiffness_against_force()
        )
    }
}
