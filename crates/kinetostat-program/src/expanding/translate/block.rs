//! The words of a block that is translated, and the rest of it, which is run before them.

use crate::expanding::number::number;
use crate::reading::block::looks_ahead;
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::line::tenths;

/// Letters that belong to a motion.
const OF_MOTION: &[u8; 15] = b"XYZABCUVWIJKRPQ";

/// Modes that take no words.
pub(crate) const G_WITHOUT_WORDS: &[f64] = &[
    17.0, 18.0, 19.0, 20.0, 21.0, 90.0, 91.0, 94.0, 95.0, 98.0, 99.0,
];

/// Spindle and coolant.
const M_WITHOUT_WORDS: &[f64] = &[3.0, 4.0, 5.0, 7.0, 8.0, 9.0];

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
    /// Words that the block has twice.
    pub twice: Option<String>,
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
                // Removed words leave no second blank.
                Token::Blank if block.before.last().is_none_or(|last| *last == b' ') => {}
                _ => block.before.extend_from_slice(piece),
            }
        }
        block.take_own_words(&tokens);
        block
    }

    /// P, Q and R of a work coordinate system and of a setting of the control are none of a motion, and stay with their code.
    fn take_own_words(&mut self, tokens: &[Spanned]) {
        let has = |wanted: &[u32]| {
            tokens
                .iter()
                .any(|one| one.g_code().is_some_and(|code| wanted.contains(&code)))
        };
        let sets = self
            .motion
            .filter(|code| looks_ahead(*code, |letter| self.value(letter)));
        let letters: &[u8] = match sets {
            Some(_) => b"XYZABCUVWPQR",
            None if has(&[541, 1030, 1540, 1870]) => b"PQ",
            None => return,
        };
        let mut own = String::new();
        if let Some(code) = sets {
            self.motion = None;
            own.push_str(&format!("G{} ", f64::from(code) / 10.0));
        }
        for letter in letters {
            if let Some(value) = self.values[usize::from(letter - b'A')].take() {
                own.push_str(&format!("{}{} ", char::from(*letter), number(value)));
            }
        }
        // In front of comments, which may go to the end of the line.
        self.before.splice(0..0, own.into_bytes());
    }

    fn word(&mut self, letter: u8, value: f64, piece: &[u8]) {
        match (letter, tenths(value)) {
            (b'N', _) => self.head.extend_from_slice(piece),
            // G80 beside a move ends the cycle and no more.
            (b'G', 800) if self.motion.is_some_and(is_move) => {}
            (b'G', code) if is_motion(code) => {
                let before = self.motion.replace(code);
                if before.is_some_and(|before| before != 800 || !is_move(code)) {
                    self.twice = Some(format!(
                        "G{value} meets another code of its group in the same block"
                    ));
                }
            }
            (b'M', 0 | 10 | 20 | 300 | 600) => {
                self.after.extend_from_slice(piece);
                self.after.push(b' ');
            }
            (b'G', code) => {
                self.wants_axes |=
                    matches!(code, 40 | 100 | 280..=301 | 431 | 432 | 500..=520 | 530 | 680 | 920);
                self.before.extend_from_slice(piece);
            }
            (letter, _) if letter == b'L' || OF_MOTION.contains(&letter) => {
                if self.values[usize::from(letter - b'A')]
                    .replace(value)
                    .is_some()
                {
                    let letter = char::from(letter);
                    self.twice = Some(format!("the letter {letter} appears twice in one block"));
                }
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

    /// A word of an axis beside X, Y and Z.
    pub fn has_other_axis(&self) -> bool {
        b"ABCUVW".iter().any(|letter| self.value(*letter).is_some())
    }

    /// Words that a cycle keeps (R, P, Q, I, J, K, L), in a block that wants them for nothing else.
    pub fn has_cycle_words(&self) -> bool {
        let words = b"RPQIJKL"
            .iter()
            .any(|letter| self.value(*letter).is_some());
        words && !self.wants_axes && self.has_only_own_words()
    }

    /// True if the codes beside the motion are modes, spindle and coolant, which have no words of their own but S and F.
    pub fn has_only_own_words(&self) -> bool {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(&self.before, &mut tokens);
        tokens.iter().all(|one| match one.token {
            Token::Word {
                letter: b'G',
                value,
                ..
            } => G_WITHOUT_WORDS.contains(&value),
            Token::Word {
                letter: b'M',
                value,
                ..
            } => M_WITHOUT_WORDS.contains(&value),
            _ => true,
        })
    }

    /// X, Y, Z or a polar word.
    pub fn has_place(&self) -> bool {
        self.polar.is_there() || b"XYZ".iter().any(|letter| self.value(*letter).is_some())
    }
}

/// G0 to G3.
fn is_move(tenths: u32) -> bool {
    matches!(tenths, 0 | 10 | 20 | 30)
}

fn is_motion(tenths: u32) -> bool {
    matches!(tenths, 50..=53)
        || matches!(tenths, 0 | 10 | 20 | 30 | 330 | 331 | 380..=385 | 730 | 740 | 760 | 800 | 810..=890)
            && tenths.is_multiple_of(10)
        || matches!(tenths, 331 | 382..=385)
}
