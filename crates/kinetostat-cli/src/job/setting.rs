//! From a job file and options to everything that decides a run: options go over the job file.

use std::path::{Path, PathBuf};

use kinetostat_machining::{FileRead, Limits, Warning, WarningCode};
use kinetostat_program::{BlockDelete, OtherAxes, ReadOptions, Units, WriteOptions};
use nalgebra::Vector3;
use serde_spanned::Spanned;

use crate::command_line::ProgramArgs;
use crate::files::input::Files;
use crate::files::origin;
use crate::files::output::inside;
use crate::job::format::{BlockDeleteWord, Job, UnitsWord};
use crate::job::limits::limits;
use crate::job::source::Source;
use crate::ui::failure::{Answer, Failure};

/// A job file that has been read: its text is kept for messages.
#[derive(Clone, Debug)]
pub(crate) struct JobFile {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
    pub(crate) job: Job,
}

impl JobFile {
    pub(crate) fn read(files: &Files, path: &Path) -> Answer<Self> {
        let text = files.job(path)?;
        let name = path.display().to_string();
        let job = Job::read(Source {
            file: &name,
            text: &text,
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
            job,
        })
    }

    /// Angles in it that were most likely written in the other unit.
    pub(crate) fn odd_angles(&self) -> impl Iterator<Item = Warning> + '_ {
        let line = |at: usize| 1 + self.text[..at].matches('\n').count();
        let found = kinetostat_model::odd_angles(&self.text).into_iter();
        found.map(move |(span, message)| {
            let line = line(span.start);
            Warning::at_line(WarningCode::OddPlacement, line, message)
                .of_file(self.path.display().to_string())
        })
    }

    /// Directory that the job's relative paths start from.
    pub(crate) fn base(&self) -> PathBuf {
        self.path.parent().map(Path::to_owned).unwrap_or_default()
    }

    pub(crate) fn error<T>(&self, at: &Spanned<T>, message: &str, help: &str) -> Failure {
        Source {
            file: &self.path.display().to_string(),
            text: &self.text,
        }
        .error(at.span(), message, help)
    }
}

/// Outputs of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Targets {
    pub(crate) program: Option<PathBuf>,
    pub(crate) report: Option<PathBuf>,
    pub(crate) json: Option<PathBuf>,
    pub(crate) points: Option<PathBuf>,
}

impl Targets {
    /// Those that are asked for, with what they are.
    pub(crate) fn named(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        [
            ("compensated program", &self.program),
            ("report", &self.report),
            ("result", &self.json),
            ("table of points", &self.points),
        ]
        .into_iter()
        .filter_map(|(what, path)| Some((what, path.as_deref()?)))
    }
}

/// Everything that decides a run along a program, the model apart.
pub(crate) struct Setting {
    pub(crate) program: Vec<u8>,
    pub(crate) program_name: String,
    pub(crate) program_file: FileRead,
    pub(crate) job_file: Option<FileRead>,
    pub(crate) reading: ReadOptions,
    pub(crate) writing: WriteOptions,
    pub(crate) max_blocks_per_second: Option<f64>,
    /// What refuses a program.
    pub(crate) limits: Limits,
    /// Whether the tolerances of path and chords were stated.
    pub(crate) stated: [bool; 2],
    pub(crate) targets: Targets,
    /// Files that were read: never overwritten.
    pub(crate) inputs: Vec<PathBuf>,
}

/// Options that only the writing needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WritingFlags<'a> {
    pub(crate) tolerance_um: Option<f64>,
    pub(crate) decimals: Option<u8>,
    pub(crate) max_blocks_per_second: Option<f64>,
    pub(crate) max_feed_factor: Option<f64>,
    pub(crate) backward_step_um: Option<f64>,
    pub(crate) no_header: bool,
    pub(crate) again: bool,
    pub(crate) out: Option<&'a Path>,
    pub(crate) json: Option<&'a Path>,
}

