//! The files of a robot's program.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{FileForm, Language, SlashBlocks, SourceFile, language_of, odd_program};
use nalgebra::Vector3;
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::{ProgramArgs, ReadingArgs};
use crate::job::expand_table::ExpandTable;
use crate::job::format::BlockDeleteWord;
use crate::job::job_file::JobFile;
use crate::job::output_paths::beside_program;
use crate::job::robot::divided::Divided;
use crate::job::robot::read_once::Reading;
use crate::job::robot::settings::{RobotSettings, settings};
use crate::ui::failure::{Answer, Failing};

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
        let made = of_text(name, original, written)?;
        Ok((Cow::Owned(made.bytes), made.widened))
    }
}

/// The program where it is one of a robot; none where it is G-code.
pub(crate) fn robot_source(
    files: &InputFiles,
    job: Option<&JobFile>,
    program: &ProgramArgs,
    path: &Path,
    name: &str,
    bytes: &[u8],
) -> Answer<Option<(RobotSource, Vec<kinetostat_machining::FileRead>)>> {
    let flags = &program.robot;
    let table = job.and_then(|j| Some((j, j.job.robot.as_ref()?)));
    let Some(language) = language_of(name, bytes) else {
        if let Some(odd) = odd_program(name, bytes) {
            return Err(ErrorCode::FileForm.failure(format!("'{name}': {odd}")));
        }
        return match (flags.of_robots_alone(), table) {
            (Some(option), _) if !flags.converted => Err(ErrorCode::Unused.failure(format!(
                    "{option} is for programs of robots, and '{name}' is none that is known ({}): it is read as G-code; leave {option} out",
                    known_endings()
                ),
            )),
            (_, Some((j, table))) if !table.get_ref().is_of_any_program() => Err(j.error(
                table,
                &format!("this table is for programs of robots, and '{name}' is read as G-code"),
                &format!(
                    "leave it out, or give the program the ending of its language ({})",
                    known_endings()
                ),
            )),
            _ => match job.and_then(|j| Some((j, j.job.values.keys().next()?))) {
                Some((j, key)) if !flags.converted => Err(j.error(
                    key,
                    &format!("[values] is for programs of robots, and '{name}' is read as G-code"),
                    "leave it out",
                )),
                _ => Ok(None),
            },
        };
    };
    refuse_unfit(job, program, language)?;
    if let Some(data) = language.data_ending().filter(|data| has_ending(path, data)) {
        return Err(ErrorCode::FileForm.failure(format!(
                "'{name}' holds data of a program: give its .{} as the program; the .{data} of the same name is read with it",
                FileForm::Program(language).ending()
            ),
        ));
    }
    let mut settings = settings(
        job,
        flags,
        language,
        Vector3::from(language.usual_tool_axis()),
    )?;
    settings.reading.slash_blocks = slash_blocks(job, &program.reading);
    let text = as_text(name, bytes)?;
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
    let stated = table.iter().flat_map(|(_, table)| &table.get_ref().files);
    let stated: Vec<&OsStr> = stated
        .filter_map(|file| Path::new(file.get_ref()).file_name())
        .collect();
    for beside in files_beside(language, path, bytes) {
        let own = beside.file_name().unwrap_or_default();
        if !stated.iter().any(|name| own.eq_ignore_ascii_case(name)) {
            take(beside)?;
        }
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

/// A file in Parquet that was written.
#[derive(Debug, Default)]
pub(crate) struct Written {
    pub(crate) bytes: Vec<u8>,
    /// Columns that have another type now.
    pub(crate) widened: Vec<String>,
}

/// The text of a program in Parquet; none of any other.
fn as_text(name: &str, bytes: &[u8]) -> Answer<Option<Vec<u8>>> {
    match bytes.starts_with(b"PAR1") {
        true => text_of(bytes).map_err(|what| {
            ErrorCode::FileForm.failure(format!("the table in Parquet '{name}': {what}"))
        }),
        false => Ok(None),
    }
}

/// A program in Parquet with the numbers of a text.
fn of_text(name: &str, original: &[u8], text: &[u8]) -> Answer<Written> {
    file_of(original, text).map_err(|what| {
        ErrorCode::Output.failure(format!(
            "the table in Parquet '{name}' cannot be written corrected: {what}"
        ))
    })
}

#[cfg(feature = "parquet")]
fn text_of(bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    kinetostat_formats::table_of_parquet(bytes).map(Some)
}

#[cfg(not(feature = "parquet"))]
fn text_of(_bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    Ok(None)
}

#[cfg(feature = "parquet")]
fn file_of(original: &[u8], text: &[u8]) -> Result<Written, String> {
    let made = kinetostat_formats::parquet_of_table(original, text)?;
    Ok(Written {
        bytes: made.bytes,
        widened: made.widened,
    })
}

#[cfg(not(feature = "parquet"))]
fn file_of(_original: &[u8], _text: &[u8]) -> Result<Written, String> {
    Err("this kinetostat does not write it".to_owned())
}

/// Refuses what would have no effect.
fn refuse_unfit(job: Option<&JobFile>, flags: &ProgramArgs, language: Language) -> Answer<()> {
    // A control has the switch for blocks behind a slash, as G-code has.
    let has_switch = language.has_slash_switch();
    let refuse = |what: &str, why: &str| {
        Err(ErrorCode::Unused.failure(format!("{what} is for G-code; {why}: leave it out")))
    };
    let reading = &flags.reading;
    let words = "a program of a robot says it by its own statements";
    for (option, is_given) in [
        ("--units", reading.units.is_some()),
        ("--arc-tolerance", reading.arc_tolerance.is_some()),
        ("--work-offset", !reading.work_offset.is_empty()),
        (
            "--block-delete",
            reading.block_delete.is_some() && !has_switch,
        ),
        ("--axes-stand-still", reading.axes_stand_still),
        ("--tool-centre-point", reading.tool_centre_point),
        ("--start-position-mm", reading.start_position_mm.is_some()),
        ("--machine-zero-mm", reading.machine_zero_mm.is_some()),
        ("--g28-mm", reading.g28_mm.is_some()),
        ("--g30-mm", reading.g30_mm.is_some()),
    ] {
        if is_given {
            return refuse(option, words);
        }
    }
    let table = job.map(|j| &j.job.reading);
    let given = table.is_some_and(|table| {
        table.units.is_some()
            || table.arc_tolerance_mm.is_some()
            || table.block_delete.is_some() && !has_switch
            || table.axes_stand_still.is_some()
            || table.tool_centre_point.is_some()
            || table.start_position_mm.is_some()
            || table.machine_zero_mm.is_some()
            || table.g28_mm.is_some()
            || table.g30_mm.is_some()
            || table.work_offset_mm.is_some()
    });
    if given {
        return refuse("[reading] in the job file", words);
    }
    let flat = "what a control's program needs to be run once, it says itself";
    if let Some(option) = flags.expansion.with.given_for_gcode() {
        return refuse(option, flat);
    }
    let table = job.and_then(|j| j.job.expand.as_ref());
    let given = table
        .map(Spanned::get_ref)
        .and_then(ExpandTable::given_for_gcode);
    if let Some(key) = given {
        return refuse(&format!("{key} under [expand]"), flat);
    }
    let in_job = job.is_some_and(|j| j.job.placement.scale.is_some());
    match flags.scale.is_some() || in_job {
        true => refuse(
            "the scale (--scale, scale under [placement])",
            "a program of a robot is in the robot's own millimetres",
        ),
        false => Ok(()),
    }
}

/// Tools and bases that were found.
#[derive(Clone, Debug)]
pub(crate) struct SystemFrames {
    pub(super) path: PathBuf,
    /// `BASE_DATA[2]`, ... in capitals.
    pub(super) names: Vec<String>,
}
