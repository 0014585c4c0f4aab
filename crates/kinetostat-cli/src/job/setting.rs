//! Everything that decides a run, the machine apart: options go over the job file.

use std::path::PathBuf;

use kinetostat_machining::{FileRead, Limits};
use kinetostat_program::{ReadOptions, WriteOptions};

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::limits::limits;
use crate::job::output_paths::{OutputPaths, output_paths};
use crate::job::reading::reading;
use crate::job::values::{NotAllowed, above_zero, chosen, micrometres};
use crate::ui::failure::{Answer, Failure};

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
    pub(crate) targets: OutputPaths,
    /// Files that were read: never overwritten.
    pub(crate) inputs: Vec<PathBuf>,
}

/// Reads the program and everything said about it.
pub(crate) fn setting(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
) -> Answer<Setting> {
    let mut inputs: Vec<PathBuf> = job.iter().map(|j| j.path.clone()).collect();
    let path = program_path(job, flags)?;
    inputs.push(path.clone());
    let reading = reading(job, &flags.reading)?;
    let limits = limits(job, &flags.limits)?;
    let (mut write, stated) = tolerances(job, flags, writing)?;
    let header = job.and_then(|j| j.job.output.header).unwrap_or(true);
    write.header = (header && !writing.no_header).then(Vec::new);
    let max_blocks_per_second = chosen(
        job,
        ("--max-blocks-per-second", writing.max_blocks_per_second),
        job.and_then(|j| j.job.tolerances.max_blocks_per_second.as_ref()),
        above_zero,
    )?;
    let program_name = path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    );
    let targets = output_paths(job, flags, writing, &path)?;
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
        stated,
        targets,
        inputs,
    })
}

/// The program's file, of the command line or of the job.
pub(crate) fn program_path(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<PathBuf> {
    match (&flags.program, job.and_then(|j| j.job.program.as_ref())) {
        (Some(path), _) => Ok(path.clone()),
        (None, Some(written)) => Ok(job
            .map(JobFile::base)
            .unwrap_or_default()
            .join(written.get_ref())),
        (None, None) => Err(Failure::input(match job {
            Some(j) => format!(
                "the job file '{}' names no program; write  program = \"part.ngc\"  at its top, or give --program FILE",
                j.path.display()
            ),
            None => "no program is named; give a job file, or --program FILE".to_owned(),
        })),
    }
}

/// How the program is written, and whether the tolerances of path and chords were stated.
fn tolerances(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
) -> Answer<(WriteOptions, [bool; 2])> {
    let tolerances = job.map(|j| j.job.tolerances.clone()).unwrap_or_default();
    let mut write = {
        let mut new_writing = WriteOptions::default();
        new_writing.again = writing.again;
        new_writing
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
            false => Err(NotAllowed(
                "1 (never above the programmed feed) to 1000 are allowed",
            )),
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
                Err(NotAllowed(
                    "3 to 8 decimals can be written; 4 keep the rounding below 0.1 micrometres",
                ))
            }
        },
    )?;
    Ok((write, [path_mm.is_some(), chord_mm.is_some()]))
}
