//! Tool direction at the end of a written block (TX, TY, TZ), and the surface normal there (NX, NY, NZ).

use nalgebra::Vector3;

use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::words::{number_text, stands};
use crate::heidenhain::writing::writer::{Reason, Writer};
use crate::model::motion::Motion;
use crate::text::edits::Edits;
use crate::writing::piece::Piece;

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
