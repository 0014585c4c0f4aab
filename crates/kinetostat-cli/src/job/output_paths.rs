//! Where the outputs of a run go, from options and the job file.

use std::path::{Path, PathBuf};

use serde_spanned::Spanned;

use crate::files::paths::inside;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::format::Job;
use crate::job::job_file::JobFile;
use crate::ui::failure::Answer;

/// Outputs of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct OutputPaths {
    pub(crate) program: Option<PathBuf>,
    pub(crate) report: Option<PathBuf>,
    pub(crate) json: Option<PathBuf>,
    pub(crate) points: Option<PathBuf>,
}

impl OutputPaths {
    /// Those that are requested, with what they are.
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

pub(crate) fn output_paths(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
    program: &Path,
) -> Answer<OutputPaths> {
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
                    &help.to_string(),
                )
            })
    };
    let mut targets = OutputPaths {
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
