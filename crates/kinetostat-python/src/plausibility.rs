//! Warnings about questions that can be answered: the checks of the commands, for typed calls.

use kinetostat::{Mechanism, Wrench};
use kinetostat_machining::{
    Limits, Warning, WarningCode, folds, odd_correction, odd_tool_length, unusual_load,
};

/// A warning: true if it is issued, its kind (a constant sentence, by which Python merges repeated ones), and its message.
pub type Said = (bool, &'static str, String);

const LOAD: &str = "the load on the tool is beyond what machining has; check its unit (N, N m)";
const FOLDED: &str = "the machine folds over under this load; check the force and the stiffnesses";
const TOOL: &str = "no tool has such a length; check its unit (m)";
const CORRECTIONS: &str = "the corrections are larger than programs have; check their unit (m)";

/// Figures for which a program would be refused are issued; unusual ones are only part of the result.
fn said(warning: Warning, kind: &'static str) -> Said {
    match warning.code {
        WarningCode::LargeDisplacement => (true, FOLDED, warning.message),
        code => (code == WarningCode::OverLimit, kind, warning.message),
    }
}

/// Warnings about a wrench and a displacement of the tool, m.
pub fn of_figures(mechanism: &Mechanism, wrench: &Wrench, displacement: f64) -> Vec<Said> {
    let folded = folds(displacement, mechanism.size());
    let all = unusual_load(wrench).into_iter().chain(folded);
    all.map(|warning| said(warning, LOAD)).collect()
}

/// Warnings about the tool of a machine, by its length, m.
pub fn of_tool(mechanism: &Mechanism, length: f64) -> Vec<Said> {
    let found = odd_tool_length(mechanism, 1e3 * length);
    found
        .into_iter()
        .map(|warning| said(warning, TOOL))
        .collect()
}

/// Warnings about corrections of a program of up to so many m, with a tolerance, m.
pub fn of_corrections(largest: f64, tolerance: f64) -> Vec<Said> {
    let limits = Limits::default();
    let mm = 1e3 * largest;
    let found = odd_correction(&limits, mm, None, 1e3 * tolerance);
    let beyond = mm > limits.correction_mm;
    found
        .map(|w| (beyond, CORRECTIONS, w.message))
        .into_iter()
        .collect()
}
