//! The files of a robot's program.

use std::path::{Path, PathBuf};

use kinetostat_formats::{Language, SourceFile, language_of, odd_program};
use nalgebra::Vector3;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::robot::settings::{RobotSettings, settings};
use crate::job::robot::unfit_options::refuse_unfit;
use crate::ui::failure::{Answer, Failure};

/// A program of a robot as it lies on disk, and how it is to be read.
#[derive(Clone, Debug)]
pub(crate) struct RobotSource {
    pub(crate) language: Language,
    /// The first is the program itself.
    pub(crate) files: Vec<SourceFile>,
    pub(crate) paths: Vec<PathBuf>,
    pub(crate) settings: RobotSettings,
}

/// The program where it is one of a robot; none where it is G-code.
pub(crate) fn robot_source(
    files: &InputFiles,
    job: Option<&JobFile>,
    program: &ProgramArgs,
    (path, name, bytes): (&Path, &str, &[u8]),
) -> Answer<Option<(RobotSource, Vec<kinetostat_machining::FileRead>)>> {
    let flags = &program.robot;
    let table = job.and_then(|j| Some((j, j.job.robot.as_ref()?)));
    let Some(language) = language_of(name, bytes) else {
        if let Some(odd) = odd_program(name, bytes) {
            return Err(Failure::input(format!("'{name}': {odd}")));
        }
        return match (flags.given(), table) {
            (Some(option), _) if !flags.converted => Err(Failure::input(format!(
                "{option} is for programs of robots, and '{name}' is none that is known (RAPID: .mod, .modx, .prg; KRL: .src; FANUC: .ls; APT: .apt, .cls; lists of poses: .csv, .yaml): it is read as G-code; leave {option} out"
            ))),
            (_, Some((j, table))) if !table.get_ref().is_of_any_program() => Err(j.error(
                table,
                &format!("this table is for programs of robots, and '{name}' is read as G-code"),
                "leave it out, or give the program the ending of its language (.mod, .src, .ls, .apt, .csv, .yaml)",
            )),
            _ => Ok(None),
        };
    };
    refuse_unfit(job, program)?;
    if language == Language::Krl && is_data(path) {
        return Err(Failure::input(format!(
            "'{name}' holds data of a program: give its .src as the program; the .dat of the same name is read with it"
        )));
    }
    let settings = settings(job, flags, (language, usual_axis(language)))?;
    let mut source = RobotSource {
        language,
        files: vec![SourceFile::new(name, bytes)],
        paths: Vec::new(),
        settings,
    };
    let mut read = Vec::new();
    let mut take = |path: PathBuf| -> Answer<()> {
        let bytes = files.bytes("file of the program", &path)?;
        read.push(origin::file("file of the program", &path, &bytes));
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        source.files.push(SourceFile::new(name, bytes));
        source.paths.push(path);
        Ok(())
    };
    let beside = path.with_extension("dat");
    if has_data_beside(language) && beside.is_file() {
        take(beside)?;
    }
    if let Some((j, table)) = table {
        for written in &table.get_ref().files {
            take(j.base().join(written.get_ref()))?;
        }
    }
    Ok(Some((source, read)))
}

/// From the tool's tip to its holder, in axes of the tool, as is usual.
fn usual_axis(language: Language) -> Vector3<f64> {
    match language {
        Language::Krl => -Vector3::x(),
        _ => -Vector3::z(),
    }
}

fn is_data(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("dat"))
}

/// Whether targets are declared in a file of the same name with the ending `.dat`.
fn has_data_beside(language: Language) -> bool {
    match language {
        Language::Rapid => false,
        Language::Krl => true,
        _ => false,
    }
}
