//! Coordinates that the program shifts, scales, mirrors or turns: G52, G50 and G51, G50.1 and G51.1, G68 and G69 (Fanuc).
//!
//! Takes blocks of plain words; gives blocks whose places are those of the machine's own coordinates. In parallel with the flat
//! program the blocks are run as they are programmed: that run knows the modes and the programmed places. Source: Fanuc,
//! Operator's Manual B-63534EN, sections 7.3 (G52), 14.6 (G68) and 14.8 (G51); Haas, Mill Operator's Manual, G50 to G52, G68,
//! G69.

pub(crate) mod stage;

use nalgebra::Vector3;

use crate::expanding::Wrong;
use crate::expanding::radius::geometry::{Axes, Point, Sense, in_plane};
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::tenths;

/// Largest difference of two scales that keep a circle a circle.
const SAME: f64 = 1e-12;

/// First the shift, then the scale about its centre, then the turn about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Map {
    pub shift: Vector3<f64>,
    /// Centre and factors, negative ones mirror.
    pub scale: Option<(Vector3<f64>, Vector3<f64>)>,
    /// True if G51.1 has made the scale, false if G51.
    pub is_mirror: bool,
    /// Axes of the plane, centre, angle in rad.
    pub turn: Option<(Axes, Point, f64)>,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            shift: Vector3::zeros(),
            scale: None,
            is_mirror: false,
            turn: None,
        }
    }
}

impl Map {
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// True if differences of places are unchanged.
    pub fn only_shifts(&self) -> bool {
        self.scale.is_none() && self.turn.is_none()
    }

    /// Takes away what G50 or G50.1 ends.
    pub fn take_away(&mut self, ending: Option<Ending>) -> Result<(), Wrong> {
        let (Some(ending), Some((about, factors))) = (ending, &mut self.scale) else {
            return Ok(());
        };
        match (ending, self.is_mirror) {
            (Ending::Scale, false) => self.scale = None,
            (Ending::Mirrors(axes), true) => {
                for axis in (0..3).filter(|axis| axes[*axis]) {
                    (about[axis], factors[axis]) = (0.0, 1.0);
                }
                if factors.iter().all(|factor| *factor == 1.0) {
                    (self.scale, self.is_mirror) = (None, false);
                }
            }
            (Ending::Scale, true) => {
                return Err((
                    "G50 ends the scale of G51, and the mirrors of G51.1 are in force".to_owned(),
                    "write G50.1 where the mirrors end",
                ));
            }
            (Ending::Mirrors(_), false) => {
                return Err((
                    "G50.1 ends the mirrors of G51.1, and the scale of G51 is in force".to_owned(),
                    "write G50 where the scale ends",
                ));
            }
        }
        Ok(())
    }

    /// True if one axis of the plane is mirrored, which swaps left and right of a path.
    pub fn turns_over(&self, axes: Axes) -> bool {
        let sign = |(_, factors): &(_, Vector3<f64>)| factors[axes[0]] * factors[axes[1]] < 0.0;
        self.scale.as_ref().is_some_and(sign)
    }

    /// Place in the part frame of a programmed place.
    pub fn place(&self, programmed: Vector3<f64>) -> Vector3<f64> {
        let mut at = programmed + self.shift;
        if let Some((centre, factors)) = self.scale {
            at = centre + factors.component_mul(&(at - centre));
        }
        if let Some((axes, centre, angle)) = self.turn {
            let turned = centre + turned(in_plane(&at, axes) - centre, angle);
            (at[axes[0]], at[axes[1]]) = (turned.x, turned.y);
        }
        at
    }

    /// Inverse of `place`.
    pub fn programmed(&self, place: Vector3<f64>) -> Vector3<f64> {
        let mut at = place;
        if let Some((axes, centre, angle)) = self.turn {
            let turned = centre + turned(in_plane(&at, axes) - centre, -angle);
            (at[axes[0]], at[axes[1]]) = (turned.x, turned.y);
        }
        if let Some((centre, factors)) = self.scale {
            at = centre + (at - centre).component_div(&factors);
        }
        at - self.shift
    }

