//! The account of a written program: nothing that came in is unaccounted for in what goes out.

use std::collections::VecDeque;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::path::moves::{Feed, FeedMode, Move, Warning};

/// Summary of the changes to a program. All lengths in mm.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Accounting {
    /// Blocks (lines with words) of the input; `blocks_carried + blocks_corrected`.
    pub blocks_in: usize,
    /// Blocks whose bytes are the same in the output.
    pub blocks_carried: usize,
    /// Blocks whose bytes changed.
    pub blocks_corrected: usize,
    /// Blocks that became several; part of `blocks_corrected`.
    pub blocks_split: usize,
    /// Blocks of the output; `blocks_in` and the further pieces of the split ones.
    pub blocks_out: usize,
    /// Motions of the input.
    pub moves_in: usize,
    /// Motions of the output.
    pub pieces: usize,
    /// Bytes of the input.
    pub bytes_in: usize,
    /// Bytes of the output.
    pub bytes_out: usize,
    /// Lines of the header in the output; 0 where none is written.
    pub header_lines: usize,
    /// Number of evaluations of the field.
    pub evaluations: usize,
    /// Largest correction, before rounding.
    pub largest_correction_mm: f64,
    /// Line of the input with the largest correction, `None` if nothing was corrected.
    pub largest_correction_line: Option<usize>,
    /// Largest distance between a corrected point and the one written, from rounding to decimals.
    pub largest_rounding_mm: f64,
    /// Largest component of a correction that was left out because the program never states its
    /// axis.
    pub left_out_mm: f64,
    /// Shortest piece of a feed move that was split, measured on the part; `None` if none was.
    pub smallest_piece_mm: Option<f64>,
    /// Steps of the tool at places where the correction jumps (a corner turns the load), but for those where a rapid ends.
    pub corner_steps: usize,
    /// Longest of these steps.
    pub largest_corner_step_mm: f64,
    /// Steps of the tool where a rapid ends and the load is there at once ([`Turn::is_entry`](crate::Turn::is_entry)), and where the
    /// program begins, without a correction until there.
    pub entry_steps: usize,
    /// Longest of these steps.
    pub largest_entry_step_mm: f64,
    /// Line of the input with the longest of them.
    pub largest_entry_step_line: Option<usize>,
    /// Largest jump of the correction that got no step, because it is below
    /// [`crate::WriteOptions::corner_step_mm`]; the piece after it starts that far from its place.
    pub largest_jump_taken_up_mm: f64,
    /// Largest way of a step, or of a piece, against the direction of motion of its own block or of the
    /// block before.
    pub largest_backward_mm: f64,
    /// Steps and pieces that go so by more than [`crate::WriteOptions::backward_step_mm`].
    pub backward_steps: usize,
    /// Line of the input with the largest of them.
    pub largest_backward_line: Option<usize>,
    /// Pieces whose feed was held to [`crate::WriteOptions::max_feed_factor`] times the programmed one.
    pub feed_limited_pieces: usize,
    /// Line of the input with the first of them.
    pub feed_limited_line: Option<usize>,
    /// Slowest speed along the part on these pieces, as a share of the programmed one; `None` if no feed
    /// was limited.
    pub slowest_limited_speed: Option<f64>,
    /// Length of the feed moves of the input whose places are known.
    pub feed_length_in_mm: f64,
    /// Length of what is written for them, steps included.
    pub feed_length_out_mm: f64,
    /// Time of the input's feed moves at the programmed feed, without acceleration, in s; `None` without
    /// feeds per minute.
    pub feed_time_in_s: Option<f64>,
    /// Time of what is written for them at the feeds written.
    pub feed_time_out_s: Option<f64>,
    /// Feed blocks of the output in a second at the feeds written, on average; `None` without feeds
    /// per minute.
    pub mean_blocks_per_second: Option<f64>,
    /// Mean block rate of the input.
    pub mean_blocks_per_second_in: Option<f64>,
    /// Block rate over the densest sixteen blocks in a row.
    pub peak_blocks_per_second: Option<f64>,
    /// The densest sixteen blocks of the input, for comparison.
    pub peak_blocks_per_second_in: Option<f64>,
    /// Blocks that are shorter than the controller takes, line by line.
    pub short_blocks: Vec<ShortBlocksOfLine>,
    /// Warnings, with lines of the input.
    pub warnings: Vec<Warning>,
}

/// Blocks of the output that are shorter than a controller takes ([`crate::WriteOptions::min_block_mm`],
/// [`crate::WriteOptions::max_blocks_per_s`]), of one line of the input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct ShortBlocksOfLine {
    /// Line of the input, counted from 1.
    pub line: usize,
    /// Number of its blocks that are too short.
    pub blocks: usize,
    /// The shortest of them, mm.
    pub shortest_mm: f64,
}

/// Blocks in a row over which the peak rate is taken: a controller looks ahead some blocks, so a
/// single short one does no harm.
const WINDOW: usize = 16;

/// Counts the rate of blocks.
#[derive(Default)]
pub(crate) struct Rate {
    window: VecDeque<f64>,
    seconds: f64,
    blocks: usize,
    shortest_window: Option<f64>,
}

impl Rate {
    /// A feed block of this duration; `None` where it is not known ends the row.
    pub fn note(&mut self, seconds: Option<f64>) {
        let Some(seconds) = seconds.filter(|seconds| seconds.is_finite()) else {
            self.window.clear();
            return;
        };
        self.seconds += seconds;
        self.blocks += 1;
        self.window.push_back(seconds);
        if self.window.len() > WINDOW {
            self.window.pop_front();
        }
        if self.window.len() == WINDOW {
            let row: f64 = self.window.iter().sum();
            self.shortest_window =
                Some(self.shortest_window.map_or(row, |best: f64| best.min(row)));
        }
    }

    /// Sum of all durations.
    pub fn seconds(&self) -> Option<f64> {
        (self.blocks > 0).then_some(self.seconds)
    }

    pub fn mean(&self) -> Option<f64> {
        (self.seconds > 0.0).then(|| self.blocks as f64 / self.seconds)
    }

    pub fn peak(&self) -> Option<f64> {
        self.shortest_window
            .filter(|row| *row > 0.0)
            .map(|row| WINDOW as f64 / row)
    }
}

impl Move {
    /// Duration at its programmed feed, s; `None` without a feed, and where that goes by the speed of the spindle.
    pub fn seconds(&self) -> Option<f64> {
        duration(self, self.length_mm())
    }
}

/// Duration of a stretch of a move at its programmed feed, in seconds; of a turn in place that of the whole.
pub(crate) fn duration(motion: &Move, length_mm: f64) -> Option<f64> {
    let feed = motion.feed?;
    if motion.turns_in_place() {
        return motion.turn_seconds();
    }
    match feed.mode {
        FeedMode::PerMinute => Some(60.0 * length_mm / feed.value),
        FeedMode::InverseTime => {
            let whole = motion.length_mm();
            (whole > 0.0).then(|| 60.0 * length_mm / whole / feed.value)
        }
        FeedMode::PerRevolution => None,
    }
}

/// Duration of a motion of this length at this feed, in seconds.
pub(crate) fn duration_at(feed: Feed, length_mm: f64) -> Option<f64> {
    match feed.mode {
        FeedMode::PerMinute => Some(60.0 * length_mm / feed.value),
        FeedMode::InverseTime => Some(60.0 / feed.value),
        FeedMode::PerRevolution => None,
    }
}
