//! The text of one block's pieces: words replaced in place, added, taken out.

use std::ops::Range;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number;
use crate::path::curve::{Curve, NO_LENGTH_MM};
use crate::path::moves::{ExtraMode, Feed, FeedMode, Knowledge, Motion, Move, Path};
use crate::reading::moment::is_written_last;
use crate::text::line::{Line, Word};
use crate::text::program::Program;
use crate::writing::arc_words::{ArcWord, ToPrint};
use crate::writing::fitting::stretch::ArcForm;
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, OutputState, motion_of};
use crate::writing::rotary_words::{EXTRA_DECIMALS, TurnedAxes};

/// Relative error of the feed in force from which a new F word is written.
const FEED_TOLERANCE: f64 = 5e-4;

const AXES: [u8; 3] = *b"XYZ";

/// Places nearer than this are the same, up to the arithmetic, in mm.
pub(crate) const UNCHANGED_MM: f64 = 1e-9;

/// What holds for all blocks of a program.
pub(crate) struct ProgramStyle {
    /// Axes that may be written.
    pub stated: [bool; 3],
    /// See [`Path::tool_axis`].
    pub tool_axis: Vector3<f64>,
    /// Every motion of the program has its own motion word, so its pieces must too: it may be meant for
    /// a firmware without modal motion (most printers').
    pub repeats_motion: bool,
}

impl ProgramStyle {
    pub fn of(program: &Program, path: &Path) -> Self {
        let names_motion = |motion: &Move| {
            program
                .lines()
                .get(motion.line - 1)
                .is_some_and(|line| motion_word(program.words(line)).is_some())
        };
        Self {
            stated: path.stated,
            tool_axis: path.tool_axis,
            repeats_motion: path.moves.iter().all(names_motion),
        }
    }
}

/// The word among these that says how to move.
pub(crate) fn motion_word(words: &[Word]) -> Option<&Word> {
    words
        .iter()
        .find(|word| word.letter == b'G' && [0.0, 1.0, 2.0, 3.0].contains(&word.value))
}

/// Whether a word acts when the block's motion is over.
pub(crate) fn is_after_motion(word: &Word) -> bool {
    is_written_last(word.letter, word.tenths())
}

/// Writes the pieces of one block.
pub(crate) struct BlockWriter<'a> {
    program: &'a Program,
    line: &'a Line,
    words: &'a [Word],
    motion: &'a Move,
    stated: [bool; 3],
    repeats_motion: bool,
    decimals: usize,
    separator: &'static str,
    lower_case: bool,
    max_feed_factor: f64,
    turn_lever_mm: f64,
    /// A turn in place by G94 whose pieces are written with their time (G93): beside X, Y and Z a controller takes F for the way of
    /// the tip, and not for the angle.
    pub by_time: bool,
    /// Rotary axes whose angles are corrected.
    pub turned: TurnedAxes<'a>,
}

/// The line of the block itself, or one of those behind it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    OwnLine,
    FurtherLine,
}

/// Changes of the line: what replaces which bytes.
type Edits = Vec<(Range<usize>, String)>;

impl<'a> BlockWriter<'a> {
    pub fn new(
        program: &'a Program,
        line: &'a Line,
        motion: &'a Move,
        whole: &ProgramStyle,
        options: &WriteOptions,
    ) -> Self {
        let words = program.words(line);
        let bytes = program.bytes();
        let spaced = words.len() < 2
            || words[1..]
                .iter()
                .any(|word| matches!(bytes[word.start as usize - 1], b' ' | b'\t'));
        Self {
            program,
            line,
            words,
            motion,
            stated: whole.stated,
            repeats_motion: whole.repeats_motion,
            decimals: options.decimals_for(motion.words.mm_per_unit),
            max_feed_factor: options.max_feed_factor,
            turn_lever_mm: options.turn_lever_mm,
            by_time: false,
            turned: TurnedAxes {
                motion,
                tool_axis: whole.tool_axis,
                were_turned: false,
                begins_directions: (words.iter())
                    .any(|word| word.letter == b'G' && word.tenths() == 435),
            },
            separator: if spaced { " " } else { "" },
            lower_case: words
                .iter()
                .any(|word| bytes[word.start as usize].is_ascii_lowercase()),
        }
    }

