//! A block with a motion: its parts, and what it means where it is programmed.

use crate::error::ProgramError;
use crate::expanding::expanded::Origin;
use crate::expanding::flat::Flat;
use crate::expanding::number::number;
use crate::expanding::radius::contour::{Dress, arc_behind};
use crate::expanding::radius::geometry::Axes;
use crate::expanding::translate::block::{MotionBlock, Polar};
use crate::expanding::translate::wrong::Wrong;
use crate::path::moves::Move;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::text::lex::{Token, tokens_of};

/// A block with a motion.
pub(crate) struct Motion {
    /// N word, with a blank.
    lead: Vec<u8>,
    /// Modes and functions, run before the motion in a block of their own.
    pub before: Vec<u8>,
    /// The motion, as programmed.
    words: String,
    /// F, S and comments.
    tail: Vec<u8>,
    /// M0 and its like, run behind it.
    pub after: Vec<u8>,
    /// X, Y and Z words.
    has: [bool; 3],
    is_arc: bool,
}

impl Motion {
    /// The parts of a block; `None` for a block that moves nothing.
    pub fn of(text: &[u8], state: &Interpreter<'_>) -> Option<Self> {
        let block = MotionBlock::of(text, Polar::default());
        let is_arc = match block.motion {
            Some(code) => matches!(code, 20 | 30),
            None => state.moves_in_arcs(),
        };
        let has_centre = b"IJKR".iter().any(|letter| block.value(*letter).is_some());
        if block.wants_axes || !(block.has_place() || is_arc && has_centre) {
            return None;
        }
        let mut words = block.motion_words();
        for letter in *b"XY" {
            if let Some(value) = block.value(letter) {
                words.push_str(&format!("{}{} ", char::from(letter), number(value)));
            }
        }
        words.push_str(block.other_words().trim_start());
        let number_word = block.head.iter().skip_while(|byte| **byte == b'/');
        let mut lead: Vec<u8> = number_word.copied().collect();
        if !lead.is_empty() {
            lead.push(b' ');
        }
        let rest = block.before.trim_ascii().to_vec();
        let (before, tail) = match has_codes(&rest) {
            true => ([std::mem::take(&mut lead), rest].concat(), Vec::new()),
            false => (Vec::new(), rest),
        };
        Some(Self {
            lead,
            before,
            words,
            tail,
            after: block.after.trim_ascii().to_vec(),
            is_arc,
            has: b"XYZ".map(|letter| block.value(letter).is_some()),
        })
    }

    /// Refuses an arc after G40: only a straight move may follow it.
    pub fn refuse_arc(&self) -> Result<(), Wrong> {
        match self.is_arc {
            true => Err(arc_behind()),
            false => Ok(()),
        }
    }

    /// True for each of X, Y, Z that the block names.
    pub fn states(&self) -> [bool; 3] {
        self.has
    }

    /// Runs the block where it is programmed; gives its motion.
    pub fn run(
        &self,
        origin: Origin,
        programmed: &mut Flat<'_>,
    ) -> Result<Option<Move>, ProgramError> {
        if !self.before.is_empty() {
            programmed.add(&self.before, origin)?;
        }
        let text = [self.words.as_bytes(), b" ", self.tail.as_slice()].concat();
        programmed.add(text.trim_ascii_end(), origin)?;
        Ok(programmed.interpreter.last_move().cloned())
    }

    /// Words around the motion in the flat program.
    pub fn dress(self, made: &Move, axes: Axes, origin: Origin) -> Dress {
        Dress {
            depth: self.has[axes[2]].then_some(made.end[axes[2]]),
            lead: self.lead,
            tail: self.tail,
            origin,
        }
    }
}

fn has_codes(text: &[u8]) -> bool {
    let mut tokens = Vec::new();
    tokens_of(text, &mut tokens);
    let is_code = |token: &Token| {
        matches!(
            token,
            Token::Word {
                letter: b'G' | b'M' | b'T',
                ..
            }
        )
    };
    tokens.iter().any(|spanned| is_code(&spanned.token))
}

/// A block without the motion that it was taken for.
pub(crate) fn no_motion() -> Wrong {
    (
        "the block has places and no motion that is followed".to_owned(),
        "write G0, G1, G2 or G3",
    )
}
