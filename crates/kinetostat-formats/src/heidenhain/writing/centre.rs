//! A block that becomes an arc, with the numbers that are printed: a circle about a centre (CC and C), or a helix by its angle (CC and CP).
//!
//! Of the centres next to the wanted one, a circle takes that which makes the radii at both ends equal, a helix that which brings
//! the angle, which has four decimals, to the wanted end.

use nalgebra::{Rotation2, Vector2};

use crate::heidenhain::reading::walker::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::words::{
    PlacedPiece, Stated, parsed, with_blanks, word_text, write_functions,
};
use crate::heidenhain::writing::writer::Writer;
use crate::model::motion::Motion;
use crate::text::source::Edits;

/// Numbers on both sides of the rounded centre that are looked at.
const NEIGHBOURS: i32 = 2;

/// Decimals of angles in degrees: the control takes no more.
pub(crate) const ANGLE_DECIMALS: usize = 4;

/// Tolerated displacement of the arc between its ends by rounding, in last digits.
const MOVED_DIGITS: f64 = 1.5;

/// An arc to be printed, in the plane of the programmed axes, mm.
pub(crate) struct ToPrint {
    /// Start of the arc as written.
    pub from: Vector2<f64>,
    /// Required end of the arc; for a circle as printed.
    pub to: Vector2<f64>,
    pub centre: Vector2<f64>,
    /// 1 anticlockwise, -1 clockwise.
    pub sense: f64,
    /// The last digit of places.
    pub digit_mm: f64,
}

/// A helix as it is printed.
pub(crate) struct Turned {
    pub centre: Vector2<f64>,
    /// Signed angle of the turn, as printed.
    pub degrees: f64,
    /// End of the arc with this angle.
    pub end: Vector2<f64>,
}

impl ToPrint {
    /// The angle between the ends about a place, with its sign, rad.
    fn angle_about(&self, centre: &Vector2<f64>) -> f64 {
        let (a, b) = (self.from - centre, self.to - centre);
        let along = self.sense * a.perp(&b).atan2(a.dot(&b));
        self.sense * along.rem_euclid(std::f64::consts::TAU)
    }

    fn centres_near(&self, wanted: Vector2<f64>) -> impl Iterator<Item = Vector2<f64>> {
        let digit = self.digit_mm;
        let numbers = wanted.map(|value| (value / digit).round());
        let range = -NEIGHBOURS..=NEIGHBOURS;
        range.clone().flat_map(move |x| {
            range.clone().map(move |y| {
                let moved = numbers + Vector2::new(f64::from(x), f64::from(y));
                moved * digit
            })
        })
    }

    /// Deviation between its ends of an arc, from the start by an angle about a centre, from the wanted circle.
    fn moved_mm(&self, centre: &Vector2<f64>, angle: f64, last_radius: f64) -> f64 {
        let arm = self.from - centre;
        let first_radius = arm.norm();
        let radius = 0.5 * ((self.from - self.centre).norm() + (self.to - self.centre).norm());
        let off = |part: f64| {
            let size = 1.0 + part * (last_radius / first_radius - 1.0);
            let place = centre + Rotation2::new(angle * part) * arm * size;
            ((place - self.centre).norm() - radius).abs()
        };
        // NaN stays.
        [0.25, 0.5, 0.75]
            .map(off)
            .into_iter()
            .fold(0.0, |worst, off| match off <= worst {
                true => worst,
                false => off,
            })
    }

    /// The best of some centres: with the least error among those that move the arc little, else that which moves it least.
    fn best_centre<T>(&self, found: impl Iterator<Item = (f64, f64, T)>) -> Option<T> {
        let most = MOVED_DIGITS * self.digit_mm;
        let nanometres = |mm: f64| (mm * 1e6).round();
        let mut best: Option<((i32, f64, f64), T)> = None;
        for (moved, error, made) in found {
            if !(moved.is_finite() && error.is_finite()) {
                continue;
            }
            let rank = match moved <= most {
                true => (0, nanometres(error), nanometres(moved)),
                false => (1, nanometres(moved), nanometres(error)),
            };
            if best.as_ref().is_none_or(|(least, _)| rank < *least) {
                best = Some((rank, made));
            }
        }
        best.map(|(_, made)| made)
    }

