//! Endings of written programs: the ending of another language is refused before a run, for a program with it would be read as
//! that language. An ending that no language is known by is anybody's own.

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::FileForm;

use crate::job::output_paths::{COMPENSATED_PROGRAM, FLAT_PROGRAM};
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};

/// A program that is written: what it is called in sentences, what it holds, and the file whose ending it may have in any case.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Written<'p> {
    pub(crate) what: &'static str,
    pub(crate) form: FileForm,
    pub(crate) source: Option<&'p Path>,
}

/// Refuses a name with the ending of another language.
pub(crate) fn refuse_other_ending(written: Written<'_>, out: &Path) -> Answer<()> {
    let form = written.form;
    let own = written.source.and_then(Path::extension);
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    let ending = out.extension();
    let is_kept = own.is_some() && ending.map(lower) == own.map(lower);
    if is_kept || form.fits(&name) {
        return Ok(());
    }
    let fitting = own.map_or_else(|| form.ending().to_owned(), lower);
    Err(ErrorCode::Output.failure(format!(
        "'{}': .{} is the ending of another language, and the {} is {}: name it '{}'",
        out.display(),
        ending.unwrap_or_default().to_string_lossy(),
        written.what,
        form.title(),
        out.with_extension(fitting).display()
    )))
}

/// Refuses such names of the programs that a run writes.
pub(crate) fn refuse_other_endings(setting: &Setting) -> Answer<()> {
    let form = setting.form();
    let source = Some(setting.program_path.as_path());
    let targets = &setting.targets;
    for (what, target) in [
        (COMPENSATED_PROGRAM, &targets.program),
        (FLAT_PROGRAM, &targets.flat),
    ] {
        if let Some(out) = target {
            refuse_other_ending(Written { what, form, source }, out)?;
        }
    }
    Ok(())
}

fn lower(ending: &std::ffi::OsStr) -> String {
    ending.to_string_lossy().to_ascii_lowercase()
}
