//! Words that a controller makes into moves of its own, written as plain moves: polar words, canned cycles.
//!
//! Takes a block of plain words and where the tool is; gives the plain blocks in its place. The motions are those of LinuxCNC
//! (`docs/src/gcode/g-code.adoc`, "Canned Cycles", "Polar Coordinates").

pub(crate) mod cycle;
pub(crate) mod holes;
pub(crate) mod spline;
pub(crate) mod turns;

use crate::number::number;
use crate::reading::block::looks_ahead;
use crate::reading::interpreting::Interpreter;
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::tenths;

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

/// A block without the blanks within its numbers; `None` if it has none. Comments stay.
///
/// LinuxCNC passes over them: `X 1 0` is X10.
pub(crate) fn without_blanks_in_numbers(text: &[u8]) -> Option<Vec<u8>> {
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let mut made = Vec::with_capacity(text.len());
    let mut at = 0;
    let mut commented = false;
    while let Some(byte) = text.get(at).copied() {
        match byte {
            b';' => {
                made.extend_from_slice(&text[at..]);
                break;
            }
            b'(' => commented = true,
            b')' => commented = false,
            _ => {}
        }
        if is_blank(&byte) && !commented {
            let blanks = text[at..].iter().take_while(|byte| is_blank(byte)).count();
            let before = made.last();
            let behind = text.get(at + blanks);
            let in_number = matches!(before, Some(b'0'..=b'9' | b'.' | b'+' | b'-'))
                && matches!(behind, Some(b'0'..=b'9' | b'.'));
            if !in_number {
                made.extend_from_slice(&text[at..at + blanks]);
            }
            at += blanks;
        } else {
            made.push(byte);
            at += 1;
        }
    }
    (made.len() < text.len()).then_some(made)
}

/// Polar words: `@` is a radius, `^` an angle in degrees, about the origin of the program's coordinates.
impl Polar {
    /// The place in X and Y that the words mean, for a tool at a place.
    pub fn place(&self, at: [f64; 2], incremental: bool) -> Result<[f64; 2], &'static str> {
        let [x, y] = at;
        let (radius, angle) = (x.hypot(y), y.atan2(x));
        let is_origin = x == 0.0 && y == 0.0;
        let of = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
        let turn = self.angle_deg.map(f64::to_radians);
        match (incremental, self.radius, turn) {
            (false, Some(radius), Some(angle)) => Ok(of(radius, angle)),
            (false, Some(_), None) if is_origin => {
                Err("a radius (@) without an angle (^) where the tool is at the origin")
            }
            (false, Some(radius), None) => Ok(of(radius, angle)),
            (false, None, Some(angle)) => Ok(of(radius, angle)),
            (true, ..) if is_origin => {
                Err("incremental polar words (G91) where the tool is at the origin")
            }
            (true, more, turn) => {
                // First the radius, then the angle.
                Ok(of(
                    radius + more.unwrap_or(0.0),
                    angle + turn.unwrap_or(0.0),
                ))
            }
            (false, None, None) => Ok(at),
        }
    }
}

const LETTERS: [char; 3] = ['X', 'Y', 'Z'];

/// Tool position in program coordinates, as far as it is known, and the distance mode for writing places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub at: [Option<f64>; 3],
    pub incremental: bool,
}

impl Place {
    pub fn of(state: &Interpreter<'_>) -> Self {
        Self {
            at: [0, 1, 2].map(|axis| state.coordinate(axis).ok()),
            incremental: state.is_incremental(),
        }
    }

    /// A straight move to a place, `G0` or `G1`; `None` if it goes nowhere. Axes without a place stand still.
    pub fn go(&mut self, code: &str, to: [Option<f64>; 3]) -> Option<String> {
        let mut text = code.to_owned();
        for axis in 0..3 {
            let Some(target) = to[axis] else { continue };
            if self.at[axis] == Some(target) {
                continue;
            }
            let word = match (self.incremental, self.at[axis]) {
                (true, Some(at)) => target - at,
                _ => target,
            };
            text.push_str(&format!(" {}{}", LETTERS[axis], number(word)));
            self.at[axis] = Some(target);
        }
        (text.len() > code.len()).then_some(text)
    }
}
