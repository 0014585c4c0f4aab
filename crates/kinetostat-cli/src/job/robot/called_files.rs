//! Files of the programs that a program calls: in its own folder, and in folders of subprograms.

use std::path::{Path, PathBuf};

use kinetostat_formats::{SourceFile, called_files};
use kinetostat_machining::FileRead;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::robot::folder::Folder;
use crate::job::robot::source::RobotSource;
use crate::ui::failure::{Answer, Failure};

/// Upper limit of the files of one program.
const MOST_FILES: usize = 1000;

/// Adds the files that a program calls, those that these call, and so on, as far as they are there: their places, and how they were
/// read. A file that the job names stands for its name.
pub(crate) fn with_called_files(
    source: &mut RobotSource,
    program: &Path,
    others: &[PathBuf],
) -> Answer<Vec<(PathBuf, FileRead)>> {
    let own = program
        .parent()
        .map(|folder| match folder.as_os_str().is_empty() {
            true => PathBuf::from("."),
            false => folder.to_owned(),
        });
    let folders: Vec<Folder> = own
        .iter()
        .chain(others)
        .map(|path| Folder::of(path))
        .collect();
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
                    return Err(Failure::input(format!(
                        "two different subprograms have one name: '{}', line 1, and '{}', line 1; leave out the folder of one, or rename one",
                        path.display(),
                        other.display()
                    )));
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
