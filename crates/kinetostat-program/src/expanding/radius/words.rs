//! The words of a block that have to do with cutter radius compensation, which words may stand while it is on, and its motion.

use crate::error::ProgramError;
use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Dress, arc_behind};
use crate::expanding::radius::geometry::{Axes, Side};
use crate::expanding::translate::{MotionBlock, Polar};
use crate::expanding::{Origin, Wrong};
use crate::number::number;
use crate::path::moves::Move;
use crate::reading::interpreting::Interpreter;
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::tenths;

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