    /// The sense of an arc in a plane; `None` if it is no circle any more.
    pub fn sense(&self, sense: Sense, axes: Axes) -> Option<Sense> {
        let Some((_, factors)) = self.scale else {
            return Some(sense);
        };
        let [a, b] = [factors[axes[0]], factors[axes[1]]];
        let same = (a.abs() - b.abs()).abs() < SAME;
        same.then_some(match self.turns_over(axes) {
            true => sense.other(),
            false => sense,
        })
    }
}

fn turned(from: Point, angle: f64) -> Point {
    // Quarter turns to the last digit.
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    let (sine, cosine) = match (quarters.round() - quarters).abs() < 1e-14 {
        true => [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
            [(quarters.round() as i64).rem_euclid(4) as usize],
        false => angle.sin_cos(),
    };
    Point::new(
        cosine * from.x - sine * from.y,
        sine * from.x + cosine * from.y,
    )
}

/// Change of the coordinates by a block.
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

/// Scaling or mirroring that a block ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// G50: the scale of G51.
    Scale,
    /// G50.1: the mirrors of G51.1 on these axes. The numbers of the axis words mean nothing.
    Mirrors([bool; 3]),
}

/// A block, the words that end scaling and turning taken out.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub switch: Option<Switch>,
    /// G50 or G50.1, and the axes whose mirrors are taken away.
    pub ends: Option<Ending>,
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
        let ends_mirrors = is_there(&tokens, 501);
        let mut selected = [false; 3];
        for spanned in &tokens {
            let piece = &text[spanned.span.clone()];
            if let Token::Word { letter, value, .. } = spanned.token {
                let tenths = tenths(value);
                if letter == b'G' {
                    block.codes.push(tenths);
                }
                if letter == b'G' && ENDING.contains(&tenths) {
                    block.ends_turn |= tenths == 690;
                    if tenths == 500 {
                        block.ends = Some(Ending::Scale);
                    }
                    continue;
                }
                if let (true, Some(axis)) = (ends_mirrors, b"XYZ".iter().position(|a| *a == letter))
                {
                    selected[axis] = true;
                    continue;
                }
                words.push((letter, value, piece.contains(&b'.')));
            }
            block.rest.extend_from_slice(piece);
        }
        if ends_mirrors {
            block.ends = Some(Ending::Mirrors(match selected {
                [false, false, false] => [true; 3],
                selected => selected,
            }));
        }
        check_beside_ending(&block, selected, &words)?;
        let begins = |code: &u32| BEGINNING.contains(code);
        if let Some(code) = block.codes.iter().copied().find(begins) {
            block.switch = Some(switch(code, &block.codes, &words)?);
        }
        if block.rest.trim_ascii().is_empty() {
            block.rest.clear();
        }
        Ok(block)
    }
}

fn is_there(tokens: &[Spanned], code: u32) -> bool {
    tokens.iter().any(|one| one.g_code() == Some(code))
}

/// Words that mean something else beside G50 and G50.1 on some controllers.
fn check_beside_ending(
    block: &Block,
    selected: [bool; 3],
    words: &[(u8, f64, bool)],
) -> Result<(), Wrong> {
    let has = |letters: &[u8]| words.iter().any(|word| letters.contains(&word.0));
    match block.ends {
        Some(Ending::Scale) if has(b"S") => Err((
            "G50 with S is the largest speed of a lathe's spindle".to_owned(),
            "remove it, or write G50 without S where it ends scaling",
        )),
        Some(Ending::Scale) if has(b"XYZABCUVWIJKPR") || selected != [false; 3] => Err((
            "axis words beside G50: it ends scaling on a mill, and sets the coordinates of a lathe"
                .to_owned(),
            "write G50 in a block of its own",
        )),
        Some(Ending::Mirrors(_)) if selected != [false; 3] && has(b"GABCUVWIJKPR") => Err((
            "G50.1 and other words are in one block: its axis words choose the mirrors that end"
                .to_owned(),
            "write them in two blocks",
        )),
        _ => Ok(()),
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
