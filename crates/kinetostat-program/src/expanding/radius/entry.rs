//! The first motion of a contour: from where the tool is to beside its end.

use crate::expanding::flat::Flat;
use crate::expanding::options::Dialect;
use crate::expanding::radius::contour::{
    Contour, Dress, Programmed, ProgrammedArc, ProgrammedShape,
};
use crate::expanding::radius::geometry::{Point, Within, sweep};
use crate::expanding::radius::pending::Waiting;
use crate::expanding::radius::piece::Shape;
use crate::expanding::translate::wrong::Wrong;

/// An entry must be longer than the tool's radius by this, in mm: equal lengths differ by rounding.
const LONGER_MM: f64 = 1e-9;

/// Unit vectors nearer than this are one.
const SAME_DIRECTION: f64 = 1e-6;

/// Cosine between the chord of an entry arc and its radius at the end, below which there is no arc (LinuxCNC,
/// `TOLERANCE_EQUAL`).
const LEAST_COSINE: f64 = 1e-4;

/// Radius of an entry arc by that cosine, mm: beyond it rounding moves the centre by more than the last digits.
const LARGEST_BY_COSINE_MM: f64 = 1e4;

impl Contour {
    pub fn enter(&mut self, programmed: Programmed, dress: Dress) -> Result<(), Wrong> {
        let length = (programmed.to - self.at).norm();
        if length <= self.tool + LONGER_MM {
            return Err((
                format!(
                    "the first move with cutter radius compensation is {length:.4} mm long in the plane; it must be longer than the tool's radius, {:.4} mm",
                    self.tool
                ),
                "begin further away from the contour",
            ));
        }
        match programmed.shape {
            ProgrammedShape::Arc(_) if self.dialect == Dialect::Fanuc => Err((
                "compensation begins with an arc, which is an alarm on Fanuc's controllers"
                    .to_owned(),
                "begin with a straight move",
            )),
            ProgrammedShape::Straight(code) => {
                self.enter_straight(programmed.to, code, dress);
                Ok(())
            }
            ProgrammedShape::Arc(arc) => self.enter_by_arc(programmed.to, arc, dress),
        }
    }

    /// Controllers agree if the lead-in and the contour begin in one direction. Else LinuxCNC leads the tool beside the end of that
    /// move, and Fanuc's controllers beside the start of the next one (B-63944EN, 14.4, start-up).
    pub fn check_lead_in(
        &self,
        normal: Point,
        next: Point,
        flat: &mut Flat<'_>,
    ) -> Result<(), Wrong> {
        let is_entry = self.pending.along() == Some(Waiting::Entry);
        if !is_entry || (normal - next).norm() < SAME_DIRECTION {
            return Ok(());
        }
        match self.dialect {
            Dialect::LinuxCnc => Ok(()),
            Dialect::Undecided => {
                let line = flat.blocks().max(1);
                flat.warn_of_lines(line, "the way to a contour with G41 or G42 is LinuxCNC's: another controller may lead the tool in otherwise where the contour begins in another direction than that way (--dialect)");
                Ok(())
            }
            Dialect::Fanuc => Err((
                "the contour begins in another direction than the move that leads to it: Fanuc's controllers lead the tool in otherwise than is known here".to_owned(),
                "let that move end in the direction in which the contour begins, or let the CAM system write the centre line of the tool",
            )),
        }
    }

    /// The tool ends square to the move, so that it would go along its direction.
    fn enter_straight(&mut self, to: Point, code: &'static str, dress: Dress) {
        let normal = self.side.normal((to - self.at).normalize());
        self.advance(to, normal);
        let piece = dress.last(Shape::Straight(code), self.tool_at(normal));
        self.pending.begin(Waiting::Entry, piece);
    }

    /// The tool's centre goes from where it is to beside the end of the arc, on an arc that runs there as the programmed one
    /// does: its centre lies on the line of the programmed radius at the end, as far from the end as from the start. With the
    /// vector `chord` from end to start and the unit vector `inwards` that is `chord^2 / (2 chord . inwards)`.
    fn enter_by_arc(&mut self, to: Point, arc: ProgrammedArc, dress: Dress) -> Result<(), Wrong> {
        let within = arc.sense.of_tool(self.side);
        let least = arc.radii[0].min(arc.radii[1]);
        if within == Within::Inside && least <= self.tool + LONGER_MM {
            return Err(too_tight(least, self.tool));
        }
        let from = self.at;
        let normal = within.normal(to, arc.centre);
        let inwards = (arc.centre - to).normalize();
        let end = to + normal * self.tool;
        let chord = from - end;
        let cosine = chord.dot(&inwards) / chord.norm();
        let radius = 0.5 * chord.norm() / cosine;
        let is_arc = cosine > LEAST_COSINE
            && radius < LARGEST_BY_COSINE_MM * cosine
            && (within == Within::Inside || radius > self.tool);
        if !is_arc {
            return Err((
                "no arc leads the tool from where it is along the end of this arc".to_owned(),
                "begin further inside the arc, or enter by a straight move",
            ));
        }
        let centre = end + inwards * radius;
        let along = Waiting::Arc {
            from,
            centre,
            sense: arc.sense,
            sweep: sweep(from, centre, arc.sense, end),
        };
        let shape = Shape::Arc {
            centre,
            sense: arc.sense,
        };
        self.advance(to, normal);
        self.pending.begin(along, dress.last(shape, end));
        Ok(())
    }
}

/// An arc that the tool cannot cut from inside.
pub(crate) fn too_tight(radius: f64, tool: f64) -> Wrong {
    (
        format!("the arc has a radius of {radius:.4} mm, and the tool inside it {tool:.4} mm"),
        "take a smaller tool",
    )
}
