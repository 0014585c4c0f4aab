//! The rotary axes of the model for the first reading of a program in the language of a machine's control.
//!
//! Its tool and its frames are asked for before the machine of the run is known; where its words turn rotary axes, it cannot be
//! read without these.

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::model_named::model_named;
use crate::job::placement::placement;
use crate::job::rotary::rotary;
use crate::job::setting::Setting;
use crate::job::tools::tool;
use crate::ui::failure::Answer;

/// Gives a SINUMERIK or Heidenhain program the rotary axes of the model; others stay as they are.
pub(crate) fn give_axes(
    setting: &mut Setting,
    files: &InputFiles,
    (job, flag_model): (Option<&JobFile>, Option<&str>),
    flags: &ProgramArgs,
) -> Answer<()> {
    let Some(source) = &setting.robot else {
        return Ok(());
    };
    if !source.language.is_in_blocks() {
        return Ok(());
    }
    let (named, base) = model_named(job, flag_model)?;
    let (model, _) = files.model(&named, &base)?;
    if model.rotary_axes().is_empty() {
        return Ok(());
    }
    let (tool, _) = tool(job, flags)?;
    let mechanism = model.mechanism.with_tool(&tool);
    let placement = placement(job, flags, &mechanism)?;
    setting.turned_by(rotary(&model, &placement));
    Ok(())
}
