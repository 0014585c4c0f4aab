//! Control flow: labels, repeats, other programs, jumps.

use crate::error::ProgramError;
use crate::flat_run::BlockId;
use crate::heidenhain::blocks::other_end;
use crate::heidenhain::expand::run::{Fault, Frame, Next, Program, Run};
use crate::heidenhain::expand::values::{STATE_VALUE, value_of};
use crate::heidenhain::flow::{called_name, label_name};
use crate::heidenhain::words::Word;

impl Run<'_> {
    /// END PGM: the program that called goes on.
    pub(crate) fn program_ends(&mut self, at: BlockId) -> Result<Next, Fault> {
        let open = self
            .frames
            .iter()
            .rposition(|frame| matches!(frame, Frame::Program { .. }));
        let in_sub = |frames: &[Frame]| frames.iter().any(|f| matches!(f, Frame::Sub { .. }));
        let from = open.map_or(0, |open| open + 1);
        if in_sub(&self.frames[from..]) {
            return Err(self.fault(at, "the program ends in a subprogram", "end it with LBL 0"));
        }
        let Some(open) = open else {
            return Ok(Next::End);
        };
        self.frames.truncate(open + 1);
        match self.frames.pop() {
            Some(Frame::Program {
                file,
                caller,
                local,
            }) => {
                self.parameters.back(local);
                let block = caller + 1;
                Ok(Next::At(BlockId { file, block }))
            }
            _ => Ok(Next::End),
        }
    }

    fn label(&self, at: BlockId, word: Option<&Word>) -> Result<usize, Fault> {
        let program = &self.programs[at.file];
        let name = word
            .filter(|word| word.is("LBL"))
            .and_then(|word| label_name(program.file.bytes(), word));
        let to = name.as_ref().and_then(|name| program.labels.get(name));
        to.copied().ok_or_else(|| {
            let name = name.map_or_else(|| "of this name".to_owned(), |name| format!("LBL {name}"));
            self.fault(
                at,
                format!("there is no {name}"),
                "write the label, or take this out",
            )
        })
    }

    pub(crate) fn call(&mut self, at: BlockId, words: &[Word]) -> Result<Next, Fault> {
        let what = words.get(1);
        if what.is_some_and(|word| word.is("PGM")) {
            return self.call_program(at, &words[1]);
        }
        let block = self.label(at, what)?;
        let to = BlockId { block, ..at };
        let Some(again) = words.get(2) else {
            self.enter(at, Frame::Sub { caller: at.block })?;
            return Ok(Next::At(to));
        };
        // To the end of the block; of `REP 2/2` the second number is how often it is still to run.
        let end = words.last().map_or(again.span.end, |word| word.span.end);
        let text = self.programs[at.file].file.part(&(again.span.start..end));
        let text = text.split(|byte| *byte == b'/').next().unwrap_or_default();
        let count = match again.is("REP") {
            true => value_of(&text[3.min(text.len())..], &self.parameters).ok(),
            false => None,
        };
        let count = count.filter(|count| count.fract() == 0.0 && (1.0..=65_534.0).contains(count));
        let Some(count) = count else {
            return Err(self.fault(
                at,
                "how often it repeats is not a whole number from 1 to 65534",
                "write CALL LBL 1 REP 2",
            ));
        };
        // Is it the repeat that is running?
        if let Some(Frame::Again { by, left }) = self.frames.last_mut()
            && *by == at.block
        {
            if *left == 0 {
                self.frames.pop();
                return Ok(Next::Block);
            }
            *left -= 1;
            return Ok(Next::At(to));
        }
        let left = count as u64 - 1;
        self.enter(at, Frame::Again { by: at.block, left })?;
        Ok(Next::At(to))
    }

    fn call_program(&mut self, at: BlockId, word: &Word) -> Result<Next, Fault> {
        let program = &self.programs[at.file];
        let block = &program.blocks[at.block];
        let name = called_name(program.file.bytes(), block, word);
        let found = (self.programs.iter()).position(|program| program.is_named(&name));
        let Some(found) = found.filter(|_| !name.is_empty()) else {
            // The reader of the flat text says what is assumed of it.
            self.write(program.file.part(&block.text), at);
            return Ok(Next::Block);
        };
        if let Some(fault) = self.programs[found].equal_labels().next() {
            return Err(fault);
        }
        let mut others = self.programs.iter().skip(found + 1);
        if let Some(other) = others.find(|other| other.is_named(&name)) {
            let begin = |program: &Program<'_>| {
                let block = program.begin.map(|begin| &program.blocks[begin]);
                block.map_or(0..0, |block| block.text.clone())
            };
            let held = &self.programs[found];
            return Err(ProgramError::named_alike(
                other.file,
                begin(other),
                held.file,
                begin(held),
            ));
        }
        let Some(begin) = self.programs[found].begin else {
            return Err(self.fault(
                at,
                format!("`{name}` has no block BEGIN PGM"),
                "give a program",
            ));
        };
        let called = &self.programs[found];
        if let Some(other) = other_end(called.file, &called.blocks, begin) {
            return Err(other.fault);
        }
        self.may_enter(at)?;
        let local = self.parameters.called();
        self.frames.push(Frame::Program {
            file: at.file,
            caller: at.block,
            local,
        });
        Ok(Next::At(BlockId {
            file: found,
            block: begin,
        }))
    }

    pub(crate) fn jump(&mut self, at: BlockId, words: &[Word]) -> Result<Next, Fault> {
        let bytes = self.programs[at.file].file.bytes();
        let place = |name: &str| words.iter().position(|word| word.is(name));
        let (Some(from), Some(goes)) = (place("IF"), place("GOTO")) else {
            return Err(self.fault(
                at,
                "the jump is not whole",
                "write IF .. EQU .. GOTO LBL ..",
            ));
        };
        let compares = ["EQU", "NE", "GT", "LT"];
        let by = compares.iter().find_map(|name| Some((*name, place(name)?)));
        let behind = |index: usize| words[index].span.start + words[index].letters.letters().len();
        let is_true = match by {
            Some((name, at_word)) if from < at_word && at_word < goes => {
                let value = |text: &[u8]| {
                    value_of(text, &self.parameters)
                        .map_err(|reason| self.fault(at, reason, STATE_VALUE))
                };
                let left = value(&bytes[behind(from)..words[at_word].span.start])?;
                let right = value(&bytes[behind(at_word)..words[goes].span.start])?;
                match name {
                    "EQU" => left == right,
                    "NE" => left != right,
                    "GT" => left > right,
                    _ => left < right,
                }
            }
            _ => {
                return Err(self.fault(
                    at,
                    "what it compares is not known",
                    "compare with EQU, NE, GT or LT",
                ));
            }
        };
        let block = self.label(at, words.get(goes + 1))?;
        if is_true {
            self.written.goes_back(at, block);
        }
        Ok(match is_true {
            true => Next::At(BlockId { block, ..at }),
            false => Next::Block,
        })
    }
}
