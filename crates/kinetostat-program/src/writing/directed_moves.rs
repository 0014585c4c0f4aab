//! Moves whose text says directions of the tool while the rotary axes turn evenly: where they may be divided.
//!
//! The end of a piece is written as a direction, in so many digits, and the controller takes the angles nearest to those before. A
//! piece is good if this leads to the angles that the undivided move has there: not near a pole, where digits of a direction say
//! nothing of one axis, and not so far that other angles of the same direction are nearer.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number::{larger, rounded};
use crate::path::moves::{Move, Path};
use crate::path::tool_turn::{RotaryTurn, StatedBy};
use crate::writing::node::{Node, is_divided};

/// Digits after the point of directions.
pub const DIRECTION_DECIMALS: usize = 8;

/// Minimum distance of the end of a piece from a pole, rad: digits of directions turn an axis by less than 2e-5 rad elsewhere. The
/// next of these limits holds for a move that is nearer for long: it hardly leans the tool, and the axis may be further off.
const NEAR_POLE: [f64; 4] = [5e-4, 1e-4, 2e-5, 5e-6];

/// Largest share of a move that is left undivided.
const LONG_SHARE: f64 = 0.05;

/// Largest angle of the tool from where the undivided move has it, rad.
const SAME_WAY: f64 = 5e-5;

/// Largest angle of an axis from where the undivided move has it, deg: the machine bends the same.
const SAME_ANGLE_DEG: f64 = 0.1;

/// A move of evenly turning axes that are stated by directions.
pub(crate) struct DirectedMove<'a> {
    turn: &'a RotaryTurn,
    /// Shares between which no piece should end.
    pub near_poles: Vec<[f64; 2]>,
    /// Shares on the way there, which divide a long approach.
    pub approaching: Vec<f64>,
}

/// Returns an entry for every move; `None` for those that state angles, do not turn their axes, or lead the tool on a
/// great circle.
pub(crate) fn directed_moves(path: &Path) -> Vec<Option<DirectedMove<'_>>> {
    path.moves.iter().map(DirectedMove::of).collect()
}

impl<'a> DirectedMove<'a> {
    pub fn of(motion: &'a Move) -> Option<Self> {
        let turn = motion.tool_turn.as_ref()?.rotary.as_ref()?;
        let by_direction = turn.stated == StatedBy::Direction && turn.great_circle.is_none();
        let turns = turn.start_deg != turn.end_deg;
        (by_direction && turns && is_divided(motion)).then(|| {
            let mut own = Self {
                turn,
                near_poles: Vec::new(),
                approaching: Vec::new(),
            };
            for near in NEAR_POLE {
                let shares = turn.shares_near_poles(near);
                let outer = std::mem::replace(&mut own.near_poles, shares);
                own.approaching.extend(outer.into_iter().flatten());
                let is_short = |[from, to]: &[f64; 2]| to - from <= LONG_SHARE;
                if !own.near_poles.is_empty() && own.near_poles.iter().all(is_short) {
                    break;
                }
            }
            own
        })
    }

    /// The direction at a share as it is written, and as it is meant.
    fn directions(&self, share: f64) -> [Vector3<f64>; 2] {
        let axes = &self.turn.axes;
        let tool_axis = axes.tool_at_zero.inverse() * Vector3::z();
        let meant = axes.tool_direction_at(&self.turn.angles_deg(share), &tool_axis);
        let written = meant.map(|part| rounded(part, DIRECTION_DECIMALS));
        // The end of the move keeps its own words.
        match share < 1.0 {
            true => [written.normalize(), meant],
            false => [meant, meant],
        }
    }

    /// True if a controller moves between two ends of a piece as in the undivided move.
    pub fn goes_on(&self, from: f64, to: f64) -> bool {
        if from >= to || (from <= 0.0 && to >= 1.0) {
            return true;
        }
        let axes = &self.turn.axes;
        let own = |share: f64| self.turn.angles_deg(share);
        let begins = match from > 0.0 {
            true => axes.angles_towards(&self.directions(from)[0], &own(from)),
            false => Ok(own(from)),
        };
        let Ok(begins) = begins else {
            return false;
        };
        let Ok(ends) = axes.angles_towards(&self.directions(to)[0], &begins) else {
            return false;
        };
        let tool_axis = axes.tool_at_zero.inverse() * Vector3::z();
        [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().all(|part| {
            let share = from + (to - from) * part;
            let both = begins.iter().zip(&ends);
            let is: Vec<f64> = both.map(|(a, b)| a + (b - a) * part).collect();
            let away = (axes.tool_direction_at(&is, &tool_axis) - self.directions(share)[1]).norm();
            let meant = own(share);
            let turned = is.iter().zip(&meant).map(|(a, b)| (a - b).abs());
            away <= SAME_WAY && turned.fold(0.0, larger) <= SAME_ANGLE_DEG
        })
    }

    /// True if a stretch crosses a pole, in which no piece should end.
    pub fn is_across_pole(&self, [from, to]: [f64; 2]) -> bool {
        self.near_poles
            .iter()
            .any(|pole| pole[0] <= from && to <= pole[1])
    }
}

/// Refuses, by line, moves that cannot be divided without other angles.
pub(crate) fn refuse_other_angles(
    path: &Path,
    nodes: &[Node],
    directed: &[Option<DirectedMove<'_>>],
) -> Result<(), WriteError> {
    for pair in nodes.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let same = a.move_index == b.move_index;
        let Some(own) = directed[a.move_index].as_ref().filter(|_| same) else {
            continue;
        };
        if !own.goes_on(a.share, b.share) {
            let motion = &path.moves[a.move_index];
            return Err(WriteError::Motion {
                line: motion.line,
                reason: format!(
                    "the correction bends here, and at {:.2} % of the block its pieces would have other angles of the rotary axes than the block: directions of the tool say too little of them near the pole (the tool along an axis), or other angles of the same direction are nearer",
                    100.0 * b.share
                ),
                remedy: "let the CAM system write angles of the rotary axes, or shorter blocks here; or widen the tolerance of the path".to_owned(),
            });
        }
    }
    Ok(())
}
