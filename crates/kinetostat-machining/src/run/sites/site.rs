//! A place at which errors are looked at.

use kinetostat::{Pose, Wrench};
use kinetostat_program::{
    Corrected, GreatCircle, Knowledge, Move, MoveKind, Path, RotaryTurn, ToolTurn,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::measured_frame::PartPlace;
use crate::near::natural_length;
use crate::placement::Placement;
use crate::result::point::PointKind;
use crate::task::Task;

/// A place on the path with its load and, for a written program, what is commanded there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Site {
    pub line: usize,
    /// Index of its move in the path.
    pub move_index: usize,
    pub output_line: usize,
    pub kind: PointKind,
    pub share: f64,
    pub path_mm: f64,
    /// Length of the path before its move, mm.
    pub start_mm: f64,
    /// True for a place at which a program is evaluated however it is written.
    pub programmed: bool,
    /// Desired position of the tool, mm, program coordinates.
    pub desired: Vector3<f64>,
    /// Commanded position of the written program, mm; the desired one without compensation.
    pub commanded: Vector3<f64>,
    /// Orientation of the tool in the program, part axes from tool axes; `None` in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Commanded orientation of the written program; that of the program without compensation, or if only the
    /// position is corrected.
    pub commanded_orientation: Option<UnitQuaternion<f64>>,
    /// Angles of the rotary axes in the written program, deg; `None` if they are those of the program.
    pub commanded_deg: Option<Vec<f64>>,
    pub wrench: Wrench,
    /// Load on a corner step by the reading that was not chosen.
    pub other_wrench: Option<Wrench>,
    /// End of a piece (or block), where a full answer is wanted; otherwise its middle.
    pub end: bool,
}

impl Site {
    /// Placement of the program there.
    pub(crate) fn placement(&self, task: &Task<'_>) -> Placement {
        let motion = &task.path().moves[self.move_index];
        task.placement.on(motion, self.share)
    }

    /// The place as the program states it.
    pub(crate) fn programmed(&self, placement: Placement) -> PartPlace {
        PartPlace {
            place: placement,
            position_mm: self.desired,
            orientation: self.orientation,
        }
    }

    /// The place as the written program commands it.
    pub(crate) fn commanded_pose(&self, task: &Task<'_>) -> Pose {
        let place = self.commanded_placement(task);
        place.pose(
            &self.commanded,
            place.orientation_of(self.commanded_orientation),
        )
    }

    /// Placement there with the rotary axes of the written program.
    pub(crate) fn commanded_placement(&self, task: &Task<'_>) -> Placement {
        let motion = &task.path().moves[self.move_index];
        match (&self.commanded_deg, rotary(motion)) {
            (Some(angles), Some(rotary)) => task.placement.turned(Some(&rotary.axes.part(angles))),
            _ => self.placement(task),
        }
    }
}

/// Length of the path before every move, mm; of a part of a longer program counted from the beginning of that, for the moves
/// that are its own and those behind them.
pub(crate) fn starts(path: &Path) -> Vec<f64> {
    let own = path.own_moves();
    let before_mm = path.part.as_ref().map_or(0.0, |part| part.before_mm);
    let mut length = before_mm;
    let moves = path.moves.iter().enumerate();
    moves
        .map(|(index, m)| {
            if index <= own.start {
                length = before_mm;
            }
            let start = length;
            length += m.known_length_mm();
            start
        })
        .collect()
}

pub(super) fn kind(motion: &Move) -> PointKind {
    match motion.kind {
        MoveKind::Rapid => PointKind::Rapid,
        MoveKind::Feed => PointKind::Feed,
    }
}

/// A move from a known place that neither goes nor turns.
pub(super) fn stays(motion: &Move) -> bool {
    motion.known == Knowledge::Whole && !motion.has_length() && !motion.turns_in_place()
}

/// Length from which on a block is looked at in more places, mm of the program.
pub(crate) fn spacing_mm(task: &Task<'_>) -> f64 {
    SPACING * 1e3 * natural_length(task.mechanism) / task.placement.scale
}

/// Share of the natural length after which a long piece is looked at in one more place.
const SPACING: f64 = 1.0 / 16.0;

/// Commanded rotation of the tool along a piece; `None` in a program of positions.
pub(super) fn commanded_turn(path: &Path, written: &Corrected, index: usize) -> Option<ToolTurn> {
    let end = *written.orientations.get(index)?;
    let turn = path.moves[written.pieces[index].move_index]
        .tool_turn
        .as_ref()?;
    let start = match index.checked_sub(1) {
        Some(before) => written.orientations[before],
        None => turn.at(0.0),
    };
    Some(turn.with_ends(start, end))
}

pub(super) fn rotary(motion: &Move) -> Option<&RotaryTurn> {
    motion.tool_turn.as_ref()?.rotary.as_ref()
}

/// Great circle of the tool's axis between the angles at both ends of a piece as written; `None` if each axis turns
/// linearly.
pub(super) fn great_circle(motion: &Move, from: &[f64], to: &[f64]) -> Option<GreatCircle> {
    let own = rotary(motion).filter(|own| own.great_circle.is_some())?;
    let tool_axis = own.axes.tool_at_zero.inverse() * Vector3::z();
    let direction = own.axes.tool_direction_at(to, &tool_axis);
    GreatCircle::new(&own.axes, from, &direction).ok()
}

/// Angles of the rotary axes at both ends of a piece as written, deg; `None` if they are those of the program.
pub(super) fn commanded_angles(
    path: &Path,
    written: &Corrected,
    index: usize,
) -> Option<[Vec<f64>; 2]> {
    let own = rotary(&path.moves[written.pieces[index].move_index])?;
    let to = written.rotary_deg.get(index)?.clone();
    let before = index
        .checked_sub(1)
        .map(|before| &written.rotary_deg[before]);
    let before = before.filter(|before| before.len() == to.len());
    let from = before.cloned().unwrap_or_else(|| own.angles_deg(0.0));
    Some([from, to])
}
