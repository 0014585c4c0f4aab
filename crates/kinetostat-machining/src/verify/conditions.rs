//! Feed and spindle of another program at the cuts that it shares with the original.

use std::fmt::Write as _;

use kinetostat_program::{FeedMode, Move, Path, SpeedMode, Spindle, SpindleRotation};

use crate::verify::along::Followed;
use crate::verify::matched::{Condition, OtherCondition};

/// Feeds and speeds that differ by less, as a share, are the same.
const SAME: f64 = 0.01;

/// Ends are found within this, mm, by which the speed along a short cut is less certain.
const ENDS_MM: f64 = 0.005;

/// Maximum number of listed differences.
const MOST: usize = 100;

/// A move of the other program with what of the original it goes along.
pub(crate) struct Cut<'a> {
    /// Of the other program and of the original, by their indices.
    pub(crate) moves: [usize; 2],
    own: &'a Move,
    original: &'a Move,
    own_mm: f64,
    original_mm: f64,
    /// Time in which the original goes that far, min.
    original_min: Option<f64>,
}

/// Cuts of the other program with another feed or another speed of the spindle than the original; consecutive moves that differ in
/// the same way are one. `most_feed_factor` is the maximum feed of a compensated program over the programmed one that keeps the
/// speed along the part: held to that it is slower there.
pub(crate) fn conditions(
    original: &Path,
    other: &Path,
    cuts: &[Cut<'_>],
    most_feed_factor: f64,
) -> Vec<OtherCondition> {
    let mut found: Vec<OtherCondition> = Vec::new();
    let mut last_move = None;
    for cut in cuts {
        let spindles = [
            original.spindle_on(cut.original.line),
            other.spindle_on(cut.own.line),
        ];
        let differences = [
            other_feed(cut, spindles, most_feed_factor),
            other_spindle(spindles),
        ];
        for (condition, was, is) in differences.into_iter().flatten() {
            let known = found
                .iter()
                .rposition(|known| known.condition == condition)
                .filter(|index| {
                    let last = found[*index].lines[1];
                    last == cut.own.line || Some(last) == last_move
                });
            if let Some(index) = known {
                found[index].lines[1] = cut.own.line;
            } else if found.len() < MOST {
                found.push(OtherCondition {
                    condition,
                    lines: [cut.own.line; 2],
                    line_of_original: cut.original.line,
                    of_original: was,
                    of_program: is,
                });
            }
        }
        last_move = Some(cut.own.line);
    }
    found
}

/// The moves of the other program that cut what the original cuts.
pub(crate) fn cuts<'a>(original: &'a Path, other: &'a Path, pieces: &[Followed]) -> Vec<Cut<'a>> {
    let cuts = |own: &&Followed| own.piece.corrected && own.piece.turn.is_none();
    let cutting: Vec<&Followed> = pieces.iter().filter(cuts).collect();
    let of_one_move = |a: &&Followed, b: &&Followed| a.other_end.0 == b.other_end.0;
    cutting
        .chunk_by(of_one_move)
        .map(|parts| {
            let own = &other.moves[parts[0].other_end.0];
            let length = |part: &&Followed| {
                let piece = &part.piece;
                original.moves[piece.move_index].length_between_mm(piece.share_from, piece.share_to)
            };
            let own_length =
                |part: &&Followed| own.length_between_mm(part.other_from, part.other_end.1);
            let minutes = |part: &&Followed| {
                let motion = &original.moves[part.piece.move_index];
                let speed = speed(motion, original.spindle_on(motion.line));
                speed.map(|speed| length(part) / speed)
            };
            // A move belongs to its longest part, not to one that it only touches at a corner.
            let longest = parts
                .iter()
                .max_by(|a, b| length(a).total_cmp(&length(b)))
                .unwrap_or(&parts[0]);
            Cut {
                moves: [parts[0].other_end.0, longest.piece.move_index],
                own,
                original: &original.moves[longest.piece.move_index],
                own_mm: parts.iter().map(own_length).sum(),
                original_mm: parts.iter().map(length).sum(),
                original_min: parts.iter().map(minutes).sum(),
            }
        })
        .collect()
}

/// Speed of the tool, mm/min; without a speed of the spindle the way in one turn of it.
fn speed(motion: &Move, spindle: Spindle) -> Option<f64> {
    let feed = motion.feed?;
    match (feed.mode, spindle.rpm()) {
        (FeedMode::PerRevolution, None) => Some(feed.value),
        (_, rpm) => motion.feed_mm_per_minute(rpm.unwrap_or(f64::NAN)),
    }
}

type Difference = Option<(Condition, String, String)>;

/// The feed is neither that which is written in the original nor such that the part is cut as fast.
fn other_feed(cut: &Cut<'_>, spindles: [Spindle; 2], most_feed_factor: f64) -> Difference {
    if !(cut.original_mm > ENDS_MM && cut.own_mm > 0.0) {
        return None;
    }
    let own = speed(cut.own, spindles[1]);
    let said = |motion: &Move| {
        let Some(feed) = motion.feed else {
            return "no feed".to_owned();
        };
        let unit = match feed.mode {
            FeedMode::PerMinute => "mm/min",
            FeedMode::InverseTime => "1/min",
            FeedMode::PerRevolution => "mm a turn",
        };
        format!("{} {unit}", rounded(feed.value))
    };
    let difference = (Condition::Feed, said(cut.original), said(cut.own));
    let (own, minutes) = match (own, cut.original_min) {
        (None, None) => return None,
        (Some(own), Some(minutes)) => (own, minutes),
        _ => return Some(difference),
    };
    let modes = [cut.original, cut.own].map(|motion| motion.feed.map(|feed| feed.mode));
    let is_of_turn = |mode| mode == Some(FeedMode::PerRevolution);
    let wanted = cut.original_mm / minutes;
    let as_written = own / wanted;
    let along_part = as_written * cut.original_mm / cut.own_mm;
    let slack = SAME + 2.0 * ENDS_MM / cut.original_mm;
    let same = |ratio: f64| (ratio - 1.0).abs() <= slack;
    // Held to the largest feed that a compensated program states.
    let is_held = as_written >= most_feed_factor * (1.0 - SAME) && along_part <= 1.0 + slack;
    let keeps = same(as_written) || same(along_part) || is_held;
    let same_kind = is_of_turn(modes[0]) == is_of_turn(modes[1]);
    if keeps && same_kind {
        return None;
    }
    let (condition, of_original, of_program) = difference;
    if of_original != of_program {
        return Some((condition, of_original, of_program));
    }
    // Equal numbers for ways of different length are shown with these lengths.
    let along = |said: String, mm: f64| format!("{said} along {} mm", rounded(mm));
    Some((
        condition,
        along(of_original, cut.original_mm),
        along(of_program, cut.own_mm),
    ))
}

fn other_spindle([of_original, own]: [Spindle; 2]) -> Difference {
    let modes = [of_original, own].map(|spindle| matches!(spindle.mode, SpeedMode::Constant));
    let stands = |spindle: Spindle| {
        spindle.rotation == SpindleRotation::Stopped || spindle.speed == Some(0.0)
    };
    let same_speed = match (of_original.speed, own.speed) {
        _ if stands(of_original) && stands(own) => true,
        (Some(a), Some(b)) => (a - b).abs() <= SAME * a.abs(),
        (None, None) => true,
        _ => false,
    };
    let same = of_original.rotation == own.rotation && modes[0] == modes[1] && same_speed;
    let said = |spindle: Spindle| {
        let mut said = match spindle.rotation {
            SpindleRotation::Clockwise => "M3".to_owned(),
            SpindleRotation::CounterClockwise => "M4".to_owned(),
            SpindleRotation::Stopped => return "a spindle that stands still".to_owned(),
        };
        if let Some(speed) = spindle.speed {
            let unit = match spindle.mode {
                SpeedMode::Constant => "rpm",
                SpeedMode::ConstantSurface { .. } => "m/min",
            };
            let _ = write!(said, " at {} {unit}", rounded(speed));
        }
        said
    };
    let turns_otherwise =
        !stands(of_original) && (stands(own) || of_original.rotation != own.rotation);
    let condition = match turns_otherwise {
        true => Condition::Rotation,
        false => Condition::Spindle,
    };
    (!same).then(|| (condition, said(of_original), said(own)))
}

/// Number as a program states it.
fn rounded(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
