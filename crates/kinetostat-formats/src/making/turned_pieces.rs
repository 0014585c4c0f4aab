//! Straight moves divided so that the tool turns in them as it does in the source: controllers turn it by laws of their own.
//!
//! `LIN` swivels the x of the tool in a plane and turns the tool about it, `MoveL`, `L` of FANUC and tables turn it about one axis, APT
//! states where its axis points, and rotary axes turn as they do ([`ToolTurn`]): with the same ends the tool stands otherwise between them.

use kinetostat_program::{Move, ToolTurn};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::extreme::larger;
use crate::making::fault::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::pieces::{Pieces, Shape};

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
