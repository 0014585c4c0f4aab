//! State of a run: the programs, the position in them, the written text, the modal state and the Q parameters.

use crate::error::ProgramError;
use crate::flat_run::{BlockId, Written};
use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::expand::values::{
    Local, Parameters, STATE_VALUE, Values, begins_value, no_value, value_of,
};
use crate::heidenhain::flow::{Labels, NAME_IT, is_called, label_twice, labels_of, order, step_of};
use crate::heidenhain::state::is_of_plane;
use crate::heidenhain::words::{Value, Word, length};
use crate::model::stated_value::SlashBlocks;
use crate::options::ReadOptions;
use crate::text::number::short;
use crate::text::source::{Edits, SourceFile};

/// Deepest nesting of calls and repeats.
pub(crate) const DEEPEST: usize = 20;

/// Running program or repeat.
pub(crate) enum Frame {
    /// A subprogram: the block that called it.
    Sub { caller: usize },
    /// A part that runs again: the block that says so, how often still.
    Again { by: usize, left: u64 },
    /// Another program: the file and block that called it, and the QL parameters there.
    Program {
        file: usize,
        caller: usize,
        local: Local,
    },
}

/// A run.
pub(crate) struct Run<'p> {
    pub options: &'p ReadOptions,
    pub files: &'p [SourceFile],
    /// Programs in the order of the files.
    pub programs: &'p [Program<'p>],
    pub unit_mm: f64,
    /// The next number, where blocks have one.
    pub number: Option<u64>,
    pub parameters: Values,
    pub frames: Vec<Frame>,
    pub written: Written,
    /// The block that runs; none at the end.
    pub at: Option<BlockId>,
    /// The number of the cycle that a call runs.
    pub cycle: Option<u32>,
    /// Numbers of cycle 1 by their lines.
    pub pecking: [Option<f64>; 6],
    /// The tool's axis.
    pub axis: &'static str,
    /// Q208 is MAX.
    pub rapid_out: bool,
    /// M89 is on.
    pub modal: bool,
    /// The feed in force, as written.
    pub feed: Option<String>,
    /// A hole has left another feed behind.
    pub feed_lost: bool,
    /// The definition of the cycle in force is refused: nothing is said of its calls.
    pub cycle_refused: bool,
}

/// Continuation of the run.
pub(crate) enum Next {
    Block,
    At(BlockId),
    End,
}

/// Error that ends the run.
pub(crate) type Fault = ProgramError;

impl Run<'_> {
    pub(crate) fn fault(&self, at: BlockId, reason: impl Into<String>, remedy: &str) -> Fault {
        let program = &self.programs[at.file];
        let text = program
            .blocks
            .get(at.block)
            .map_or(0..0, |block| block.text.clone());
        ProgramError::at(program.file, text, reason, remedy)
    }

    /// A block: its text without number and line end.
    pub(crate) fn write(&mut self, text: &[u8], at: BlockId) {
        let program = &self.programs[at.file];
        let line = program.file.line_of(program.blocks[at.block].lines.start);
        let number = self
            .number
            .map_or(Vec::new(), |number| format!("{number} ").into());
        self.number = self.number.map(|number| number + 1);
        let slash: &[u8] = match program.blocks[at.block].skipped {
            true => b"/",
            false => b"",
        };
        self.written
            .line(&[slash, &number, text].concat(), at.file, line);
    }

    pub(crate) fn may_enter(&self, at: BlockId) -> Result<(), Fault> {
        if self.frames.len() >= DEEPEST {
            return Err(self.fault(
                at,
                "calls and repeats are nested more than 20 deep",
                "nest them less deeply",
            ));
        }
        Ok(())
    }

    pub(crate) fn enter(&mut self, at: BlockId, frame: Frame) -> Result<(), Fault> {
        self.may_enter(at)?;
        self.frames.push(frame);
        Ok(())
    }
}

/// A file of the program.
pub(crate) struct Program<'f> {
    pub file: &'f SourceFile,
    pub blocks: Vec<Block>,
    pub labels: Labels,
    /// Blocks that state a label a second time, each behind that of before.
    pub twice: Vec<[usize; 2]>,
    /// The block BEGIN PGM.
    pub begin: Option<usize>,
}

impl<'f> Program<'f> {
    pub(crate) fn of(file: &'f SourceFile) -> Self {
        let blocks = blocks_of(file.bytes());
        let (labels, twice) = labels_of(file.bytes(), &blocks);
        let begins = |block: &Block| {
            let letter = file.bytes().get(block.text.start);
            letter.is_some_and(|letter| letter.eq_ignore_ascii_case(&b'B'))
                && block
                    .words(file.bytes())
                    .first()
                    .is_some_and(|word| word.is("BEGIN"))
        };
        let begin = blocks.iter().position(begins);
        Self {
            file,
            blocks,
            labels,
            twice,
            begin,
        }
    }

    pub(crate) fn unit_mm(&self) -> f64 {
        let words = self
            .begin
            .map(|at| self.blocks[at].words(self.file.bytes()));
        match words.is_some_and(|words| words.iter().any(|word| word.is("INCH"))) {
            true => 25.4,
            false => 1.0,
        }
    }

    /// True if CALL PGM calls the program by this name.
    pub(crate) fn is_named(&self, name: &str) -> bool {
        is_called(self.file, name)
    }

