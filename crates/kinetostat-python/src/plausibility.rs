//! What looks wrong in a question although it can be answered: the checks of the commands, for typed calls.

use kinetostat::{Mechanism, MechanismEquilibrium, Posture};
use kinetostat_machining::{
    Limits, Warning, WarningCode, folds, odd_correction, odd_tool_length, unusual_load,
};

/// Whether somebody has to hear of it, and what was found.
pub type Said = (bool, String);

/// What a program would be refused for is heard; what is unusual is written down.
fn said(warning: Warning) -> Said {
    let heard = [WarningCode::OverLimit, WarningCode::LargeDisplacement];
    (heard.contains(&warning.code), warning.message)
}

/// What looks wrong in the load on the tool and in the displacement from a posture.
pub fn of_load(posture: &Posture, loaded: &MechanismEquilibrium) -> Vec<Said> {
    let far = loaded.displacement.linear().norm();
    let folded = folds(far, posture.mechanism().size());
    let all = unusual_load(&loaded.wrench).into_iter().chain(folded);
    all.map(said).collect()
}

/// What looks wrong in the tool of a machine, by its length, m.
pub fn of_tool(mechanism: &Mechanism, length: f64) -> Vec<Said> {
    let found = odd_tool_length(mechanism, 1e3 * length);
    found.into_iter().map(said).collect()
}

/// What looks wrong in corrections of a program of up to so many m, with a tolerance, m.
pub fn of_corrections(largest: f64, tolerance: f64) -> Vec<Said> {
    let limits = Limits::default();
    let mm = 1e3 * largest;
    let found = odd_correction(&limits, mm, None, 1e3 * tolerance);
    let beyond = mm > limits.correction_mm;
    found.map(|w| (beyond, w.message)).into_iter().collect()
}
