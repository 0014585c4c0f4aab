//! Another program of the same part, solved: how far is the tool off where that sends it?
//!
//! The other program may be compensated by whatever means, or not at all; nothing is taken from how it was written. To solve it
//! two things must be known at each of its places: which place of the original it belongs to (where the tool should be), and with
//! it the load. The compensation of the original by the model is the guide for that: a path that comes as near to a compensated
//! program as two compensations differ, and that steps at corners where a compensated program steps. Only the correspondence
//! is taken from it: positions and orientations are those that the other program commands, and the machine is solved there.
//!
//! Ends of the other program's moves are given to the guide in their order ([`kinetostat_program::in_order`]), their moves are
//! divided where the original goes on to another move, each place is taken to its foot on the compensated path itself, by corrections
//! that are solved for it, and the pieces are solved as those of any written program. Inside a move of the original the error is so the
//! distance from the compensated path: along that, where an error moves no material, there is none but at ends.

mod along;
mod conditions;
mod exact;
mod follow;
mod matched;
mod on_guide;
mod places;
mod rapids;
mod stretches;

use kinetostat::number::{larger, smaller};
use kinetostat_program::{
    Accounting, Arcs, Corrected, CorrectionField, Move, MoveKind, Path, Piece, Unwatched,
    WriteError,
};
use nalgebra::UnitQuaternion;

use crate::load::law::CornerLoad;
use crate::run::conclude::{Run, conclude};
use crate::run::other_load::{by_the_other_reading, force_band};
use crate::run::places::places;
use crate::run::points::solve;
use crate::run::preparation::Preparation;
use crate::run::sites::of_written::sites_of_written;
use crate::run::summary::Checked;
use crate::run::way_out::with_way_out;
use crate::task::{RunError, Task};
use crate::verify::along::Followed;
use crate::verify::conditions::{conditions, cuts};
use crate::verify::exact::exact;
use crate::verify::follow::follow;
use crate::warning::WarningCode;
use crate::watch::Watch;

pub use matched::{Condition, ExtraCut, Matched, OtherCondition, RapidElsewhere, Turned, Uncut};

/// A program that was verified.
#[derive(Clone, Debug)]
pub struct Verified {
    /// Run along the program: errors before are those of the original as it is, errors after those of the program. Lines
    /// are those of the original, output lines those of the program.
    pub run: Run,
    /// Match with the original.
    pub matched: Matched,
}

/// The machine along another program of the same part: `task` is that of the original, `other` where the other program goes, in
/// the same part frame, and `bytes` what it was read from.
///
/// ```no_run
/// # fn with(task: &kinetostat_machining::Task<'_>, other: &kinetostat_program::Path) -> Result<(), kinetostat_machining::RunError> {
/// let verified = kinetostat_machining::verify_program(task, other, b"", &kinetostat_machining::Unwatched)?;
/// let off_mm = verified.run.result.summary.max_position_error_after_mm;
/// # let _ = off_mm; Ok(())
/// # }
/// ```
///
/// # Errors
/// [`RunError::Elsewhere`] where it does not go where the original goes; else as [`crate::compensate_program`].
pub fn verify_program(
    task: &Task<'_>,
    other: &Path,
    bytes: &[u8],
    watch: &dyn Watch,
) -> Result<Verified, RunError> {
    verified(task, other, bytes, watch).map_err(|error| with_way_out(task, error))
}

fn verified(
    task: &Task<'_>,
    other: &Path,
    bytes: &[u8],
    watch: &dyn Watch,
) -> Result<Verified, RunError> {
    let prepared = Preparation::of_correction(task, None, watch)?;
    let field = prepared.field(task);
    let guide = guide(task, &field, watch)?;
    watch.stage("places of the original", 0);
    let (pieces, mut matched) = follow(task.path(), &guide, other)?;
    // The guide is as large as the program, and the points that are solved now are larger.
    drop(guide);
    let pieces = exact(task.path(), &field, pieces);
    let most_feed_factor = task.writing.max_feed_factor;
    let both = cuts(task.path(), other, &pieces);
    matched.conditions = conditions(task.path(), other, &both, most_feed_factor);
    matched.cuts = both.iter().map(|cut| cut.moves).collect();
    matched.turned = turned_most(task.path(), other, &pieces);
    let backward_mm = task.writing.backward_step_mm;
    let written = as_written(task.path(), other, bytes, pieces, backward_mm);
    let (load, how) = (&prepared.load.acting, prepared.solving(true));
    let sites = || sites_of_written(task, load, &written);
    // A place where the program is worse than the original is a finding here.
    let (mut points, _worse) = solve(task, sites(), how, watch)?;
    let checked = Checked {
        if_turns_mm: by_the_other_reading(task, CornerLoad::Turns, sites, watch)?,
        if_follows_mm: by_the_other_reading(task, CornerLoad::FollowsFeed, sites, watch)?,
        force_band: force_band(task, &mut points, sites, watch)?,
        places: places(task, &points, sites, how),
        ramps: prepared.load.findings.clone(),
        ..Checked::default()
    };
    let mut run = conclude(task, load, points, Some(written), &checked);
    // A program without corrections is one that leaves something to correct, unless the original does not.
    if run.result.summary.max_position_error_before_mm > task.writing.tolerance_mm {
        let warnings = &mut run.result.warnings;
        warnings.retain(|warning| warning.code != WarningCode::SmallCorrection);
    }
    Ok(Verified { run, matched })
}

/// Maximum distance of the guide from the compensated path, mm.
const GUIDE_MM: f64 = 1e-3;

