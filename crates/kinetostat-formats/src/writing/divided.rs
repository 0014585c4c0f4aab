//! A motion with its pieces: further statements before it with their shares of the external axes, and its own end.

use nalgebra::UnitQuaternion;

use crate::error::WriteError;
use crate::model::external::AxisWay;
use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::{PoseText, SpeedSite};
use crate::writing::ends::{Writer, span_of, text_of};
use crate::writing::piece::{NO_END, NO_VIA, Piece, Reason, check_pieces};
use crate::writing::syntax::{PieceLiterals, Wanted};

/// Orientations nearer than this are the same: the text of the orientation stays.
pub(crate) const SAME_RAD: f64 = 1e-9;

impl Writer<'_> {
    /// Writes a motion with its pieces; without pieces it stays.
    pub(super) fn write_motion(
        &mut self,
        motion: &Motion,
        with_axes: &[(&Piece, &AxesOfPiece)],
    ) -> Result<(), Reason> {
        let Some(((last, last_axes), before)) = with_axes.split_last() else {
            self.write_end(motion, &motion.site.target, None)?;
            return match &motion.site.via {
                Some((_, site)) => self.write_end(motion, site, None),
                None => Ok(()),
            };
        };
        let end = motion.target.pose().ok_or(NO_END)?;
        if !motion.has_known_way() {
            return Err(NO_VIA);
        }
        let pieces: Vec<&Piece> = with_axes.iter().map(|(piece, _)| *piece).collect();
        check_pieces(&pieces)?;
        let states_none = |text: &PoseText| text.convention == OrientationText::Unstated;
        let turns = |to: UnitQuaternion<f64>| to.angle_to(&end.orientation) > SAME_RAD;
        if !self.program.language.keeps_direction()
            && text_of(self.program, &motion.site.target).is_some_and(states_none)
            && pieces
                .iter()
                .any(|piece| piece.orientation.is_some_and(turns))
        {
            return Err((
                "the end states no orientation that could be corrected",
                "write its angles, or correct its place alone",
            ));
        }
        let is_circle = matches!(
            motion.kind,
            MotionKind::Circular { .. } | MotionKind::Arc { .. }
        );
        let divided = !before.is_empty() && !self.syntax.writes_circles();
        let becomes_straight = is_circle && (divided || last.via_mm.is_none());
        if let (true, false, Some(via)) = (is_circle, becomes_straight, last.via_mm) {
            let (_, site) = motion.site.via.as_ref().ok_or(NO_END)?;
            let wanted = Wanted {
                position_mm: via,
                orientation: last.via_orientation.filter(|_| !before.is_empty()),
                external: &last_axes.halfway,
            };
            self.write_end(motion, site, Some(wanted))?;
        }
        let wanted = Wanted {
            position_mm: last.position_mm,
            orientation: last
                .orientation
                .filter(|to| to.angle_to(&end.orientation) > SAME_RAD),
            external: &last_axes.end,
        };
        self.write_end(motion, &motion.site.target, Some(wanted))?;
        (self.syntax).moved(self.program, motion, &mut self.edits[motion.file]);
        // A modal speed is stated by each piece, and the earlier speed is restored after the last one.
        let restored = match pieces.iter().any(|piece| piece.speed_factor != 1.0) {
            true => self.syntax.restored_speed(self.program, motion),
            false => None,
        };
        let stated = match &restored {
            Some(_) => Stated::Always,
            None => Stated::IfChanged,
        };
        let own_speed = speed_of(motion, last, stated)?;
        if let Some((at, text)) = restored {
            self.edits[motion.file].replace(at..at, text);
        }
        let stays_circle = is_circle && !becomes_straight;
        // A circle as read has one orientation, or it turns evenly already: what turns the tool is the correction.
        let is_turned = stays_circle && pieces.iter().any(|p| p.orientation.is_some_and(turns));
        let mode = (motion.site.turns_otherwise.filter(|_| is_turned))
            .and_then(|otherwise| otherwise.evenly);
        if before.is_empty() && !becomes_straight && mode.is_none() {
            self.state_speed(motion, own_speed);
            return Ok(());
        }
        if motion.kind == MotionKind::Joint {
            return Err((
                "a joint motion cannot be divided: the tool does not go straight",
                "give it one piece, at its end",
            ));
        }
        if let Some(reason) = motion.site.indivisible {
            return Err((
                reason,
                "write it so that several motions can take its place: with a speed instead of a time, what it starts at a motion of its own, its IF over several lines",
            ));
        }
        if becomes_straight {
            let edits = &mut self.edits[motion.file];
            self.syntax.straighten(self.program, motion, edits);
        }
        let mut inserted = match mode {
            Some(statement) => self.on_own_line(motion, statement.into()),
            None => Vec::new(),
        };
        for (piece, axes) in before {
            let speed = speed_of(motion, piece, stated)?.map(|(_, text)| text);
            inserted.extend(self.inserted(motion, piece, axes, speed.as_deref())?);
        }
        self.edits[motion.file].replace(motion.span.start..motion.span.start, inserted);
        self.state_speed(motion, own_speed);
        Ok(())
    }

    /// The statement of a piece before the end of a motion, with what parts it from that motion.
    fn inserted(
        &mut self,
        motion: &Motion,
        piece: &Piece,
        axes: &AxesOfPiece,
        speed: Option<&[u8]>,
    ) -> Result<Vec<u8>, Reason> {
        let end = motion.target.pose().ok_or(NO_END)?;
        let wanted = Wanted {
            position_mm: piece.position_mm,
            orientation: Some(piece.orientation.unwrap_or(end.orientation)),
            external: &axes.end,
        };
        let mut literals = PieceLiterals {
            end: self.literal_near(motion, &motion.site.target, &wanted)?,
            via: None,
        };
        let circle = (&motion.kind, &motion.site.via, piece.via_mm);
        if let (MotionKind::Circular { via }, Some((_, site)), Some(via_mm)) = circle
            && self.syntax.writes_circles()
        {
            let written = via.pose().map(|via| via.orientation);
            let wanted = Wanted {
                position_mm: via_mm,
                orientation: piece.via_orientation.or(written),
                external: &axes.halfway,
            };
            literals.via = Some((span_of(site), self.literal_near(motion, site, &wanted)?));
        }
        let statement = self.syntax.piece(self.program, motion, &literals, speed);
        Ok(self.on_own_line(motion, statement.ok_or(NO_END)?))
    }

    /// A statement before a motion, with what parts the two.
    fn on_own_line(&self, motion: &Motion, mut statement: Vec<u8>) -> Vec<u8> {
        let file = &self.program.files[motion.file];
        statement.extend_from_slice(file.line_ending());
        statement.extend_from_slice(file.indentation(motion.span.start));
        statement
    }
}

