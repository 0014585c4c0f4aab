//! A move divided into what a language has: lines and arcs.

use kinetostat_program::{Arc, Curve, Move};

use crate::extreme::larger;
use crate::making::limits::{Arcs, Limits};

/// Shape of a piece of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    Line,
    Circle,
    AboutZ { clockwise: bool },
}

/// Reason why an arc is approximated by lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Followed {
    /// Helical arc.
    Helix,
    /// The language has no such arcs.
    Language,
    /// Arc that is too small for the controller.
    Small,
    /// Spiral: the radius grows from start to end by more than the tolerance.
    Spiral,
}

/// A move in pieces: shares of its length, in order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pieces {
    pub ends: Vec<f64>,
    pub shape: Shape,
    pub followed: Option<Followed>,
}

/// Limit of the pieces of one move.
const MOST_PIECES: usize = 1_000_000;

/// Heights below this are those of the arithmetic, mm.
const FLAT_MM: f64 = 1e-6;

/// The pieces of a move; none where there would be too many.
pub(crate) fn pieces_of(motion: &Move, limits: &Limits, tolerance_mm: f64) -> Option<Pieces> {
    let whole = |shape| Pieces {
        ends: vec![1.0],
        shape,
        followed: None,
    };
    let Curve::Arc(arc) = &motion.curve else {
        return Some(whole(Shape::Line));
    };
    let halves = (arc.sweep.abs() / std::f64::consts::PI - 1e-9)
        .ceil()
        .max(1.0);
    let radius = arc.start_radius.max(arc.end_radius);
    // An arc that leaves its chord by less than the digits is a line.
    if radius * (1.0 - (0.5 * arc.sweep.abs()).min(std::f64::consts::PI).cos()) < FLAT_MM
        && arc.sweep.abs() < 1.0
    {
        return Some(whole(Shape::Line));
    }
    match why_followed(motion, arc, limits, halves, tolerance_mm) {
        None if limits.arcs == Arcs::AboutZ => {
            let clockwise = (arc.sweep < 0.0) != (arc.axis.z < 0.0);
            Some(Pieces {
                ends: even(halves)?,
                shape: Shape::AboutZ { clockwise },
                followed: None,
            })
        }
        None => Some(Pieces {
            ends: even(halves)?,
            shape: Shape::Circle,
            followed: None,
        }),
        Some(followed) => Some(Pieces {
            ends: even(arc.chords_within(tolerance_mm) as f64)?,
            shape: Shape::Line,
            followed: Some(followed),
        }),
    }
}

/// Shares at the ends of equal pieces.
fn even(count: f64) -> Option<Vec<f64>> {
    let number = count as usize;
    (count <= MOST_PIECES as f64).then(|| (1..=number).map(|i| i as f64 / count).collect())
}

fn why_followed(
    motion: &Move,
    arc: &Arc,
    limits: &Limits,
    halves: f64,
    tolerance_mm: f64,
) -> Option<Followed> {
    match limits.arcs {
        Arcs::None => Some(Followed::Language),
        Arcs::AboutZ => {
            let upright = arc.axis.z.abs() > 1.0 - 1e-12;
            (!upright).then_some(Followed::Language)
        }
        Arcs::Through if arc.rise.abs() > FLAT_MM => Some(Followed::Helix),
        Arcs::Through => {
            let places = [0.0, 0.5 / halves, 1.0 / halves].map(|share| motion.point(share));
            let near = (places[1] - places[0])
                .norm()
                .min((places[2] - places[0]).norm());
            let sweep = arc.sweep.abs() / halves;
            if near < limits.least_chord_mm || sweep < limits.least_sweep_rad {
                return Some(Followed::Small);
            }
            // A piece of a spiral and the circle through three of its places.
            let apart = Arc::through(&places[0], &places[1], &places[2]).map(|circle| {
                let off = |share: f64| (circle.point(share) - motion.point(share / halves)).norm();
                larger(off(0.25), off(0.75))
            });
            match apart {
                Some(apart) if apart <= tolerance_mm => None,
                Some(_) => Some(Followed::Spiral),
                None => Some(Followed::Small),
            }
        }
    }
}
