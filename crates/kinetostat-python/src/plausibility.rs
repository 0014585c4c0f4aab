//! What looks wrong in a question although it can be answered: the checks of the commands, for typed calls.

use kinetostat_machining::{
    Limits, Warning, WarningCode, folds, odd_correction, odd_tool_length, unusual_load,
};
use pyo3::prelude::*;

use crate::equilibrium::Equilibrium;
use crate::machine::Machine;
use crate::posture::Posture;

/// Whether somebody has to hear of it, and what was found.
pub type Said = (bool, String);

/// What a program would be refused for is heard; what is unusual is written down.
fn said(warning: Warning) -> Said {
    let heard = [WarningCode::OverLimit, WarningCode::LargeDisplacement];
    (heard.contains(&warning.code), warning.message)
}

/// What looks wrong in the tool of a machine.
#[pyfunction]
pub fn tool_warnings(machine: &Machine) -> Vec<Said> {
    let vector = machine.tool.translation.vector;
    // Lengths of straight tools have a sign.
    let length = match vector.xy().norm() == 0.0 {
        true => vector.z,
        false => vector.norm(),
    };
    let found = odd_tool_length(&machine.mechanism, 1e3 * length);
    found.into_iter().map(said).collect()
}

/// What looks wrong in the load on the tool and in the displacement from a posture.
#[pyfunction]
pub fn load_warnings(posture: &Posture, loaded: &Equilibrium) -> Vec<Said> {
    let far = loaded.0.displacement.linear().norm();
    let folded = folds(far, posture.0.mechanism().size());
    let all = unusual_load(&loaded.0.wrench).into_iter().chain(folded);
    all.map(said).collect()
}

/// What looks wrong in corrections of a program of up to so many m, with a tolerance, m.
pub fn of_corrections(largest: f64, tolerance: f64) -> Vec<Said> {
    let limits = Limits::default();
    let mm = 1e3 * largest;
    let found = odd_correction(&limits, mm, None, 1e3 * tolerance);
    let beyond = mm > limits.correction_mm;
    found.map(|w| (beyond, w.message)).into_iter().collect()
}
