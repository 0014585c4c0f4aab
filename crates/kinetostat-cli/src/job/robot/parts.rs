//! The parts of a divided program of a robot: found beside it, and joined with it where they hold motions.

use std::path::{Path, PathBuf};

use kinetostat_formats::{SourceFile, read};
use kinetostat_machining::{FileRead, FlatProgram};

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::robot::divided::Divided;
use crate::job::robot::read_once::Reading;
use crate::job::robot::read_program::refused;
use crate::job::robot::source::RobotSource;
use crate::ui::failure::Answer;

/// Upper limit of the parts of a program.
const MOST_PARTS: usize = 1000;

/// A divided program that was joined.
pub(crate) struct Joined {
    pub(crate) flat: FlatProgram,
    /// Paths of the further files.
    pub(crate) paths: Vec<PathBuf>,
    /// Files that were found beside the program.
    pub(crate) read: Vec<FileRead>,
}

/// Joins a program whose motions stand in several files: those that the job names, else the numbered parts beside the program that
/// it calls. None where it is no such program.
pub(crate) fn join_parts(source: &mut RobotSource, program: &Path) -> Answer<Option<Joined>> {
    if !source.language.files_are_joined() {
        return Ok(None);
    }
    let mut files = source.files.clone();
    let (mut paths, mut found) = (source.paths.clone(), Vec::new());
    if files.len() == 1 {
        let inputs = InputFiles::default();
        for path in numbered_parts(program, &files[0]) {
            let bytes = inputs.bytes("part of the program", &path)?;
            found.push(origin::file("part of the program", &path, &bytes));
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            files.push(SourceFile::new(name, bytes.as_slice()));
            paths.push(path);
        }
    }
    let divided = Divided::of(source.language, files.clone());
    let Some(divided) = divided.filter(|all| files.len() > 1 && all.are_programs()) else {
        return Ok(None);
    };
    let all = match read(source.language, files, &source.settings.reading) {
        Ok(all) => all,
        Err(faults) if !found.is_empty() => {
            return Err(refused(&faults).of_program());
        }
        Err(_) => return Ok(None),
    };
    if all.motions.iter().all(|motion| motion.file == 0) {
        return Ok(None);
    }
    let mut flat = FlatProgram::new(divided.names(), all.motions.len(), divided.sources());
    flat.settings = vec!["the program and its parts in one file".to_owned()];
    source.files = vec![divided.joined()?];
    source.paths.clear();
    source.divided = Some(divided);
    source.reading = Reading::new();
    Ok(Some(Joined {
        flat,
        paths,
        read: found,
    }))
}

/// `part_1.src`, `part_2.src` ... beside `part.src`, as far as they are there and the program names them.
fn numbered_parts(program: &Path, main: &SourceFile) -> Vec<PathBuf> {
    let stem = program.file_stem().unwrap_or_default().to_string_lossy();
    let ending = program.extension().unwrap_or_default().to_string_lossy();
    let there: Vec<(String, PathBuf)> = (1..=MOST_PARTS)
        .map(|number| format!("{stem}_{number}"))
        .map(|name| {
            (
                name.clone(),
                program.with_file_name(format!("{name}.{ending}")),
            )
        })
        .take_while(|(_, path)| path.is_file())
        .collect();
    if there.is_empty() {
        return Vec::new();
    }
    let text = main.bytes().to_ascii_lowercase();
    let names = |name: &str| {
        let name = name.to_ascii_lowercase();
        text.windows(name.len() + 1).any(|part| {
            part.starts_with(name.as_bytes()) && !part[name.len()].is_ascii_alphanumeric()
        })
    };
    let called = there.into_iter().take_while(|(name, _)| names(name));
    called.map(|(_, path)| path).collect()
}
