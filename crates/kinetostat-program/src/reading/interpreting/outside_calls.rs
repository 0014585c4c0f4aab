//! Calls of subprograms (M98, G65): only a run for Fanuc's controllers leaves them in a program, those that are in none of its files.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::reading::block::Block;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::text::program::Program;
use crate::text::syntax::{FLATTEN, of_subprogram};

impl Interpreter<'_> {
    /// Carries a block that calls a subprogram: the tool is taken to stay where it is; false for any other block.
    pub(super) fn outside_call(
        &mut self,
        program: &Program,
        index: usize,
    ) -> Result<bool, ProgramError> {
        let words = program.words(&program.lines()[index]);
        let call = words.iter().find(|word| {
            word.letter == b'M' && word.value == 98.0 || word.letter == b'G' && word.value == 65.0
        });
        let Some(call) = call else {
            return Ok(false);
        };
        let Some(called) = words.iter().find(|word| word.letter == b'P') else {
            return Ok(false);
        };
        let refused = |reason: &str, remedy: &str| {
            let block = Block::understood(program, index);
            Err(block.refuse(ProgramErrorKind::UnknownCode, Some(call), reason, remedy))
        };
        let number = called.value as u32;
        if !self.options.of_fanuc_run || f64::from(number) != called.value {
            let what = match call.letter {
                b'M' => "M98",
                _ => "the macro call G65",
            };
            return refused(&of_subprogram(what), FLATTEN);
        }
        if self.options.moving_calls.contains(&number) {
            return refused(
                &format!(
                    "O{number} moves the tool, as is stated, and none of the files says where to"
                ),
                "give its file as well, or divide the program at the call",
            );
        }
        let line = program.number_of(index);
        self.outside_calls.entry(number).or_insert(line);
        self.repeated.note(line, &format!("O{number} is in none of the files: it is taken not to move the tool and not to change speed, tool or frame; state it under [calls] if it moves, or give its file"));
        Ok(true)
    }

    /// Names the subprograms that are stated to move the tool, and that nothing calls.
    pub(super) fn warn_of_calls_without_effect(&mut self) {
        for number in self.options.moving_calls.clone() {
            self.warn(1, &format!("O{number}, of which is stated that it moves the tool, is called nowhere, or its file is given: that changes nothing"));
        }
    }
}
