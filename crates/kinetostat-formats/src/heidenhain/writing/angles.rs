//! Angles of rotary axes at the end of a written block, the tool direction (TX, TY, TZ) and the surface normal (NX, NY, NZ) there.
//!
//! The pieces of a block share its turns out. What is rounded in one piece is made up for in the next.

use nalgebra::Vector3;

use crate::heidenhain::path_words::RotaryWord;
use crate::heidenhain::reading::walker::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::words::{Stated, number_text, parsed, stands};
use crate::heidenhain::writing::writer::{Reason, Writer};
use crate::model::motion::Motion;
use crate::model::program::AxesStated;
use crate::text::source::Edits;
use crate::turned_axis::{EndWord, turns_below};
use crate::writing::piece::Piece;

/// Limit of the decimals of an angle on the control.
const MOST_DECIMALS: usize = 4;

/// Angles nearer than this are one, deg.
const SAME_DEG: f64 = 1e-9;

fn angles_of(way: &Way) -> Option<[&[f64]; 2]> {
    match &way.axes {
        Some(AxesStated::Angles { start, end }) => Some([start, end]),
        _ => None,
    }
}

impl Writer<'_> {
    fn angle_decimals(&self) -> usize {
        self.options.angle_decimals.min(MOST_DECIMALS)
    }

    /// Half of the last digit of an angle, deg.
    fn half_deg(&self) -> f64 {
        0.5 * 0.1_f64.powi(self.angle_decimals() as i32) * (1.0 + 1e-6)
    }

    /// True if the rotary axes are at the program's angles within the written digits.
    pub(crate) fn angles_stand(&self) -> bool {
        let half = self.half_deg();
        self.turned_deg.iter().all(|turned| turned.abs() <= half)
    }

    /// A motion begins: where its axes stand then, deg.
    pub(crate) fn begin_angles(&mut self, way: &Way) {
        let Some([start, _]) = angles_of(way) else {
            self.angles_now.clear();
            return;
        };
        self.turned_deg.resize(start.len(), 0.0);
        let both = start.iter().zip(&self.turned_deg);
        self.angles_now = both.map(|(start, turned)| start + turned).collect();
    }

    /// Ends a motion: stores the deviation of the rotary axes from the program, deg.
    pub(crate) fn end_angles(&mut self, way: &Way) {
        let Some([_, end]) = angles_of(way) else {
            return;
        };
        let both = self.angles_now.iter().zip(end);
        let turned = both.map(|(now, end)| now - end);
        // A residue of rounding is zero.
        let clean = |turned: f64| match turned.abs() < SAME_DEG {
            true => 0.0,
            false => turned,
        };
        self.turned_deg = turned.map(clean).collect();
    }

    /// Writes the angles of a piece in the words of a block; the words that are needed where it has none.
    pub(crate) fn write_angles(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        piece: &Piece,
        edits: &mut Edits,
    ) -> String {
        let mut added = String::new();
        let Some([_, end]) = angles_of(way) else {
            return added;
        };
        let stated = piece.rotary_deg.as_deref();
        let wanted = stated.filter(|all| all.len() == end.len()).unwrap_or(end);
        let file = &self.program.files[motion.file];
        let own = Stated::of(words).rotary;
        let digits = self.angle_decimals();
        for axis in 0..end.len() {
            let letter = self.program.rotary.letters[axis];
            let (to, now) = (wanted[axis], self.angles_now[axis]);
            let word = own.iter().find(|word| char::from(word.letter) == letter);
            let number = word.and_then(|word| words[word.at].number().map(|n| (word, n)));
            // The shorter way goes to angles of one turn.
            let reference = match (number, way.shorter) {
                (Some((RotaryWord { step: true, .. }, _)), _) => now,
                (_, true) => turns_below(to),
                (_, false) => 0.0,
            };
            let shown = self.shown.get(axis).copied().unwrap_or_default();
            let is_step = matches!(number, Some((RotaryWord { step: true, .. }, _)));
            let by_step = !is_step
                && !way.shorter
                && shown.way_of_counting().word_of_end(now, to, digits) != EndWord::Angle;
            let signs = self.signs[motion.file];
            if by_step && (number.is_some() || (to - now).abs() > self.half_deg()) {
                let text = stands(&format!("I{letter}"), to - now, digits, signs);
                self.angles_now[axis] = now + parsed(&text.as_bytes()[2..]).unwrap_or(to - now);
                match number {
                    Some((word, _)) => edits.replace(words[word.at].span.clone(), text),
                    None => added += &format!(" {text}"),
                }
                continue;
            }
            let value = to - reference;
            let Some((word, number)) = number else {
                if (to - now).abs() > self.half_deg() {
                    let text = stands(&letter.to_string(), value, digits, signs);
                    let value = parsed(&text.as_bytes()[1..]).unwrap_or(value);
                    self.angles_now[axis] = reference + value;
                    added += &format!(" {text}");
                }
                continue;
            };
            let off = match way.shorter && !word.step {
                // Whole turns are none there.
                true => (value - number.value + 180.0).rem_euclid(360.0) - 180.0,
                false => value - number.value,
            };
            if off.abs() < SAME_DEG {
                self.angles_now[axis] = to - off;
                continue;
            }
            let text = number_text(file, number, value, digits);
            self.angles_now[axis] = reference + parsed(&text).unwrap_or(value);
            if text != file.part(&number.span) {
                edits.replace(number.span.clone(), text);
            }
        }
        added
    }

    /// In a block that stays as it is written, axes with absolute words come to where the program has them.
    pub(crate) fn angles_left(&mut self, words: &[Word]) {
        for word in Stated::of(words).rotary.iter().filter(|word| !word.step) {
            let mut letters = self.program.rotary.letters.iter();
            let place = letters.position(|letter| *letter == char::from(word.letter));
            if let Some(turned) = place.and_then(|place| self.turned_deg.get_mut(place)) {
                *turned = 0.0;
            }
        }
    }
}

