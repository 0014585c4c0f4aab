//! Output paths of a run, from options and the job file.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{Language, language_of};
use serde_spanned::Spanned;

use crate::files::file_names::file_name;
use crate::files::paths::{COMPENSATED, FLAT, inside, is_own_folder, parent_of};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::format::Job;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};
use crate::ui::language::LanguageWord;

/// Output name of the compensated program.
pub(crate) const COMPENSATED_PROGRAM: &str = "compensated program";

/// Output name of the report to be signed.
pub(crate) const PDF: &str = "report as PDF";

/// Output name of the path for ParaView.
pub(crate) const PATH_VTK: &str = "path as VTK";

/// Output name of the flat program.
pub(crate) const FLAT_PROGRAM: &str = "flat program";

/// Output name of the picture of the turn.
pub(crate) const TURN_PLOT: &str = "picture of the turn";

/// Output name of further files of a program.
pub(crate) const BESIDE: &str = "file of the compensated program";

/// Path of a further file: beside the program. A file with the program's name gets its new name; another one keeps its name in
/// another folder, and is appended to the program's name in the same one.
pub(crate) fn beside_program(out: &Path, program: &Path, file: &Path) -> PathBuf {
    let is_called_otherwise = file.file_stem() != program.file_stem();
    let own = file.file_name().filter(|_| is_called_otherwise);
    if let (Some(own), true) = (own, out.parent() != file.parent()) {
        return out.with_file_name(own);
    }
    let mut name = out.file_stem().unwrap_or_default().to_owned();
    if is_called_otherwise {
        name.push("-");
        name.push(file.file_stem().unwrap_or_default());
    }
    if let Some(extension) = file.extension() {
        name.push(".");
        name.push(extension);
    }
    out.with_file_name(name)
}

/// Form in which the program is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    AsItStands,
    Flat,
}

/// Outputs of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct OutputPaths {
    pub(crate) program: Option<PathBuf>,
    pub(crate) report: Option<PathBuf>,
    /// Report to be signed.
    pub(crate) pdf: Option<PathBuf>,
    /// Language of both reports.
    pub(crate) language: Option<LanguageWord>,
    pub(crate) json: Option<PathBuf>,
    pub(crate) points: Option<PathBuf>,
    /// Path with errors, for ParaView.
    pub(crate) vtk: Option<PathBuf>,
    /// Path of the flat program.
    pub(crate) flat: Option<PathBuf>,
    /// Picture of the turn of the tool, where it is chosen.
    pub(crate) turn_plot: Option<PathBuf>,
    /// Additional files of a program of a robot, in their order.
    pub(crate) beside: Vec<PathBuf>,
}

impl OutputPaths {
    /// Requested outputs with their names.
    pub(crate) fn named(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        [
            (COMPENSATED_PROGRAM, &self.program),
            ("report", &self.report),
            (PDF, &self.pdf),
            ("result", &self.json),
            ("table of points", &self.points),
            (PATH_VTK, &self.vtk),
            (FLAT_PROGRAM, &self.flat),
            (TURN_PLOT, &self.turn_plot),
        ]
        .into_iter()
        .filter_map(|(what, path)| Some((what, path.as_deref()?)))
        .chain(self.beside.iter().map(|path| (BESIDE, path.as_path())))
    }
}

