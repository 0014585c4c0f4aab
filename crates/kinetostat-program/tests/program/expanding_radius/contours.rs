//! Promises of every contour: the tool touches each piece with its edge all along and cuts into none, and its way has no gap.
//!
//! Random contours of lines and arcs, corners towards the tool and away from it. Distances are measured to the programmed
//! pieces themselves, sampled densely; which piece a motion belongs to is known by its line.

use std::f64::consts::{FRAC_PI_2, TAU};

use kinetostat_program::Move;
use nalgebra::{Vector2, Vector3};
use proptest::prelude::*;

use super::flat;

type Point = Vector2<f64>;

const SAMPLES: usize = 40;
const NEAR_MM: f64 = 1e-9;

/// A piece by its start and direction.
#[derive(Debug, Clone, Copy)]
enum Piece {
    Line {
        from: Point,
        to: Point,
    },
    /// `turn` is signed, in rad.
    Arc {
        centre: Point,
        radius: f64,
        start: f64,
        turn: f64,
    },
}

/// What a piece is drawn from: the corner before it, its size, and how far it turns (none: straight).
#[derive(Debug, Clone, Copy)]
struct Drawn {
    corner: f64,
    size: f64,
    turn: Option<f64>,
}

fn unit(angle: f64) -> Point {
    Point::new(angle.cos(), angle.sin())
}

impl Piece {
    fn start(&self) -> Point {
        match *self {
            Self::Line { from, .. } => from,
            Self::Arc {
                centre,
                radius,
                start,
                ..
            } => centre + unit(start) * radius,
        }
    }

    fn end(&self) -> Point {
        match *self {
            Self::Line { to, .. } => to,
            Self::Arc {
                centre,
                radius,
                start,
                turn,
            } => centre + unit(start + turn) * radius,
        }
    }

    /// Distance of a point to the piece, its ends included.
    fn distance(&self, point: Point) -> f64 {
        match *self {
            Self::Line { from, to } => {
                let way = to - from;
                let share = ((point - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                (point - from - way * share).norm()
            }
            Self::Arc {
                centre,
                radius,
                start,
                turn,
            } => {
                let out = point - centre;
                let along = (turn.signum() * (out.y.atan2(out.x) - start)).rem_euclid(TAU);
                match along <= turn.abs() {
                    true => (out.norm() - radius).abs(),
                    false => (point - self.start())
                        .norm()
                        .min((point - self.end()).norm()),
                }
            }
        }
    }

    /// Distance to the whole line or circle, positive to the left.
    fn distance_to_left(&self, point: Point) -> f64 {
        match *self {
            Self::Line { from, to } => (to - from).normalize().perp(&(point - from)),
            Self::Arc {
                centre,
                radius,
                turn,
                ..
            } => turn.signum() * (radius - (point - centre).norm()),
        }
    }

    fn words(&self) -> String {
        let end = self.end();
        match *self {
            Self::Line { .. } => format!("G1 X{} Y{}", end.x, end.y),
            Self::Arc { centre, turn, .. } => {
                let (code, way) = (if turn > 0.0 { "G3" } else { "G2" }, centre - self.start());
                format!("{code} X{} Y{} I{} J{}", end.x, end.y, way.x, way.y)
            }
        }
    }
}

fn contour(heading: f64, drawn: &[Drawn]) -> Vec<Piece> {
    let (mut at, mut heading) = (Point::new(3.0, -4.0), heading);
    let mut pieces = Vec::new();
    for one in drawn {
        heading += one.corner;
        let piece = match one.turn {
            None => Piece::Line {
                from: at,
                to: at + unit(heading) * one.size,
            },
            Some(turn) => {
                let start = heading - turn.signum() * FRAC_PI_2;
                Piece::Arc {
                    centre: at - unit(start) * one.size,
                    radius: one.size,
                    start,
                    turn,
                }
            }
        };
        heading += one.turn.unwrap_or(0.0);
        at = piece.end();
        pieces.push(piece);
    }
    pieces
}

fn drawn() -> impl Strategy<Value = Drawn> {
    // Tangent, or a corner that is one; sizes in radii of the tool. Two neighbours do not come back to each other.
    let corner = prop_oneof![Just(0.0), 0.06..1.2, -1.2..-0.06];
    let turn = prop_oneof![
        2 => Just(None),
        1 => (0.5..1.0).prop_map(Some),
        1 => (-1.0..-0.5).prop_map(Some),
    ];
    (corner, 8.0..20.0, turn).prop_map(|(corner, size, turn)| Drawn { corner, size, turn })
}

/// Points of a motion; its ends included.
fn sampled(motion: &Move) -> impl Iterator<Item = Point> + '_ {
    (0..=SAMPLES).map(|index| motion.point(index as f64 / SAMPLES as f64).xy())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn the_tool_touches_every_piece_and_cuts_into_none(
        heading in 0.0..TAU,
        tool in 0.3..3.0_f64,
        left in any::<bool>(),
        drawn in prop::collection::vec(drawn(), 2..12),
    ) {
        let drawn: Vec<Drawn> = drawn.iter().map(|one| Drawn { size: one.size * tool, ..*one }).collect();
        let pieces = contour(heading, &drawn);
        let switch = if left { "G41.1" } else { "G42.1" };
        let side = if left { 1.0 } else { -1.0 };
        // The entry runs straight onto the first piece.
        let first = match pieces[0] {
            Piece::Line { from, to } => (from - to).normalize(),
            Piece::Arc { start, turn, .. } => -unit(start + turn.signum() * FRAC_PI_2),
        };
        let entry = pieces[0].start();
        let before: Point = entry + first * (3.0 * tool);
        let mut text = format!(
            "G21 G90 G17 F100\nG0 X{} Y{} Z0\n{switch} D{}\nG1 X{} Y{}\n",
            before.x, before.y, 2.0 * tool, entry.x, entry.y
        );
        for piece in &pieces {
            text.push_str(&piece.words());
            text.push('\n');
        }
        text.push_str("G40\nM2\n");
        let flat = flat(&text);
        let moves = &flat.path.moves;
        let mut place: Option<Vector3<f64>> = None;
        let mut cut = vec![0; pieces.len()];
        for (index, motion) in moves.iter().enumerate() {
            if let Some(place) = place {
                prop_assert!((motion.start - place).norm() < NEAR_MM, "a gap in {}", text);
            }
            place = Some(motion.end);
            let line = flat.origins[motion.line - 1].line;
            let Some(own) = line.checked_sub(5) else { continue };
            // The first of two motions of a block rounds the corner before it.
            let rounds = moves.get(index + 1).is_some_and(|next| flat.origins[next.line - 1].line == line);
            cut[own] += usize::from(!rounds);
            for point in sampled(motion) {
                let distance = match rounds {
                    true => (point - pieces[own].start()).norm(),
                    false => side * pieces[own].distance_to_left(point),
                };
                prop_assert!((distance - tool).abs() < NEAR_MM, "{distance} from piece {own}: {text}");
                for near in &pieces[own.saturating_sub(1)..(own + 2).min(pieces.len())] {
                    let distance = near.distance(point);
                    prop_assert!(distance >= tool - NEAR_MM, "{distance} of {tool} near piece {own}: {text}");
                }
            }
        }
        prop_assert!(cut.iter().all(|times| *times == 1), "{cut:?}: {text}");
    }
}
