//! Blocks that are too short for the controller: which, and what to do.

use crate::number::{at_most, larger, smaller};
use crate::path::moves::{FeedMode, Move, Warning};
use crate::writing::accounting::ShortBlocksOfLine;
use crate::writing::options::WriteOptions;

/// Lines that a warning names.
const NAMED: usize = 5;

/// Relative error of the arithmetic.
const ARITHMETIC: f64 = 1e-9;

/// Margin over the shortest block, in last digits, of a piece before its ends are rounded.
const ROUNDING_DIGITS: f64 = 2.0;

/// The shortest block of a move that a controller takes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShortestBlock {
    /// Length as written, mm.
    written_mm: f64,
    /// Length of the part that the programmed feed covers in the time of a block, mm: pieces are as fast along the part.
    on_part_mm: f64,
}

impl ShortestBlock {
    /// True if a piece of this length, in place of so much of the part, is long enough.
    pub fn allows(&self, written_mm: f64, on_part_mm: f64) -> bool {
        written_mm >= self.written_mm && on_part_mm >= self.on_part_mm
    }

    /// The longer of the two lengths, mm.
    pub fn longer_mm(&self) -> f64 {
        larger(self.written_mm, self.on_part_mm)
    }
}

impl WriteOptions {
    /// The shortest block that this move is to have; `None` if no limit holds.
    pub(crate) fn shortest_block(&self, motion: &Move) -> Option<ShortestBlock> {
        let seconds = self.max_blocks_per_s.map(f64::recip);
        let in_time = seconds.zip(motion.feed).and_then(|(seconds, feed)| {
            let mm_per_minute = match feed.mode {
                FeedMode::PerMinute => Some(feed.value),
                FeedMode::InverseTime => Some(feed.value * motion.length_mm()),
                FeedMode::PerRevolution => None,
            };
            Some(seconds * mm_per_minute? / 60.0)
        });
        let rounding_mm = ROUNDING_DIGITS * self.last_digit_mm(motion.words.mm_per_unit);
        let written = self.min_block_mm.map(|least| least + rounding_mm);
        (written.is_some() || in_time.is_some()).then(|| ShortestBlock {
            written_mm: written.unwrap_or(0.0),
            on_part_mm: in_time.unwrap_or(0.0),
        })
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
    lines: Vec<ShortBlocksOfLine>,
    shortest: Option<Shortest>,
}

/// The shortest of them.
#[derive(Debug, Clone, Copy)]
struct Shortest {
    length_mm: f64,
    seconds: Option<f64>,
    line: usize,
    /// Number of pieces of its block; `None` before all of them are written.
    pieces: Option<usize>,
}

impl Found {
    fn note(&mut self, line: usize, length_mm: f64, seconds: Option<f64>) {
        self.blocks += 1;
        // NaN lengths are reported, not filtered.
        match self.lines.last_mut().filter(|last| last.line == line) {
            Some(last) => {
                last.blocks += 1;
                last.shortest_mm = smaller(last.shortest_mm, length_mm);
            }
            None => self.lines.push(ShortBlocksOfLine {
                line,
                blocks: 1,
                shortest_mm: length_mm,
            }),
        }
        let is_longer = |shortest: &Shortest| length_mm >= shortest.length_mm;
        if !self.shortest.as_ref().is_some_and(is_longer) {
            self.shortest = Some(Shortest {
                length_mm,
                seconds,
                line,
                pieces: None,
            });
        }
    }

    /// The block of this line has so many pieces.
    fn end_block(&mut self, line: usize, count: usize) {
        let own = self.shortest.as_mut().filter(|found| found.line == line);
        if let Some(found) = own {
            found.pieces = Some(count);
        }
    }

    fn warning(&self, limit: &str, options: &WriteOptions, whose: Whose) -> Option<Warning> {
        let Shortest {
            length_mm,
            seconds,
            line,
            pieces,
        } = self.shortest?;
        let named = self.lines.iter().take(NAMED);
        let named: Vec<String> = named.map(|of| of.line.to_string()).collect();
        let more = match self.lines.len() > named.len() {
            true => format!(
                " and {} more (short_blocks in the JSON result lists every line)",
                self.lines.len() - named.len()
            ),
            false => String::new(),
        };
        let time = seconds.map_or_else(String::new, |seconds| {
            format!(", {} ms", at_most(1e3 * seconds))
        });
        let (what, remedy) = match whose {
            Whose::Piece => (
                "written",
                "widen the tolerance of the path, or that of corner steps",
            ),
            Whose::Input => (
                match self.blocks {
                    1 => "of the input, carried as it is,",
                    _ => "of the input, carried as they are,",
                },
                "let the CAM system write longer ones (a wider tolerance of its chords)",
            ),
        };
        let needs = pieces.map_or_else(String::new, |pieces| {
            format!("the block here needs {pieces} pieces within the tolerances; ")
        });
        // A slower block is no longer one.
        let slower = match options.max_blocks_per_s {
            Some(_) => ", or cut more slowly there",
            None => "",
        };
        Some(Warning::new(
            line,
            format!(
                "{} block{} {what} on {} {}{more} {} shorter than the controller takes ({limit}), the shortest here with {} mm{time}: {needs}{remedy}{slower}",
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
        ))
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
        motion: &Move,
        whose: Whose,
        length_mm: f64,
        seconds: Option<f64>,
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

    /// The block of a move has so many pieces, which were noted before.
    pub fn note_count(&mut self, motion: &Move, count: usize) {
        if count > 1 {
            self.pieces.end_block(motion.line, count);
        }
    }

    /// All of them, in the order of their lines.
    pub fn by_line(&self) -> Vec<ShortBlocksOfLine> {
        let all = self.pieces.lines.iter().chain(&self.input.lines);
        let mut all: Vec<ShortBlocksOfLine> = all.copied().collect();
        all.sort_by_key(|of| of.line);
        all
    }

    /// Warnings about short blocks.
    pub fn warnings(&self, options: &WriteOptions) -> Vec<Warning> {
        let length = options.min_block_mm.map(|mm| format!("{mm} mm"));
        let rate = options
            .max_blocks_per_s
            .map(|rate| format!("{rate} blocks per second"));
        let limit: Vec<String> = length.into_iter().chain(rate).collect();
        let limit = limit.join(", ");
        [
            self.pieces.warning(&limit, options, Whose::Piece),
            self.input.warning(&limit, options, Whose::Input),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