pub(crate) fn output_paths(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
    program: &Path,
    bytes: &[u8],
    form: Form,
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
        beside: Vec::new(),
        program: from_job(writing.out, |j| j.output.program.as_ref())?,
        pdf: from_job(flags.pdf.as_deref(), |j| j.output.pdf.as_ref())?,
        language: flags
            .language
            .or_else(|| job.and_then(|j| j.job.output.language)),
        report: from_job(flags.report.as_deref(), |j| j.output.report.as_ref())?,
        json: from_job(writing.json.filter(|p| *p != Path::new("-")), |j| {
            j.output.json.as_ref()
        })?,
        points: from_job(flags.points.as_deref(), |j| j.output.points.as_ref())?,
        vtk: from_job(flags.vtk.as_deref(), |j| j.output.vtk.as_ref())?,
        turn_plot: from_job(flags.turn.turn_plot.as_deref(), |j| {
            j.output.turn_plot.as_ref()
        })?,
        flat: from_job(flags.expansion.flat_program.as_deref(), |j| {
            j.output.flat_program.as_ref()
        })?,
    };
    refuse_unused(flags, &targets)?;
    let out = match targets.program.take() {
        Some(out) => out,
        None => {
            let near = job.map_or(program, |j| &j.path);
            match keeps_name(program, bytes) {
                true => in_folder(near, program, COMPENSATED)?,
                false => beside(near, program, "-compensated"),
            }
        }
    };
    if form == Form::Flat && targets.flat.is_none() {
        targets.flat = Some(flat_beside(&out, program, bytes)?);
    }
    targets.program = Some(out);
    Ok(targets)
}

/// Refuses options of outputs that are not asked for.
pub(crate) fn refuse_unused(flags: &ProgramArgs, targets: &OutputPaths) -> Answer<()> {
    if flags.language.is_some() && targets.report.is_none() && targets.pdf.is_none() {
        return Err(ErrorCode::Unused.failure("--language is the language of the reports, and none is asked for: add --report FILE or --pdf FILE",
        ));
    }
    let of_part = [
        ("--part-number", flags.part_number.is_some()),
        ("--revision", flags.revision.is_some()),
    ];
    if let Some((option, _)) = of_part.into_iter().find(|(_, given)| *given)
        && targets.report.is_none()
        && targets.pdf.is_none()
    {
        return Err(ErrorCode::Unused.failure(format!(
            "{option} stands in the reports, and none is asked for: add --report FILE or --pdf FILE"
        )));
    }
    match flags.all_points && targets.points.is_none() {
        true => Err(ErrorCode::Unused.failure(
            "--all-points is about the table of points, and none is asked for: add --points FILE",
        )),
        false => Ok(()),
    }
}

/// True of a program that its controller loads by a name that it states itself, with letters that file names have.
fn keeps_name(program: &Path, bytes: &[u8]) -> bool {
    let ending = program.extension().unwrap_or_default().to_string_lossy();
    let ending = ending.to_ascii_lowercase();
    let mut loaded = Language::ALL.iter().filter(|language| language.is_loaded());
    loaded.any(|language| language.endings().contains(&ending.as_str()))
        || language_of(&file_name(program), bytes).is_some_and(|language| language.is_loaded())
}

/// A program under its own name in a folder beside `near`, which leads to no other place.
pub(crate) fn in_folder(near: &Path, program: &Path, folder: &str) -> Answer<PathBuf> {
    let folder = near.with_file_name(folder);
    if folder.is_symlink() {
        return Err(ErrorCode::Output.failure(format!(
                "'{}' is a symbolic link, and outputs do not follow links; name the output (--out), or remove the link",
                folder.display()
            ),
        ));
    }
    Ok(folder.join(program.file_name().unwrap_or_default()))
}

/// Another program in a folder of its own goes beside the folder of this one, where it has one.
pub(crate) fn or_its_folder(out: &Path) -> PathBuf {
    let folder = parent_of(out);
    match is_own_folder(&folder) {
        true => folder,
        false => out.to_owned(),
    }
}

/// Default path of the flat program.
pub(crate) fn flat_beside(out: &Path, program: &Path, bytes: &[u8]) -> Answer<PathBuf> {
    match keeps_name(program, bytes) {
        true => in_folder(&or_its_folder(out), program, FLAT),
        false => Ok(beside(out, program, "-flat")),
    }
}

/// `part.ngc` becomes `part-compensated.ngc` in the directory of `near`.
fn beside(near: &Path, program: &Path, ending: &str) -> PathBuf {
    // A disk has names that are no text: they stay what they are.
    let mut name = program.file_stem().unwrap_or_default().to_owned();
    name.push(ending);
    if let Some(extension) = program.extension() {
        name.push(".");
        name.push(extension);
    }
    near.with_file_name(name)
}
