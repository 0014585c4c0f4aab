//! Forces that a job has measured.

use kinetostat_cutting::{ForceLog, LoggedBy};
use kinetostat_machining::{MeasuredForces, Placement};
use serde_spanned::Spanned;

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::twice::{MEASURED, not_typed_too};
use crate::job::cut_tables::MeasuredTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

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
    let log = ForceLog::read(&name, &with_decimal_points(&text)).map_err(Failure::input)?;
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
