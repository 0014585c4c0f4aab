//! The geometry, feeds and further axes of a written program, against the input's path.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use crate::checking::{Verifier, fail};
use crate::error::WriteError;
use crate::number::{irregular, larger};
use crate::path::curve::{Curve, NO_LENGTH_MM};
use crate::path::moves::{ExtraMode, FeedMode, Knowledge, Move, MoveKind, Path};
use crate::path::tool_turn::{RotaryTurn, StatedBy};
use crate::writing::written::Piece;

/// Largest difference between a place as written and as read again, in mm: arithmetic only.
const SAME_PLACE_MM: f64 = 1e-6;

/// Largest relative error of the speed along the part.
const SPEED_TOLERANCE: f64 = 1e-3;

/// Directions of the tool as written and as read again differ by less, rad: their digits.
const SAME_DIRECTION: f64 = 1e-6;

/// Largest difference between two ends, rad: near a pole digits of directions turn the axes by more.
const SAME_WAY: f64 = 1e-4;

/// Largest difference between an angle as written and as read again, in deg: arithmetic only.
const SAME_ANGLE_DEG: f64 = 1e-7;

/// Larger corrections of an angle are no deflections, in deg.
const LARGEST_TURN_DEG: f64 = 10.0;

/// Seed of the places that this check looks at.
const SEED: u64 = 2;