/// When the speed of a piece is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stated {
    IfChanged,
    Always,
}

/// The speed of a piece where it is written.
fn speed_of<'m>(
    motion: &'m Motion,
    piece: &Piece,
    stated: Stated,
) -> Result<Option<(&'m SpeedSite, Vec<u8>)>, Reason> {
    if piece.speed_factor == 1.0 && stated == Stated::IfChanged {
        return Ok(None);
    }
    let (Some(site), Some(speed)) = (&motion.site.speed, motion.speed.mm_per_s) else {
        return Err((
            "its speed cannot be changed: it is not known from the text",
            "state the speed as a number, or keep it",
        ));
    };
    // A tenth of a um/s, whatever the unit.
    let decimals = match site.unit_mm_per_s > 1.0 {
        true => 7,
        false => 4,
    };
    let number = speed * piece.speed_factor / site.unit_mm_per_s;
    let number = format!("{number:.decimals$}");
    let number = number.trim_end_matches('0').trim_end_matches('.');
    let text = [&site.before, number, &site.after].concat();
    Ok(Some((site, text.into_bytes())))
}

/// Positions of the external axes at a piece's end, by their order; unmoved axes are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct AxesOfPiece {
    /// Positions at the end of the piece.
    pub end: Vec<Option<f64>>,
    /// Halfway between its ends.
    pub halfway: Vec<Option<f64>>,
}

/// The external axes of the pieces of a motion; why they cannot be shared out.
pub(crate) fn shared_axes(
    program: &RobotProgram,
    motion: &Motion,
    ways: &[AxisWay],
    text: Option<&PoseText>,
    pieces: &[&Piece],
) -> Result<Vec<AxesOfPiece>, WriteError> {
    let mut axes = vec![AxesOfPiece::default(); pieces.len()];
    if pieces.len() < 2 || ways.is_empty() {
        return Ok(axes);
    }
    let refused = |way: &AxisWay, reason: &str, remedy: &str| WriteError::Motion {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason: format!(
            "{} {reason}",
            program.language.name_of_external_axis(way.axis)
        ),
        remedy: remedy.to_owned(),
    };
    let shares = shares_of(program, motion, pieces);
    for way in ways {
        let is_written = |text: &PoseText| text.external.get(way.axis).is_some_and(Option::is_some);
        if !text.is_some_and(is_written) {
            return Err(refused(
                way,
                "moves with it, and would make all of its way in the first of the pieces into which it is divided",
                "move external axes where the tool is in air, with a joint motion or one at rapid speed, or write the motion in short steps of both",
            ));
        }
        let Some(start) = way.start else {
            return Err(refused(
                way,
                "may move with it, and where that axis is as the motion begins is not known from the text: its way cannot be shared out over the pieces into which the motion is divided",
                "state the axis in the motion before, too",
            ));
        };
        let Some(shares) = &shares else {
            return Err(refused(
                way,
                "moves with it, and how much of the way each of its pieces is, is not known",
                "state the share of every piece",
            ));
        };
        let mut before = 0.0;
        for (own, share) in axes.iter_mut().zip(shares) {
            let put = |list: &mut Vec<Option<f64>>, share: f64| {
                list.resize(list.len().max(way.axis + 1), None);
                list[way.axis] = Some(way.at(start, share));
            };
            put(&mut own.end, *share);
            put(&mut own.halfway, f64::midpoint(before, *share));
            before = *share;
        }
        // The last piece ends as the text says.
        if let Some(last) = axes.last_mut() {
            last.end.clear();
        }
    }
    Ok(axes)
}

/// Fraction of the path covered at the end of each piece; `None` if unknown.
fn shares_of(program: &RobotProgram, motion: &Motion, pieces: &[&Piece]) -> Option<Vec<f64>> {
    let stated: Option<Vec<f64>> = pieces.iter().map(|piece| piece.share).collect();
    if let Some(stated) = stated {
        let is_share = |share: &f64| (0.0..=1.0).contains(share);
        return (stated.iter().all(is_share) && stated.is_sorted()).then_some(stated);
    }
    let before = program.motions.get(motion.follows?)?;
    let same = before.tool == motion.tool && before.work_object == motion.work_object;
    let mut last = before.target.pose().filter(|_| same)?.position_mm;
    let mut length = 0.0;
    let lengths: Vec<f64> = (pieces.iter())
        .map(|piece| {
            length += (piece.position_mm - last).norm();
            last = piece.position_mm;
            length
        })
        .collect();
    (length > 0.0 && length.is_finite()).then(|| lengths.iter().map(|at| at / length).collect())
}