/// Reads the program and everything said about it.
pub(crate) fn setting(
    files: &Files,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
) -> Answer<Setting> {
    let mut inputs: Vec<PathBuf> = job.iter().map(|j| j.path.clone()).collect();
    let path = match (&flags.program, job.and_then(|j| j.job.program.as_ref())) {
        (Some(path), _) => path.clone(),
        (None, Some(written)) => job
            .map(JobFile::base)
            .unwrap_or_default()
            .join(written.get_ref()),
        (None, None) => {
            return Err(Failure::input(match job {
                Some(j) => format!(
                    "the job file '{}' names no program; write  program = \"part.ngc\"  at its top, or give --program FILE",
                    j.path.display()
                ),
                None => "no program is named; give a job file, or --program FILE".to_owned(),
            }));
        }
    };
    inputs.push(path.clone());
    let reading = reading(job, flags)?;
    let limits = limits(job, &flags.limits)?;
    let tolerances = job.map(|j| j.job.tolerances.clone()).unwrap_or_default();
    let mut write = WriteOptions {
        again: writing.again,
        ..WriteOptions::default()
    };
    let path_mm = chosen(
        job,
        ("--tolerance-um", writing.tolerance_um),
        tolerances.path_um.as_ref(),
        micrometres,
    )?;
    let chord_mm = chosen(
        job,
        ("--chord-tolerance-um", flags.chord_tolerance_um),
        tolerances.chord_um.as_ref(),
        micrometres,
    )?;
    write.tolerance_mm = path_mm.unwrap_or(write.tolerance_mm);
    write.chord_tolerance_mm = chord_mm.unwrap_or(write.chord_tolerance_mm);
    if let Some(factor) = chosen(
        job,
        ("--max-feed-factor", writing.max_feed_factor),
        tolerances.max_feed_factor.as_ref(),
        |factor| match (1.0..=1000.0).contains(&factor) {
            true => Ok(factor),
            false => Err("1 (never above the programmed feed) to 1000 are allowed"),
        },
    )? {
        write.max_feed_factor = factor;
    }
    if let Some(mm) = chosen(
        job,
        ("--backward-step-um", writing.backward_step_um),
        tolerances.backward_step_um.as_ref(),
        micrometres,
    )? {
        write.backward_step_mm = mm;
    }
    write.decimals = chosen(
        job,
        ("--decimals", writing.decimals),
        tolerances.decimals.as_ref(),
        |decimals| {
            if (3..=8).contains(&decimals) {
                Ok(decimals)
            } else {
                Err("3 to 8 decimals can be written; 4 keep the rounding below 0.1 micrometres")
            }
        },
    )?;
    let header = job.and_then(|j| j.job.output.header).unwrap_or(true);
    write.header = (header && !writing.no_header).then(Vec::new);
    let max_blocks_per_second = chosen(
        job,
        ("--max-blocks-per-second", writing.max_blocks_per_second),
        tolerances.max_blocks_per_second.as_ref(),
        above_zero,
    )?;
    let program_name = path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    );
    let targets = targets(job, flags, writing, &path)?;
    // The last, so that nothing else is hidden by a program that is not there.
    let program = files.bytes("program", &path)?;
    Ok(Setting {
        program_file: origin::file("program", &path, &program),
        job_file: job.map(|j| origin::file("job", &j.path, j.text.as_bytes())),
        program,
        program_name,
        reading,
        writing: write,
        max_blocks_per_second,
        limits,
        stated: [path_mm.is_some(), chord_mm.is_some()],
        targets,
        inputs,
    })
}

