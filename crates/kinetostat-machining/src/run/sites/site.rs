//! A place at which errors are looked at.

use kinetostat::{Pose, Wrench};
use kinetostat_program::{
    Corrected, Curve, GreatCircle, Knowledge, Move, MoveKind, Path, RotaryTurn, ToolTurn,
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

/// Blocks longer than this share of the path that is cut are looked at in more places.
const PIECES: f64 = 500.0;

/// A move that turns the tool is looked at after so much of its turn, deg.
const TURN_DEG: f64 = 10.0;

/// Arcs are looked at where chords leave them by at most this, mm.
pub(super) const ARC_MM: f64 = 0.01;

/// The places at which a program is looked at as it is given: the same whether and how it is written anew,
/// so that means without compensation are the same in every run.
pub(super) struct Programmed {
    longest_mm: f64,
    pub short_mm: f64,
}

impl Programmed {
    pub fn new(path: &Path, spacing_mm: f64) -> Self {
        let cut = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
        let length = match &path.part {
            Some(part) => part.whole_feed_mm,
            None => cut.map(Move::known_length_mm).sum::<f64>(),
        };
        Self {
            longest_mm: (length / PIECES).min(spacing_mm),
            short_mm: SHORT * spacing_mm,
        }
    }

    /// Into how many pieces a block is divided.
    pub fn pieces(&self, motion: &Move) -> usize {
        let length = motion.length_mm();
        // All lengths are zero in a program that only turns.
        let pieces = match length > 0.0 {
            true => (length / self.longest_mm).ceil().clamp(1.0, 1e6) as usize,
            false => 1,
        };
        let pieces = pieces.max(turns(motion, 1.0));
        match &motion.curve {
            Curve::Line => pieces,
            Curve::Arc(arc) => pieces.max(arc.chords_within(ARC_MM)),
        }
    }

    /// Ends and middles of its equal pieces ([`Self::pieces`]) of a block at feed, as shares of it, and which of them are ends: between
    /// the ends of a long block the load or the machine may differ much. A very short one has no middle.
    pub fn shares(
        &self,
        motion: &Move,
        pieces: usize,
    ) -> impl Iterator<Item = (f64, bool)> + use<> {
        let middles = pieces > 1 || motion.length_mm() > self.short_mm || motion.turns_in_place();
        (1..=2 * pieces)
            .filter(move |half| middles || half % 2 == 0)
            .map(move |half| (half as f64 / (2 * pieces) as f64, half % 2 == 0))
    }
}

/// Into how many parts a share of a move is divided by the turn of the tool in the part.
pub(super) fn turns(motion: &Move, width: f64) -> usize {
    (motion.turn_deg() * width / TURN_DEG)
        .ceil()
        .clamp(1.0, 1e6) as usize
}

/// Share of the spacing below which a block that was not divided is straight in every respect.
const SHORT: f64 = 0.05;
