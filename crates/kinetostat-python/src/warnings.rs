//! What looks wrong in machines, postures and loads that Python holds.

use pyo3::prelude::*;

use crate::equilibrium::Equilibrium;
use crate::machine::Machine;
use crate::plausibility::{Said, of_load, of_tool};
use crate::posture::Posture;

/// What looks wrong in the tool of a machine.
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

/// What looks wrong in the load on the tool and in the displacement from a posture.
#[pyfunction]
pub fn load_warnings(posture: &Posture, loaded: &Equilibrium) -> Vec<Said> {
    of_load(&posture.0, &loaded.0)
}