fn targets(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
    program: &Path,
) -> Answer<Targets> {
    let from_job = |flag: Option<&Path>, pick: fn(&Job) -> Option<&Spanned<String>>| {
        if let Some(path) = flag {
            return Ok(Some(path.to_owned()));
        }
        let Some(j) = job else { return Ok(None) };
        let Some(written) = pick(&j.job) else {
            return Ok(None);
        };
        let base = j.base();
        let root = if base.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &base
        };
        inside(root, written.get_ref())
            .map(|_| Some(base.join(written.get_ref())))
            .map_err(|help| {
                j.error(
                    written,
                    &format!(
                        "the output '{}' is outside the job's directory",
                        written.get_ref()
                    ),
                    &help,
                )
            })
    };
    let mut targets = Targets {
        program: from_job(writing.out, |j| j.output.program.as_ref())?,
        report: from_job(flags.report.as_deref(), |j| j.output.report.as_ref())?,
        json: from_job(writing.json.filter(|p| *p != Path::new("-")), |j| {
            j.output.json.as_ref()
        })?,
        points: from_job(flags.points.as_deref(), |j| j.output.points.as_ref())?,
    };
    if targets.program.is_none() {
        targets.program = Some(beside(job.map_or(program, |j| &j.path), program));
    }
    Ok(targets)
}

/// `part.ngc` becomes `part-compensated.ngc` in the directory of `near`.
fn beside(near: &Path, program: &Path) -> PathBuf {
    // A disk has names that are no text: they stay what they are.
    let mut name = program.file_stem().unwrap_or_default().to_owned();
    name.push("-compensated");
    if let Some(extension) = program.extension() {
        name.push(".");
        name.push(extension);
    }
    near.with_file_name(name)
}

/// The value of an option, or else of the job file, if it is allowed; a refusal shows where it was
/// given.
pub(crate) fn chosen<T: Copy + std::fmt::Display, U>(
    job: Option<&JobFile>,
    (flag, given): (&str, Option<T>),
    written: Option<&Spanned<T>>,
    allowed: impl Fn(T) -> Result<U, &'static str>,
) -> Answer<Option<U>> {
    if let Some(value) = given {
        return allowed(value)
            .map(Some)
            .map_err(|reason| Failure::input(format!("{flag} is {value}: {reason}")));
    }
    match (job, written) {
        (Some(j), Some(value)) => allowed(*value.get_ref()).map(Some).map_err(|reason| {
            j.error(
                value,
                &format!("the value {} is not allowed here", value.get_ref()),
                reason,
            )
        }),
        _ => Ok(None),
    }
}

pub(crate) fn above_zero(value: f64) -> Result<f64, &'static str> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err("a number above zero is needed")
    }
}

/// Programs are drawn larger or smaller, in inches for millimetres at most (25.4), or in metres (1000).
pub(crate) fn scale_of_program(value: f64) -> Result<f64, &'static str> {
    match (1e-3..=1e3).contains(&value) {
        true => Ok(value),
        false => Err(
            "a number from 0.001 to 1000 is needed: the machine's length for one of the program",
        ),
    }
}

/// How far the radii at both ends of an arc may differ: controllers allow 0.001 to 0.1 mm as they come, and are
/// rarely set to more than 1 mm. A centre that is farther off is another arc, and would be cut as it stands.
fn arc_tolerance(value: f64) -> Result<f64, &'static str> {
    match (1e-6..=ARC_TOLERANCE_MM).contains(&value) {
        true => Ok(value),
        false => Err(
            "0.000001 to 2 mm are allowed: controllers take arcs whose radii at both ends differ by 0.001 to 0.1 mm, and refuse others",
        ),
    }
}

/// Above what any controller allows, and below what a wrong centre word makes.
const ARC_TOLERANCE_MM: f64 = 2.0;

fn micrometres(value: f64) -> Result<f64, &'static str> {
    if (1e-3..=1e4).contains(&value) {
        Ok(1e-3 * value)
    } else {
        Err("a tolerance is 0.001 to 10000 micrometres")
    }
}

pub(crate) fn finite(name: &str, values: &[f64]) -> Answer<()> {
    match values.iter().find(|v| !v.is_finite()) {
        Some(v) => Err(Failure::input(format!(
            "{name} holds {v}: finite numbers are needed"
        ))),
        None => Ok(()),
    }
}

