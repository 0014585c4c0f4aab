//! A piece of a written program, with what is commanded along it.

use kinetostat::Wrench;
use kinetostat_program::{Corrected, GreatCircle, Move, Path, Piece, ToolTurn};

use crate::result::point::PointKind;
use crate::run::sites::commanded::{commanded_angles, commanded_turn, great_circle, rotary};
use crate::run::sites::site::{Site, kind};

/// A place on a piece.
pub(super) struct Spot {
    /// Share of the piece.
    pub place: f64,
    /// Share of its move.
    pub share: f64,
    /// See [`Site::programmed`].
    pub programmed: bool,
}

/// A piece with what is commanded along it.
pub(super) struct AlongPiece<'a> {
    pub piece: &'a Piece,
    pub motion: &'a Move,
    /// Share of its move that it is.
    pub width: f64,
    /// Length on a move at feed, mm.
    pub length_mm: f64,
    kind: PointKind,
    start_mm: f64,
    turn: Option<ToolTurn>,
    angles: Option<[Vec<f64>; 2]>,
    circle: Option<GreatCircle>,
}

impl<'a> AlongPiece<'a> {
    /// Piece `index` of a written program, before whose move the path is so long; `is_first`: before it nobody corrected the
    /// tool.
    pub fn new(
        (path, written): (&'a Path, &'a Corrected),
        index: usize,
        (start_mm, is_first): (f64, bool),
    ) -> Self {
        let piece = &written.pieces[index];
        let motion = &path.moves[piece.move_index];
        let angles = commanded_angles(path, written, index);
        let ends = angles.as_ref();
        Self {
            piece,
            motion,
            width: piece.share_to - piece.share_from,
            length_mm: match motion.is_known_feed() {
                true => motion.length_between_mm(piece.share_from, piece.share_to),
                false => 0.0,
            },
            kind: match piece.corner_step {
                true if piece.turn.is_some_and(|turn| turn.is_entry(path)) => PointKind::Entry,
                true if is_first => PointKind::Entry,
                true => PointKind::Corner,
                false => kind(motion),
            },
            start_mm,
            turn: commanded_turn(path, written, index),
            circle: ends.and_then(|[from, to]| great_circle(motion, from, to)),
            angles,
        }
    }

    /// A place of its own at a share of the piece.
    pub fn spot(&self, place: f64) -> Spot {
        Spot {
            place,
            share: match place {
                1.0 => self.piece.share_to,
                _ => self.piece.share_from + place * self.width,
            },
            programmed: false,
        }
    }

    /// Commanded angles of the rotary axes at a share of the piece, deg.
    fn degrees(&self, place: f64) -> Option<Vec<f64>> {
        let [from, to] = self.angles.as_ref()?;
        if let (Some(circle), Some(rotary), true) = (
            &self.circle,
            rotary(self.motion),
            place > 0.0 && place < 1.0,
        ) {
            return Some(circle.angles_at(&rotary.axes, place));
        }
        let both = from.iter().zip(to);
        Some(both.map(|(from, to)| from + (to - from) * place).collect())
    }

    /// A place with the load there, as chosen and by the other reading.
    pub fn site(
        &self,
        spot: &Spot,
        (wrench, other_wrench): (Wrench, Option<Wrench>),
        end: bool,
    ) -> Site {
        let (piece, motion) = (self.piece, self.motion);
        let &Spot {
            place,
            share,
            programmed,
        } = spot;
        let commanded_deg = self.degrees(place);
        Site {
            line: motion.line,
            move_index: piece.move_index,
            output_line: piece.output_line,
            kind: self.kind,
            share,
            path_mm: self.start_mm + share * motion.known_length_mm(),
            start_mm: self.start_mm,
            programmed,
            desired: motion.point(share),
            commanded: piece.commanded(motion, place),
            orientation: motion.orientation(share),
            // In G-code the words of rotary axes say it.
            commanded_orientation: match (&self.turn, &commanded_deg, rotary(motion)) {
                (Some(turn), ..) => Some(turn.at(place)),
                (None, Some(angles), Some(rotary)) => Some(rotary.axes.tool(angles)),
                _ => motion.orientation(share),
            },
            commanded_deg,
            wrench,
            other_wrench,
            end,
        }
    }
}
