//! Warnings about machines, postures and loads that Python holds.

use kinetostat::Wrench;
use kinetostat::nalgebra::Vector3;
use pyo3::prelude::*;

use crate::equilibrium::Equilibrium;
use crate::machine::Machine;
use crate::plausibility::{Said, of_figures, of_tool};
use crate::posture::Posture;

/// Warnings about the tool of a machine.
#[pyfunction]
pub fn tool_warnings(machine: &Machine) -> Vec<Said> {
    let vector = machine.tool.translation.vector;
    // Lengths of straight tools have a sign.
    let length = match vector.xy().norm() == 0.0 {
        true => vector.z,
        false => vector.norm(),
    };
    of_tool(&machine.mechanism, length)
}

/// Warnings about many answers, by the largest force (N), moment (N m) and displacement (m) among them.
#[pyfunction]
pub fn answer_warnings(machine: &Machine, force: f64, moment: f64, displacement: f64) -> Vec<Said> {
    let wrench = Wrench::new(Vector3::x() * force, Vector3::x() * moment);
    of_figures(&machine.mechanism, &wrench, displacement)
}

/// Warnings about the load on the tool and the displacement from a posture.
#[pyfunction]
pub fn load_warnings(posture: &Posture, loaded: &Equilibrium) -> PyResult<Vec<Said>> {
    let (_, moved, wrench) = loaded.moved()?;
    let mechanism = posture.0.mechanism();
    Ok(of_figures(mechanism, &wrench, moved.linear().norm()))
}
