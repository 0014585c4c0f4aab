//! Forces of the cut along the program of a job.

use kinetostat_machining::{
    CutFailure, CutFinding, CutFindingKind, ExpectedForce, ForceAlongPath, MeasuredReport, Warning,
    WarningCode, Watch,
};
use kinetostat_program::Path as ToolPath;

use crate::job::cut::measured::MeasuredSetup;
use crate::job::cut::question::CutSetup;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Code, Failure};

/// The forces along a program, where the job asks for them.
pub(crate) fn forces(
    cut: Option<&CutSetup>,
    setting: &Setting,
    path: &ToolPath,
    watch: &dyn Watch,
) -> Answer<Option<ForceAlongPath>> {
    let Some(cut) = cut else {
        return Ok(None);
    };
    let along = cut.question.along(path, watch);
    along
        .map(Some)
        .map_err(|failure| stopped_or_within(failure, setting))
}

/// Measured forces along the program.
pub(crate) fn measured(
    setup: &MeasuredSetup,
    setting: &Setting,
    path: &ToolPath,
    watch: &dyn Watch,
) -> Answer<ForceAlongPath> {
    let along = setup.forces.along(path, ExpectedForce::InFeedMoves, watch);
    along.map_err(|failure| match failure {
        CutFailure::Log { .. } => Failure::input(failure).within(&setup.name),
        _ => stopped_or_within(failure, setting),
    })
}

/// Converts a missing cutting force into a failure of the command.
pub(crate) fn stopped_or_within(failure: CutFailure, setting: &Setting) -> Failure {
    match failure {
        CutFailure::Cancelled => Failure::new(Code::Stopped, failure),
        _ => setting.within(Failure::input(failure)),
    }
}

/// A cut that the tool does not survive: chips beyond its limit, material behind the ends of its edges. A program with one is
/// not compensated.
fn breaks_the_tool(forces: Option<&ForceAlongPath>) -> Option<&CutFinding> {
    let mut found = forces.into_iter().flat_map(|forces| &forces.findings);
    found.find(|finding| {
        matches!(
            finding.kind,
            CutFindingKind::ThickChip | CutFindingKind::ShortEdges
        )
    })
}

/// Refuses it, with the worst line.
pub(crate) fn refuse_what_breaks_the_tool(
    forces: Option<&ForceAlongPath>,
    setting: &Setting,
) -> Answer<()> {
    let Some(found) = breaks_the_tool(forces) else {
        return Ok(());
    };
    let help = match found.kind {
        CutFindingKind::ShortEdges => "cut less deep, or correct the lengths of the tool",
        _ => "write a smaller feed or a higher speed, or correct the tool",
    };
    let what = format!("line {}: {}; {help}", found.line, text_of(found));
    Err(setting.within(Failure::input(what)))
}

/// Text of the worst line, with the number of lines.
fn text_of(finding: &CutFinding) -> String {
    match finding.lines {
        0 | 1 => finding.text.clone(),
        n => format!("{} (the worst of {n} lines)", finding.text),
    }
}

/// Warnings about cuts.
pub(crate) fn warnings(forces: Option<&ForceAlongPath>) -> Vec<Warning> {
    let log = forces.and_then(|forces| forces.measured.as_ref());
    let of_moves = warnings_of_moves(forces);
    log.into_iter().flat_map(of_log).chain(of_moves).collect()
}

/// Warnings that name lines of the program.
pub(crate) fn warnings_of_moves(forces: Option<&ForceAlongPath>) -> Vec<Warning> {
    let found = forces.iter().flat_map(|forces| &forces.findings);
    found
        .map(|finding| Warning::at_line(code(finding.kind), finding.line, text_of(finding)))
        .collect()
}

/// Warnings about a log as a whole.
fn of_log(report: &MeasuredReport) -> Vec<Warning> {
    let done = &report.conditioning;
    let unit = done.by.unit();
    let outliers = done.worst().map(|worst| {
        let text = match done.outlier_count {
            1 => format!("the log of the forces has an outlier: {worst}"),
            n => format!("the log of the forces has {n} outliers; the worst: {worst}"),
        };
        Warning::new(WarningCode::OutliersInLog, text)
    });
    let gap = report.gap().map(|[at, length]| {
        let text = format!(
            "the log of the forces has no rows for {length:.4} {unit} from {at:.4} {unit} on: the force is taken to be a straight line there"
        );
        Warning::new(WarningCode::GapInLog, text)
    });
    outliers.into_iter().chain(gap).collect()
}

/// The word for programs that read the JSON.
fn code(kind: CutFindingKind) -> WarningCode {
    match kind {
        CutFindingKind::RapidThroughStock => WarningCode::RapidThroughStock,
        CutFindingKind::ThickChip => WarningCode::ChipOverLimit,
        CutFindingKind::OutsideTheLaw => WarningCode::ChipsOutsideMeasured,
        CutFindingKind::Spindle => WarningCode::SpindleExceeded,
        CutFindingKind::ShortEdges | CutFindingKind::DeepCut => WarningCode::ToolTooShort,
        CutFindingKind::LinesWithoutCut => WarningCode::LoadNeverActs,
        CutFindingKind::Plunge => WarningCode::Plunge,
        CutFindingKind::EndBeyondTheLaw => WarningCode::ChipsOutsideMeasured,
        CutFindingKind::NothingCut => WarningCode::LoadNeverActs,
        CutFindingKind::ThinFeed | CutFindingKind::BelowTheStock | CutFindingKind::LeftHandTool => {
            WarningCode::ImplausibleCut
        }
        CutFindingKind::NotMeasured => WarningCode::NotMeasured,
        CutFindingKind::ForceInRapid => WarningCode::ForceInRapid,
        CutFindingKind::TimeUnknown => WarningCode::TimeUnknown,
        // Kinds that this program does not know have no word of their own yet.
        _ => WarningCode::Program,
    }
}