impl Verifier<'_> {
    /// Motions as read again against the pieces that were written.
    pub(crate) fn check_moves(&mut self, output_path: &Path) -> Result<(), WriteError> {
        let count = output_path.moves.len();
        if count != self.pieces.len() {
            return Err(fail(
                0,
                0,
                format!(
                    "{count} motions are read, {} were written",
                    self.pieces.len()
                ),
            ));
        }
        let own = self.input_path.own_moves();
        let mut expected = (own.start, 0.0);
        for (index, (piece, read)) in self.pieces.iter().zip(&output_path.moves).enumerate() {
            let Some(motion) = self.input_path.moves.get(piece.move_index) else {
                return Err(fail(0, piece.output_line, "a piece of no move".to_owned()));
            };
            let broken = |what: String| Err(fail(motion.line, piece.output_line, what));
            if (piece.move_index, piece.share_from) != expected {
                return broken(
                    "the pieces are not in the order of the path, or one is missing".to_owned(),
                );
            }
            expected = if piece.share_to >= 1.0 {
                (piece.move_index + 1, 0.0)
            } else {
                (piece.move_index, piece.share_to)
            };
            let same_curve = match &piece.arc {
                _ if piece.kept_arc => is_same_arc(read, |share| motion.point(share)),
                Some(arc) => {
                    let curve = arc.between(&piece.commanded_from, &piece.commanded_to);
                    is_same_arc(read, |share| curve.point(share))
                }
                None => read.curve == Curve::Line,
            };
            if read.line != piece.output_line || read.kind != motion.kind || !same_curve {
                return broken("the motion read is another than the one written".to_owned());
            }
            let start = (read.start - piece.commanded_from).norm();
            let end = (read.end - piece.commanded_to).norm();
            // If an axis is not known yet, only its later places can be compared.
            if end > SAME_PLACE_MM || start > SAME_PLACE_MM && motion.known == Knowledge::Whole {
                return broken(format!(
                    "its place is read {:.7} mm away from where it was written",
                    start.max(end)
                ));
            }
            self.check_uncorrected(motion, piece, read)?;
            self.check_distance(motion, piece, read)?;
            self.check_speed(motion, piece, read)?;
            self.check_directions(index, motion, read)?;
            let turned = self.check_turned_axes(index, motion, read)?;
            check_extra_axes(motion, piece, read, &turned)?;
        }
        if expected != (own.end, 0.0) {
            return Err(fail(
                0,
                0,
                "the last moves of the input are missing".to_owned(),
            ));
        }
        Ok(())
    }

    /// If the position is not known, the axes that a block names go where the input has them: no correction is left
    /// in them. The others are off by what an earlier block left, which is at most the largest correction.
    fn check_uncorrected(
        &self,
        motion: &Move,
        piece: &Piece,
        read: &Move,
    ) -> Result<(), WriteError> {
        if motion.known != Knowledge::Nothing {
            return Ok(());
        }
        let words = match self.input.line(motion.line) {
            Some(line) => self.input.words(line),
            None => &[],
        };
        // An axis that is not named was perhaps rounded in coarser units.
        let rounding = [1.0, 25.4, motion.words.mm_per_unit]
            .map(|unit| unit * 10_f64.powi(-(self.writing.decimals_for(unit) as i32)))
            .into_iter()
            .fold(0.0, larger);
        for (axis, letter) in b"XYZ".iter().enumerate() {
            let named = words.iter().any(|word| word.letter == *letter);
            let allowed = match (motion.words.is_to_machine(), named) {
                (true, _) if motion.words.to_machine[axis] => SAME_PLACE_MM,
                (false, true) => rounding + SAME_PLACE_MM,
                _ => self.accounting.largest_correction_mm + rounding + SAME_PLACE_MM,
            };
            let off = (read.end[axis] - motion.end[axis]).abs();
            if off.is_nan() || off > allowed {
                return Err(fail(
                    motion.line,
                    piece.output_line,
                    format!(
                        "{} ends {off:.5} mm from where the input has it, {allowed:.5} mm are allowed where the \
                         place is not known",
                        char::from(*letter)
                    ),
                ));
            }
        }
        Ok(())
    }

    fn check_distance(
        &mut self,
        motion: &Move,
        piece: &Piece,
        read: &Move,
    ) -> Result<(), WriteError> {
        if motion.known != Knowledge::Whole {
            return Ok(());
        }
        let rounding_of = |motion: &Move| {
            let unit = motion.words.mm_per_unit;
            unit * 10_f64.powi(-(self.writing.decimals_for(unit) as i32))
        };
        // The piece begins where the move before ended, perhaps rounded in coarser units.
        let before = piece
            .move_index
            .checked_sub(1)
            .map_or(0.0, |before| rounding_of(&self.input_path.moves[before]));
        let rounding = rounding_of(motion).max(before);
        let mut allowed = self.accounting.largest_correction_mm + rounding + SAME_PLACE_MM;
        if motion.curve != Curve::Line {
            // A chord is compared with its arc at equal shares, which are not quite the nearest points.
            allowed += 2.0 * self.writing.chord_tolerance_mm;
        }
        if piece.arc.is_some() {
            // The centre is rounded too, and between its ends the arc leaves the curve within the tolerance of the path.
            allowed += rounding + self.writing.tolerance_mm;
            if self.writing.smallest_step_mm() > self.writing.tolerance_mm {
                allowed += self.writing.smallest_step_mm();
            }
        }
        let place = |k: u64| irregular(SEED, piece.output_line as u64, k);
        for part in [place(0), place(1), place(2), 1.0] {
            if motion.kind == MoveKind::Rapid && part < 1.0 {
                continue;
            }
            let share = piece.share_from + (piece.share_to - piece.share_from) * part;
            let turned = piece.arc.map_or(part, |arc| arc.turned(part));
            let commanded = read.point(turned);
            let distance = (commanded - motion.point(share)).norm();
            self.found.largest_distance_mm = larger(self.found.largest_distance_mm, distance);
            if distance > allowed {
                return Err(fail(
                    motion.line,
                    piece.output_line,
                    format!(
                        "it leaves the input's path by {distance:.5} mm, {allowed:.5} mm are allowed"
                    ),
                ));
            }
        }
        Ok(())
    }

    fn check_speed(&mut self, motion: &Move, piece: &Piece, read: &Move) -> Result<(), WriteError> {
        let Some(feed) = motion.feed.filter(|_| motion.kind == MoveKind::Feed) else {
            return Ok(());
        };
        if motion.turns_in_place() && motion.known == Knowledge::Whole {
            return self.check_time_of_turn(motion, piece, read);
        }
        let Some(written) = read.feed.filter(|written| written.mode == feed.mode) else {
            return Err(fail(
                motion.line,
                piece.output_line,
                "the feed is lost".to_owned(),
            ));
        };
        let length = match piece.kept_arc || piece.arc.is_some() {
            true => read.length_mm(),
            false => (piece.commanded_to - piece.commanded_from).norm(),
        };
        let part = motion.length_between_mm(piece.share_from, piece.share_to);
        let known = motion.known == Knowledge::Whole;
        let speed = match feed.mode {
            FeedMode::InverseTime if piece.corner_step && length > NO_LENGTH_MM => {
                written.value * length / motion.length_mm()
            }
            FeedMode::InverseTime if part > 0.0 => written.value * part / motion.length_mm(),
            FeedMode::PerMinute | FeedMode::PerRevolution
                if known && part > 0.0 && length > NO_LENGTH_MM =>
            {
                written.value * part / length
            }
            _ => written.value,
        };
        if piece.feed_limited {
            self.found.feed_limited_pieces += 1;
            let own = match feed.mode {
                FeedMode::InverseTime => written.value * length / motion.length_mm(),
                _ => written.value,
            };
            let most = self.writing.max_feed_factor * feed.value * (1.0 + SPEED_TOLERANCE);
            if own > most || speed > feed.value * (1.0 + SPEED_TOLERANCE) {
                return Err(fail(
                    motion.line,
                    piece.output_line,
                    "its feed is above the largest that is allowed".to_owned(),
                ));
            }
            return Ok(());
        }
        let error = (speed / feed.value - 1.0).abs();
        self.found.largest_speed_error = larger(self.found.largest_speed_error, error);
        if error > SPEED_TOLERANCE {
            return Err(fail(
                motion.line,
                piece.output_line,
                format!("its speed along the part is off by {:.3} %", error * 100.0),
            ));
        }
        Ok(())
    }
}

