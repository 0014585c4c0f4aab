//! Forces of the cut along the program of a job.

use kinetostat_machining::{
    CutFailure, CutFindingKind, ForceAlongPath, Warning, WarningCode, Watch,
};
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
    along
        .map(Some)
        .map_err(|failure| stopped_or_within(failure, program))
}

/// Why a program has no cutting force, as a failure of the command.
pub(crate) fn stopped_or_within(failure: CutFailure, program: &str) -> Failure {
    match failure {
        CutFailure::Cancelled => Failure::new(Code::Stopped, failure),
        _ => Failure::input(failure).within(program),
    }
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
            Warning::at_line(code(finding.kind), finding.line, text)
        })
        .collect()
}

/// The word for programs that read the JSON.
fn code(kind: CutFindingKind) -> WarningCode {
    match kind {
        CutFindingKind::RapidThroughStock => WarningCode::RapidThroughStock,
        CutFindingKind::ThickChip => WarningCode::ChipOverLimit,
        CutFindingKind::OutsideTheLaw => WarningCode::ChipsOutsideMeasured,
        CutFindingKind::Spindle => WarningCode::SpindleExceeded,
        CutFindingKind::ShortEdges => WarningCode::ToolTooShort,
        CutFindingKind::LinesWithoutCut => WarningCode::LoadNeverActs,
        CutFindingKind::Plunge => WarningCode::Plunge,
        // Kinds that this program does not know have no word of their own yet.
        _ => WarningCode::Program,
    }
}
