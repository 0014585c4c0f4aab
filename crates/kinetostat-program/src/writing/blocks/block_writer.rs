//! The lines of the pieces of one block.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number;
use crate::path::curve::Curve;
use crate::path::moves::{ExtraAxis, ExtraMode, Motion, Move, Path};
use crate::text::program::Program;
use crate::text::{Line, Word};
use crate::writing::blocks::arc_words::arc_words;
use crate::writing::blocks::words::{AxisWords, FeedWords};
use crate::writing::blocks::{AXES, BlockText, Edits, Place, motion_word, number_span};
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, OutputState, motion_of};
use crate::writing::rotary_words::{EXTRA_DECIMALS, TurnedAxes};

/// Writes the pieces of one block.
pub(crate) struct BlockWriter<'a> {
    pub text: BlockText<'a>,
    motion: &'a Move,
    repeats_motion: bool,
    pub axes: AxisWords<'a>,
    extra: ExtraWords<'a>,
    pub feeds: FeedWords<'a>,
    /// Rotary axes whose angles are corrected.
    pub turned: TurnedAxes<'a>,
}

impl<'a> BlockWriter<'a> {
    pub fn new(
        program: &'a Program,
        line: &'a Line,
        motion: &'a Move,
        whole: &ProgramStyle,
        options: &WriteOptions,
    ) -> Self {
        let text = BlockText::of(program, line);
        Self {
            text,
            motion,
            repeats_motion: whole.repeats_motion,
            axes: AxisWords {
                text,
                motion,
                stated: whole.stated,
                decimals: options.decimals_for(motion.words.mm_per_unit),
            },
            extra: ExtraWords { text, motion },
            feeds: FeedWords {
                text,
                motion,
                max_feed_factor: options.max_feed_factor,
                turn_lever_mm: options.turn_lever_mm,
                by_time: false,
            },
            turned: TurnedAxes {
                motion,
                tool_axis: whole.tool_axis,
                were_turned: false,
                begins_directions: (text.words.iter())
                    .any(|word| word.letter == b'G' && word.tenths() == 435),
            },
        }
    }

    /// The block's own line, changed to be the first piece.
    pub fn first_line(
        &self,
        state: &mut OutputState,
        steps: &[OutputMove],
    ) -> Result<Vec<u8>, WriteError> {
        let text = &self.text;
        let step = &steps[0];
        let from = state.position;
        let own = motion_of_piece(self.motion, step);
        let mut edits = Edits::default();
        self.feeds.edit_feed_mode(&mut edits);
        edit_motion_words(text, self.motion, state, own, &mut edits);
        for (letter, number) in self.axes.words_to(state, &step.target, Place::OwnLine) {
            text.edit_word(&mut edits, letter, number);
        }
        let of_arc = arc_words(&self.axes, state, step, from, Place::OwnLine)?;
        let turned = (self.turned).words_of_piece(state, steps, 0, |l| text.number_of(l));
        for (letter, number) in of_arc.into_iter().chain(turned) {
            if let Some(number) = number {
                text.edit_word(&mut edits, letter, number);
            }
        }
        if steps.len() > 1 {
            for (letter, number) in self.extra.shares(&self.turned, steps, 0)? {
                text.edit_word(&mut edits, letter, number);
            }
        }
        let directed = self.turned.is_directed();
        let is_axis = |word: &Word| {
            AXES.contains(&word.letter)
                || b"ABCEUVW".contains(&word.letter)
                || directed && b"IJK".contains(&word.letter)
        };
        if edits.added.is_empty() && !text.words.iter().any(is_axis) {
            // A circle too small to leave the rounded place: without an axis it would be no motion.
            let (letter, number) = self.axes.standing_word(state);
            text.add_word(&mut edits.added, letter, &number);
        }
        let written_mm = written_length(state, &from);
        self.feeds
            .edit_feed(state, step, steps.len(), written_mm, &mut edits);
        if steps.len() > 1 {
            for word in text.words_after_motion() {
                text.remove_word(&mut edits, word);
            }
        }
        state.target = step.target;
        state.motion = Some(own);
        Ok(text.edited(edits, text.place_for_added()))
    }

