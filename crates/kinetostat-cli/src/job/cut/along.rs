//! Forces of the cut along the program of a job.

use kinetostat_cutting::{ForceLog, LoggedBy};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    CutFailure, CutFinding, CutFindingKind, ForceAlongPath, MeasuredForces, MeasuredReport,
    Placement, Warning, WarningCode, Watch,
};
use kinetostat_program::Path as ToolPath;
use serde_spanned::Spanned;

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::question::{CutSetup, MEASURED, not_typed_too};
use crate::job::cut_tables::MeasuredTable;
use crate::job::job_file::JobFile;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing, Failure};

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
    let along = setup.forces.along(path, watch);
    along.map_err(|failure| match failure {
        CutFailure::Log { .. } => ErrorCode::FileForm.failure(failure).within(&setup.name),
        _ => stopped_or_within(failure, setting),
    })
}

/// Converts a missing cutting force into a failure of the command.
pub(crate) fn stopped_or_within(failure: CutFailure, setting: &Setting) -> Failure {
    match failure {
        CutFailure::Cancelled => ErrorCode::Stopped.failure(failure),
        _ => setting.within(ErrorCode::ProgramUnsuited.failure(failure)),
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
    Err(setting.within(ErrorCode::ProgramUnsuited.failure(what)))
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

/// Measured forces of a job.
pub(crate) struct MeasuredSetup {
    pub(crate) forces: MeasuredForces,
    /// The log, for messages.
    pub(crate) name: String,
    pub(crate) files: FilesOfCut,
}

impl MeasuredSetup {
    /// Names of the log's files.
    pub(crate) fn words(&self) -> String {
        let names = self.files.read.iter().map(|file| file.name.clone());
        format!("log of forces: {}", names.collect::<String>())
    }
}

/// The measured forces of a job; `None` where it has none.
pub(crate) fn measured_setup(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    placement: &Placement,
) -> Answer<Option<MeasuredSetup>> {
    let Some((j, table)) = job.and_then(|j| j.job.measured.as_ref().map(|table| (j, table))) else {
        return Ok(None);
    };
    if j.job.material.is_some() {
        return Err(j.error(
            table,
            "the load is given twice: measured forces, and a material to compute them from",
            "keep [measured] or [material]",
        ));
    }
    not_typed_too(j, flags, table, &MEASURED)?;
    if placement.scale != 1.0 {
        return Err(j.error(
            table,
            "the program is scaled; what was measured along a program of another size has other places and times",
            "leave out the scale, or state the force under [load]",
        ));
    }
    let t = table.get_ref();
    within(
        j,
        t.rapid_mm_per_min.as_ref(),
        1e-3..=1e7,
        "a speed of rapids is 0.001 to 10000000 mm/min",
    )?;
    within(
        j,
        t.shift_s.as_ref(),
        -1e9..=1e9,
        "a shift is -1e9 to 1e9 s",
    )?;
    let mut read = FilesOfCut::default();
    let (text, name) = read.text(files, j, "log of forces", &t.file)?;
    let log = ForceLog::read(&name, &with_decimal_points(&text))
        .map_err(|error| ErrorCode::ProgramUnsuited.failure(error))?;
    drop(text);
    let (smooth, air) = by_its_columns(j, t, log.by())?;
    let mut forces = MeasuredForces::new(log, t.acts_on);
    forces.axes = t.axes;
    forces.shift_s = t.shift_s.as_ref().map(|shift| *shift.get_ref());
    forces.smooth = smooth;
    forces.air = air;
    forces.drift = t.drift;
    forces.outliers = t.outliers;
    forces.dwell_unit = t.dwell_unit.as_ref().map(|unit| *unit.get_ref());
    forces.rapid_mm_per_minute = t.rapid_mm_per_min.as_ref().map(|rate| *rate.get_ref());
    Ok(Some(MeasuredSetup {
        forces,
        name,
        files: read,
    }))
}

/// Window and stretches in air, in the units of the log.
fn by_its_columns(
    j: &JobFile,
    t: &MeasuredTable,
    by: LoggedBy,
) -> Answer<(Option<f64>, Vec<[f64; 2]>)> {
    let (smooth, air) = match by {
        LoggedBy::Time => {
            not_here(j, t.smooth_mm.as_ref(), by, "write smooth_s")?;
            not_here(j, t.air_mm.as_ref(), by, "write air_s")?;
            (&t.smooth_s, &t.air_s)
        }
        LoggedBy::AlongPath => {
            not_here(j, t.smooth_s.as_ref(), by, "write smooth_mm")?;
            not_here(j, t.air_s.as_ref(), by, "write air_mm")?;
            not_here(j, t.shift_s.as_ref(), by, "leave out the shift")?;
            not_here(
                j,
                t.rapid_mm_per_min.as_ref(),
                by,
                "leave out the speed of rapids",
            )?;
            not_here(j, t.dwell_unit.as_ref(), by, "leave out the unit of dwells")?;
            (&t.smooth_mm, &t.air_mm)
        }
    };
    within(
        j,
        smooth.as_ref(),
        0.0..=1e6,
        "a mean is taken over 0 to 1000000 s or mm; 0 takes none",
    )?;
    let air = air.as_ref().map(|air| air.get_ref().clone());
    Ok((
        smooth.as_ref().map(|smooth| *smooth.get_ref()),
        air.unwrap_or_default(),
    ))
}

/// A key that belongs to the other kind of log.
fn not_here<T>(j: &JobFile, key: Option<&Spanned<T>>, by: LoggedBy, help: &str) -> Answer<()> {
    match key {
        None => Ok(()),
        Some(key) => Err(j.error(
            key,
            &format!("the log is counted by its column {}", by.column()),
            help,
        )),
    }
}

fn within(
    j: &JobFile,
    value: Option<&Spanned<f64>>,
    bounds: std::ops::RangeInclusive<f64>,
    message: &str,
) -> Answer<()> {
    match value {
        Some(value) if !bounds.contains(value.get_ref()) => {
            Err(j.error(value, message, "correct the number"))
        }
        _ => Ok(()),
    }
}
