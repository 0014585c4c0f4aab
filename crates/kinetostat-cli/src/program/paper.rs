//! The report to be signed: the hashes of what was written, and the document itself.

use std::borrow::Cow;
use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::FileRead;
use kinetostat_report::Paper;

use crate::files::origin;
use crate::job::output_paths::OutputPaths;
use crate::ui::failure::{Answer, Failing};

/// Refuses a PDF that this build cannot write, before the long work begins.
pub(crate) fn refuse_without_pdf() -> Answer<()> {
    match Paper::makes_pdf() {
        true => Ok(()),
        false => Err(ErrorCode::NotBuiltIn.failure("this build makes no PDF: the command line does (kinetostat compensate job.toml --pdf report.pdf); an HTML report can be printed",
        )),
    }
}

/// The document.
pub(crate) fn pdf(paper: &Paper<'_>) -> Answer<Vec<u8>> {
    paper
        .pdf()
        .map_err(|error| ErrorCode::Internal.failure(error.to_string()))
}

/// Written files with their hashes.
pub(crate) fn written(
    targets: &OutputPaths,
    program: &[u8],
    beside: &[Cow<'_, [u8]>],
) -> Vec<FileRead> {
    let paths = targets.program.iter().chain(&targets.beside);
    let bytes = std::iter::once(program).chain(beside.iter().map(Cow::as_ref));
    let file = |(path, bytes): (&std::path::PathBuf, &[u8])| {
        origin::file("written program", Path::new(path), bytes)
    };
    paths.zip(bytes).map(file).collect()
}
