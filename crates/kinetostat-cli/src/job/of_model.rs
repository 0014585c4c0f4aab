//! Model data for the first reading of a program, before the machine of the run is known.
//!
//! A program in the language of a machine's control whose words turn rotary axes cannot be read without those of the model.

use kinetostat_model::Model;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::{JobFile, model_named};
use crate::job::machine::{MachineSetup, machine_setup};
use crate::job::placement::placement;
use crate::job::robot::joint_arm::give_arm;
use crate::job::rotary::rotary;
use crate::job::setting::Setting;
use crate::job::tools::tool;
use crate::ui::failure::Answer;

/// The machine of a run and its model; the setting gets what the model states of how its program is read.
pub(crate) fn machine_of(
    setting: &mut Setting,
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
    flags: &ProgramArgs,
) -> Answer<(MachineSetup, Model)> {
    give_of_model(setting, files, job, flag_model, flags)?;
    let frames = setting.robot_frames()?;
    let inputs = &mut setting.inputs;
    let found = machine_setup(files, job, flag_model, flags, frames.as_ref(), inputs)?;
    setting.turned_by(found.0.rotary.clone());
    Ok(found)
}

/// Gives a table of joint values the arm of the model, and a program whose words turn rotary axes those of the model.
pub(crate) fn give_of_model(
    setting: &mut Setting,
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
    flags: &ProgramArgs,
) -> Answer<()> {
    give_arm(setting.robot.as_mut(), files, job, flag_model, flags)?;
    give_axes(setting, files, job, flag_model, flags)
}

/// Gives a SINUMERIK or Heidenhain program the rotary axes of the model; others stay as they are.
fn give_axes(
    setting: &mut Setting,
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
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
