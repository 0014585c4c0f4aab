//! Blocks that are too short for the controller: which, and what to do.

use crate::number::{at_most, smaller};
use crate::path::moves::{FeedMode, Move, Warning};
use crate::writing::options::WriteOptions;

/// Lines that a warning names.
const NAMED: usize = 5;

/// Relative error of the arithmetic.
const ARITHMETIC: f64 = 1e-9;

impl WriteOptions {
    /// Shortest length that a block of this move is to have, in mm; none where no limit holds.
    pub(crate) fn shortest_block_mm(&self, motion: &Move) -> Option<f64> {
        let seconds = self.max_blocks_per_s.map(f64::recip);
        let in_time = seconds.zip(motion.feed).and_then(|(seconds, feed)| {
            let mm_per_minute = match feed.mode {
                FeedMode::PerMinute => Some(feed.value),
                FeedMode::InverseTime => Some(feed.value * motion.length_mm()),
                FeedMode::PerRevolution => None,
            };
            Some(seconds * mm_per_minute? / 60.0)
        });
        // The longer of the two, whichever are stated.
        match (self.min_block_mm, in_time) {
            (Some(a), Some(b)) => Some(crate::number::larger(a, b)),
            (a, b) => a.or(b),
        }
    }
}

/// Whose a short block is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Whose {
    /// The block of the input, as one piece.
    Input,
    /// A piece of one that was divided, or a step.
    Piece,
}

/// The short blocks of one kind.
#[derive(Debug, Default)]
struct Found {
    blocks: usize,
    /// Lines, each once; only the first ones.
    named: Vec<usize>,
    lines: usize,
    last_line: usize,
    /// Length and time of the shortest, and its line.
    shortest: Option<(f64, Option<f64>, usize)>,
}

impl Found {
    fn note(&mut self, line: usize, length_mm: f64, seconds: Option<f64>) {
        self.blocks += 1;
        if line != self.last_line {
            self.last_line = line;
            self.lines += 1;
            if self.named.len() < NAMED {
                self.named.push(line);
            }
        }
        let least = self
            .shortest
            .map_or(length_mm, |(least, ..)| smaller(length_mm, least));
        if self.shortest.is_none_or(|(least, ..)| length_mm < least) {
            self.shortest = Some((least, seconds, line));
        }
    }

    fn warning(&self, limit: &str, whose: Whose) -> Option<Warning> {
        let (length_mm, seconds, line) = self.shortest?;
        let named: Vec<String> = self.named.iter().map(usize::to_string).collect();
        let more = match self.lines > self.named.len() {
            true => format!(" and {} more", self.lines - self.named.len()),
            false => String::new(),
        };
        let time = seconds.map_or_else(String::new, |seconds| {
            format!(", {} ms", at_most(1e3 * seconds))
        });
        let (what, remedy) = match whose {
            Whose::Piece => (
                "written",
                "widen the tolerance of the path, or that of corner steps, or cut more slowly there",
            ),
            Whose::Input => (
                match self.blocks {
                    1 => "of the input, carried as it is,",
                    _ => "of the input, carried as they are,",
                },
                "let the CAM system write longer ones (a wider tolerance of its chords), or cut more slowly there",
            ),
        };
        Some(Warning {
            line,
            text: format!(
                "{} block{} {what} on {} {}{more} {} shorter than the controller takes ({limit}), the shortest here with {} mm{time}: {remedy}",
                self.blocks,
                if self.blocks == 1 { "" } else { "s" },
                match named.len() {
                    1 if more.is_empty() => "line",
                    _ => "the lines",
                },
                named.join(", "),
                if self.blocks == 1 { "is" } else { "are" },
                at_most(length_mm),
            ),
        })
    }
}

/// Counts blocks that are too short.
#[derive(Debug, Default)]
pub(crate) struct ShortBlocks {
    input: Found,
    pieces: Found,
}

impl ShortBlocks {
    /// A block at feed with its length as written and the time that it takes.
    pub fn note(
        &mut self,
        (motion, whose): (&Move, Whose),
        (length_mm, seconds): (f64, Option<f64>),
        options: &WriteOptions,
    ) {
        // A turn in place has no length; its time counts.
        let short = !motion.turns_in_place()
            && options
                .min_block_mm
                .is_some_and(|least| length_mm < least * (1.0 - ARITHMETIC));
        let fast = options
            .max_blocks_per_s
            .zip(seconds)
            .is_some_and(|(most, seconds)| seconds * most < 1.0 - 1e-3);
        if !short && !fast {
            return;
        }
        match whose {
            Whose::Input => self.input.note(motion.line, length_mm, seconds),
            Whose::Piece => self.pieces.note(motion.line, length_mm, seconds),
        }
    }

    /// What is to be said of them.
    pub fn warnings(&self, options: &WriteOptions) -> Vec<Warning> {
        let length = options.min_block_mm.map(|mm| format!("{mm} mm"));
        let rate = options
            .max_blocks_per_s
            .map(|rate| format!("{rate} blocks per second"));
        let limit: Vec<String> = length.into_iter().chain(rate).collect();
        let limit = limit.join(", ");
        [
            self.pieces.warning(&limit, Whose::Piece),
            self.input.warning(&limit, Whose::Input),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