    /// The block's own line where it has no correction: its axis words bring the output to where the input
    /// goes, and no word is added.
    pub fn uncorrected_line(&self, state: &mut OutputState) -> Vec<u8> {
        let text = &self.text;
        let own = motion_of(self.motion);
        let mut edits = Edits::default();
        edit_motion_words(text, self.motion, state, own, &mut edits);
        for (letter, number) in self.axes.own_words_to(state, &self.motion.end) {
            text.edit_word(&mut edits, letter, number);
        }
        state.motion = Some(own);
        text.edited(edits, text.place_for_added())
    }

    /// A further piece: a line of axis words.
    pub fn further_line(
        &self,
        state: &mut OutputState,
        steps: &[OutputMove],
        index: usize,
    ) -> Result<Vec<u8>, WriteError> {
        let block = &self.text;
        let step = &steps[index];
        let from = state.position;
        let mut text = String::new();
        for (letter, number) in self.axes.words_to(state, &step.target, Place::FurtherLine) {
            block.add_word(&mut text, letter, &number);
        }
        let of_arc = arc_words(&self.axes, state, step, from, Place::FurtherLine)?;
        let turned = (self.turned).words_of_piece(state, steps, index, |_| None);
        for (letter, number) in of_arc.into_iter().chain(turned) {
            if let Some(number) = number {
                block.add_word(&mut text, letter, &number);
            }
        }
        if !step.corner_step {
            for (letter, number) in self.extra.shares(&self.turned, steps, index)? {
                if block.separator.is_empty() && letter == b'E' && !text.is_empty() {
                    // `1E5` would be read as a number with an exponent.
                    text.push(' ');
                }
                block.add_word(&mut text, letter, &number);
            }
        }
        if text.is_empty() {
            // Rounding left nothing to move; the piece is kept so that every share is accounted for.
            let (letter, number) = self.axes.standing_word(state);
            block.add_word(&mut text, letter, &number);
        }
        let written_mm = written_length(state, &from);
        if let Some(number) = self.feeds.of_piece(state, step, steps.len(), written_mm) {
            block.add_word(&mut text, b'F', &number);
        }
        let mut line = Vec::new();
        if block.line.block_delete {
            line.push(b'/');
        }
        let own = motion_of_piece(self.motion, step);
        if self.repeats_motion || state.motion != Some(own) {
            line.push(block.cased(b'G') as u8);
            line.extend_from_slice(code_of(own).as_bytes());
            line.extend_from_slice(text.as_bytes());
        } else {
            line.extend_from_slice(text.trim_start().as_bytes());
        }
        if index + 1 == steps.len() {
            for word in block.words_after_motion() {
                line.extend_from_slice(block.separator.as_bytes());
                line.extend_from_slice(&block.program.bytes()[word.span()]);
            }
        }
        state.target = step.target;
        state.motion = Some(own);
        Ok(line)
    }

    /// The block's own line where it stays an arc: its bytes, with the motion and the feed named where
    /// the output has others in force.
    pub fn arc_line(&self, state: &mut OutputState, step: &OutputMove) -> Vec<u8> {
        let text = &self.text;
        let own = arc_motion(self.motion);
        let mut edits = Edits::default();
        if motion_word(text.words).is_none() && state.motion != Some(own) {
            text.add_word(&mut edits.added, b'G', code_of(own));
        }
        let written_mm = self.motion.length_mm();
        self.feeds.edit_feed(state, step, 1, written_mm, &mut edits);
        state.position = self.motion.end;
        state.target = self.motion.end;
        state.arc = None;
        state.motion = Some(own);
        text.edited(edits, text.words.last().map_or(0, |word| word.end as usize))
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

/// Shares out the words of a block.
pub(crate) struct ExtraWords<'a> {
    pub text: BlockText<'a>,
    pub motion: &'a Move,
}

impl ExtraWords<'_> {
    /// The words of a piece of a divided block, but for those of rotary axes whose angles are corrected.
    pub fn shares(
        &self,
        turned: &TurnedAxes<'_>,
        steps: &[OutputMove],
        index: usize,
    ) -> Result<Vec<(u8, String)>, WriteError> {
        let mut words = Vec::new();
        for extra in &self.motion.extra {
            // Also the words that are not written tell whether they can be shared out.
            let number = self.share(extra, &steps[index])?;
            if !turned.has_word(extra.letter, steps) {
                words.push((extra.letter as u8, number));
            }
        }
        Ok(words)
    }