/// Three numbers of an option.
pub(crate) fn vector(name: &str, values: &[f64]) -> Answer<Vector3<f64>> {
    finite(name, values)?;
    match values {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(Failure::input(format!("{name} needs three numbers"))),
    }
}

fn reading(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<ReadOptions> {
    let table = job.map(|j| j.job.reading.clone()).unwrap_or_default();
    let mut reading = ReadOptions {
        units: flags.units.or(table.units).map(|u| match u {
            UnitsWord::Mm => Units::Millimetres,
            UnitsWord::Inch => Units::Inches,
        }),
        ..ReadOptions::default()
    };
    if let Some(mm) = chosen(
        job,
        ("--arc-tolerance", flags.arc_tolerance),
        table.arc_tolerance_mm.as_ref(),
        arc_tolerance,
    )? {
        reading.arc_tolerance_mm = mm;
    }
    if let Some(word) = flags.block_delete.or(table.block_delete) {
        reading.block_delete = match word {
            BlockDeleteWord::Run => BlockDelete::Run,
            BlockDeleteWord::Skip => BlockDelete::Skip,
        };
    }
    if flags.axes_stand_still || table.axes_stand_still.unwrap_or_default() {
        reading.other_axes = OtherAxes::StandStill;
    }
    if let Some(j) = job.filter(|j| !j.job.tools.is_empty()) {
        let numbers = j.job.tools.iter().map(|tool| tool.get_ref().number);
        reading.tools = Some(numbers.collect());
        reading.tool_before_first = j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some();
    }
    reading.start_position_mm = match (&flags.start_position_mm, table.start_position_mm) {
        (Some(v), _) => Some(vector("--start-position-mm", v)?),
        (None, Some(v)) => Some(v.into()),
        _ => None,
    };
    if let (Some(j), Some(offsets)) = (job, &table.work_offset_mm) {
        let mut given: Vec<usize> = Vec::new();
        for (name, value) in offsets.get_ref() {
            let index = work_offset(name).ok_or_else(|| {
                j.error(
                    offsets,
                    &format!("'{name}' is no work coordinate system"),
                    "there are G54, G55, G56, G57, G58, G59, \"G59.1\", \"G59.2\", \"G59.3\"",
                )
            })?;
            if given.contains(&index) {
                let what = format!("the origin of {} is given twice", WORK_OFFSETS[index]);
                return Err(j.error(offsets, &what, "keep one of the two"));
            }
            given.push(index);
            reading.work_offsets_mm[index] = Vector3::from(*value);
        }
    }
    let mut given: Vec<usize> = Vec::new();
    for text in &flags.work_offset {
        let refuse = || {
            Failure::input(format!(
                "--work-offset '{text}': write the coordinate system and its origin in the part in mm, as in G54=10,0,-5"
            ))
        };
        let (name, values) = text.split_once('=').ok_or_else(refuse)?;
        let index = work_offset(name.trim()).ok_or_else(refuse)?;
        if given.contains(&index) {
            return Err(Failure::input(format!(
                "--work-offset '{text}': the origin of {} is given twice; keep one of the two",
                WORK_OFFSETS[index]
            )));
        }
        given.push(index);
        let numbers: Vec<f64> = values
            .split(',')
            .map(|v| v.trim().parse().ok().filter(|x: &f64| x.is_finite()))
            .collect::<Option<_>>()
            .ok_or_else(refuse)?;
        let [x, y, z] = numbers[..] else {
            return Err(refuse());
        };
        reading.work_offsets_mm[index] = Vector3::new(x, y, z);
    }
    Ok(reading)
}

const WORK_OFFSETS: [&str; 9] = [
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

fn work_offset(name: &str) -> Option<usize> {
    WORK_OFFSETS
        .iter()
        .position(|known| known.eq_ignore_ascii_case(name))
}