/// The original, compensated by the model in straight pieces.
fn guide(
    task: &Task<'_>,
    field: &dyn CorrectionField,
    watch: &dyn Watch,
) -> Result<Corrected, RunError> {
    let mut own = task.writing.clone();
    own.header = None;
    // The correspondence is to be no coarser than what is verified by it.
    let mut fine = own.clone();
    fine.tolerance_mm = smaller(fine.tolerance_mm, GUIDE_MM);
    fine.chord_tolerance_mm = smaller(fine.chord_tolerance_mm, GUIDE_MM);
    let mut in_lines = fine.clone();
    in_lines.arcs = Arcs::Lines;
    watch.stage("corrections", 0);
    // In some languages the tool turns on a circle as it could not in straight motions, and the other way round. Runs of a statement
    // that is shared have one correction within the tolerance of the program, and not within a finer one.
    for writing in [&in_lines, &fine] {
        match task.program.write(field, writing, &Unwatched) {
            Err(WriteError::Motion { .. }) => {}
            done => return Ok(done?),
        }
    }
    Ok(task.program.write(field, &own, &Unwatched)?)
}

/// The other program as one that was written from the original; steps that go backwards by more than `backward_mm` are counted.
fn as_written(
    original: &Path,
    other: &Path,
    bytes: &[u8],
    followed: Vec<Followed>,
    backward_mm: f64,
) -> Corrected {
    let states = |path: &Path| path.moves.iter().any(|motion| motion.tool_turn.is_some());
    let turns = states(original) && states(other);
    let (mut orientations, mut rotary_deg) = (Vec::new(), Vec::new());
    if turns {
        for Followed {
            other_end, piece, ..
        } in &followed
        {
            let (index, share) = *other_end;
            let turn = other.moves[index].tool_turn.as_ref();
            // A move that does not state how the tool stands leaves it to what the original says there.
            let of_original = || original.moves[piece.move_index].orientation(piece.share_to);
            let stands = turn.map(|turn| turn.at(share)).or_else(of_original);
            orientations.push(stands.unwrap_or_else(UnitQuaternion::identity));
            let rotary = turn.and_then(|turn| turn.rotary.as_ref());
            rotary_deg.push(rotary.map_or_else(Vec::new, |rotary| rotary.angles_deg(share)));
        }
    }
    let feed = other.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let mut accounting = Accounting {
        blocks_out: feed.count(),
        bytes_out: bytes.len(),
        pieces: followed.len(),
        ..Accounting::default()
    };
    let pieces: Vec<Piece> = followed.into_iter().map(|f| f.piece).collect();
    note_steps(&mut accounting, original, &pieces, backward_mm);
    Corrected {
        bytes: bytes.to_vec(),
        pieces,
        beside: Vec::new(),
        orientations,
        rotary_deg,
        accounting,
        writer: None,
    }
}

/// Steps at corners and where a rapid ends, and how far they go against the direction of motion.
fn note_steps(accounting: &mut Accounting, original: &Path, pieces: &[Piece], backward_mm: f64) {
    let place = |piece: &Piece| piece.turn.map(|turn| (piece.move_index, turn.to_share));
    for step in pieces.chunk_by(|a, b| place(a) == place(b)) {
        let (first, last) = (&step[0], &step[step.len() - 1]);
        let Some(turn) = first.turn else { continue };
        let way = last.commanded_to - first.commanded_from;
        let a = &mut *accounting;
        let is_entry = turn.is_entry(original);
        let (count, longest) = match is_entry {
            true => (&mut a.entry_steps, &mut a.largest_entry_step_mm),
            false => (&mut a.corner_steps, &mut a.largest_corner_step_mm),
        };
        *count += 1;
        *longest = larger(*longest, way.norm());
        let before = original.moves[turn.from_move].tangent(turn.from_share);
        let directions = original.moves[first.move_index].tangent(turn.to_share);
        let directions = directions.into_iter().chain(before.filter(|_| !is_entry));
        let backward = directions.fold(0.0, |most, along| larger(most, -way.dot(&along)));
        a.backward_steps += usize::from(backward > backward_mm);
        a.largest_backward_mm = larger(a.largest_backward_mm, backward);
    }
}

/// Share of a turning move within which a place on it is known.
const PLACED: f64 = 0.1;

/// Largest difference of the commanded orientation from that of the original at its place: the way from one move to the next is not
/// evaluated if both programs turn the tool.
fn turned_most(original: &Path, other: &Path, pieces: &[Followed]) -> Option<Turned> {
    let of_piece = |own: &Followed| {
        let (index, share) = own.other_end;
        let motion = &other.moves[index];
        let of_original = &original.moves[own.piece.move_index];
        let cuts = own.piece.corrected && own.piece.turn.is_none() && motion.is_known_feed();
        let turn = motion.tool_turn.as_ref().filter(|_| cuts)?;
        let wanted = of_original.orientation(own.piece.share_to)?;
        let slack = PLACED * (turn_of(of_original)? + turn_of(motion)?);
        let angle = turn.at(share).angle_to(&wanted) - slack;
        Some(Turned {
            line: motion.line,
            line_of_original: of_original.line,
            angle_deg: angle.max(0.0).to_degrees(),
        })
    };
    let all = pieces.iter().filter_map(of_piece);
    all.max_by(|a, b| a.angle_deg.total_cmp(&b.angle_deg))
}

/// Rotation of the tool in a move, rad.
fn turn_of(motion: &Move) -> Option<f64> {
    let at = |share: f64| -> Option<UnitQuaternion<f64>> { motion.orientation(share) };
    Some(at(0.0)?.angle_to(&at(1.0)?))
}
