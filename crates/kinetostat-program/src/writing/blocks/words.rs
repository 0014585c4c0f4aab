//! The axis words and the feed word of a piece.

use nalgebra::Vector3;

use crate::number;
use crate::path::curve::NO_LENGTH_MM;
use crate::path::moves::{Feed, FeedMode, Knowledge, Motion, Move};
use crate::text::Word;
use crate::writing::blocks::{AXES, BlockText, Edits, Place, number_span};
use crate::writing::output_state::{OutputMove, OutputState, motion_of};

/// Places nearer than this are the same, up to the arithmetic, in mm.
pub(crate) const UNCHANGED_MM: f64 = 1e-9;

/// Axis words of the pieces of a block.
///
/// Each word is chosen against where the output really is, so rounded increments never add up.
pub(crate) struct AxisWords<'a> {
    pub text: BlockText<'a>,
    pub motion: &'a Move,
    /// Axes that may be written.
    pub stated: [bool; 3],
    pub decimals: usize,
}

impl AxisWords<'_> {
    /// Moves the output to a target, of which the words are given that must be written: those that stand on the line may do.
    pub fn words_to(
        &self,
        state: &mut OutputState,
        target_mm: &Vector3<f64>,
        place: Place,
    ) -> Vec<(u8, String)> {
        let mut words = Vec::new();
        for (axis, letter) in AXES.into_iter().enumerate() {
            let written = match place {
                Place::OwnLine => self.text.number_of(letter),
                Place::FurtherLine => None,
            };
            let number = self.number_to(state, axis, target_mm[axis], written);
            words.extend(number.map(|number| (letter, number)));
        }
        words
    }

    /// Words for the axes that the block itself names; the others stay where they are.
    pub fn own_words_to(
        &self,
        state: &mut OutputState,
        target_mm: &Vector3<f64>,
    ) -> Vec<(u8, String)> {
        let mut words = Vec::new();
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(written) = self.text.number_of(letter) else {
                continue;
            };
            let number = self.number_to(state, axis, target_mm[axis], Some(written));
            words.extend(number.map(|number| (letter, number)));
        }
        words
    }

    /// Moves an axis of the output to its target. Returns the number to be written, `None` if the
    /// word that stands there (or that none stands there) is as near as rounding comes.
    fn number_to(
        &self,
        state: &mut OutputState,
        axis: usize,
        target_mm: f64,
        written: Option<f64>,
    ) -> Option<String> {
        let half = 0.5 * 0.1_f64.powi(self.decimals as i32) * (1.0 + 1e-6);
        if let Some(word) = written {
            if (self.word_value(state, axis, target_mm) - word).abs() <= half {
                state.position[axis] = self.place(state, axis, word);
                return None;
            }
        } else {
            let distance = (target_mm - state.position[axis]).abs() / self.motion.words.mm_per_unit;
            if distance <= half || !self.stated[axis] {
                return None;
            }
        }
        let text = number::fixed(self.word_value(state, axis, target_mm), self.decimals);
        state.position[axis] = self.place(state, axis, number::of_own_text(&text));
        Some(text)
    }

    /// An axis word for the place where the output stands.
    pub fn standing_word(&self, state: &mut OutputState) -> (u8, String) {
        let axis = (0..3).find(|axis| self.stated[*axis]).unwrap_or(0);
        let value = match self.motion.words.incremental {
            true => 0.0,
            false => self.word_value(state, axis, state.position[axis]),
        };
        let number = number::fixed(value, self.decimals);
        state.position[axis] = self.place(state, axis, number::of_own_text(&number));
        (AXES[axis], number)
    }

    /// True if the axis words of the block would bring the output to the block's own end.
    pub fn words_still_hold(&self, state: &OutputState) -> bool {
        AXES.into_iter().enumerate().all(|(axis, letter)| {
            let reached = match self.text.number_of(letter) {
                Some(word) => self.place(state, axis, word),
                None => state.position[axis],
            };
            (reached - self.motion.end[axis]).abs() < UNCHANGED_MM
        })
    }

    /// Origin of the words of an axis, in mm.
    fn reference_mm(&self, state: &OutputState, axis: usize) -> f64 {
        let words = &self.motion.words;
        match words.incremental {
            true => state.position[axis],
            false => words.work_offset_mm[axis] + state.offset.active_mm[axis],
        }
    }

    /// The word that would bring an axis to `place_mm`, unrounded, in units.
    fn word_value(&self, state: &OutputState, axis: usize, place_mm: f64) -> f64 {
        (place_mm - self.reference_mm(state, axis)) / self.motion.words.mm_per_unit
    }

    /// Position of an axis for a word, in mm.
    fn place(&self, state: &OutputState, axis: usize, word: f64) -> f64 {
        self.reference_mm(state, axis) + word * self.motion.words.mm_per_unit
    }
}

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
