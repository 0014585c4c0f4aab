//! What looks wrong in a question although it can be answered: the checks of the commands, for typed calls.

use kinetostat::{Mechanism, Wrench};
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

/// What looks wrong in a load on the tool, and in how far it moves a tool of a machine of such a size, m.
pub fn of_load(wrench: &Wrench, moved: f64, size: f64) -> Vec<Said> {
    let all = unusual_load(wrench).into_iter().chain(folds(moved, size));
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
