//! Words of rotary axes whose angles are corrected.
//!
//! A correction turns the tool; the axes turn so that it lies where it is wanted, and the turn about the tool is free
//! ([`crate::path::tool_direction`]). Each word is chosen against where the axis really stands as written.

use nalgebra::{UnitQuaternion, Vector3};

use crate::number;
use crate::path::moves::{ExtraMode, Move};
use crate::path::tool_turn::{RotaryTurn, StatedBy};
use crate::writing::directed_moves::DIRECTION_DECIMALS;
use crate::writing::output_state::{OutputMove, OutputState};

/// Digits after the point of words of other axes, at least.
pub(crate) const EXTRA_DECIMALS: usize = 5;

/// A word of an axis: its letter, and its number where the one that stands there (or none) will not do.
type RotaryWord = (u8, Option<String>);

/// The rotary axes of one block.
pub(crate) struct TurnedAxes<'a> {
    pub motion: &'a Move,
    /// See [`crate::Path::tool_axis`].
    pub tool_axis: Vector3<f64>,
    /// True if they differ from the program when the block begins.
    pub were_turned: bool,
    /// G43.5 stands in the block: a direction does not, and the axes stay at the angles of the program.
    pub begins_directions: bool,
}

impl TurnedAxes<'_> {
    fn rotary(&self) -> Option<&RotaryTurn> {
        let turn = self.motion.tool_turn.as_ref()?;
        turn.rotary.as_ref()
    }

    /// True if a word is that of a corrected rotary axis of the block.
    pub fn has_word(&self, letter: char, steps: &[OutputMove]) -> bool {
        let mut axes = self
            .rotary()
            .into_iter()
            .flat_map(|rotary| &rotary.axes.axes);
        self.are_turned(steps) && axes.any(|axis| axis.letter == letter)
    }

    /// True if angles of the block differ from those of the program, or did in the one before it.
    fn are_turned(&self, steps: &[OutputMove]) -> bool {
        let corrected = steps.iter().any(|step| step.tilt != Vector3::zeros());
        self.rotary().is_some() && (corrected || self.were_turned)
    }

    /// True if pieces of the block get words of their own here: the angles of the program are shared out elsewhere.
    fn has_words(&self, steps: &[OutputMove]) -> bool {
        let divided = steps.len() > 1 && self.is_directed();
        !self.begins_directions && (divided || self.are_turned(steps))
    }

    /// True if directions state the orientation of the tool (G43.5).
    pub fn is_directed(&self) -> bool {
        let directed = |rotary: &RotaryTurn| rotary.stated == StatedBy::Direction;
        self.rotary().is_some_and(directed)
    }

    /// Correction of the axes at the end of a piece, deg.
    fn wanted_deg(&self, rotary: &RotaryTurn, step: &OutputMove) -> Vec<f64> {
        let near = rotary.angles_deg(step.share_to);
        if step.tilt == Vector3::zeros() {
            return vec![0.0; near.len()];
        }
        let tilted = UnitQuaternion::from_scaled_axis(step.tilt);
        let direction = tilted * rotary.axes.tool_direction_at(&near, &self.tool_axis);
        let found = rotary.axes.angles_near(&direction, &self.tool_axis, &near);
        let both = found.angles_deg.iter().zip(&near);
        both.map(|(found, near)| found - near).collect()
    }

    /// The words of all rotary axes in a piece; none in a block whose angles are those of the program.
    /// `own` says which number the block has for a letter.
    pub fn words_of_piece(
        &self,
        state: &mut OutputState,
        steps: &[OutputMove],
        index: usize,
        own: impl Fn(u8) -> Option<f64>,
    ) -> Vec<RotaryWord> {
        let Some(rotary) = self.rotary().filter(|_| self.has_words(steps)) else {
            return Vec::new();
        };
        let step = &steps[index];
        let wanted = self.wanted_deg(rotary, step);
        let (from, to) = (
            rotary.angles_deg(step.share_from),
            rotary.angles_deg(step.share_to),
        );
        state.turned_deg.resize(wanted.len(), 0.0);
        if rotary.stated == StatedBy::Direction {
            let stood = directed(rotary, &from, &state.turned_deg, &self.tool_axis);
            let stands = directed(rotary, &to, &wanted, &self.tool_axis);
            state.turned_deg = wanted;
            let standing = match index {
                0 => b"IJK".map(own),
                _ => [None; 3],
            };
            let is_own = step.share_to >= 1.0 && step.tilt == Vector3::zeros();
            return words_of_direction(&stood, &stands, standing, is_own);
        }
        let mut words = Vec::with_capacity(wanted.len());
        for (axis, wanted) in wanted.into_iter().enumerate() {
            let letter = rotary.axes.axes[axis].letter;
            let turned = &mut state.turned_deg[axis];
            let stands = from[axis] + *turned;
            let target = to[axis] + wanted;
            let extra = self
                .motion
                .extra
                .iter()
                .find(|extra| extra.letter == letter);
            let incremental = match extra.map(|extra| extra.mode) {
                Some(mode) => mode == ExtraMode::Incremental,
                None => self.motion.words.incremental,
            };
            let reference = match incremental {
                true => stands,
                false => rotary.origin_deg[axis],
            };
            let own = match index {
                0 => own(letter as u8),
                _ => None,
            };
            let half = 0.5 * 0.1_f64.powi(EXTRA_DECIMALS as i32) * (1.0 + 1e-6);
            let (reached, text) = match own {
                Some(own) if (reference + own - target).abs() <= half => (reference + own, None),
                None if (target - stands).abs() <= half => (stands, None),
                _ => {
                    let text = number::fixed(target - reference, EXTRA_DECIMALS);
                    (reference + number::of_own_text(&text), Some(text))
                }
            };
            // A rounding error of the program's own angle is no correction.
            let left = reached - to[axis];
            *turned = if left.abs() < 1e-9 { 0.0 } else { left };
            words.push((letter as u8, text));
        }
        words
    }
}

/// Directions nearer than this are one.
const SAME_DIRECTION: f64 = 1e-9;

/// The tool's direction where the axes stand otherwise than in the program.
fn directed(
    rotary: &RotaryTurn,
    angles_deg: &[f64],
    turned_deg: &[f64],
    tool_axis: &Vector3<f64>,
) -> Vector3<f64> {
    let both = angles_deg.iter().zip(turned_deg);
    let angles: Vec<f64> = both.map(|(angle, turned)| angle + turned).collect();
    rotary.axes.tool_direction_at(&angles, tool_axis)
}

/// I, J and K of a piece in which the tool turns from one direction to another one. `standing` are the numbers that stand in its line;
/// where the piece ends as the block does (`is_own`), they stay.
fn words_of_direction(
    stood: &Vector3<f64>,
    stands: &Vector3<f64>,
    standing: [Option<f64>; 3],
    is_own: bool,
) -> Vec<RotaryWord> {
    let stated = standing.iter().any(Option::is_some);
    let stays = match stated {
        true => is_own,
        false => (stood - stands).norm() < SAME_DIRECTION,
    };
    let word = |(letter, part): (u8, &f64)| {
        let text = (!stays).then(|| number::fixed(*part, DIRECTION_DECIMALS));
        (letter, text)
    };
    b"IJK"
        .iter()
        .copied()
        .zip(stands.iter())
        .map(word)
        .collect()
}
