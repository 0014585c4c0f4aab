//! The words that shift, scale, mirror and turn coordinates.

use crate::expanding::translate::wrong::Wrong;
use crate::text::lex::{Spanned, Token, tokens_of};

/// What a block does to the coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Switch {
    /// G52.
    Shift([Option<f64>; 3]),
    /// G51: centre and factors.
    Scale([Option<f64>; 3], [f64; 3]),
    /// G51.1: where the mirrors of the axes stand.
    Mirror([Option<f64>; 3]),
    /// G68: centre and angle in degrees.
    Turn([Option<f64>; 3], f64),
}

/// A block, the words that end scaling and turning taken out.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub switch: Option<Switch>,
    /// G50 or G50.1.
    pub ends_scale: bool,
    /// G69.
    pub ends_turn: bool,
    pub rest: Vec<u8>,
    /// G codes, in tenths.
    pub codes: Vec<u32>,
}

const BEGINNING: &[u32] = &[510, 511, 520, 680];
const ENDING: &[u32] = &[500, 501, 690];

impl Block {
    /// Divides a block; none where no such code is in it.
    pub fn of(text: &[u8]) -> Result<Self, Wrong> {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let mut block = Self::default();
        let mut words: Vec<(u8, f64, bool)> = Vec::new();
        for spanned in &tokens {
            let piece = &text[spanned.span.clone()];
            if let Token::Word { letter, value, .. } = spanned.token {
                let tenths = (10.0 * value).round() as u32;
                if letter == b'G' {
                    block.codes.push(tenths);
                }
                if letter == b'G' && ENDING.contains(&tenths) {
                    block.ends_turn |= tenths == 690;
                    block.ends_scale |= tenths != 690;
                    continue;
                }
                words.push((letter, value, piece.contains(&b'.')));
            }
            block.rest.extend_from_slice(piece);
        }
        let begins = |code: &u32| BEGINNING.contains(code);
        if let Some(code) = block.codes.iter().copied().find(begins) {
            block.switch = Some(switch(code, &block.codes, &words)?);
        } else if block.ends_scale && words.iter().any(|(letter, ..)| *letter == b'S') {
            return Err((
                "G50 with S is the largest speed of a lathe's spindle".to_owned(),
                "remove it, or write G50 without S where it ends scaling",
            ));
        }
        if block.rest.trim_ascii().is_empty() {
            block.rest.clear();
        }
        Ok(block)
    }
}

fn switch(code: u32, codes: &[u32], words: &[(u8, f64, bool)]) -> Result<Switch, Wrong> {
    let name = format!("G{}", f64::from(code) / 10.0);
    let others = codes.len() > 1 || words.iter().any(|word| !b"GNXYZIJKPR".contains(&word.0));
    if others {
        return Err((
            format!("{name} and other words are in one block"),
            "write them in two blocks",
        ));
    }
    let find = |letter: u8| words.iter().find(|word| word.0 == letter);
    let place = b"XYZ".map(|letter| find(letter).map(|word| word.1));
    let factor = |letter: u8| match find(letter) {
        None => Ok(None),
        Some((_, value, _)) if *value == 0.0 => Err((
            format!("{name} with a factor of zero"),
            "write a factor that is not zero",
        )),
        Some((_, value, true)) => Ok(Some(*value)),
        Some((_, value, false)) => Err((
            format!(
                "{name} {}{value} without a decimal point is a factor of {value} to some controllers, and counts thousandths (or hundred-thousandths) to others",
                char::from(letter)
            ),
            "write the factor with a decimal point",
        )),
    };
    match code {
        520 => Ok(Switch::Shift(place)),
        511 if place == [None; 3] => Err((
            "G51.1 mirrors no axis".to_owned(),
            "write X, Y or Z: where the mirror stands",
        )),
        511 => Ok(Switch::Mirror(place)),
        510 => {
            let all = factor(b'P')?;
            let own = [factor(b'I')?, factor(b'J')?, factor(b'K')?];
            match (all, own) {
                (Some(all), [None, None, None]) => Ok(Switch::Scale(place, [all; 3])),
                (None, [None, None, None]) => Err((
                    "G51 without a factor (P, or I, J, K): it is a parameter of the controller"
                        .to_owned(),
                    "write P with a decimal point",
                )),
                (None, own) => Ok(Switch::Scale(place, own.map(|k| k.unwrap_or(1.0)))),
                (Some(_), _) => Err((
                    "G51 with P and with I, J or K".to_owned(),
                    "write P, or the factors of the axes",
                )),
            }
        }
        _ => match find(b'R') {
            _ if [b'I', b'J', b'K', b'P'].iter().any(|l| find(*l).is_some()) => Err((
                "G68 with I, J, K or P tilts the plane".to_owned(),
                "write G68 with the two axes of the plane and R",
            )),
            Some((_, angle, _)) => Ok(Switch::Turn(place, *angle)),
            None => Err(("G68 has no angle (R)".to_owned(), "write R, in degrees")),
        },
    }
}
