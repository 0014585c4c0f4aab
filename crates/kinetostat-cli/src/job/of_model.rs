//! Model data for the first reading of a program, before the machine of the run is known.

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::axes_of_program::give_axes;
use crate::job::job_file::JobFile;
use crate::job::robot::joint_arm::give_arm;
use crate::job::setting::Setting;
use crate::ui::failure::Answer;

/// Gives a table of joint values the arm of the model, and a program whose words turn rotary axes those of the model.
pub(crate) fn give_of_model(
    setting: &mut Setting,
    files: &InputFiles,
    model: (Option<&JobFile>, Option<&str>),
    flags: &ProgramArgs,
) -> Answer<()> {
    give_arm(setting.robot.as_mut(), files, model, flags)?;
    give_axes(setting, files, model, flags)
}
