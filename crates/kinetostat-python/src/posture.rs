//! A machine commanded for a target of its tool.

use std::sync::Arc;

use kinetostat_report::Placed;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{Numbers, array, matrix_of, one_pose};
use crate::equilibrium::Equilibrium;
use crate::errors::{of_core, require_stiffness};
use crate::stiffness::{Stiffness, json_of};

/// A machine whose actuators are commanded.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Posture(pub(crate) Arc<kinetostat::Posture>);

#[pymethods]
impl Posture {
    /// Commands of all actuators, m or rad.
    #[getter]
    fn commands<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.commands())
    }

    /// Nominal pose of the tool, (4, 4).
    #[getter]
    fn target<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, matrix_of(self.0.target()), [4, 4])
    }

    /// Actuators outside their limits: name, command, lower and upper limit (m or rad).
    #[getter]
    fn limit_violations(&self) -> Vec<(String, f64, f64, f64)> {
        let found = self.0.limit_violations().into_iter();
        found
            .map(|(name, at, (low, high))| (name, at, low, high))
            .collect()
    }

    /// Each limb as a line (n, 3) through its joints and the ends of its links; base axes, m.
    fn limb_lines<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let lines = Placed::at(&self.0).limb_lines(self.0.mechanism());
        let rows = lines.into_iter().map(|line| {
            let numbers: Vec<f64> = line.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
            array(py, numbers, [line.len(), 3])
        });
        rows.collect()
    }

    /// Commands of the actuators and all coordinates of every limb, m or rad.
    #[getter]
    fn limbs(&self) -> Vec<(Vec<f64>, Vec<f64>)> {
        let each = self.0.limbs().iter();
        each.map(|l| (l.commands.clone(), l.coordinates.clone()))
            .collect()
    }

    /// Cartesian stiffness of the unloaded machine as drawn.
    fn stiffness(&self) -> PyResult<Stiffness> {
        require_stiffness(self.0.mechanism())?;
        Stiffness::of(&self.0)
    }

    /// Stiffness of every limb as JSON, of a stiffness of this posture.
    fn limbs_of_stiffness(&self, found: &Stiffness) -> PyResult<String> {
        json_of(&found.0.limb_stiffnesses(&self.0))
    }

    /// Stiffness of every limb as JSON, of an equilibrium of this posture.
    fn limbs_of_equilibrium(&self, found: &Equilibrium) -> PyResult<String> {
        json_of(&found.whole()?.limb_stiffnesses(self.0.mechanism()))
    }

    /// Equilibrium with the tool held at a pose (4, 4): the wrench that holds it is part of the answer.
    fn held_at(&self, py: Python<'_>, target: Numbers<'_>) -> PyResult<Equilibrium> {
        let held = one_pose("pose", &target)?;
        require_stiffness(self.0.mechanism())?;
        let found = py.detach(|| self.0.wrench_at(&held));
        Ok(Equilibrium::of(found.map_err(|e| of_core(&e))?))
    }

    fn __repr__(&self) -> String {
        let at = self.0.target().translation.vector;
        format!(
            "<Posture of '{}', tool at [{:.6}, {:.6}, {:.6}] m{}>",
            self.0.mechanism().name(),
            at.x,
            at.y,
            at.z,
            match self.0.limit_violations().is_empty() {
                true => "",
                false => ", OUTSIDE_LIMITS",
            }
        )
    }
}
