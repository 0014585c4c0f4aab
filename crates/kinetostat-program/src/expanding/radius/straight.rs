//! A straight move of a contour, and the corner before it.

use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Contour, Dress, behind_a_stop};
use crate::expanding::radius::corner::{Corner, Reversal, corner};
use crate::expanding::radius::geometry::{Point, Within, left_of};
use crate::expanding::radius::meeting::{Circle, line_and_circle, lines, off_arc};
use crate::expanding::radius::pending::{Waiting, write};
use crate::expanding::radius::piece::Shape;
use crate::expanding::radius::trouble::Trouble;
use crate::expanding::translate::wrong::Wrong;

impl Contour {
    pub fn straight(
        &mut self,
        to: Point,
        code: &'static str,
        normal: Point,
        mut dress: Dress,
        flat: &mut Flat<'_>,
    ) -> Result<(), Trouble> {
        let direction = (to - self.at).normalize();
        let next = self.side.normal(direction);
        self.check_lead_in(normal, next, flat)?;
        let reversal = match self.pending.along() {
            Some(Waiting::Arc { sense, .. }) if sense.of_tool(self.side) == Within::Outside => {
                Reversal::Inside
            }
            _ => Reversal::Outside,
        };
        let before = self.side.direction(normal);
        let kind = corner(before, direction, self.side, reversal)?;
        let from = match kind {
            Corner::Inside => self.inside_straight(direction, [normal, next])?,
            Corner::Outside | Corner::Flat => self.tool_at(normal),
        };
        self.pending.end_at(from, flat)?;
        let from = match kind {
            Corner::Inside | Corner::Flat => from,
            Corner::Outside => {
                let beside = self.tool_at(next);
                let shape = match code {
                    // No arc is rapid: the tool cuts the corner straight.
                    "G0" => Shape::Straight("G0"),
                    _ => Shape::Arc {
                        centre: self.at,
                        sense: self.side.around_a_corner(),
                    },
                };
                write(&dress.first(shape, beside), flat)?;
                beside
            }
        };
        self.advance(to, next);
        let along = Waiting::Line { from, direction };
        let piece = dress.last(Shape::Straight(code), self.tool_at(next));
        self.pending.begin(along, piece);
        Ok(())
    }

    /// Point at which the tool stops before an inside corner and continues along a straight move.
    fn inside_straight(&self, direction: Point, normals: [Point; 2]) -> Result<Point, Wrong> {
        match self.pending.along() {
            None => Err(behind_a_stop()),
            Some(Waiting::Entry | Waiting::Line { .. }) => Ok(lines(self.at, normals, self.tool)),
            Some(Waiting::Arc { centre, sense, .. }) => {
                let end = self.tool_at(normals[0]);
                let circle = Circle {
                    centre,
                    radius: (centre - end).norm(),
                };
                let to_left =
                    (centre - self.at).dot(&left_of(direction)) - self.side.sign() * self.tool;
                let along = off_arc(sense.of_tool(self.side));
                line_and_circle(direction, to_left, circle, along)
            }
        }
    }
}
