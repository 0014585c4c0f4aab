//! The run, block by block.

use crate::heidenhain::blocks::{Block, STRAY, STRAY_REMEDY};
use crate::heidenhain::expand::run::{Fault, Frame, Next, Run};
use crate::heidenhain::expand::values::begins_value;
use crate::heidenhain::flow::NOT_ALONE;
use crate::heidenhain::words::{EXPONENT, Value, Word, exponent};
use crate::refused_run::Behind;

/// Most blocks that run one after another without one that is written.
const MOST_SILENT: usize = 1_000_000;

/// Most blocks that run.
const MOST_STEPS: usize = 20_000_000;

impl Run<'_> {
    /// Runs the program; what is refused is noted.
    pub(crate) fn whole(&mut self) {
        if let Err(fault) = self.blocks() {
            self.refuse(fault, Behind::Nothing);
        }
    }

    fn blocks(&mut self) -> Result<(), Fault> {
        let programs = self.programs;
        let begin = programs[0].begin.unwrap_or(0);
        let mut at = (0, 0);
        // What stands before the program stays.
        while at.1 < begin {
            let text = &programs[0].blocks[at.1];
            self.raw(programs[0].file.part(&text.lines), at)?;
            at.1 += 1;
        }
        if let (Some(_), Some(number)) = (self.number, &programs[0].blocks[begin].number) {
            let digits = String::from_utf8_lossy(programs[0].file.part(number)).into_owned();
            self.number = Some(digits.parse().unwrap_or(0));
        }
        loop {
            self.steps += 1;
            self.silent += 1;
            let fewer = self.most_blocks.saturating_mul(4);
            if self.steps > MOST_STEPS.min(fewer) || self.silent > MOST_SILENT {
                return Err(self.endless(
                    at,
                    "the program runs more than a million blocks that write nothing, or 20 million in all",
                ));
            }
            if at.1 >= programs[at.0].blocks.len() {
                let last = (at.0, at.1.saturating_sub(1));
                return match self.frames.last() {
                    None => Ok(()),
                    Some(Frame::Program { .. }) => Err(self.fault(
                        last,
                        "no block END PGM ends the program that is called",
                        "give the whole program",
                    )),
                    Some(_) => {
                        Err(self.fault(last, "the file ends in a subprogram", "end it with LBL 0"))
                    }
                };
            }
            let written = self.origins.len();
            match self.block(at) {
                Ok(Next::Block) => at.1 += 1,
                Ok(Next::At(file, block)) => at = (file, block),
                Ok(Next::End) => break,
                Err(fault) => {
                    let behind = self.behind(at);
                    if !self.refuse(fault, behind) {
                        return Ok(());
                    }
                    self.go_on(at, written)?;
                    at.1 += 1;
                }
            }
        }
        // The last block of the program.
        let main = &programs[0];
        let is_end = |block: &&Block| {
            block
                .words(main.file.bytes())
                .first()
                .is_some_and(|word| word.is("END"))
        };
        if let Some(end) = main
            .blocks
            .iter()
            .skip(begin)
            .position(|block| is_end(&block))
        {
            let end = begin + end;
            self.write(main.file.part(&main.blocks[end].text), (0, end))?;
        }
        Ok(())
    }

    fn block(&mut self, at: (usize, usize)) -> Result<Next, Fault> {
        let program = &self.programs[at.0];
        let (file, block) = (program.file, &program.blocks[at.1]);
        let words = block.words(file.bytes());
        let Some(first) = words.first() else {
            let text = file.part(&block.text);
            if !text.is_empty() || self.number.is_none() {
                self.write(text, at)?;
            }
            return Ok(Next::Block);
        };
        if block.skipped {
            return Err(self.fault(
                at,
                "the block is skipped or not, as a switch of the machine says",
                "take the sign `/` away, or the block out",
            ));
        }
        if exponent(&words).is_some() {
            return Err(self.fault(at, EXPONENT.0, EXPONENT.1));
        }
        match first.letters.letters() {
            b"BEGIN" if at.0 == 0 => self.write(file.part(&block.text), at)?,
            b"BEGIN" => {
                if program.unit_mm() != self.unit_mm {
                    return Err(self.fault(
                        at,
                        "the program that is called has another unit",
                        "write both in one unit",
                    ));
                }
            }
            b"END" => return self.program_ends(at),
            b"LBL" if words.len() > 1 => {
                return Err(self.fault(at, NOT_ALONE.0, NOT_ALONE.1));
            }
            b"LBL" => {
                let is_end = first.value() == Some(0.0);
                let sub = self
                    .frames
                    .iter()
                    .rposition(|frame| matches!(frame, Frame::Sub { .. } | Frame::Program { .. }));
                if let (true, Some(sub)) = (is_end, sub)
                    && let Frame::Sub { caller } = self.frames[sub]
                {
                    self.frames.truncate(sub);
                    return Ok(Next::At(at.0, caller + 1));
                }
            }
            b"CALL" => return self.call(at, &words),
            b"FN" => return self.function(at, &words),
            b"Q" | b"QL" | b"QR" => self.assign(at, &words)?,
            b"QS" => {}
            // Its parameters are what it finds.
            b"TCH" => self.write(file.part(&block.text), at)?,
            b"CYCL" | b"CYCLE" if block.no_parameter(file.bytes()).is_some() => {
                return Err(self.fault(at, STRAY, STRAY_REMEDY));
            }
            b"CYCL" | b"CYCLE" => self.cycle(at, &words)?,
            _ => return self.path(at, &words),
        }
        Ok(Next::Block)
    }

    fn function(&mut self, at: (usize, usize), words: &[Word]) -> Result<Next, Fault> {
        let bytes = self.programs[at.0].file.bytes();
        match words[0].whole() {
            Some(0..=8 | 13) => self.assign(at, &words[1..])?,
            Some(9..=12) => return self.jump(at, words),
            Some(14) => {
                return Err(self.fault(
                    at,
                    "the program ends here with an error of its own",
                    "mend the values that lead here",
                ));
            }
            Some(17 | 25) | None => {
                return Err(self.fault(
                    at,
                    "it writes data of the control, which may move the coordinates",
                    "take it into a program of its own",
                ));
            }
            Some(_) => {
                // What only the machine knows has no value behind it.
                let mut reads = false;
                for pair in words[1..].windows(2) {
                    if begins_value(&pair[1], bytes) && pair[0].whole().is_some() {
                        let letters =
                            String::from_utf8_lossy(pair[0].letters.letters()).into_owned();
                        let key = format!("{letters}{}", pair[0].whole().unwrap_or(0));
                        self.parameters.remove(&key);
                        reads = true;
                    }
                    for word in pair.iter().filter(|_| reads) {
                        // `SYSREAD Q11`.
                        if let Value::Parameter { name, .. } = &word.value {
                            let key = String::from_utf8_lossy(&bytes[name.clone()]);
                            self.parameters.remove(&key.to_ascii_uppercase());
                        }
                    }
                }
                if let Some(Value::Parameter { name, .. }) = words
                    .iter()
                    .find(|word| word.is("SYSREAD"))
                    .map(|word| &word.value)
                {
                    let key = String::from_utf8_lossy(&bytes[name.clone()]).to_ascii_uppercase();
                    self.parameters.remove(&key);
                }
                let block = &self.programs[at.0].blocks[at.1];
                self.write(self.programs[at.0].file.part(&block.text), at)?;
            }
        }
        Ok(Next::Block)
    }
}
