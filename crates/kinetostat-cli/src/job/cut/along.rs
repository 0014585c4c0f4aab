//! Forces of the cut along the program of a job.

use kinetostat_machining::{CutFailure, ForceAlongPath, Warning, WarningCode, Watch};
use kinetostat_program::Path as ToolPath;

use crate::job::cut::question::CutSetup;
use crate::ui::failure::{Answer, Code, Failure};

/// The forces along a program, where the job asks for them.
pub(crate) fn forces(
    cut: Option<&CutSetup>,
    program: &str,
    path: &ToolPath,
    watch: &dyn Watch,
) -> Answer<Option<ForceAlongPath>> {
    let Some(cut) = cut else {
        return Ok(None);
    };
    let along = cut.question.along(path, watch);
    along.map(Some).map_err(|failure| match failure {
        CutFailure::Cancelled => Failure::new(Code::Stopped, failure),
        _ => Failure::input(failure).within(program),
    })
}

/// What no such cut should be, as warnings.
pub(crate) fn warnings(forces: Option<&ForceAlongPath>) -> Vec<Warning> {
    let found = forces.iter().flat_map(|forces| &forces.findings);
    found
        .map(|finding| {
            let more = match finding.lines {
                0 | 1 => String::new(),
                n => format!(" (the worst of {n} lines)"),
            };
            let text = format!("{}{more}", finding.text);
            Warning::at_line(WarningCode::Cut, finding.line, text)
        })
        .collect()
}
