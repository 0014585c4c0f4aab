//! What the run of a program knows: where it is, what it has written, what is in force.

use std::collections::BTreeMap;

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
    pub steps: usize,
    pub silent: usize,
    pub most_blocks: usize,
    /// Blocks that were jumped back to by their files, each with the last block from where.
    pub back_to: BTreeMap<(usize, usize), usize>,
    /// It reached the most blocks or bytes: what it wrote is not the program.
    pub is_endless: bool,
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

    /// Notes a jump, where it goes back.
    pub(crate) fn goes_back(&mut self, file: usize, from: usize, to: usize) {
        if to <= from {
            let last = self.back_to.entry((file, to)).or_insert(from);
            *last = from.max(*last);
        }
    }

    /// Why a run ends that does not end by itself: at the block that jumps back to the beginning of the loop, where one runs.
    pub(crate) fn endless(&mut self, at: (usize, usize), reason: &str) -> Fault {
        self.is_endless = true;
        // From the block that runs to the one in the first program that led there.
        let mut runs = vec![at];
        let mut file = at.0;
        for frame in self.frames.iter().rev() {
            let block = match frame {
                Frame::Sub { caller } => *caller,
                Frame::Again { by, .. } => *by,
                Frame::Program {
                    file: calls,
                    caller,
                    ..
                } => {
                    file = *calls;
                    *caller
                }
            };
            runs.push((file, block));
        }
        let last = runs.into_iter().rev().find_map(|(file, block)| {
            let loops = self.back_to.iter();
            let around =
                loops.filter(|((of, from), to)| *of == file && (*from..=**to).contains(&block));
            let widest = around.max_by_key(|((_, from), to)| **to - from);
            widest.map(|(_, to)| (file, *to))
        });
        match last {
            Some(last) => self.fault(
                last,
                format!("the loop that jumps back here does not end: {reason}"),
                "check its condition, or divide the program",
            ),
            None => self.fault(at, reason, "repeat fewer times, or divide the program"),
        }
    }

    /// Bytes as they are, with their line ends.
    pub(crate) fn raw(&mut self, bytes: &[u8], at: (usize, usize)) -> Result<(), Fault> {
        let program = &self.programs[at.0];
        let line = program.file.line_of(program.blocks[at.1].lines.start);
        let lines = bytes.iter().filter(|byte| **byte == b'\n').count();
        let lines = lines + usize::from(!bytes.ends_with(b"\n"));
        let full = self.origins.len() + lines > self.most_blocks;
        if full || self.output.len() + bytes.len() > MOST_BYTES {
            return Err(self.endless(
                at,
                "the flat program has more than 5 million blocks, or 256 MiB",
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
