//! The lines of the pieces of one block.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::path::curve::Curve;
use crate::path::moves::Move;
use crate::text::line::{Line, Word};
use crate::text::program::Program;
use crate::writing::blocks::arc_of_piece::arc_words;
use crate::writing::blocks::axis_words::AxisWords;
use crate::writing::blocks::block_text::{AXES, BlockText, Edits, Place, motion_word};
use crate::writing::blocks::extra_words::ExtraWords;
use crate::writing::blocks::feed_words::FeedWords;
use crate::writing::blocks::motion_words::{
    arc_motion, code_of, edit_motion_words, motion_of_piece,
};
use crate::writing::blocks::program_style::ProgramStyle;
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, OutputState, motion_of};
use crate::writing::rotary_words::TurnedAxes;

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
        (program, line): (&'a Program, &'a Line),
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
        edit_motion_words((text, self.motion), state, own, &mut edits);
        for (letter, number) in self.axes.words_to(state, &step.target, Place::OwnLine) {
            text.edit_word(&mut edits, letter, number);
        }
        let of_arc = arc_words(&self.axes, state, step, (from, Place::OwnLine))?;
        let turned = (self.turned).words_of_piece(state, (steps, 0), |l| text.number_of(l));
        for (letter, number) in of_arc.into_iter().chain(turned) {
            if let Some(number) = number {
                text.edit_word(&mut edits, letter, number);
            }
        }
        if steps.len() > 1 {
            for (letter, number) in self.extra.shares(&self.turned, (steps, 0))? {
                text.edit_word(&mut edits, letter, number);
            }
        }
        let is_axis =
            |word: &Word| AXES.contains(&word.letter) || b"ABCEUVW".contains(&word.letter);
        if edits.added.is_empty() && !text.words.iter().any(is_axis) {
            // A circle too small to leave the rounded place: without an axis it would be no motion.
            let (letter, number) = self.axes.standing_word(state);
            text.add_word(&mut edits.added, letter, &number);
        }
        let pieces = (steps.len(), written_length(state, &from));
        self.feeds.edit_feed(state, step, pieces, &mut edits);
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
        edit_motion_words((text, self.motion), state, own, &mut edits);
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
        let of_arc = arc_words(&self.axes, state, step, (from, Place::FurtherLine))?;
        let turned = (self.turned).words_of_piece(state, (steps, index), |_| None);
        for (letter, number) in of_arc.into_iter().chain(turned) {
            if let Some(number) = number {
                block.add_word(&mut text, letter, &number);
            }
        }
        if !step.corner_step {
            for (letter, number) in self.extra.shares(&self.turned, (steps, index))? {
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
        let pieces = (steps.len(), written_length(state, &from));
        if let Some(number) = self.feeds.of_piece(state, step, pieces) {
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
        let pieces = (1, self.motion.length_mm());
        self.feeds.edit_feed(state, step, pieces, &mut edits);
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
