//! Geometry in the plane in force (XY, or ZX), in mm of the part frame: points, sides and senses, the angle between pieces of a
//! contour, and intersections of their offset curves.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Vector2, Vector3};

use crate::expanding::Wrong;

/// A place or a direction.
pub(crate) type Point = Vector2<f64>;

/// Axes of a plane, and the one across it.
pub(crate) type Axes = [usize; 3];

/// A place as the plane has it.
pub(crate) fn in_plane(place: &Vector3<f64>, axes: Axes) -> Point {
    Point::new(place[axes[0]], place[axes[1]])
}

/// Side of the contour on which the tool is, looking along the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// G41.
    Left,
    /// G42.
    Right,
}

impl Side {
    /// 1 for left.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// Vector from the contour to the tool, for a direction of motion; its length is kept.
    pub fn normal(self, direction: Point) -> Point {
        left_of(direction) * self.sign()
    }

    /// The direction of motion of a normal.
    pub fn direction(self, normal: Point) -> Point {
        left_of(normal) * -self.sign()
    }

    /// The way round a point of the contour.
    pub fn around_a_corner(self) -> Sense {
        match self {
            Self::Left => Sense::Clockwise,
            Self::Right => Sense::CounterClockwise,
        }
    }
}

/// The way an arc turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sense {
    /// G3.
    CounterClockwise,
    /// G2.
    Clockwise,
}

impl Sense {
    pub fn other(self) -> Self {
        match self {
            Self::CounterClockwise => Self::Clockwise,
            Self::Clockwise => Self::CounterClockwise,
        }
    }

    /// 1 for counter-clockwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::CounterClockwise => 1.0,
            Self::Clockwise => -1.0,
        }
    }

    /// Side of such an arc, inside or outside, on which the tool runs.
    pub fn of_tool(self, side: Side) -> Within {
        match self.sign() == side.sign() {
            true => Within::Inside,
            false => Within::Outside,
        }
    }
}

/// Side of an arc on which the tool runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Within {
    /// Between the arc and its centre.
    Inside,
    /// Outside the arc.
    Outside,
}

impl Within {
    /// Radius of the centre line beside an arc.
    pub fn radius(self, arc: f64, tool: f64) -> f64 {
        match self {
            Self::Inside => arc - tool,
            Self::Outside => arc + tool,
        }
    }

    /// Unit vector from a place on the arc to the tool.
    pub fn normal(self, place: Point, centre: Point) -> Point {
        let inwards = (centre - place).normalize();
        match self {
            Self::Inside => inwards,
            Self::Outside => -inwards,
        }
    }
}

/// A quarter turn to the left.
pub(crate) fn left_of(direction: Point) -> Point {
    Point::new(-direction.y, direction.x)
}

/// Angle that an arc turns through, above 0 and at most a full turn, in rad: a place to itself is a full turn.
pub(crate) fn sweep(from: Point, centre: Point, sense: Sense, to: Point) -> f64 {
    let (a, b) = (from - centre, to - centre);
    let angle = sense.sign() * a.perp(&b).atan2(a.dot(&b));
    match angle > 0.0 {
        true => angle,
        false => angle + TAU,
    }
}

/// Corners flatter than this are none, in rad (LinuxCNC, `TOLERANCE_CONCAVE_CORNER`).
const FLAT: f64 = 0.05;

/// Distance from a bound, in rad, below which the last digit would decide.
const UNSURE: f64 = 1e-9;

/// Motion of the tool between two pieces of a contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Corner {
    /// No turn.
    Flat,
    /// The tool rolls round the corner.
    Outside,
    /// The tool stops short of the corner.
    Inside,
}

/// Motion at a reversal of the contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reversal {
    /// The tool goes round its end.
    Outside,
    /// The reversal is the foot of an arc that bends away from the tool, as in the letter h.
    Inside,
}

/// The corner between two directions of motion, unit vectors.
pub(crate) fn corner(
    before: Point,
    after: Point,
    side: Side,
    reversal: Reversal,
) -> Result<Corner, Wrong> {
    let opening = opening(before, after, side);
    if [-FLAT, FLAT, PI - FLAT, PI + FLAT]
        .iter()
        .any(|bound| (opening - bound).abs() < UNSURE)
    {
        return Err((
            format!(
                "the corner turns by {opening:.3} rad, where LinuxCNC begins to take it for another kind of corner"
            ),
            "change the angle by a little",
        ));
    }
    let most = match reversal {
        Reversal::Outside => PI + FLAT,
        Reversal::Inside => PI - FLAT,
    };
    Ok(match opening {
        opening if opening < -FLAT || opening > most => Corner::Inside,
        opening if opening > FLAT => Corner::Outside,
        _ => Corner::Flat,
    })
}

/// Angle by which a contour turns away from the tool, in rad: from a quarter turn towards it to three quarters away.
fn opening(before: Point, after: Point, side: Side) -> f64 {
    let away = -side.sign() * before.perp(&after).atan2(before.dot(&after));
    match away < -FRAC_PI_2 {
        true => away + TAU,
        false => away,
    }
}

/// A circle that is touched rather than crossed moves its meeting point by far more than the arithmetic errs; squared sine.
const TOUCHING: f64 = 1e-5;

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Circle {
    pub centre: Point,
    pub radius: f64,
}

/// Choice between the two intersections on a line.
///
/// The ways beside the contour at the tool's radius are straight lines and circles. Two of them may meet twice; the tool takes the
/// place that it reaches without leaving the free side.
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