    /// The share of a word in a piece.
    fn share(&self, extra: &ExtraAxis, step: &OutputMove) -> Result<String, WriteError> {
        let refuse = |reason: &str| WriteError::ExtraAxis {
            line: self.motion.line,
            letter: extra.letter,
            reason: reason.to_owned(),
        };
        let original = self.text.word(extra.letter as u8).map_or(&b""[..], |word| {
            &self.text.program.bytes()[number_span(word)]
        });
        let decimals = number::decimals_of(original).clamp(EXTRA_DECIMALS, 9);
        Ok(match (extra.mode, extra.start) {
            (ExtraMode::Disputed, _) => {
                return Err(refuse(
                    "M82/M83 and the later G90/G91 disagree whether it is absolute, and so do firmwares; write M82 or M83 again after G90 or G91",
                ));
            }
            (ExtraMode::Absolute, None) => {
                return Err(refuse(
                    "the program has not stated where the axis is before; write a block with its place, or G92, before",
                ));
            }
            (ExtraMode::Absolute, Some(_)) if step.share_to >= 1.0 => {
                String::from_utf8_lossy(original).into_owned()
            }
            (ExtraMode::Absolute, Some(start)) => {
                number::fixed(start + (extra.word - start) * step.share_to, decimals)
            }
            (ExtraMode::Incremental, _) => {
                // Whole units of the last decimal, so that the pieces add up to the word.
                let unit = 10_f64.powi(decimals as i32);
                let reached = |share: f64| (extra.word * unit * share).round();
                let units = reached(step.share_to) - reached(step.share_from);
                number::fixed(units / unit, decimals)
            }
        })
    }
}

/// The motion word that a piece of this move needs.
fn motion_of_piece(motion: &Move, step: &OutputMove) -> Motion {
    match step.arc {
        Some(_) => arc_motion(motion),
        None => motion_of(motion),
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

/// The number of a motion word.
fn code_of(motion: Motion) -> &'static str {
    match motion {
        Motion::Rapid => "0",
        Motion::Clockwise => "2",
        Motion::CounterClockwise => "3",
        Motion::Feed | Motion::Off => "1",
    }
}

/// Edits the motion on the block's own line: if its piece is straight, G2 and G3 become G1, and the words of the arc go.
fn edit_motion_words(
    text: &BlockText<'_>,
    motion: &Move,
    state: &OutputState,
    own: Motion,
    edits: &mut Edits,
) {
    let straightened = motion.curve != Curve::Line && own == motion_of(motion);
    if let Some(word) = motion_word(text.words) {
        if straightened {
            let digits = match text.program.bytes()[word.number as usize] {
                b'0' => "01",
                _ => "1",
            };
            edits.replaced.push((number_span(word), digits.to_owned()));
        }
    } else if state.motion != Some(own) {
        let coordinate = text.words.iter().find(|word| AXES.contains(&word.letter));
        let (at, after) = match coordinate {
            Some(word) => (word.start as usize, text.separator),
            None => (text.place_for_added(), ""),
        };
        let word = format!("{}{}{after}", text.cased(b'G'), code_of(own));
        edits.replaced.push((at..at, word));
    }
    if straightened {
        let of_arc = |word: &&Word| b"IJKRP".contains(&word.letter);
        for word in text.words.iter().filter(of_arc) {
            text.remove_word(edits, word);
        }
    }
}

/// Style common to all blocks of a program.
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
                .line(motion.line)
                .is_some_and(|line| motion_word(program.words(line)).is_some())
        };
        Self {
            stated: path.stated,
            tool_axis: path.tool_axis,
            repeats_motion: match program.part() {
                Some(part) => part.repeats_motion,
                None => path.moves.iter().all(names_motion),
            },
        }
    }
}