    /// The block's own line, changed to be the first piece.
    pub fn first_line(
        &mut self,
        state: &mut OutputState,
        steps: &[OutputMove],
    ) -> Result<Vec<u8>, WriteError> {
        let step = &steps[0];
        let from = state.position;
        let mut edits: Edits = Vec::new();
        let mut added = String::new();

        let own = self.motion_of(step);
        if self.by_time {
            self.edit_feed_mode(&mut edits);
        }
        self.edit_motion_words(state, own, &mut edits);
        for (axis, letter) in AXES.into_iter().enumerate() {
            let word = self.word(letter);
            let written = word.map(|word| word.value);
            match (
                self.coordinate(state, axis, step.target[axis], written),
                word,
            ) {
                (Some(text), Some(word)) => edits.push((number_span(word), text)),
                (Some(text), None) => self.add(&mut added, letter, &text),
                (None, _) => {}
            }
        }
        for (letter, text) in self.arc_words(state, step, from, Place::OwnLine)? {
            match (text, self.word(letter)) {
                (Some(text), Some(word)) => edits.push((number_span(word), text)),
                (Some(text), None) => self.add(&mut added, letter, &text),
                (None, _) => {}
            }
        }
        let standing = |letter| self.word(letter).map(|word| word.value);
        for (letter, text) in self.turned.words_of_piece(state, (steps, 0), standing) {
            match (text, self.word(letter)) {
                (Some(text), Some(word)) => edits.push((number_span(word), text)),
                (Some(text), None) => self.add(&mut added, letter, &text),
                (None, _) => {}
            }
        }
        self.edit_extra_axes(steps, &mut edits)?;
        let directed = self.turned.is_directed();
        let is_axis = |word: &Word| {
            AXES.contains(&word.letter)
                || b"ABCEUVW".contains(&word.letter)
                || directed && b"IJK".contains(&word.letter)
        };
        if added.is_empty() && !self.words.iter().any(is_axis) {
            // A circle too small to leave the rounded place: without an axis it would be no motion.
            self.add_standing(state, &mut added);
        }
        let feed_word = self.word(b'F');
        if feed_word.is_some() {
            state.feed = self.motion.feed;
        }
        let length = written_length(state, &from);
        if let Some(text) = self.feed(state, step, steps.len(), length) {
            match feed_word {
                Some(word) => edits.push((number_span(word), text)),
                None => self.add(&mut added, b'F', &text),
            }
        }
        if steps.len() > 1 {
            for word in self.words_after_motion() {
                edits.push((self.with_blanks_before(word), String::new()));
            }
        }
        if !added.is_empty() {
            let at = self.place_for_added();
            if at == self.program.content(self.line).start {
                added = added.trim_start().to_owned();
            }
            edits.push((at..at, added));
        }
        state.target = step.target;
        state.motion = Some(own);
        Ok(self.apply(edits))
    }

