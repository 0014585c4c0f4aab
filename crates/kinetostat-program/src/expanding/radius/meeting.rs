//! Intersection of the offset curves of two consecutive pieces of a contour.
//!
//! The ways are straight lines and circles beside the contour at the tool's radius. Two of them may meet twice; the tool takes
//! the place that it reaches without leaving the free side.

use crate::expanding::radius::geometry::{Point, Sense, Side, Within, left_of};
use crate::expanding::translate::wrong::Wrong;

/// A circle that is touched rather than crossed moves its meeting point by far more than the arithmetic errs; squared sine.
const TOUCHING: f64 = 1e-5;

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Circle {
    pub centre: Point,
    pub radius: f64,
}

/// Choice between the two intersections on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Along {
    Forward,
    Backward,
}

impl Along {
    fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }
}

fn no_room() -> Wrong {
    (
        "the tool does not fit into the corner without cutting into the contour".to_owned(),
        "take a smaller tool, or widen the corner",
    )
}

/// Meeting of two lines beside a corner, by the unit normals that lead to them: it lies on the bisector.
pub(crate) fn lines(corner: Point, normals: [Point; 2], tool: f64) -> Point {
    let [a, b] = normals;
    corner + (a + b) * (tool / (1.0 + a.dot(&b)))
}

/// A circle and a line of a direction (unit vector) that the centre lies beside, `to_left` mm to its left.
pub(crate) fn line_and_circle(
    direction: Point,
    to_left: f64,
    circle: Circle,
    along: Along,
) -> Result<Point, Wrong> {
    let sine = to_left / circle.radius;
    let cosine = cosine_of(sine)?;
    let across = left_of(direction) * -to_left;
    Ok(circle.centre + across + direction * (along.sign() * circle.radius * cosine))
}

/// Choice for a line and an arc inside a corner. The tool inside the arc runs on until it meets the far wall; outside it stops
/// before the near one.
pub(crate) fn onto_arc(within: Within) -> Along {
    match within {
        Within::Inside => Along::Forward,
        Within::Outside => Along::Backward,
    }
}

/// Choice for an arc and a line: that of a line and an arc, run backwards.
pub(crate) fn off_arc(within: Within) -> Along {
    match within {
        Within::Inside => Along::Backward,
        Within::Outside => Along::Forward,
    }
}

/// Meeting of two circles, the first one run until it meets the second.
///
/// By the law of cosines in the triangle of the two centres and the meeting point, which lies on the side of the line of
/// centres where the tool leaves the first circle for the second.
pub(crate) fn circles(
    [one, two]: [Circle; 2],
    [one_sense, two_sense]: [Sense; 2],
    side: Side,
) -> Result<Point, Wrong> {
    let between = two.centre - one.centre;
    let distance = between.norm();
    if one.radius * distance < f64::EPSILON {
        return Err((
            "two arcs about the same centre meet in a corner".to_owned(),
            "join them into one arc",
        ));
    }
    let cosine = (one.radius * one.radius + distance * distance - two.radius * two.radius)
        / (2.0 * one.radius * distance);
    let sine = cosine_of(cosine)?;
    let sign = match one_sense.of_tool(side) {
        Within::Inside => two_sense.sign(),
        Within::Outside => -two_sense.sign(),
    };
    let axis = between / distance;
    Ok(one.centre + (axis * cosine + left_of(axis) * (sign * sine)) * one.radius)
}

/// The other side of a right-angled triangle with a hypotenuse of 1.
fn cosine_of(sine: f64) -> Result<f64, Wrong> {
    let square = 1.0 - sine * sine;
    match square > TOUCHING {
        true => Ok(square.sqrt()),
        false => Err(no_room()),
    }
}
