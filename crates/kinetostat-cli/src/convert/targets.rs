//! Output paths of a run that is written in another language.

use std::path::{Path, PathBuf};

use kinetostat_formats::MakeLanguage;

use crate::files::file_names::stem;
use crate::files::paths::{COMPENSATED, FLAT};
use crate::job::file_endings::{Written, refuse_other_ending};
use crate::job::job_file::JobFile;
use crate::job::output_paths::{
    COMPENSATED_PROGRAM, FLAT_PROGRAM, OutputPaths, in_folder, or_its_folder,
};
use crate::ui::failure::Answer;

/// Programs that options name.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Named<'o> {
    pub(crate) out: Option<&'o Path>,
    pub(crate) flat: Option<&'o Path>,
}

/// Puts the programs where they go in the other language: one that neither options nor the job name is called like its module, in a
/// folder of its own.
pub(crate) fn in_language(
    targets: &mut OutputPaths,
    program: &Path,
    module: Option<String>,
    job: Option<&JobFile>,
    options: Named<'_>,
    language: MakeLanguage,
) -> Answer<()> {
    let in_job = job.map(|j| &j.job.output);
    let out_is_named =
        options.out.is_some() || in_job.is_some_and(|output| output.program.is_some());
    let flat_is_named =
        options.flat.is_some() || in_job.is_some_and(|output| output.flat_program.is_some());
    let named = targets.program.take().unwrap_or_default();
    let module = module.unwrap_or_else(|| stem(program));
    let own = PathBuf::from(format!("{module}.{}", language.ending()));
    let out = match out_is_named {
        true => named,
        false => in_folder(&or_its_folder(&named), &own, COMPENSATED)?,
    };
    let flat = match (targets.flat.take().filter(|_| flat_is_named), out_is_named) {
        (Some(flat), _) => flat,
        (None, true) => as_converted(&out, language),
        (None, false) => in_folder(&or_its_folder(&out), &own, FLAT)?,
    };
    for (what, path) in [(COMPENSATED_PROGRAM, &out), (FLAT_PROGRAM, &flat)] {
        let written = Written {
            what,
            form: language.form(),
            source: None,
        };
        refuse_other_ending(written, path)?;
    }
    targets.beside.clear();
    targets.program = Some(out);
    targets.flat = Some(flat);
    Ok(())
}

/// Path of the converted program beside its compensated form.
fn as_converted(out: &Path, language: MakeLanguage) -> PathBuf {
    let ending = out.extension().map(|ending| ending.to_string_lossy());
    let ending = ending.unwrap_or_else(|| language.ending().into());
    out.with_file_name(format!("{}_flat.{ending}", stem(out)))
}
