//! State of a run: position, written text, modal state.

use crate::error::ProgramError;
use crate::flat_run::{BlockId, Written};
use crate::heidenhain::expand::program::Program;
use crate::heidenhain::expand::values::{Local, Values};
use crate::options::ReadOptions;
use crate::text::source::SourceFile;

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
