//! A block that becomes an arc about a centre of its own: CC before it, and C or, where it rises, CP.

use nalgebra::Vector2;

use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::centre::{ANGLE_DECIMALS, ToPrint};
use crate::heidenhain::writing::words::{
    PlacedPiece, Stated, parsed, with_blanks, word_text, write_functions,
};
use crate::heidenhain::writing::writer::Writer;
use crate::model::motion::Motion;
use crate::text::edits::Edits;

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
