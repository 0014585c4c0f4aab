//! The files of a robot's program.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use kinetostat_formats::{FileForm, Language, SlashBlocks, SourceFile, language_of, odd_program};
use nalgebra::Vector3;

use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::{ProgramArgs, ReadingArgs};
use crate::job::format::BlockDeleteWord;
use crate::job::job_file::JobFile;
use crate::job::output_paths::beside_program;
use crate::job::robot::config_frames::SystemFrames;
use crate::job::robot::divided::Divided;
use crate::job::robot::parquet;
use crate::job::robot::read_once::Reading;
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
    /// The program in Parquet of which `files` hold the text.
    pub(crate) parquet: Option<Vec<u8>>,
    /// The files of which the program was joined.
    pub(crate) divided: Option<Divided>,
    /// Original program, if it was written flat.
    pub(crate) before: Option<BeforeFlat>,
    /// Tools and bases of the controller that were found beside the program.
    pub(crate) system_frames: Option<SystemFrames>,
    /// The program as it was read.
    pub(crate) reading: Reading,
}

/// The files of a program before it was written flat.
#[derive(Debug, Clone)]
pub(crate) struct BeforeFlat {
    pub(crate) files: Vec<SourceFile>,
    /// File and source line of each flat line.
    pub(crate) origins: Vec<(usize, usize)>,
}

impl RobotSource {
    /// A program that was written, in the form of its file: bytes as they are, or a table in Parquet; and columns of that which have
    /// another type now.
    pub(crate) fn in_form_of_file<'b>(
        &self,
        written: &'b [u8],
    ) -> Answer<(Cow<'b, [u8]>, Vec<String>)> {
        let Some(original) = &self.parquet else {
            return Ok((Cow::Borrowed(written), Vec::new()));
        };
        let name = self.files.first().map_or("", SourceFile::name);
        let made = parquet::of_text(name, original, written)?;
        Ok((Cow::Owned(made.bytes), made.widened))
    }
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
        return match (flags.of_robots_alone(), table) {
            (Some(option), _) if !flags.converted => Err(Failure::input(format!(
                "{option} is for programs of robots, and '{name}' is none that is known ({}): it is read as G-code; leave {option} out",
                known_endings()
            ))),
            (_, Some((j, table))) if !table.get_ref().is_of_any_program() => Err(j.error(
                table,
                &format!("this table is for programs of robots, and '{name}' is read as G-code"),
                &format!(
                    "leave it out, or give the program the ending of its language ({})",
                    known_endings()
                ),
            )),
            _ => match job.and_then(|j| Some((j, only_of_robots(j)?))) {
                Some((j, (table, key))) if !flags.converted => Err(j.error(
                    key,
                    &format!("[{table}] is for programs of robots, and '{name}' is read as G-code"),
                    "leave it out",
                )),
                _ => Ok(None),
            },
        };
    };
    refuse_unfit(job, program, language)?;
    if let Some(data) = language.data_ending().filter(|data| has_ending(path, data)) {
        return Err(Failure::input(format!(
            "'{name}' holds data of a program: give its .{} as the program; the .{data} of the same name is read with it",
            FileForm::Program(language).ending()
        )));
    }
    let mut settings = settings(
        job,
        flags,
        (language, Vector3::from(language.usual_tool_axis())),
    )?;
    settings.reading.slash_blocks = slash_blocks(job, &program.reading);
    let text = parquet::as_text(name, bytes)?;
    let mut source = RobotSource {
        language,
        parquet: text.as_ref().map(|_| bytes.to_vec()),
        files: vec![match text {
            Some(text) => SourceFile::new(name, text),
            None => SourceFile::new(name, bytes),
        }],
        paths: Vec::new(),
        settings,
        divided: None,
        before: None,
        system_frames: None,
        reading: Reading::new(),
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
    for beside in files_beside(language, path, bytes) {
        take(beside)?;
    }
    if let Some((j, table)) = table {
        let of_job = j.job.program.as_ref();
        let of_job = of_job.map(|program| j.base().join(program.get_ref()));
        for written in &table.get_ref().files {
            let file = j.base().join(written.get_ref());
            // A program that was written from that of the job has the files that were written with it.
            let own = of_job.as_ref().filter(|of_job| *of_job != path);
            let own = own.map(|of_job| beside_program(path, of_job, &file));
            take(own.filter(|own| own.is_file()).unwrap_or(file))?;
        }
    }
    Ok(Some((source, read)))
}

/// Treatment of blocks behind a slash, by options or job file.
pub(crate) fn slash_blocks(job: Option<&JobFile>, flags: &ReadingArgs) -> SlashBlocks {
    let in_job = job.and_then(|j| j.job.reading.block_delete);
    match flags.block_delete.or(in_job) {
        Some(BlockDeleteWord::Run) => SlashBlocks::Run,
        Some(BlockDeleteWord::Skip) => SlashBlocks::Skipped,
        None => SlashBlocks::Refused,
    }
}

/// The usual endings of all languages: `.mod, .src, ...`.
fn known_endings() -> String {
    let first = |language: &Language| Some(format!(".{}", language.endings().first()?));
    let all: Vec<String> = Language::ALL.iter().filter_map(first).collect();
    all.join(", ")
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Files in the folder of a program that belong to it, and those that belong to them.
fn files_beside(language: Language, path: &Path, bytes: &[u8]) -> Vec<PathBuf> {
    let own_name = |path: &Path| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).into_iter();
    let files = entries.flatten().flatten().map(|entry| entry.path());
    let mut names: Vec<String> = files
        .filter(|file| file.is_file())
        .filter_map(|file| own_name(&file))
        .collect();
    names.sort();
    let first = own_name(path).unwrap_or_default();
    let mut open = vec![SourceFile::new(first.clone(), bytes)];
    names.retain(|name| *name != first);
    let mut found = Vec::new();
    while let Some(file) = open.pop() {
        for name in language.files_beside(&file, &names) {
            let beside = path.with_file_name(&name);
            open.extend(std::fs::read(&beside).map(|bytes| SourceFile::new(name.clone(), bytes)));
            names.retain(|other| *other != name);
            found.push(beside);
        }
    }
    found
}

/// The first key of a table that only programs of robots have, with the name of the table.
fn only_of_robots(job: &JobFile) -> Option<(&'static str, &Spanned<String>)> {
    let call = job.job.calls.keys().next().map(|key| ("calls", key));
    call.or_else(|| job.job.values.keys().next().map(|key| ("values", key)))
}
