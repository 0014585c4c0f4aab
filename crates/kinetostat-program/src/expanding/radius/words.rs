//! The words of a block that have to do with cutter radius compensation, and which words may stand while it is on.

use crate::expanding::radius::geometry::{Axes, Side};
use crate::expanding::translate::wrong::Wrong;
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::line::tenths;

/// G4, the moves, and modes that change nothing about the contour; in tenths.
const CODES: &[u32] = &[
    0, 10, 20, 30, 40, 200, 210, 800, 900, 901, 910, 911, 940, 950, 960, 970,
];

/// Stops, spindle and coolant.
const FUNCTIONS: &[u32] = &[0, 10, 20, 300, 600, 30, 40, 50, 70, 80, 90, 190];

const STOPS: &[u32] = &[0, 10, 20, 300, 600];

/// First function of the machine builder's own.
const OWN_FUNCTIONS: u32 = 1000;

/// Codes that ask where the tool is: after G40 that is two places, in tenths.
const ASKING: &[u32] = &[100, 280, 281, 300, 301, 382, 383, 384, 385, 520, 530, 920];

const CHANGES: &[u32] = &[60, 610];

/// Change of the compensation by a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Switch {
    Off,
    /// Radius of the tool with this number (D), or of the one in the spindle.
    Tool(Side, Option<f64>),
    /// G41.1 and G42.1: by the diameter in D.
    Diameter(Side, Option<f64>),
}

/// A block, the words of compensation taken out.
#[derive(Debug, Default)]
pub(crate) struct Words {
    pub switch: Option<Switch>,
    pub rest: Vec<u8>,
    g: Vec<u32>,
    m: Vec<u32>,
    /// Value of T.
    pub tool: Option<f64>,
    /// Value of Q, which M61 has.
    pub q: Option<f64>,
    pub has_other_axes: bool,
}

/// Divides a block.
pub(crate) fn words(text: &[u8]) -> Result<Words, Wrong> {
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(text, &mut tokens);
    let mut found = Words::default();
    let mut number = None;
    let is_switch = |token: &Token| matches!(token, Token::Word { letter: b'G', value, .. } if switch_of(tenths(*value)).is_some());
    let switches = tokens.iter().filter(|one| is_switch(&one.token)).count();
    if switches > 1 {
        return Err((
            "two codes of cutter radius compensation are in one block".to_owned(),
            "write them in two blocks",
        ));
    }
    for spanned in &tokens {
        let piece = &text[spanned.span.clone()];
        let Token::Word { letter, value, .. } = spanned.token else {
            found.rest.extend_from_slice(piece);
            continue;
        };
        match letter {
            b'G' if switch_of(tenths(value)).is_some() => {
                found.switch = switch_of(tenths(value));
                continue;
            }
            b'D' if switches > 0 => {
                number = Some(value);
                continue;
            }
            b'G' => found.g.push(tenths(value)),
            b'M' => found.m.push(tenths(value)),
            b'T' => found.tool = Some(value),
            b'Q' => found.q = Some(value),
            b'A' | b'B' | b'C' | b'U' | b'V' | b'W' | b'E' => found.has_other_axes = true,
            b'L' if switches > 0 => {
                return Err((
                    "L beside G41.1 and G42.1 means the tool of a lathe".to_owned(),
                    "remove it; the tool is taken to be round about its place",
                ));
            }
            _ => {}
        }
        found.rest.extend_from_slice(piece);
    }
    found.switch = match found.switch {
        Some(Switch::Tool(side, _)) => Some(Switch::Tool(side, number)),
        Some(Switch::Diameter(side, _)) => Some(Switch::Diameter(side, number)),
        other => other,
    };
    Ok(found)
}

/// The switch of a block with its D word, and the rest.
pub(crate) fn divided(text: &[u8]) -> Result<(Vec<u8>, Vec<u8>), Wrong> {
    let found = words(text)?;
    if found.switch.is_none() {
        return Ok((Vec::new(), text.to_vec()));
    }
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(text, &mut tokens);
    let pieces = tokens.iter().filter(|one| match one.token {
        Token::Word { letter, value, .. } => {
            letter == b'D' || letter == b'G' && switch_of(tenths(value)).is_some()
        }
        _ => false,
    });
    let mut switch = Vec::new();
    for piece in pieces {
        switch.extend_from_slice(&text[piece.span.clone()]);
        switch.push(b' ');
    }
    Ok((switch.trim_ascii_end().to_vec(), found.rest))
}

