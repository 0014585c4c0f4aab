//! Files that a job's cut is read from: never overwritten, and named in the result with their hashes.

use std::path::{Path, PathBuf};

use kinetostat_machining::FileRead;

use serde_spanned::Spanned;

use crate::files::input_files::{InputFiles, text_in};
use crate::files::origin;
use crate::job::job_file::JobFile;
use crate::ui::failure::Answer;

/// Files that were read.
#[derive(Default)]
pub(crate) struct FilesOfCut {
    pub(crate) paths: Vec<PathBuf>,
    pub(crate) read: Vec<FileRead>,
}

impl FilesOfCut {
    /// The text of a file that a job names, and its path for messages.
    pub(super) fn text(
        &mut self,
        files: &InputFiles,
        job: &JobFile,
        what: &str,
        name: &Spanned<String>,
    ) -> Answer<(String, String)> {
        let (bytes, shown) = self.bytes(files, job, what, name)?;
        let text = text_in(what, Path::new(&shown), bytes)?;
        Ok((text, shown))
    }

    /// The bytes of a file that a job names, and its path for messages.
    pub(super) fn bytes(
        &mut self,
        files: &InputFiles,
        job: &JobFile,
        what: &str,
        name: &Spanned<String>,
    ) -> Answer<(Vec<u8>, String)> {
        let path = job.base().join(name.get_ref());
        let shown = path.display().to_string();
        let bytes = self.stated(files, what, path).map_err(|failure| {
            let help = "paths count from the folder of the job file";
            job.error(name, &failure.plain, help)
        })?;
        Ok((bytes, shown))
    }

    /// The bytes of a file that an option names.
    pub(crate) fn stated(
        &mut self,
        files: &InputFiles,
        what: &str,
        path: PathBuf,
    ) -> Answer<Vec<u8>> {
        let bytes = files.bytes(what, &path)?;
        self.read.push(origin::file(what, &path, &bytes));
        self.paths.push(path);
        Ok(bytes)
    }
}