impl Verifier<'_> {
    /// A piece of a turn in place takes its share of the time.
    fn check_time_of_turn(
        &mut self,
        motion: &Move,
        piece: &Piece,
        read: &Move,
    ) -> Result<(), WriteError> {
        let broken = |what: &str| Err(fail(motion.line, piece.output_line, what.to_owned()));
        let (Some(feed), Some(written)) = (motion.feed, read.feed) else {
            return broken("the feed is lost");
        };
        let width = piece.share_to - piece.share_from;
        let stands = (piece.commanded_to - piece.commanded_from).norm() <= NO_LENGTH_MM;
        let error = match (written.mode, motion.turn_seconds()) {
            // F is in degrees per minute if only rotary axes move.
            (mode, Some(_)) if mode == feed.mode && mode != FeedMode::InverseTime => {
                if !stands || width < 1.0 {
                    return broken("X, Y and Z move beside a feed in degrees a minute");
                }
                (written.value / feed.value - 1.0).abs()
            }
            (FeedMode::InverseTime, Some(_)) if piece.corner_step => 0.0,
            (FeedMode::InverseTime, Some(seconds)) => {
                (60.0 / written.value / (seconds * width) - 1.0).abs()
            }
            _ => return broken("the feed of a turn in place counts otherwise"),
        };
        self.found.largest_speed_error = larger(self.found.largest_speed_error, error);
        match error <= SPEED_TOLERANCE {
            true => Ok(()),
            false => broken("the time of a turn in place is off"),
        }
    }
}

/// An arc read again goes where one with these points does.
fn is_same_arc(read: &Move, point: impl Fn(f64) -> Vector3<f64>) -> bool {
    read.curve != Curve::Line
        && (0..=8)
            .map(|k| f64::from(k) / 8.0)
            .all(|share| (read.point(share) - point(share)).norm() <= SAME_PLACE_MM)
}

impl Verifier<'_> {
    /// Checks tool directions (G43.5): at the end of a piece the tool has the written direction, and between its ends the one of the
    /// program.
    fn check_directions(&self, index: usize, motion: &Move, read: &Move) -> Result<(), WriteError> {
        let rotary = |motion: &Move| motion.tool_turn.as_ref()?.rotary.clone();
        let Some(own) = rotary(motion).filter(|own| own.stated == StatedBy::Direction) else {
            return Ok(());
        };
        let piece = &self.pieces[index];
        let lost = || {
            fail(
                motion.line,
                piece.output_line,
                "the direction of the tool is lost".to_owned(),
            )
        };
        let again = rotary(read).ok_or_else(lost)?;
        let axis = self.input_path.tool_axis;
        let at = |angles: &[f64]| own.axes.tool_direction_at(angles, &axis);
        let tilt = |index: usize| -> Option<f64> {
            let piece = self.pieces.get(index)?;
            let own = rotary(&self.input_path.moves[piece.move_index])?;
            let written = self.rotary_deg.get(index).filter(|list| !list.is_empty())?;
            Some((at(written) - at(&own.angles_deg(piece.share_to))).norm())
        };
        let written = self.rotary_deg.get(index).filter(|list| !list.is_empty());
        let wanted = written.map_or_else(|| at(&own.angles_deg(piece.share_to)), |list| at(list));
        let off = (at(&again.end_deg) - wanted).norm();
        if own.great_circle.is_some() {
            let stand = written.map_or_else(|| own.angles_deg(piece.share_to), Clone::clone);
            same_angles(motion, &own, &again.end_deg, &stand)?;
        }
        let before = index.checked_sub(1).and_then(tilt);
        let tilted = before.unwrap_or(0.0) + tilt(index).unwrap_or(0.0);
        let between = [0.25, 0.5, 0.75].map(|part| {
            let share = piece.share_from + part * (piece.share_to - piece.share_from);
            (at(&again.angles_deg(part)) - at(&own.angles_deg(share))).norm()
        });
        // Not a number is off, too.
        let goes = between.iter().all(|off| *off <= tilted + SAME_WAY);
        match off <= SAME_DIRECTION && (goes || motion.kind == MoveKind::Rapid) {
            true => Ok(()),
            false => Err(fail(
                motion.line,
                piece.output_line,
                format!(
                    "the tool points {off:.2e} rad from where it was written, or leaves its way between"
                ),
            )),
        }
    }

    /// Checks that corrected rotary axes have their written angles, near those of the program. Returns their letters; none
    /// if the words of the program stay.
    fn check_turned_axes(
        &self,
        index: usize,
        motion: &Move,
        read: &Move,
    ) -> Result<Vec<char>, WriteError> {
        let rotary = |motion: &Move| motion.tool_turn.as_ref()?.rotary.clone();
        if rotary(motion).is_some_and(|rotary| rotary.stated == StatedBy::Direction) {
            return Ok(Vec::new());
        }
        let (Some(written), Some(own)) = (self.rotary_deg.get(index), rotary(motion)) else {
            return Ok(Vec::new());
        };
        let Some(read_again) = rotary(read) else {
            return Err(fail(
                motion.line,
                read.line,
                "the angles of the rotary axes are lost".to_owned(),
            ));
        };
        let piece = &self.pieces[index];
        let programmed = own.angles_deg(piece.share_to);
        let letters: Vec<char> = own.axes.axes.iter().map(|axis| axis.letter).collect();
        for (axis, letter) in letters.iter().enumerate() {
            let angle = |list: &[f64]| list.get(axis).copied().unwrap_or(f64::NAN);
            let off = (angle(&read_again.end_deg) - angle(written)).abs();
            let corrected = (angle(written) - angle(&programmed)).abs();
            if !(off <= SAME_ANGLE_DEG && corrected <= LARGEST_TURN_DEG) {
                return Err(fail(
                    motion.line,
                    piece.output_line,
                    format!(
                        "axis {letter} is read {off:.6} deg from where it was written, {corrected:.3} deg from the program"
                    ),
                ));
            }
        }
        Ok(letters)
    }
}

