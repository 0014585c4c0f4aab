//! Checks of a written program, from its bytes.

use kinetostat_program::{
    Corrected, Knowledge, Move, Piece, Verification, WriteError, WriteOptions, irregular,
};
use nalgebra::UnitQuaternion;

use crate::path::broken;
use crate::path::kept_lines::{ReadProgram, kept_lines, lines};
use crate::path::of_program::RobotPath;

/// Seed of the places that are looked at: neither that of the division nor those of other checks.
const SEED: u64 = 11;

/// Turn of the tool that may lie between what is read and what was to be written, rad.
const TURN: f64 = 1e-5;

/// Turn between the ends of a piece that the digits of written directions may leave, rad.
const TURN_BETWEEN: f64 = 1e-4;

/// Checks a written program that was read again:
///
/// - its motions are the pieces accounted for, one after the other, at their places and with their orientation;
/// - between them the tool's axis goes as in the input, where the program states it alone;
/// - no place between them is farther from the input's path than the largest correction, the chords of arcs and the rounding;
/// - the speed along the part is the programmed one, or slower where it was held;
/// - lines without a motion or a target of one are there byte for byte, in their order; in FOLDs the names of points may have changed.
pub(crate) fn check(
    input: ReadProgram<'_>,
    output: ReadProgram<'_>,
    written: &Corrected,
    options: &WriteOptions,
) -> Result<Verification, WriteError> {
    let again = output.path;
    let mut found = Verification {
        lines: lines(&written.bytes).count(),
        moves: again.path.moves.len(),
        longest_line_bytes: lines(&written.bytes).map(<[u8]>::len).max().unwrap_or(0),
        feed_limited_pieces: written.pieces.iter().filter(|p| p.feed_limited).count(),
        ..Verification::default()
    };
    if again.path.moves.len() != written.pieces.len() {
        return Err(broken(
            0,
            0,
            format!(
                "it has {} motions, {} pieces were written",
                again.path.moves.len(),
                written.pieces.len()
            ),
        ));
    }
    for (index, piece) in written.pieces.iter().enumerate() {
        one(input, again, written, index, piece, options, &mut found)?;
    }
    kept_lines(input, output, written)?;
    Ok(found)
}

fn one(
    read: ReadProgram<'_>,
    again: &RobotPath,
    written: &Corrected,
    index: usize,
    piece: &Piece,
    options: &WriteOptions,
    found: &mut Verification,
) -> Result<(), WriteError> {
    let input = read.path;
    let motion = &input.path.moves[piece.move_index];
    let made = &again.path.moves[index];
    let fail = |what: String| Err(broken(motion.line, made.line, what));
    if motion.known == Knowledge::Nothing {
        return match made.known {
            Knowledge::Nothing => Ok(()),
            _ => fail("a motion without a pose has become one with a pose".to_owned()),
        };
    }
    let rounding = options.last_digit_mm(1.0);
    // NaN counts as a mismatch.
    let off = (made.end - piece.commanded_to).norm();
    if off.is_nan() || off > 1e-6 {
        return fail(format!(
            "it ends {off:.6} mm from where it was to be written"
        ));
    }
    let wanted = match written.orientations.get(index) {
        Some(wanted) => Some(*wanted),
        // Rotary axes of a machine go on as they were, or stand where they were written.
        None => turned_to(motion, written, index).or_else(|| motion.orientation(piece.share_to)),
    };
    let turned = wanted
        .zip(made.orientation(1.0))
        .map(|(a, b)| input.turned(&a, &b));
    if turned.is_some_and(|angle| angle.is_nan() || angle > TURN) {
        return fail("the tool stands otherwise than was to be written".to_owned());
    }
    let rotary = motion
        .tool_turn
        .as_ref()
        .is_some_and(|turn| turn.rotary.is_some());
    let between = (input.axis_alone || rotary) && motion.known == Knowledge::Whole;
    if between && !goes_as_stated(input, made, written, index, piece) {
        return fail("between its ends the tool stands otherwise than in the program".to_owned());
    }
    if let Some(circle) = &piece.circle {
        let off =
            [0.25, 0.5, 0.75].map(|part| (made.point(part) - circle.curve.point(part)).norm());
        // NaN counts as a mismatch.
        if !off.iter().all(|off| *off <= 1e-6) {
            return fail("it goes round otherwise than was to be written".to_owned());
        }
    }
    if motion.known != Knowledge::Whole || !motion.is_known_feed() {
        return Ok(());
    }
    let accounting = &written.accounting;
    let allowed = accounting.largest_correction_mm
        + options.chord_tolerance_mm * 1.2
        + options.tolerance_mm
        + options.corner_step_mm.unwrap_or(options.tolerance_mm)
        + 2.0 * rounding;
    for k in 0..2 {
        let part = irregular(SEED, index as u64, k);
        let share = piece.share_from + part * (piece.share_to - piece.share_from);
        let commanded = match piece.kept_arc {
            true => made.point(part),
            false => piece.commanded(motion, part),
        };
        let distance = (commanded - motion.point(share)).norm();
        if distance.is_nan() || distance > allowed {
            return fail(format!(
                "it is {distance:.4} mm from the path of the input, {allowed:.4} mm are allowed"
            ));
        }
        if distance > found.largest_distance_mm {
            found.largest_distance_mm = distance;
        }
    }
    speed(read, again, index, piece, found).map_or(Ok(()), fail)
}

