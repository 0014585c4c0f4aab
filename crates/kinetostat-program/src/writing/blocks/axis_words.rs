//! X, Y and Z of a piece.

use nalgebra::Vector3;

use crate::number;
use crate::path::moves::Move;
use crate::writing::blocks::block_text::{AXES, BlockText, Place};
use crate::writing::output_state::OutputState;

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
