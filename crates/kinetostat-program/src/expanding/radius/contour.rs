//! The way of the tool's centre beside a contour, move by move.

use crate::expanding::flat::Flat;
use crate::expanding::radius::geometry::{Axes, Point, Sense, Side, in_plane};
use crate::expanding::radius::pending::{Pending, Piece, Shape};
use crate::expanding::{Dialect, Origin, Trouble, Wrong};
use crate::path::curve::Curve;
use crate::path::moves::{FeedMode, Move, MoveKind};

/// A programmed motion, in mm of the part frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Programmed {
    pub to: Point,
    pub shape: ProgrammedShape,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ProgrammedShape {
    Straight(&'static str),
    Arc(ProgrammedArc),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ProgrammedArc {
    pub centre: Point,
    pub sense: Sense,
    /// Radii at the start and at the end, which may differ by the tolerance of arcs.
    pub radii: [f64; 2],
    /// Sweep in rad, above 0.
    pub sweep: f64,
}

impl Programmed {
    /// Programmed motion of a block.
    pub fn of(motion: &Move, axes: Axes) -> Result<Self, Wrong> {
        if motion
            .feed
            .is_some_and(|feed| feed.mode == FeedMode::InverseTime)
        {
            return Err((
                "the time of a block (G93) is not that of the tool's centre line".to_owned(),
                "write feeds per minute (G94) while cutter radius compensation is on",
            ));
        }
        let shape = match motion.curve {
            Curve::Line => ProgrammedShape::Straight(match motion.kind {
                MoveKind::Rapid => "G0",
                MoveKind::Feed => "G1",
            }),
            Curve::Arc(arc) => ProgrammedShape::Arc(ProgrammedArc {
                centre: in_plane(&arc.centre, axes),
                sense: match arc.sweep > 0.0 {
                    true => Sense::CounterClockwise,
                    false => Sense::Clockwise,
                },
                radii: [arc.start_radius, arc.end_radius],
                sweep: arc.sweep.abs(),
            }),
        };
        Ok(Self {
            to: in_plane(&motion.end, axes),
            shape,
        })
    }
}

impl Programmed {
    /// The code of a straight move; an arc is an error behind G40.
    pub fn straight_only(&self) -> Result<&'static str, Wrong> {
        match self.shape {
            ProgrammedShape::Straight(code) => Ok(code),
            ProgrammedShape::Arc(_) => Err(arc_behind()),
        }
    }
}

/// An arc as the first move behind G40.
pub(crate) fn arc_behind() -> Wrong {
    (
        "the first move behind G40 is an arc, and the tool is beside its start".to_owned(),
        "move straight (G0 or G1) first",
    )
}

/// Words around a motion in its block.
#[derive(Debug, Clone)]
pub(crate) struct Dress {
    pub depth: Option<f64>,
    pub lead: Vec<u8>,
    pub tail: Vec<u8>,
    pub origin: Origin,
}

impl Dress {
    /// The last piece of a block: it has the depth.
    pub fn last(self, shape: Shape, to: Point) -> Piece {
        Piece {
            shape,
            to,
            depth: self.depth,
            lead: self.lead,
            tail: self.tail,
            origin: self.origin,
        }
    }

    /// A piece before the last: it takes the words of the block that are no motion.
    pub fn first(&mut self, shape: Shape, to: Point) -> Piece {
        Piece {
            shape,
            to,
            depth: None,
            lead: std::mem::take(&mut self.lead),
            tail: std::mem::take(&mut self.tail),
            origin: self.origin,
        }
    }
}

/// A contour and the tool beside it.
pub(crate) struct Contour {
    pub side: Side,
    /// Radius of the tool, in mm, above 0.
    pub tool: f64,
    /// The last programmed place.
    pub at: Point,
    /// Unit vector from there to the tool; `None` before the first move.
    pub normal: Option<Point>,
    pub pending: Pending,
    /// The controller that the program is written for.
    pub dialect: Dialect,
}

impl Contour {
    pub fn new(side: Side, tool: f64, at: Point, dialect: Dialect) -> Self {
        Self {
            side,
            tool,
            at,
            normal: None,
            pending: Pending::default(),
            dialect,
        }
    }

    /// Tool centre at the last programmed place, offset by the radius.
    pub fn tool_at(&self, normal: Point) -> Point {
        self.at + normal * self.tool
    }

    /// Ends the last motion as it is, for a stop or for G40.
    pub fn settle(&mut self, flat: &mut Flat<'_>) -> Result<(), Trouble> {
        match self.normal {
            Some(normal) => {
                let place = self.tool_at(normal);
                self.pending.end_at(place, flat)
            }
            None => self.pending.end_at(self.at, flat),
        }
    }

    /// True if the tool is offset from the contour.
    pub fn has_begun(&self) -> bool {
        self.normal.is_some()
    }

    /// Words without a motion: behind what waits.
    pub fn words(
        &mut self,
        text: &[u8],
        origin: Origin,
        flat: &mut Flat<'_>,
    ) -> Result<(), Trouble> {
        match self.pending.is_waiting() {
            true => self.pending.words(text.to_vec(), origin),
            false => flat.add(text, origin)?,
        }
        Ok(())
    }

    /// The tool is beside a new place.
    pub fn advance(&mut self, to: Point, normal: Point) {
        self.at = to;
        self.normal = Some(normal);
    }
}

/// An inside corner behind a stop: the end of the move before it has been made.
pub(crate) fn behind_a_stop() -> Wrong {
    (
        "an inside corner follows a stop (M0, M1, M60): the tool has cut into it already"
            .to_owned(),
        "write the stop before or behind the corner",
    )
}