    /// The block's own line where it has no correction: its axis words bring the output to where the input
    /// goes, and no word is added.
    pub fn uncorrected_line(&self, state: &mut OutputState) -> Vec<u8> {
        let mut edits: Edits = Vec::new();
        self.edit_motion_words(state, motion_of(self.motion), &mut edits);
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(word) = self.word(letter) else {
                continue;
            };
            let target = self.motion.end[axis];
            if let Some(text) = self.coordinate(state, axis, target, Some(word.value)) {
                edits.push((number_span(word), text));
            }
        }
        state.motion = Some(motion_of(self.motion));
        self.apply(edits)
    }

    /// A further piece: a line of axis words.
    pub fn further_line(
        &mut self,
        state: &mut OutputState,
        steps: &[OutputMove],
        index: usize,
    ) -> Result<Vec<u8>, WriteError> {
        let step = &steps[index];
        let from = state.position;
        let mut text = String::new();
        for (axis, letter) in AXES.into_iter().enumerate() {
            if let Some(number) = self.coordinate(state, axis, step.target[axis], None) {
                self.add(&mut text, letter, &number);
            }
        }
        for (letter, number) in self.arc_words(state, step, from, Place::FurtherLine)? {
            if let Some(number) = number {
                self.add(&mut text, letter, &number);
            }
        }
        let turned = self.turned.words_of_piece(state, (steps, index), |_| None);
        for (letter, number) in turned {
            if let Some(number) = number {
                self.add(&mut text, letter, &number);
            }
        }
        for (letter, number) in self.extra_words(steps, index)? {
            if self.separator.is_empty() && letter == 'E' && !text.is_empty() {
                // `1E5` would be read as a number with an exponent.
                text.push(' ');
            }
            self.add(&mut text, letter as u8, &number);
        }
        if text.is_empty() {
            // Rounding left nothing to move; the piece is kept so that every share is accounted for.
            self.add_standing(state, &mut text);
        }
        let length = written_length(state, &from);
        if let Some(number) = self.feed(state, step, steps.len(), length) {
            self.add(&mut text, b'F', &number);
        }
        let mut line = Vec::new();
        if self.line.block_delete {
            line.push(b'/');
        }
        let own = self.motion_of(step);
        if self.repeats_motion || state.motion != Some(own) {
            line.push(if self.lower_case { b'g' } else { b'G' });
            line.extend_from_slice(code_of(own).as_bytes());
            line.extend_from_slice(text.as_bytes());
        } else {
            line.extend_from_slice(text.trim_start().as_bytes());
        }
        if index + 1 == steps.len() {
            for word in self.words_after_motion() {
                line.extend_from_slice(self.separator.as_bytes());
                line.extend_from_slice(&self.program.bytes()[word.span()]);
            }
        }
        state.target = step.target;
        state.motion = Some(own);
        Ok(line)
    }

    fn motion_of(&self, step: &OutputMove) -> Motion {
        match step.arc {
            Some(_) => arc_motion(self.motion),
            None => motion_of(self.motion),
        }
    }

    /// How the block says where its arc is.
    pub fn arc_form(&self) -> ArcForm {
        match self.word(b'R') {
            Some(_) => ArcForm::Radius,
            None => ArcForm::Centre,
        }
    }

    /// Words of a piece that is an arc, of which both ends are written already.
    fn arc_words(
        &self,
        state: &mut OutputState,
        step: &OutputMove,
        from: Vector3<f64>,
        place: Place,
    ) -> Result<Vec<ArcWord>, WriteError> {
        state.arc = None;
        let (Some(fitted), Curve::Arc(arc)) = (&step.arc, &self.motion.curve) else {
            return Ok(Vec::new());
        };
        let words = &self.motion.words;
        let to_print = ToPrint {
            fitted,
            normal: arc.axis.imax(),
            from,
            to: state.position,
            reference: match words.absolute_centre {
                true => words.work_offset_mm + state.offset.active_mm,
                false => from,
            },
            mm_per_unit: words.mm_per_unit,
            decimals: self.decimals,
        };
        let standing = |letter: u8| self.word(letter).map(|word| word.value);
        let printed = match (self.arc_form(), place) {
            (ArcForm::Radius, Place::OwnLine) => to_print.radius(standing(b'R')),
            (ArcForm::Radius, Place::FurtherLine) => to_print.radius(None),
            // A missing word is a centre right beside the start.
            (ArcForm::Centre, Place::OwnLine) => to_print.centre(
                b"IJK".map(|letter| standing(letter).or((!words.absolute_centre).then_some(0.0))),
            ),
            (ArcForm::Centre, Place::FurtherLine) => to_print.centre([None; 3]),
        };
        let (written, words) = printed.ok_or(WriteError::Verification {
            line: self.motion.line,
            output_line: 0,
            what: "an arc that was fitted cannot be printed".to_owned(),
        })?;
        state.arc = Some(written);
        Ok(words)
    }

    /// The block's own line where it stays an arc: its bytes, with the motion and the feed named where
    /// the output has others in force.
    pub fn arc_line(&mut self, state: &mut OutputState, step: &OutputMove) -> Vec<u8> {
        let own = arc_motion(self.motion);
        let mut edits: Edits = Vec::new();
        let mut added = String::new();
        if motion_word(self.words).is_none() && state.motion != Some(own) {
            self.add(&mut added, b'G', code_of(own));
        }
        let feed_word = self.word(b'F');
        if feed_word.is_some() {
            state.feed = self.motion.feed;
        }
        if let Some(text) = self.feed(state, step, 1, self.motion.length_mm()) {
            match feed_word {
                Some(word) => edits.push((number_span(word), text)),
                None => self.add(&mut added, b'F', &text),
            }
        }
        if !added.is_empty() {
            let at = self.words.last().map_or(0, |word| word.end as usize);
            edits.push((at..at, added));
        }
        state.position = self.motion.end;
        state.target = self.motion.end;
        state.arc = None;
        state.motion = Some(own);
        self.apply(edits)
    }

    /// Whether the axis words of the block would bring the output to the block's own end.
    pub fn words_still_hold(&self, state: &OutputState) -> bool {
        AXES.into_iter().enumerate().all(|(axis, letter)| {
            let reached = match self.word(letter) {
                Some(word) => self.place(state, axis, word.value),
                None => state.position[axis],
            };
            (reached - self.motion.end[axis]).abs() < UNCHANGED_MM
        })
    }

    fn word(&self, letter: u8) -> Option<&'a Word> {
        self.words.iter().find(|word| word.letter == letter)
    }

    fn add(&self, text: &mut String, letter: u8, number: &str) {
        text.push_str(self.separator);
        let letter = char::from(letter);
        text.push(if self.lower_case {
            letter.to_ascii_lowercase()
        } else {
            letter
        });
        text.push_str(number);
    }

    /// An axis word for the place where the output stands.
    fn add_standing(&self, state: &mut OutputState, text: &mut String) {
        let axis = (0..3).find(|axis| self.stated[*axis]).unwrap_or(0);
        let number = if self.motion.words.incremental {
            number::fixed(0.0, self.decimals)
        } else {
            number::fixed(
                self.word_value(state, axis, state.position[axis]),
                self.decimals,
            )
        };
        self.add(text, AXES[axis], &number);
        state.position[axis] = self.place(state, axis, parse(&number));
    }

    /// The word that would bring an axis to `place_mm`, unrounded, in units.
    fn word_value(&self, state: &OutputState, axis: usize, place_mm: f64) -> f64 {
        let words = &self.motion.words;
        let reference = if words.incremental {
            state.position[axis]
        } else {
            words.work_offset_mm[axis] + state.offset.active_mm[axis]
        };
        (place_mm - reference) / words.mm_per_unit
    }

    /// Where a word brings an axis, in mm.
    fn place(&self, state: &OutputState, axis: usize, word: f64) -> f64 {
        let words = &self.motion.words;
        let reference = if words.incremental {
            state.position[axis]
        } else {
            words.work_offset_mm[axis] + state.offset.active_mm[axis]
        };
        reference + word * words.mm_per_unit
    }

    /// Moves an axis of the output to its target. Returns the number to be written, `None` if the
    /// word that stands there (or that none stands there) is as near as rounding comes.
    ///
    /// Each word is chosen against where the output really is, so rounded increments never add up.
    fn coordinate(
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
        state.position[axis] = self.place(state, axis, parse(&text));
        Some(text)
    }

    /// Where the piece is straight, G2 and G3 become G1, and the words of the arc go.
    fn edit_motion_words(&self, state: &OutputState, own: Motion, edits: &mut Edits) {
        let straightened = self.motion.curve != Curve::Line && own == motion_of(self.motion);
        if let Some(word) = motion_word(self.words) {
            if straightened {
                let bytes = self.program.bytes();
                let digits = if bytes[word.number as usize] == b'0' {
                    "01"
                } else {
                    "1"
                };
                edits.push((number_span(word), digits.to_owned()));
            }
        } else if state.motion != Some(own) {
            let coordinate = self.words.iter().find(|word| AXES.contains(&word.letter));
            let at = match coordinate {
                Some(word) => word.start as usize,
                None => self.place_for_added(),
            };
            let letter = if self.lower_case { 'g' } else { 'G' };
            let after = if coordinate.is_some() {
                self.separator
            } else {
                ""
            };
            edits.push((at..at, format!("{letter}{}{after}", code_of(own))));
        }
        if straightened {
            for word in self
                .words
                .iter()
                .filter(|word| b"IJKRP".contains(&word.letter))
            {
                edits.push((self.with_blanks_before(word), String::new()));
            }
        }
    }

    fn edit_extra_axes(&self, steps: &[OutputMove], edits: &mut Edits) -> Result<(), WriteError> {
        if steps.len() == 1 {
            return Ok(());
        }
        for (extra, number) in self.motion.extra.iter().zip(self.extra_numbers(steps, 0)?) {
            if self.turned.has_word(extra.letter, steps) {
                continue;
            }
            if let Some(word) = self.word(extra.letter as u8) {
                edits.push((number_span(word), number));
            }
        }
        Ok(())
    }

    /// Words of other axes on a further line: those that change.
    fn extra_words(
        &self,
        steps: &[OutputMove],
        index: usize,
    ) -> Result<Vec<(char, String)>, WriteError> {
        if self.motion.extra.is_empty() || steps[index].corner_step {
            return Ok(Vec::new());
        }
        let numbers = self.extra_numbers(steps, index)?;
        let letters = self.motion.extra.iter().map(|extra| extra.letter);
        let own = letters
            .zip(numbers)
            .filter(|(letter, _)| !self.turned.has_word(*letter, steps));
        Ok(own.collect())
    }

    /// The share of each extra axis' word in a piece.
    fn extra_numbers(&self, steps: &[OutputMove], index: usize) -> Result<Vec<String>, WriteError> {
        let mut numbers = Vec::with_capacity(self.motion.extra.len());
        for extra in &self.motion.extra {
            let refuse = |reason: &str| WriteError::ExtraAxis {
                line: self.motion.line,
                letter: extra.letter,
                reason: reason.to_owned(),
            };
            let original = self
                .word(extra.letter as u8)
                .map_or(&b""[..], |word| &self.program.bytes()[number_span(word)]);
            let decimals = number::decimals_of(original).clamp(EXTRA_DECIMALS, 9);
            numbers.push(match (extra.mode, extra.start) {
                (ExtraMode::Disputed, _) => {
                    return Err(refuse("M82/M83 and the later G90/G91 disagree whether it is absolute, and so do firmwares; write M82 or M83 again after G90 or G91"));
                }
                (ExtraMode::Absolute, None) => {
                    return Err(refuse("the program has not stated where the axis is before; write a block with its place, or G92, before"));
                }
                (ExtraMode::Absolute, Some(start)) => {
                    let share = steps[index].share_to;
                    if share >= 1.0 {
                        String::from_utf8_lossy(original).into_owned()
                    } else {
                        number::fixed(start + (extra.word - start) * share, decimals)
                    }
                }
                (ExtraMode::Incremental, _) => {
                    // Whole units of the last decimal, so that the pieces add up to the word.
                    let unit = 10_f64.powi(decimals as i32);
                    let reached = |share: f64| (extra.word * unit * share).round();
                    let units = reached(steps[index].share_to) - reached(steps[index].share_from);
                    number::fixed(units / unit, decimals)
                }
            });
        }
        Ok(numbers)
    }

    /// The F word that a piece needs, if the feed in force will not do.
    fn feed(
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
            return self.feed_of_turn(state, step, pieces, written_mm);
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
        // How many times the programmed speed the tool's own path would need.
        let raised = match step.corner_step || !moves {
            true => 1.0,
            false => written_mm / part_mm,
        };
        state.feed_limited = raised > self.max_feed_factor;
        let held = (self.max_feed_factor / raised).min(1.0);
        let value = match feed.mode {
            FeedMode::InverseTime if pieces == 1 && !state.feed_limited => return None,
            // As long as the programmed speed takes for the step.
            FeedMode::InverseTime if step.corner_step && written_mm > 0.0 => {
                feed.value * whole_mm / written_mm
            }
            FeedMode::InverseTime if step.corner_step => feed.value,
            FeedMode::InverseTime => held * feed.value * whole_mm / part_mm,
            _ if step.corner_step || !moves => feed.value,
            _ => held * feed.value * written_mm / part_mm,
        };
        self.feed_word(state, Feed { value, ..feed })
    }

    /// The F word for a feed, if that in force will not do.
    fn feed_word(&self, state: &mut OutputState, feed: Feed) -> Option<String> {
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
            value: parse(&text) * mm_per_unit,
        });
        Some(text)
    }

    /// The F word of a piece of a turn in place: its share of the time of the whole.
    fn feed_of_turn(
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
            return self.feed_word(state, feed);
        };
        if pieces == 1 && !self.by_time {
            return None;
        }
        let width = step.share_to - step.share_from;
        let seconds = match step.corner_step {
            false => seconds * width,
            // As fast as a point of the tool goes that is so far from the tip.
            true => {
                let way_mm = self.motion.turn_deg().to_radians() * self.turn_lever_mm;
                seconds * (written_mm / way_mm).clamp(1e-6, 1.0)
            }
        };
        let feed = Feed {
            mode: FeedMode::InverseTime,
            value: 60.0 / seconds,
        };
        self.feed_word(state, feed)
    }

    /// Whether the block is a turn in place by G94.
    pub fn may_be_by_time(&self) -> bool {
        let motion = self.motion;
        let per_minute = |feed: Feed| feed.mode == FeedMode::PerMinute;
        motion.is_known_feed()
            && motion.turns_in_place()
            && motion.feed.is_some_and(per_minute)
            && motion.turn_seconds().is_some()
    }

    /// Whether the block ends the program.
    pub fn ends_program(&self) -> bool {
        let ends = |word: &Word| word.letter == b'M' && [2.0, 30.0].contains(&word.value);
        self.words.iter().any(ends)
    }

    /// The line behind pieces in inverse time: the feed as it was.
    pub fn line_of_feed(&self, state: &mut OutputState) -> Vec<u8> {
        let mut text = String::new();
        self.add(&mut text, b'G', "94");
        if let Some(feed) = self.motion.feed {
            state.feed = None;
            if let Some(number) = self.feed_word(state, feed) {
                self.add(&mut text, b'F', &number);
            }
        }
        let deletes = if self.line.block_delete { "/" } else { "" };
        format!("{deletes}{}", text.trim_start()).into_bytes()
    }

    /// The block is one of inverse time.
    fn edit_feed_mode(&self, edits: &mut Edits) {
        let mode = |word: &&Word| word.letter == b'G' && word.value == 94.0;
        if let Some(word) = self.words.iter().find(mode) {
            edits.push((number_span(word), "93".to_owned()));
            return;
        }
        let first = self.words.iter().find(|word| !b"NO".contains(&word.letter));
        let at = first.map_or(0, |word| word.start as usize);
        let letter = if self.lower_case { 'g' } else { 'G' };
        edits.push((at..at, format!("{letter}93{}", self.separator)));
    }

    fn words_after_motion(&self) -> impl Iterator<Item = &'a Word> {
        self.words.iter().filter(|word| is_after_motion(word))
    }

    fn with_blanks_before(&self, word: &Word) -> Range<usize> {
        let content = self.program.content(self.line);
        let bytes = self.program.bytes();
        let mut start = word.start as usize;
        while start > content.start && matches!(bytes[start - 1], b' ' | b'\t') {
            start -= 1;
        }
        start..word.end as usize
    }

    /// Where words are added: after the last coordinate word, else where the arc's words stood, else
    /// after the last axis word, else at the end of the words.
    fn place_for_added(&self) -> usize {
        let last = |letters: &[u8]| {
            self.words
                .iter()
                .rev()
                .find(|word| letters.contains(&word.letter))
        };
        if let Some(word) = last(&AXES) {
            return word.end as usize;
        }
        if let Some(word) = self
            .words
            .iter()
            .find(|word| b"IJKR".contains(&word.letter))
        {
            return self.with_blanks_before(word).start;
        }
        last(b"ABCEUVW")
            .or(self.words.last())
            .map_or(0, |word| word.end as usize)
    }

    fn apply(&self, mut edits: Edits) -> Vec<u8> {
        let content = self.program.content(self.line);
        let bytes = self.program.bytes();
        edits.sort_by_key(|(span, _)| (span.start, span.end));
        let mut line = Vec::with_capacity(content.len() + 24);
        let mut at = content.start;
        for (span, text) in edits {
            line.extend_from_slice(&bytes[at..span.start]);
            line.extend_from_slice(text.as_bytes());
            at = span.end;
        }
        line.extend_from_slice(&bytes[at..content.end]);
        line
    }
}

/// Length of the piece that ends where the output is now.
fn written_length(state: &OutputState, from: &Vector3<f64>) -> f64 {
    let to = &state.position;
    match &state.arc {
        Some(arc) => Curve::Arc(arc.between(from, to)).length_between(from, to, 0.0, 1.0),
        None => (to - from).norm(),
    }
}

/// The motion word of an arc: its angle grows counter-clockwise about the plane's normal.
fn arc_motion(motion: &Move) -> Motion {
    match &motion.curve {
        Curve::Arc(arc) if arc.sweep < 0.0 => Motion::Clockwise,
        Curve::Arc(_) => Motion::CounterClockwise,
        Curve::Line => motion_of(motion),
    }
}

fn code_of(motion: Motion) -> &'static str {
    match motion {
        Motion::Rapid => "0",
        Motion::Clockwise => "2",
        Motion::CounterClockwise => "3",
        Motion::Feed | Motion::Off => "1",
    }
}

fn number_span(word: &Word) -> Range<usize> {
    word.number as usize..word.end as usize
}

/// The value a controller reads; the text is one of our own fixed-point numbers.
fn parse(text: &str) -> f64 {
    text.parse().unwrap_or(0.0)
}