/// Largest angle of an axis on a great circle from where it was written, deg, beside what the digits of directions leave.
const SAME_ON_CIRCLE_DEG: f64 = 0.1;

/// Error of a direction by the digits that it is written with, rad.
const DIGITS_RAD: f64 = 4e-8;

/// Distance from the pole, rad, below which directions do not determine one axis.
const AT_POLE_RAD: f64 = 1e-6;

/// Directions on a great circle lead the axes to the angles for which the pieces were corrected, not to others of the same direction.
fn same_angles(
    motion: &Move,
    own: &RotaryTurn,
    read: &[f64],
    written: &[f64],
) -> Result<(), WriteError> {
    let from_pole = own.axes.from_pole_rad(written).unwrap_or(FRAC_PI_2);
    if from_pole < AT_POLE_RAD {
        return Ok(());
    }
    let allowed = SAME_ON_CIRCLE_DEG + (DIGITS_RAD / from_pole).to_degrees();
    let turned = read.iter().zip(written).map(|(a, b)| (a - b).abs());
    let turned = turned.fold(0.0, larger);
    match turned <= allowed {
        true => Ok(()),
        false => Err(WriteError::Motion {
            line: motion.line,
            reason: format!(
                "directions of the tool pass the pole of its rotary axes (the tool along an axis), and with the correction an axis would come to an angle {turned:.2} deg from where the block has it, {:.4} deg from the pole",
                from_pole.to_degrees()
            ),
            remedy: "let the CAM system keep the tool farther from the pole here, or write angles of the rotary axes; or correct the position alone".to_owned(),
        }),
    }
}

/// The other axes are where their share of the block wants them, but for those whose angles are corrected.
fn check_extra_axes(
    motion: &Move,
    piece: &Piece,
    read: &Move,
    turned: &[char],
) -> Result<(), WriteError> {
    let broken = |letter: char| {
        Err(fail(
            motion.line,
            piece.output_line,
            format!("axis {letter} does not reach its place"),
        ))
    };
    let extras = motion.extra.iter();
    for extra in extras.filter(|extra| !turned.contains(&extra.letter)) {
        let word = read
            .extra
            .iter()
            .find(|word| word.letter == extra.letter)
            .map(|word| word.word);
        let share = piece.share_to - piece.share_from;
        let last = piece.share_to >= 1.0;
        let tolerance = 1.1e-5;
        let right = match (extra.mode, extra.start) {
            (ExtraMode::Incremental, _) => {
                (word.unwrap_or(0.0) - extra.word * share).abs() <= tolerance
            }
            (ExtraMode::Absolute, Some(start)) => {
                let wanted = start + (extra.word - start) * piece.share_to;
                piece.corner_step || word.is_some_and(|word| (word - wanted).abs() <= tolerance)
            }
            _ => word == Some(extra.word) && last && share == 1.0,
        };
        if !right {
            return broken(extra.letter);
        }
    }
    match read
        .extra
        .iter()
        .filter(|word| !turned.contains(&word.letter))
        .find(|word| !motion.extra.iter().any(|extra| extra.letter == word.letter))
    {
        Some(word) => broken(word.letter),
        None => Ok(()),
    }
}
