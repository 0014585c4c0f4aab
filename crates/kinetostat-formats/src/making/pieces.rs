//! A move divided into what a language has: lines and arcs, and pieces in which the tool turns as in the source.

use kinetostat_program::{Arc, Curve, Move, ToolTurn};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::extreme::larger;
use crate::making::MakeFinding;
use crate::making::limits::{Arcs, Limits, MakeLanguage};

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

// Straight moves divided so that the tool turns in them as it does in the source: controllers turn it by laws of their own.
//
// `LIN` swivels the x of the tool in a plane and turns the tool about it, `MoveL`, `L` of FANUC and tables turn it about one axis, APT
// states where its axis points, and rotary axes turn as they do ([`ToolTurn`]): with the same ends the tool stands otherwise between them.

/// Tolerated deviation of the tool orientation from the source along a straight move.
const SAME_DEG: f64 = 0.01;

/// Two laws with the same ends differ by less than this share of the square of the angle between them, both in rad; ends nearer than that
/// leave nothing to divide. The largest is that of a swivel by `t` and a turn about the axis by `t`: `t^2 / 8` half way.
const LEAST_TURN_RAD: f64 = 0.01;

/// Limit of the motions of one move.
const MOST: usize = 1000;

/// Shares of a motion at which both laws are compared: the middle, where they are farthest apart, and others for those that are not alike.
const SHARES: [f64; 7] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];

/// Divided motions, and those that could not be divided.
#[derive(Debug, Default)]
pub(crate) struct Turned {
    divided: usize,
    motions: usize,
    first: Option<usize>,
    /// Largest angle that was not divided, rad, and its line.
    left: Option<(f64, usize)>,
}

impl Turned {
    /// Divides the pieces of a move, with the direction from the tool's tip to its holder in axes of the tool.
    pub(crate) fn divide(
        &mut self,
        motion: &Move,
        pieces: &mut Pieces,
        language: MakeLanguage,
        tool_axis: &Vector3<f64>,
    ) {
        let Some(turn) = motion.tool_turn.as_deref() else {
            return;
        };
        let is_short = turn.rotary.is_none() && turn.start.angle_to(&turn.end) < LEAST_TURN_RAD;
        if is_short || language == MakeLanguage::Gcode {
            return;
        }
        let apart = |ends: &[f64]| {
            let starts = std::iter::once(0.0).chain(ends.iter().copied());
            let each = starts.zip(ends);
            let each = each.map(|(from, to)| apart(turn, [from, *to], language, tool_axis));
            each.fold(0.0, larger)
        };
        let most = SAME_DEG.to_radians();
        let mut found = apart(&pieces.ends);
        if found <= most {
            return;
        }
        if pieces.shape == Shape::Line {
            let whole = pieces.ends.clone();
            let mut count = 1;
            while found > most && count * whole.len() < MOST {
                // Halves are a quarter apart.
                let wanted = (count as f64 * (found / most).sqrt()).ceil();
                count = (wanted as usize).clamp(count + 1, (MOST / whole.len()).max(count + 1));
                pieces.ends = divided(&whole, count);
                found = apart(&pieces.ends);
            }
            self.divided += 1;
            self.motions += pieces.ends.len();
            self.first.get_or_insert(motion.line);
        }
        let worst = self.left.map_or(0.0, |(angle, _)| angle);
        let is_near = found <= most;
        if !is_near && (found > worst || found.is_nan()) {
            self.left = Some((found, motion.line));
        }
    }

    /// Both in words.
    pub(crate) fn findings(&self) -> Vec<MakeFinding> {
        let divided = self.first.map(|line| {
            let moves = match self.divided {
                1 => "1 move is".to_owned(),
                count => format!("{count} moves, here first, are"),
            };
            MakeFinding::of(
                line,
                format!(
                    "{moves} divided into {} motions: between two points this controller turns the tool otherwise than the source, and so within {SAME_DEG} deg as there",
                    self.motions
                ),
            )
        });
        let left = self.left.map(|(angle, line)| {
            MakeFinding::of(
                line,
                format!(
                    "between the points the tool stands up to {:.2} deg otherwise than in the source, most here: this controller turns it in another way",
                    angle.to_degrees()
                ),
            )
        });
        divided.into_iter().chain(left).collect()
    }
}

/// The ends of so many equal parts of every piece.
fn divided(ends: &[f64], count: usize) -> Vec<f64> {
    let starts = std::iter::once(0.0).chain(ends.iter().copied());
    let parts = starts.zip(ends).flat_map(|(from, to)| {
        (1..=count).map(move |part| match part == count {
            true => *to,
            false => from + (to - from) * part as f64 / count as f64,
        })
    });
    parts.collect()
}

/// Deviation of a made motion's orientation from the source between its ends, rad; of the axis, if that alone is written.
fn apart(
    turn: &ToolTurn,
    [from, to]: [f64; 2],
    language: MakeLanguage,
    tool_axis: &Vector3<f64>,
) -> f64 {
    let ends = [turn.at(from), turn.at(to)];
    let made = law(ends, language, tool_axis);
    let each = SHARES.iter().map(|share| {
        let wanted = turn.at(from + (to - from) * share);
        let found = made.at(*share);
        match language {
            MakeLanguage::Apt => {
                let [one, other] = [wanted, found].map(|turn| turn * tool_axis);
                one.cross(&other).norm().atan2(one.dot(&other))
            }
            _ => found.angle_to(&wanted),
        }
    });
    each.fold(0.0, larger)
}

/// Orientation interpolation of a language's controller between the ends of a motion.
fn law(
    [start, end]: [UnitQuaternion<f64>; 2],
    language: MakeLanguage,
    tool_axis: &Vector3<f64>,
) -> ToolTurn {
    match language {
        MakeLanguage::Krl => ToolTurn::swivelled(start, end, Vector3::x_axis()),
        MakeLanguage::Apt => ToolTurn::swivelled(start, end, Unit::new_normalize(*tool_axis)),
        _ => ToolTurn::shortest(start, end),
    }
}