const TOOL: [&str; 3] = ["TX", "TY", "TZ"];
const NORMAL: [&str; 3] = ["NX", "NY", "NZ"];

/// Threshold of the angle between directions, rad.
const SAME_RAD: f64 = 1e-9;

/// Directions as written are the same below this, rad: their last digit.
const SAME_WRITTEN: f64 = 2e-7;

/// A direction on the great circle between two others.
fn between(from: &Vector3<f64>, to: &Vector3<f64>, share: f64) -> Vector3<f64> {
    let angle = from.angle(to);
    let sine = angle.sin();
    // Opposite ones have no great circle of their own.
    if sine < SAME_RAD {
        return *to;
    }
    (from * ((1.0 - share) * angle).sin() + to * (share * angle).sin()) / sine
}

/// The words of a direction, where a block states all of them.
fn words_of(words: &[Word], names: [&str; 3]) -> Option<[usize; 3]> {
    let at = |name: &str| words.iter().position(|word| word.is(name));
    Some([at(names[0])?, at(names[1])?, at(names[2])?])
}

impl Writer<'_> {
    /// Wanted and programmed tool direction at the end of a piece; in the preset's axes.
    fn tool_axes(motion: &Motion, piece: &Piece) -> Option<[Vector3<f64>; 2]> {
        let own = motion.target.pose()?.orientation * Vector3::z();
        let wanted = piece.orientation.map(|turn| turn * Vector3::z());
        Some([wanted.unwrap_or(own), own])
    }

    /// Checks that the direction of a piece can be written.
    pub(crate) fn can_stand(motion: &Motion, piece: &Piece, way: &Way) -> Result<(), Reason> {
        let turned = Self::tool_axes(motion, piece).map_or(0.0, |[wanted, own]| wanted.angle(&own));
        match turned > SAME_RAD && !way.directed {
            true => Err((
                "no block up to here states a direction of the tool (TX, TY, TZ) that could be corrected"
                    .to_owned(),
                "let the CAM system write LN blocks with TX, TY, TZ, or correct places alone (leave out --correct pose)",
            )),
            false => Ok(()),
        }
    }

    /// True if the tool already has the wanted direction at the end of a block that states none.
    pub(crate) fn stands_already(&self, motion: &Motion, piece: &Piece) -> bool {
        Self::tool_axes(motion, piece)
            .is_none_or(|[wanted, own]| wanted.angle(&self.axis.unwrap_or(own)) <= SAME_WRITTEN)
    }

    /// Writes the direction of the tool in the words of a block; the words that are needed where it has none.
    pub(crate) fn write_tool_axis(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        piece: &Piece,
        edits: &mut Edits,
    ) -> Option<String> {
        let [wanted, own] = Self::tool_axes(motion, piece)?;
        let file = &self.program.files[motion.file];
        let digits = self.options.quaternion_decimals;
        let inner = way.datum.programmed_direction(&wanted);
        let turned = wanted.angle(&own) > SAME_RAD;
        let stated = words_of(words, TOOL);
        let needed = stated.is_none() && !self.stands_already(motion, piece);
        if stated.is_some() || needed {
            self.axis = turned.then_some(wanted);
        }
        match stated {
            Some(_) if !turned => None,
            Some(at) => {
                for (at, value) in at.into_iter().zip(inner.iter()) {
                    if let Some(number) = words[at].number() {
                        let text = number_text(file, number, *value, digits);
                        edits.replace(number.span.clone(), text);
                    }
                }
                None
            }
            None if needed => {
                let signs = self.signs[motion.file];
                let texts = TOOL.iter().zip(inner.iter());
                let texts = texts.map(|(name, value)| stands(name, *value, digits, signs));
                Some(texts.fold(String::new(), |all, text| all + " " + &text))
            }
            None => None,
        }
    }

    /// Writes the surface normal of a piece that ends at a share of its block.
    pub(crate) fn write_normal(
        &self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        share: f64,
        edits: &mut Edits,
    ) {
        let ([Some(from), Some(to)], Some(at)) = (way.normals, words_of(words, NORMAL)) else {
            return;
        };
        if from.angle(&to) <= SAME_RAD {
            return;
        }
        let file = &self.program.files[motion.file];
        let digits = self.options.quaternion_decimals;
        let normal = between(&from, &to, share);
        for (at, value) in at.into_iter().zip(normal.iter()) {
            if let Some(number) = words[at].number() {
                let text = number_text(file, number, *value, digits);
                edits.replace(number.span.clone(), text);
            }
        }
    }
}

/// The share of its block at which a piece ends; `order` where the block goes nowhere.
pub(crate) fn share_of(way: &Way, place: &Vector3<f64>, order: f64) -> f64 {
    let all = |place: [Option<f64>; 3]| Some(Vector3::new(place[0]?, place[1]?, place[2]?));
    let (Some(start), Some(end)) = (all(way.start), all(way.end)) else {
        return order;
    };
    let along = end - start;
    match along.norm() < LEAST_WAY_MM {
        true => order,
        false => ((place - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0),
    }
}

/// Ways shorter than this say no share, mm.
const LEAST_WAY_MM: f64 = 1e-3;
