//! What the run of a program knows: where it is, what it has written, what is in force.

use crate::error::ProgramError;
use crate::heidenhain::expand::program::Program;
use crate::heidenhain::expand::values::{Local, Values};
use crate::options::ReadOptions;
use crate::refused_run::FaultsOfRun;

/// Most bytes of it.
const MOST_BYTES: usize = 1 << 28;

/// Deepest nesting of calls and repeats.
pub(crate) const DEEPEST: usize = 20;

/// What is running.
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
    pub programs: &'p [Program<'p>],
    pub unit_mm: f64,
    /// The next number, where blocks have one.
    pub number: Option<u64>,
    pub ending: &'static [u8],
    pub parameters: Values,
    pub frames: Vec<Frame>,
    pub output: Vec<u8>,
    pub origins: Vec<(usize, usize)>,
    /// The number of the cycle that a call runs.
    pub cycle: Option<u32>,
    /// Numbers of cycle 1 by their lines.
    pub pecking: [Option<f64>; 6],
    /// Q208 is MAX.
    pub rapid_out: bool,
    /// M89 is on.
    pub modal: bool,
    /// The feed in force, as written.
    pub feed: Option<String>,
    /// A hole has left another feed behind.
    pub feed_lost: bool,
    pub steps: usize,
    pub silent: usize,
    pub most_blocks: usize,
    /// The definition of the cycle in force is refused: nothing is said of its calls.
    pub cycle_refused: bool,
    pub faults: FaultsOfRun,
}

/// Where the run goes on.
pub(crate) enum Next {
    Block,
    At(usize, usize),
    End,
}

/// Why the run ends.
pub(crate) type Fault = ProgramError;

impl Run<'_> {
    pub(crate) fn fault(
        &self,
        at: (usize, usize),
        reason: impl Into<String>,
        remedy: &str,
    ) -> Fault {
        let program = &self.programs[at.0];
        let text = program
            .blocks
            .get(at.1)
            .map_or(0..0, |block| block.text.clone());
        ProgramError::at(program.file, text, reason, remedy)
    }

    /// Bytes as they are, with their line ends.
    pub(crate) fn raw(&mut self, bytes: &[u8], at: (usize, usize)) -> Result<(), Fault> {
        let program = &self.programs[at.0];
        let line = program.file.line_of(program.blocks[at.1].lines.start);
        let lines = bytes.iter().filter(|byte| **byte == b'\n').count();
        let lines = lines + usize::from(!bytes.ends_with(b"\n"));
        let full = self.origins.len() + lines > self.most_blocks;
        if full || self.output.len() + bytes.len() > MOST_BYTES {
            return Err(self.fault(
                at,
                "the flat program has more than 5 million blocks, or 256 MiB",
                "repeat fewer times, or divide the program",
            ));
        }
        self.output.extend_from_slice(bytes);
        self.origins
            .extend((0..lines).map(|further| (at.0, line + further)));
        Ok(())
    }

    /// A block: its text without number and line end.
    pub(crate) fn write(&mut self, text: &[u8], at: (usize, usize)) -> Result<(), Fault> {
        self.silent = 0;
        let mut bytes = Vec::with_capacity(text.len() + 12);
        if let Some(number) = self.number {
            bytes.extend(format!("{number} ").bytes());
            self.number = Some(number + 1);
        }
        bytes.extend_from_slice(text);
        bytes.extend_from_slice(self.ending);
        self.raw(&bytes, at)
    }

    pub(crate) fn may_enter(&self, at: (usize, usize)) -> Result<(), Fault> {
        if self.frames.len() >= DEEPEST {
            return Err(self.fault(
                at,
                "calls and repeats are nested more than 20 deep",
                "nest them less deeply",
            ));
        }
        Ok(())
    }

    pub(crate) fn enter(&mut self, at: (usize, usize), frame: Frame) -> Result<(), Fault> {
        self.may_enter(at)?;
        self.frames.push(frame);
        Ok(())
    }
}
