//! The words of a block that is translated, and the rest of it, which is run before them.

use crate::expanding::number::number;
use crate::text::lex::{Spanned, Token, tokens_of};

/// Letters that belong to a motion.
const OF_MOTION: &[u8; 15] = b"XYZABCUVWIJKRPQ";

/// Polar words: `@` and `^` (degrees).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Polar {
    pub radius: Option<f64>,
    pub angle_deg: Option<f64>,
}

impl Polar {
    pub fn is_there(&self) -> bool {
        self.radius.is_some() || self.angle_deg.is_some()
    }
}

/// A block in two parts.
#[derive(Debug, Default)]
pub(crate) struct MotionBlock {
    /// Values by letter, codes left out.
    values: [Option<f64>; 26],
    /// G codes of motion and cycles, in tenths.
    pub motion: Option<u32>,
    pub polar: Polar,
    /// G4, G10, G28 ... want the axis words.
    pub wants_axes: bool,
    /// Everything that is no motion, run before it; with comments.
    pub before: Vec<u8>,
    /// M0 and its like, run behind it.
    pub after: Vec<u8>,
    /// N word and block delete.
    pub head: Vec<u8>,
}

impl MotionBlock {
    /// Divides a line.
    pub fn of(text: &[u8], polar: Polar) -> Self {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let mut block = Self {
            polar,
            ..Self::default()
        };
        for spanned in &tokens {
            let piece = &text[spanned.span.clone()];
            match &spanned.token {
                Token::Word { letter, value, .. } => block.word(*letter, *value, piece),
                Token::Other(b'/') if block.before.is_empty() => {
                    block.head.extend_from_slice(piece)
                }
                // What is taken out leaves no second blank.
                Token::Blank if block.before.last().is_none_or(|last| *last == b' ') => {}
                _ => block.before.extend_from_slice(piece),
            }
        }
        block
    }

    fn word(&mut self, letter: u8, value: f64, piece: &[u8]) {
        let tenths = (10.0 * value).round();
        match (letter, tenths as u32) {
            (b'N', _) => self.head.extend_from_slice(piece),
            (b'G', code) if is_motion(code) => self.motion = Some(code),
            (b'M', 0 | 10 | 20 | 300 | 600) => {
                self.after.extend_from_slice(piece);
                self.after.push(b' ');
            }
            (b'G', code) => {
                self.wants_axes |=
                    matches!(code, 40 | 100 | 280..=301 | 431 | 432 | 520 | 530 | 920);
                self.before.extend_from_slice(piece);
            }
            (b'L', _) => self.values[usize::from(b'L' - b'A')] = Some(value),
            (letter, _) if OF_MOTION.contains(&letter) => {
                self.values[usize::from(letter - b'A')] = Some(value);
            }
            _ => self.before.extend_from_slice(piece),
        }
    }

    pub fn value(&self, letter: u8) -> Option<f64> {
        self.values[usize::from(letter - b'A')]
    }

    /// `G1 `, where the block names its motion.
    pub fn motion_words(&self) -> String {
        let code = self
            .motion
            .map(|tenths| format!("G{} ", f64::from(tenths) / 10.0));
        code.unwrap_or_default()
    }

    /// Words of the motion but X and Y.
    pub fn other_words(&self) -> String {
        let others = OF_MOTION
            .iter()
            .filter(|letter| !matches!(letter, b'X' | b'Y'));
        let words = others.filter_map(|letter| {
            let value = self.value(*letter)?;
            Some(format!(" {}{}", char::from(*letter), number(value)))
        });
        words.collect()
    }

    /// X, Y, Z or a polar word.
    pub fn has_place(&self) -> bool {
        self.polar.is_there() || b"XYZ".iter().any(|letter| self.value(*letter).is_some())
    }
}

fn is_motion(tenths: u32) -> bool {
    matches!(tenths, 50..=53)
        || matches!(tenths, 0 | 10 | 20 | 30 | 330 | 331 | 380..=385 | 730 | 740 | 760 | 800 | 810..=890)
            && tenths.is_multiple_of(10)
        || matches!(tenths, 331 | 382..=385)
}
