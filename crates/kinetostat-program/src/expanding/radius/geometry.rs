//! Points, sides and senses in the plane in force (XY, or ZX), in mm of the part frame.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};

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