    /// The centre of a circle.
    pub(crate) fn printed_circle(&self) -> Option<Vector2<f64>> {
        self.best_centre(self.centres_near(self.centre).map(|centre| {
            let last = (self.to - centre).norm();
            let error = (last - (self.from - centre).norm()).abs();
            let moved = self.moved_mm(&centre, self.angle_about(&centre), last);
            (moved, error, centre)
        }))
    }

    /// A helix: its angle as printed, and the centre about which it ends where it should.
    pub(crate) fn printed_helix(&self) -> Option<Turned> {
        let fine = 10.0_f64.powi(ANGLE_DECIMALS as i32);
        let degrees = (self.angle_about(&self.centre).to_degrees() * fine).round() / fine;
        let angle = degrees.to_radians();
        let chord = self.to - self.from;
        let left = Vector2::new(-chord.y, chord.x);
        let wanted = self.from + 0.5 * chord + left * (0.5 / (0.5 * angle).tan());
        if !wanted.iter().all(|value| value.is_finite()) {
            return None;
        }
        self.best_centre(self.centres_near(wanted).map(|centre| {
            let arm = self.from - centre;
            let end = centre + Rotation2::new(angle) * arm;
            let moved = self.moved_mm(&centre, angle, arm.norm());
            let turned = Turned {
                centre,
                degrees,
                end,
            };
            (moved, (end - self.to).norm(), turned)
        }))
    }
}

/// Largest coordinate that the control takes, in its unit.
const FARTHEST: f64 = 99_999.999;

/// A piece as it is written: what stands before its block, and the changes of the block.
pub(crate) struct Block {
    pub before: Option<String>,
    pub edits: Edits,
}

impl Writer<'_> {
    /// A piece as an arc, from a place in the programmed axes, which is that of its end then; none where it is straight, or where
    /// the digits say no arc.
    pub(crate) fn arc_block(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        placed: PlacedPiece<'_>,
        place: &mut [Option<f64>; 3],
    ) -> Option<Block> {
        let PlacedPiece { piece, part, .. } = placed;
        let centre = way.datum.programmed(&piece.centre_mm?);
        let wanted = way.datum.programmed(&piece.position_mm);
        let plane = way.plane;
        let [u, v] = plane.axes();
        let (from, z) = (plane.known(*place)?, place[plane.0]?);
        let (decimals, half) = (self.decimals(way), self.half_mm(way));
        let signs = self.signs[motion.file];
        let text = |axis: usize, mm: f64| word_text(axis, mm / way.unit_mm, decimals, signs);
        let says = |text: &str| {
            let digits = text.get(1..).unwrap_or_default();
            parsed(digits.as_bytes()).map(|value| value * way.unit_mm)
        };
        let to = [text(u, wanted[u]), text(v, wanted[v])];
        let arc = ToPrint {
            from,
            to: Vector2::new(says(&to[0])?, says(&to[1])?),
            centre: plane.flat(&centre),
            sense: way.turns,
            digit_mm: 2.0 * half,
        };
        let turn = match way.turns < 0.0 {
            true => "DR-",
            false => "DR+",
        };
        let up = wanted[plane.0] - z;
        let rise = text(plane.0, up);
        let rises = up.abs() > half;
        let (centre, end, keyword, own) = match rises {
            false => (
                arc.printed_circle()?,
                plane.place(arc.to, z),
                "C",
                format!(" {} {} {turn}", to[0], to[1]),
            ),
            true => {
                let turned = arc.printed_helix()?;
                let sign = match signs && turned.degrees > 0.0 {
                    true => "+",
                    false => "",
                };
                let digits = ANGLE_DECIMALS;
                (
                    turned.centre,
                    plane.place(turned.end, z + says(&rise)?),
                    "CP",
                    format!(" IPA{sign}{:.digits$} I{rise} {turn}", turned.degrees),
                )
            }
        };
        if centre.amax() > FARTHEST * way.unit_mm {
            return None;
        }
        let mut edits = Edits::default();
        edits.replace(words[0].span.clone(), keyword);
        edits.replace(words[0].span.end..words[0].span.end, own);
        for at in &Stated::of(words).places {
            edits.replace(with_blanks(words, *at), "");
        }
        write_functions(words, part, &mut edits);
        self.write_feed(way, words, piece.speed_factor, &mut edits);
        *place = [Some(end.x), Some(end.y), Some(end.z)];
        let before = self.own_pole(way, centre).then(|| {
            let [first, second] = [text(u, centre.x), text(v, centre.y)];
            format!("CC {first} {second}")
        });
        Some(Block { before, edits })
    }
}
