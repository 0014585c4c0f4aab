//! One motion of a contour after the other: the way in, straight moves, arcs, moves in depth.

use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{
    Contour, Dress, Programmed, ProgrammedArc, ProgrammedShape, behind_a_stop,
};
use crate::expanding::radius::geometry::{
    Circle, Corner, Point, Reversal, Within, circles, corner, left_of, line_and_circle, lines,
    off_arc, onto_arc, sweep,
};
use crate::expanding::radius::pending::{Shape, Waiting, write};
use crate::expanding::{Dialect, Trouble, Wrong};
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

/// An entry must be longer than the tool's radius by this, in mm: equal lengths differ by rounding.
const LONGER_MM: f64 = 1e-9;

/// Unit vectors nearer than this are one.
const SAME_DIRECTION: f64 = 1e-6;

/// Cosine between the chord of an entry arc and its radius at the end, below which there is no arc (LinuxCNC,
/// `TOLERANCE_EQUAL`).
const LEAST_COSINE: f64 = 1e-4;

/// Radius of an entry arc by that cosine, mm: beyond it rounding moves the centre by more than the last digits.
const LARGEST_BY_COSINE_MM: f64 = 1e4;

/// The first motion of a contour: from where the tool is to beside its end.
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

/// A straight move of a contour, and the corner before it.
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

/// An arc inside which the tool goes must be larger than the tool by this, in mm: equal radii differ by rounding.
const LARGER_MM: f64 = 1e-9;

/// An arc of a contour, and the corner before it.
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
