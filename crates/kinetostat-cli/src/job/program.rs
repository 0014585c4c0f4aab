//! The program of a run, read and interpreted.

use kinetostat_program::{Path as ToolPath, Program, faults, interpret};

use crate::job::expansion::advice::advice;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failure};
use crate::ui::fault_list::fault_list_text;

/// Reads and interprets a program.
pub(crate) fn read_program(setting: &Setting) -> Answer<(Program, ToolPath)> {
    let read = Program::read(setting.program.clone()).and_then(|program| {
        let path = interpret(&program, &setting.reading)?;
        Ok((program, path))
    });
    read.map_err(|error| {
        let all = faults(setting.program.clone(), &setting.reading);
        let message = fault_list_text("lines", &error, &all, |fault| fault.reason.as_str());
        let (bytes, path) = (&setting.program, &setting.program_path);
        let first = match setting.flat {
            Some(_) => None,
            None => advice(bytes, path, &setting.reading, &all),
        };
        setting.within(Failure::input(first.unwrap_or_default() + &message))
    })
}
