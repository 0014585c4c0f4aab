//! `compensate --no-compensation`: a program of a machine as it was read, or its flat form.

use std::sync::Arc;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::counted;
use kinetostat_program::{Program, RotaryAxes, interpret};

use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::program::read_program;
use crate::job::robot::source::RobotSource;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::wrapped;
use crate::ui::screen::{self, Stream};

/// The rotary axes of the model that a copy is given: whether its program could be compensated depends on them.
pub(crate) fn rotary_of_copy(
    files: &InputFiles,
    job: Option<&JobFile>,
    model: Option<&str>,
    flags: &ProgramArgs,
) -> Option<Arc<RotaryAxes>> {
    // A copy needs no machine: what is wrong with it stops nothing.
    let machine = machine_setup(files, job, model, flags, None, &mut Vec::new());
    machine.ok()?.0.rotary
}

/// The program as it was read.
pub(crate) fn copy(setting: &Setting, existing: Existing) -> Answer<()> {
    let (holds, problem) = match &setting.robot {
        None => of_gcode(setting)?,
        Some(source) => of_control(setting, source)?,
    };
    let mut outputs = Outputs::new(existing, setting.inputs.clone());
    let mut text = wrapped(
        &format!(
            "{}: {holds}, {}.",
            setting.program_name,
            match setting.flat {
                Some(_) => "run once and written flat, without a correction",
                None => "written as read, byte for byte",
            }
        ),
        0,
    );
    if let Some(problem) = problem {
        text.push_str(&wrapped(
            &format!("It could not be compensated as it is: {problem}."),
            0,
        ));
    }
    if let Some(target) = &setting.targets.program {
        let index = outputs.claim("program", target)?;
        outputs.fill(index, &setting.program)?;
    }
    let paths = outputs.commit()?;
    text.push_str(&outputs::written(&paths));
    screen::print(Stream::Out, &text)
}

/// Describes the program, and the fault that prevents a compensation.
fn of_gcode(setting: &Setting) -> Answer<(String, Option<String>)> {
    let refuse = |error| setting.within(ErrorCode::ProgramUnsuited.failure(error));
    let program = Program::read(setting.program.clone()).map_err(refuse)?;
    let holds = format!(
        "{} in {}",
        counted(program.block_count(), "block"),
        counted(program.line_count(), "line")
    );
    let problem = interpret(&program, &setting.reading).err();
    Ok((holds, problem.map(|problem| problem.to_string())))
}

/// Describes a program of SINUMERIK or Heidenhain, and its fault.
fn of_control(setting: &Setting, source: &RobotSource) -> Answer<(String, Option<String>)> {
    if !source.language.is_in_blocks() {
        return Err(ErrorCode::Unused.failure("--no-compensation writes a program of a machine as it was read, or with --expand its flat form; a program of a robot would be its own copy: leave it where it is",
        ));
    }
    let lines = setting
        .program
        .split_inclusive(|byte| *byte == b'\n')
        .count();
    let problem = read_program(setting).err().map(|failure| failure.plain);
    Ok((counted(lines, "line"), problem))
}
