//! One motion of a contour after the other: the way in, straight moves, arcs, moves in depth.

use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Contour, Dress, Programmed, ProgrammedShape};
use crate::expanding::radius::piece::Shape;
use crate::expanding::radius::trouble::Trouble;
use crate::path::curve::NO_LENGTH_MM;

impl Contour {
    /// The next motion of the contour.
    pub fn go(
        &mut self,
        programmed: Programmed,
        dress: Dress,
        flat: &mut Flat<'_>,
    ) -> Result<(), Trouble> {
        let way = (programmed.to - self.at).norm();
        let is_arc = matches!(programmed.shape, ProgrammedShape::Arc(_));
        if way > 0.0 && way < NO_LENGTH_MM && !is_arc {
            return Err(Trouble::Line((
                format!("a move of {way:.1e} mm has no direction beyond rounding"),
                "remove it",
            )));
        }
        let Some(normal) = self.normal else {
            self.enter(programmed, dress)?;
            return Ok(());
        };
        match programmed.shape {
            ProgrammedShape::Straight(code) if way == 0.0 => {
                let piece = dress.last(Shape::Straight(code), self.tool_at(normal));
                self.pending.stand(piece);
                Ok(())
            }
            ProgrammedShape::Straight(code) => {
                self.straight(programmed.to, code, normal, dress, flat)
            }
            ProgrammedShape::Arc(arc) => self.arc(programmed.to, arc, normal, dress, flat),
        }
    }
}
