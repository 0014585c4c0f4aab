//! F of a piece: the speed along the part stays the programmed one.

use crate::number;
use crate::path::curve::NO_LENGTH_MM;
use crate::path::moves::{Feed, FeedMode, Knowledge, Motion, Move};
use crate::text::line::Word;
use crate::writing::blocks::block_text::{BlockText, Edits, number_span};
use crate::writing::output_state::{OutputMove, OutputState, motion_of};

/// Relative error of the feed in force from which a new F word is written.
const FEED_TOLERANCE: f64 = 5e-4;

/// Feed words of the pieces of a block.
pub(crate) struct FeedWords<'a> {
    pub text: BlockText<'a>,
    pub motion: &'a Move,
    pub max_feed_factor: f64,
    pub turn_lever_mm: f64,
    /// A turn in place by G94 whose pieces are written with their time (G93): beside X, Y and Z a controller takes F for the way of
    /// the tip, and not for the angle.
    pub by_time: bool,
}

impl FeedWords<'_> {
    /// F on the block's own line; the F that stands there is in force before its piece.
    pub fn edit_feed(
        &self,
        state: &mut OutputState,
        step: &OutputMove,
        pieces: usize,
        written_mm: f64,
        edits: &mut Edits,
    ) {
        if self.text.word(b'F').is_some() {
            state.feed = self.motion.feed;
        }
        if let Some(number) = self.of_piece(state, step, pieces, written_mm) {
            self.text.edit_word(edits, b'F', number);
        }
    }

    /// The F word that a piece of a length as written needs, if the feed in force will not do.
    pub fn of_piece(
        &self,
        state: &mut OutputState,
        step: &OutputMove,
        pieces: usize,
        written_mm: f64,
    ) -> Option<String> {
        state.feed_limited = false;
        let feed = self.motion.feed?;
        if motion_of(self.motion) == Motion::Rapid || self.motion.known != Knowledge::Whole {
            return None;
        }
        if self.motion.turns_in_place() {
            return self.of_turn(state, step, pieces, written_mm);
        }
        let part_mm = self
            .motion
            .length_between_mm(step.share_from, step.share_to);
        let whole_mm = self.motion.length_mm();
        // A piece that stands still for all but the last bit of its sums has no speed to keep.
        let written_mm = if written_mm > NO_LENGTH_MM {
            written_mm
        } else {
            0.0
        };
        let moves = part_mm > 0.0 && written_mm > 0.0;
        // Speed of the tool's own path over the programmed one.
        let raised = match step.corner_step || !moves {
            true => 1.0,
            false => written_mm / part_mm,
        };
        state.feed_limited = raised > self.max_feed_factor;
        let held = (self.max_feed_factor / raised).min(1.0);
        let value = match feed.mode {
            FeedMode::InverseTime if pieces == 1 && !state.feed_limited => return None,
            // The step takes as long as it would at the programmed speed.
            FeedMode::InverseTime if step.corner_step && written_mm > 0.0 => {
                feed.value * whole_mm / written_mm
            }
            FeedMode::InverseTime if step.corner_step => feed.value,
            FeedMode::InverseTime => held * feed.value * whole_mm / part_mm,
            _ if step.corner_step || !moves => feed.value,
            _ => held * feed.value * written_mm / part_mm,
        };
        self.word_of(state, Feed { value, ..feed })
    }

    /// The F word of a piece of a turn in place: its share of the time of the whole.
    fn of_turn(
        &self,
        state: &mut OutputState,
        step: &OutputMove,
        pieces: usize,
        written_mm: f64,
    ) -> Option<String> {
        let feed = self.motion.feed?;
        let in_time = self.by_time || feed.mode == FeedMode::InverseTime;
        let seconds = self.motion.turn_seconds().filter(|_| in_time);
        let Some(seconds) = seconds else {
            return self.word_of(state, feed);
        };
        if pieces == 1 && !self.by_time {
            return None;
        }
        let width = step.share_to - step.share_from;
        let seconds = match step.corner_step {
            false => seconds * width,
            // The feed is that of a point of the tool at the lever's distance from the tip.
            true => {
                let way_mm = self.motion.turn_deg().to_radians() * self.turn_lever_mm;
                seconds * (written_mm / way_mm).clamp(1e-6, 1.0)
            }
        };
        let feed = Feed {
            mode: FeedMode::InverseTime,
            value: 60.0 / seconds,
        };
        self.word_of(state, feed)
    }

    /// The F word for a feed, if that in force will not do.
    fn word_of(&self, state: &mut OutputState, feed: Feed) -> Option<String> {
        let value = feed.value;
        let mm_per_unit = match feed.mode {
            FeedMode::InverseTime => 1.0,
            _ => self.motion.words.mm_per_unit,
        };
        let in_force = state.feed.filter(|current| current.mode == feed.mode);
        let will_do =
            in_force.is_some_and(|current| (current.value / value - 1.0).abs() <= FEED_TOLERANCE);
        let every_piece = feed.mode == FeedMode::InverseTime;
        if will_do && !every_piece {
            return None;
        }
        let text = number::feed(value / mm_per_unit);
        state.feed = Some(Feed {
            mode: feed.mode,
            value: number::of_own_text(&text) * mm_per_unit,
        });
        Some(text)
    }

    /// True if the block is a rotation in place with G94.
    pub fn may_be_by_time(&self) -> bool {
        let motion = self.motion;
        let per_minute = |feed: Feed| feed.mode == FeedMode::PerMinute;
        motion.is_known_feed()
            && motion.turns_in_place()
            && motion.feed.is_some_and(per_minute)
            && motion.turn_seconds().is_some()
    }

    /// Makes the block's own line one of inverse time, where its pieces are.
    pub fn edit_feed_mode(&self, edits: &mut Edits) {
        if !self.by_time {
            return;
        }
        let words = self.text.words;
        let mode = |word: &&Word| word.letter == b'G' && word.value == 94.0;
        if let Some(word) = words.iter().find(mode) {
            edits.replaced.push((number_span(word), "93".to_owned()));
            return;
        }
        let first = words.iter().find(|word| !b"NO".contains(&word.letter));
        let at = first.map_or(0, |word| word.start as usize);
        let word = format!("{}93{}", self.text.cased(b'G'), self.text.separator);
        edits.replaced.push((at..at, word));
    }

    /// The line behind pieces in inverse time: the feed as it was.
    pub fn line_of_feed(&self, state: &mut OutputState) -> Vec<u8> {
        let mut line = String::new();
        self.text.add_word(&mut line, b'G', "94");
        if let Some(feed) = self.motion.feed {
            state.feed = None;
            if let Some(number) = self.word_of(state, feed) {
                self.text.add_word(&mut line, b'F', &number);
            }
        }
        let deletes = match self.text.line.block_delete {
            true => "/",
            false => "",
        };
        format!("{deletes}{}", line.trim_start()).into_bytes()
    }
}
