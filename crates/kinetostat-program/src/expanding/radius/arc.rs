//! An arc of a contour, and the corner before it.

use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Contour, Dress, ProgrammedArc, behind_a_stop};
use crate::expanding::radius::corner::{Corner, Reversal, corner};
use crate::expanding::radius::entry::too_tight;
use crate::expanding::radius::geometry::{Point, Within, left_of};
use crate::expanding::radius::meeting::{Circle, circles, line_and_circle, onto_arc};
use crate::expanding::radius::pending::{Waiting, write};
use crate::expanding::radius::piece::Shape;
use crate::expanding::radius::trouble::Trouble;
use crate::expanding::translate::wrong::Wrong;

/// An arc inside which the tool goes must be larger than the tool by this, in mm: equal radii differ by rounding.
const LARGER_MM: f64 = 1e-9;

impl Contour {
    pub fn arc(
        &mut self,
        to: Point,
        arc: ProgrammedArc,
        normal: Point,
        mut dress: Dress,
        flat: &mut Flat<'_>,
    ) -> Result<(), Trouble> {
        let within = arc.sense.of_tool(self.side);
        let radius = arc.radii[1];
        if within == Within::Inside && radius <= self.tool + LARGER_MM {
            return Err(Trouble::Line(too_tight(radius, self.tool)));
        }
        let next = within.normal(self.at, arc.centre);
        self.check_lead_in(normal, next, flat)?;
        let reversal = match within {
            Within::Inside => Reversal::Outside,
            Within::Outside => Reversal::Inside,
        };
        let [before, after] = [normal, next].map(|normal| self.side.direction(normal));
        let kind = corner(before, after, self.side, reversal)?;
        let from = match kind {
            Corner::Inside => self.inside_arc(arc, before)?,
            Corner::Outside | Corner::Flat => self.tool_at(normal),
        };
        self.pending.end_at(from, flat)?;
        let from = match kind {
            Corner::Inside | Corner::Flat => from,
            Corner::Outside => {
                let beside = self.tool_at(next);
                let around = Shape::Arc {
                    centre: self.at,
                    sense: self.side.around_a_corner(),
                };
                write(&dress.first(around, beside), flat)?;
                beside
            }
        };
        let normal = within.normal(to, arc.centre);
        self.advance(to, normal);
        let along = Waiting::Arc {
            from,
            centre: arc.centre,
            sense: arc.sense,
            sweep: arc.sweep,
        };
        let shape = Shape::Arc {
            centre: arc.centre,
            sense: arc.sense,
        };
        let end = self.tool_at(normal);
        self.pending.begin(along, dress.last(shape, end));
        Ok(())
    }

    /// Point at which the tool stops before an inside corner and continues along an arc.
    fn inside_arc(&self, arc: ProgrammedArc, before: Point) -> Result<Point, Wrong> {
        let within = arc.sense.of_tool(self.side);
        let circle = Circle {
            centre: arc.centre,
            radius: within.radius(arc.radii[1], self.tool),
        };
        match self.pending.along() {
            None => Err(behind_a_stop()),
            Some(Waiting::Entry | Waiting::Line { .. }) => {
                // The arc is taken as large as it ends.
                let outwards = (arc.centre - self.at).normalize() * arc.radii[1];
                let to_left = outwards.dot(&left_of(before)) - self.side.sign() * self.tool;
                line_and_circle(before, to_left, circle, onto_arc(within))
            }
            Some(Waiting::Arc { centre, sense, .. }) => {
                let end = self.tool_at(self.side.normal(before));
                let last = Circle {
                    centre,
                    radius: (centre - end).norm(),
                };
                circles([last, circle], [sense, arc.sense], self.side)
            }
        }
    }
}