    /// Errors of labels that are defined twice.
    pub(crate) fn equal_labels(&self) -> impl Iterator<Item = ProgramError> + '_ {
        let fault = |[first, index]: &[usize; 2]| {
            let text = self.blocks[*index].text.clone();
            let line = self.file.line_of(self.blocks[*first].text.start);
            ProgramError::at(self.file, text, label_twice(line), NAME_IT)
        };
        self.twice.iter().map(fault)
    }

    /// True if the program needs to be expanded.
    pub(crate) fn needs(&self, slash: SlashBlocks) -> bool {
        let bytes = self.file.bytes();
        let Some(begin) = self.begin else {
            return false;
        };
        let mut calls = false;
        for block in &self.blocks[begin..] {
            let words = block.words(bytes);
            let Some(first) = words.first() else {
                continue;
            };
            let assigns = matches!(first.letters.letters(), b"Q" | b"QL" | b"QR" | b"QS");
            match first.letters.letters() {
                b"CALL" if words.len() == 2 && words[1].is("LBL") => calls = true,
                b"CALL" => return true,
                b"FN" if matches!(first.whole(), Some(9..=12)) => return true,
                b"FN" => continue,
                b"CYCL" | b"CYCLE" if words.get(1).is_some_and(|word| word.is("CALL")) => {
                    return true;
                }
                _ if assigns => continue,
                _ => {}
            }
            let needs = |word: &Word| {
                matches!(word.value, Value::Parameter { .. })
                    || (word.is("M") && matches!(word.whole(), Some(89 | 99)))
            };
            if words.iter().any(needs) {
                return true;
            }
        }
        calls
            && order(begin, self.blocks.len(), &self.labels, |at| {
                step_of(bytes, &self.blocks[at], slash)
            })
            .is_err()
    }
}

impl Run<'_> {
    /// Puts values into parameters: `Q1 = ...`, more of them in a cycle.
    pub(crate) fn assign(&mut self, at: BlockId, words: &[Word]) -> Result<(), Fault> {
        let bytes = self.programs[at.file].file.bytes();
        let is_name = |word: &Word| {
            matches!(word.letters.letters(), b"Q" | b"QL" | b"QR") && word.whole().is_some()
        };
        let starts: Vec<usize> = (0..words.len().saturating_sub(1))
            .filter(|index| is_name(&words[*index]) && begins_value(&words[index + 1], bytes))
            .collect();
        if starts.is_empty() {
            return Err(self.fault(at, "no parameter gets a value here", "write Q1 = ..."));
        }
        for (order, index) in starts.iter().enumerate() {
            let next = starts.get(order + 1).copied().unwrap_or(words.len());
            let name = &words[*index];
            let key = format!(
                "{}{}",
                String::from_utf8_lossy(name.letters.letters()),
                name.whole().unwrap_or(0)
            );
            // Comments between are no words.
            let parts = words[index + 1..next]
                .iter()
                .map(|word| &bytes[word.span.clone()]);
            let text = parts.collect::<Vec<_>>().join(&b' ');
            let text = text.strip_prefix(b"=").unwrap_or(&text).trim_ascii();
            if key == "Q208" {
                self.rapid_out = text.eq_ignore_ascii_case(b"MAX");
            }
            if ["MAX", "FMAX", "AUTO", "FAUTO"]
                .iter()
                .any(|w| text.eq_ignore_ascii_case(w.as_bytes()))
            {
                self.parameters.remove(&key);
                continue;
            }
            let value = value_of(text, &self.parameters);
            let value = value.map_err(|reason| self.fault(at, reason, STATE_VALUE))?;
            self.parameters.insert(key, value);
        }
        Ok(())
    }

    /// The text of a block with values in place of its parameters.
    pub(crate) fn text(&self, at: BlockId, words: &[Word]) -> Result<Vec<u8>, Fault> {
        let program = &self.programs[at.file];
        let block = &program.blocks[at.block];
        let bytes = program.file.bytes();
        let mut edits = Edits::default();
        for (index, word) in words.iter().enumerate() {
            let (span, sign, name) = match &word.value {
                Value::Parameter { span, sign, name } => (span.clone(), *sign, name.clone()),
                // `= Q5` without a sign.
                Value::Number(number)
                    if matches!(word.letters.letters(), b"Q" | b"QL" | b"QR")
                        && index > 0
                        && begins_value(&words[index - 1], bytes) =>
                {
                    (word.span.clone(), 1.0, word.span.start..number.span.end)
                }
                _ => continue,
            };
            let key: Vec<u8> = bytes[name]
                .iter()
                .filter(|byte| !byte.is_ascii_whitespace())
                .map(u8::to_ascii_uppercase)
                .collect();
            let key = String::from_utf8_lossy(&key).into_owned();
            let held = self.parameters.value(&key);
            if held.is_none() && is_of_plane(word, bytes) {
                continue;
            }
            let Some(value) = held else {
                return Err(self.fault(at, no_value(&key), STATE_VALUE));
            };
            let plain = ["F", "S", "M", "CALL", "DEF"]
                .iter()
                .any(|letters| word.is(letters));
            let text = match plain {
                true => short(sign * value, 3),
                false => length(sign * value, self.unit_mm),
            };
            edits.replace(span, text);
        }
        let text = edits.applied_to_part(bytes, &block.text);
        text.ok_or_else(|| {
            self.fault(
                at,
                "its words overlap",
                "write the block as the control shows it",
            )
        })
    }

    pub(crate) fn substituted(&mut self, at: BlockId, words: &[Word]) -> Result<Vec<u8>, Fault> {
        let text = self.text(at, words)?;
        self.write(&text, at);
        Ok(text)
    }
}