/// A block with G41 and G42, G41.1 and G42.1 exchanged: left is right in a mirror.
pub(crate) fn other_side(text: &[u8]) -> Vec<u8> {
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(text, &mut tokens);
    let mut other = Vec::with_capacity(text.len());
    for one in &tokens {
        let code = match one.token {
            Token::Word {
                letter: b'G',
                value,
                ..
            } => tenths(value),
            _ => 0,
        };
        let piece: &[u8] = match code {
            410 => b"G42",
            420 => b"G41",
            411 => b"G42.1",
            421 => b"G41.1",
            _ => &text[one.span.clone()],
        };
        other.extend_from_slice(piece);
    }
    other
}

/// True if a function is allowed in a contour.
fn may_stand(function: u32) -> bool {
    FUNCTIONS.contains(&function) || function >= OWN_FUNCTIONS
}

fn switch_of(tenths: u32) -> Option<Switch> {
    match tenths {
        400 => Some(Switch::Off),
        410 => Some(Switch::Tool(Side::Left, None)),
        420 => Some(Switch::Tool(Side::Right, None)),
        411 => Some(Switch::Diameter(Side::Left, None)),
        421 => Some(Switch::Diameter(Side::Right, None)),
        _ => None,
    }
}

impl Words {
    /// True if the block has a function, as M6 (tool change) or M61 (tool in the spindle).
    pub fn has_function(&self, tenths: u32) -> bool {
        self.m.contains(&tenths)
    }

    /// The first code that may not stand in a contour.
    pub fn check_within(&self, axes: Axes) -> Result<(), Wrong> {
        let remedy = "write it before G41 and G42, or behind G40 and the move after it";
        let plane = [190, 180, 170][axes[2]];
        let may_be = |code: &u32| CODES.contains(code) || *code == plane;
        let code = self.g.iter().find(|code| !may_be(code));
        let function = self.m.iter().find(|code| !may_stand(**code));
        let name = match (code, function) {
            (Some(code), _) => format!("G{}", f64::from(*code) / 10.0),
            (_, Some(code)) => format!("M{}", f64::from(*code) / 10.0),
            _ if self.has_other_axes => "a move of an axis other than X, Y, Z".to_owned(),
            _ => return Ok(()),
        };
        Err((
            format!("{name} cannot stand while cutter radius compensation is on"),
            remedy,
        ))
    }

    /// True if the block stops the program, or ends it.
    pub fn stops(&self) -> bool {
        STOPS.iter().any(|code| self.m.contains(code))
    }

    /// Words that a controller runs before the switch of their block, and that must not change what it rests on: the plane, the
    /// units, the tool.
    pub fn check_beside_switch(&self, units: Option<u32>) -> Result<(), Wrong> {
        let is_other = |code: &&u32| match **code {
            180 | 190 => true,
            200 | 210 => Some(**code) != units,
            _ => false,
        };
        let code = self.g.iter().find(is_other).map(|code| ('G', *code));
        let function = self.m.iter().find(|code| !may_stand(**code));
        let function = function.map(|code| ('M', *code));
        match code.or(function) {
            Some((letter, code)) => Err((
                format!(
                    "{letter}{} and a switch of cutter radius compensation are in one block",
                    f64::from(code) / 10.0
                ),
                "write them in two blocks",
            )),
            None => Ok(()),
        }
    }

    /// M6 and M61.
    pub fn changes_tool(&self) -> bool {
        CHANGES.iter().any(|code| self.m.contains(code))
    }

    /// G53, with nothing else that asks where the tool is.
    pub fn is_in_machine_coordinates(&self) -> bool {
        let others = |code: &u32| ASKING.contains(code) && *code != 530;
        self.g.contains(&530) && !self.g.iter().any(others) && !self.has_other_axes
    }

    /// Codes that ask where the tool is cannot stand between G40 and the next move.
    pub fn check_behind(&self) -> Result<(), Wrong> {
        let asks = self.g.iter().any(|code| ASKING.contains(code)) || self.has_other_axes;
        match asks {
            true => Err(asks_behind()),
            false => Ok(()),
        }
    }
}

/// Error of a query of the tool position after G40.
pub(crate) fn asks_behind() -> Wrong {
    (
        "behind G40 the tool is beside the place that the program counts from, until it moves"
            .to_owned(),
        "move with G0 or G1 and X, Y first",
    )
}
