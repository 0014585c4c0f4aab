//! Files of the programs that a program calls: in its own folder, and in folders of subprograms.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{SourceFile, called_files};
use kinetostat_machining::FileRead;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::robot::folder::Folder;
use crate::job::robot::source::RobotSource;
use crate::ui::failure::{Answer, Failing};

/// Upper limit of the files of one program.
const MOST_FILES: usize = 1000;

/// A program in blocks that calls what lies in its folder is run, or refused: what the other file moves must not be passed over.
pub(crate) fn refuse_calls_beside(source: &RobotSource, program: &Path) -> Answer<()> {
    let (Some(file), true) = (source.files.first(), source.language.is_in_blocks()) else {
        return Ok(());
    };
    let called = called_files(source.language, file);
    if called.is_empty() {
        return Ok(());
    }
    let folder = Folder::of(&folder_of(program));
    match called.iter().find(|name| folder.file(name).is_some()) {
        Some(name) => Err(ErrorCode::Missing.failure(format!(
                "'{}' calls {name}, which lies in its folder and is not read with it: let both be run once and written flat (--expand, or a table [expand] in the job file)",
                file.name()
            ),
        )),
        None => Ok(()),
    }
}

fn folder_of(program: &Path) -> PathBuf {
    match program.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Adds the files that a program calls, those that these call, and so on, as far as they are there: their places, and how they were
/// read. A file that the job names stands for its name.
pub(crate) fn with_called_files(
    source: &mut RobotSource,
    program: &Path,
    others: &[PathBuf],
) -> Answer<Vec<(PathBuf, FileRead)>> {
    let own = folder_of(program);
    let folders = std::iter::once(&own).chain(others);
    let folders: Vec<Folder> = folders.map(|path| Folder::of(path)).collect();
    let inputs = InputFiles::default();
    let mut read = Vec::new();
    let mut at = 0;
    while at < source.files.len() && source.files.len() < MOST_FILES {
        for name in called_files(source.language, &source.files[at]) {
            let known = |file: &SourceFile| file.name().eq_ignore_ascii_case(&name);
            if source.files.iter().any(known) {
                continue;
            }
            let mut found = folders.iter().filter_map(|folder| folder.file(&name));
            let Some(path) = found.next() else {
                continue;
            };
            let bytes = inputs.bytes("subprogram", &path)?;
            for other in found {
                if inputs.bytes("subprogram", &other)? != bytes {
                    return Err(ErrorCode::Conflict.failure(format!(
                            "two different subprograms have one name: '{}', line 1, and '{}', line 1; leave out the folder of one, or rename one",
                            path.display(),
                            other.display()
                        ),
                    ));
                }
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            source.files.push(SourceFile::new(name, bytes.as_slice()));
            read.push((path.clone(), origin::file("subprogram", &path, &bytes)));
        }
        at += 1;
    }
    Ok(read)
}