/// Orientation at the end of a piece with corrected angles.
fn turned_to(motion: &Move, written: &Corrected, index: usize) -> Option<UnitQuaternion<f64>> {
    let angles = written
        .rotary_deg
        .get(index)
        .filter(|all| !all.is_empty())?;
    let rotary = motion.tool_turn.as_ref()?.rotary.as_ref()?;
    Some(rotary.axes.tool(angles))
}

/// True if the tool axis moves between the ends of a piece as in the input, apart from the correction at the ends.
fn goes_as_stated(
    input: &RobotPath,
    made: &Move,
    written: &Corrected,
    index: usize,
    piece: &Piece,
) -> bool {
    let motion = &input.path.moves[piece.move_index];
    let tilt = |index: usize| {
        let piece = written.pieces.get(index)?;
        let own = input.path.moves[piece.move_index].orientation(piece.share_to)?;
        let stated = written.orientations.get(index).copied();
        let to = stated.or_else(|| turned_to(&input.path.moves[piece.move_index], written, index));
        Some(input.turned(&to?, &own))
    };
    let before = index.checked_sub(1).and_then(tilt);
    let allowed = before.unwrap_or(0.0) + tilt(index).unwrap_or(0.0) + TURN_BETWEEN;
    [0.25, 0.5, 0.75].into_iter().all(|part| {
        let share = piece.share_from + part * (piece.share_to - piece.share_from);
        let both = made.orientation(part).zip(motion.orientation(share));
        // NaN counts as a mismatch.
        both.is_none_or(|(made, own)| input.turned(&made, &own) <= allowed)
    })
}

/// The speed along the part; what is wrong with it.
fn speed(
    input: ReadProgram<'_>,
    again: &RobotPath,
    index: usize,
    piece: &Piece,
    found: &mut Verification,
) -> Option<String> {
    let motion = &input.path.path.moves[piece.move_index];
    let made = &again.path.moves[index];
    let part_mm = motion.length_between_mm(piece.share_from, piece.share_to);
    let written_mm = match piece.kept_arc {
        true => made.length_mm(),
        false => piece.length_mm(motion),
    };
    let (wanted, is) = (motion.feed?.value, made.feed.map(|feed| feed.value));
    let Some(is) = is else {
        return Some("its speed is not known".to_owned());
    };
    // Rounding dominates in very short pieces.
    if piece.corner_step || part_mm < SHORT_MM || written_mm == 0.0 {
        return None;
    }
    let error = (is * part_mm / written_mm / wanted - 1.0).abs();
    if piece.feed_limited && is <= wanted * 1e6 {
        return None;
    }
    // NaN is refused below.
    if error > found.largest_speed_error {
        found.largest_speed_error = error;
    }
    // A modal speed is that of the input: its deviation along the part is in the result.
    let own = input.program.motions[input.path.motions[piece.move_index]]
        .site
        .speed
        .is_some();
    (error.is_nan() || own && error > SPEED)
        .then(|| format!("the speed along the part is {:.2} % off", 100.0 * error))
}

/// Pieces shorter than this have no speed that could be compared: digits of their ends decide, mm.
const SHORT_MM: f64 = 0.5;

/// Tolerated relative deviation of the speed along the part.
const SPEED: f64 = 2e-3;
