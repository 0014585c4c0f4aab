//! A robot's program whose path is corrected: pieces of the path as pieces of motions, and the check of what was written.

use kinetostat_program::{
    Circles, Corrected, CorrectionField, Curve, DIRECTION_DECIMALS, MachineProgram, Monitor, Move,
    Path, Plan, PlannedMove, StatedBy, Verification, WriteError as PathWriteError,
    WriteOptions as PathWriteOptions, WrittenEnd, WrittenMove,
};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::document::{read, write};
use crate::error::WriteError;
use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::options::{ReadOptions, WriteOptions};
use crate::path::broken;
use crate::path::header::{mark_line, with_header};
use crate::path::kept_lines::ReadProgram;
use crate::path::maker::PathOptions;
use crate::path::of_program::{RobotPath, path_of};
use crate::path::read_again::check;
use crate::path::turned_by_correction::{
    angles_as_written, angles_of_piece, by_angles, refuse_lost_orientation, refuse_lost_turn,
};
use crate::text::source::SourceFile;
use crate::writing::piece::Piece;

/// A robot's program with its path, for [`kinetostat_program::MachineProgram`].
///
/// ```
/// use kinetostat_formats::*;
/// use kinetostat_program::{MachineProgram, Request, Unwatched};
/// use nalgebra::Vector3;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;\n\
///     MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     MoveL [[100,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     ENDPROC\nENDMODULE\n";
/// let options = ReadOptions::default();
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &options).unwrap();
/// let path = path_of(&program, &PathOptions::default()).unwrap();
/// let robot = Correctable {
///     program: &program,
///     path: &path,
///     reading: &options,
///     making: &PathOptions::default(),
///     writing: &WriteOptions::default(),
/// };
/// // An arm that sags by 0.1 mm a metre further out.
/// let field = |request: &Request| Ok(Vector3::z() * 1e-4 * request.position_mm.x);
/// let mut writing = kinetostat_program::WriteOptions::default();
/// writing.header = None;
/// let written = robot.write(&field, &writing, &Unwatched).unwrap();
/// robot.verify(&written, &writing).unwrap();
/// let output = String::from_utf8(written.bytes).unwrap();
/// assert_eq!(output, text.replace("[[100,0,0]", "[[100,0,0.0100]"));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Correctable<'a> {
    /// The program as read.
    pub program: &'a RobotProgram,
    /// Path of the program from [`path_of`].
    pub path: &'a RobotPath,
    /// Options with which the program was read.
    pub reading: &'a ReadOptions,
    /// Options with which the path was made.
    pub making: &'a PathOptions,
    /// Options of the writer; decimals of [`kinetostat_program::WriteOptions`] are used if there are more (4 if these state none).
    pub writing: &'a WriteOptions,
}

/// Turns of the tool below this are not written, rad: those of the last digit of an angle.
const SAME_RAD: f64 = 1e-7;

/// Axes of the tool nearer than this are one, rad.
const SAME_AXIS: f64 = 1e-9;

impl Correctable<'_> {
    fn text(&self, options: &PathWriteOptions) -> WriteOptions {
        let decimals = usize::from(options.decimals.unwrap_or(4));
        let by_direction = |motion: &Move| {
            let turn = motion.tool_turn.as_ref();
            let rotary = turn.and_then(|turn| turn.rotary.as_ref());
            rotary.is_some_and(|rotary| rotary.stated == StatedBy::Direction)
        };
        // The division counts with these digits.
        let least = match self.path.path.moves.iter().any(by_direction) {
            true => DIRECTION_DECIMALS,
            false => 0,
        };
        WriteOptions {
            position_decimals: self.writing.position_decimals.max(decimals),
            quaternion_decimals: self.writing.quaternion_decimals.max(least),
            ..self.writing.clone()
        }
    }

    /// Transformation from the axes of the path to those of a motion's work object.
    fn work_object_from_path(&self, motion: usize) -> Isometry3<f64> {
        let frame = self.program.motions[motion].work_object.known();
        match (&self.path.work_object, frame) {
            (None, Some(frame)) => frame.inverse(),
            _ => Isometry3::identity(),
        }
    }

    /// An orientation of the tool as the text of a motion says it: where that is the axis alone, the one that the axis is read as.
    fn as_stated(&self, motion: &Motion, turn: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        let Some(pose) = motion.target.pose().filter(|_| self.path.axis_alone) else {
            return turn;
        };
        let axis = turn * self.path.path.tool_axis;
        let read = OrientationText::Axis.rotation_of(axis.as_slice());
        let own = pose.orientation * Vector3::z();
        // The last bits of an axis say nothing, and at -z they would say another turn.
        match (axis - own).norm() < SAME_AXIS {
            true => pose.orientation,
            false => read.unwrap_or(pose.orientation),
        }
    }

    /// The pieces that a move becomes in the text; none where it stays as it is.
    fn pieces(&self, index: usize, plan: &PlannedMove, half_mm: f64) -> Vec<Piece> {
        let motion = &self.path.path.moves[index];
        let number = self.path.motions[index];
        let own = &self.program.motions[number];
        // A speed that stands elsewhere (FEDRAT) is not another one from piece to piece.
        let same_speed =
            |factor: f64| own.site.speed.is_none() || (factor - 1.0).abs() <= SAME_SPEED;
        // The text of an arc changes with its start, and so does a speed where the way becomes longer or shorter.
        let unchanged = plan.pieces.len() == 1
            && motion.curve == Curve::Line
            && plan.pieces.iter().all(|piece| {
                let turned = piece.orientation.zip(motion.orientation(1.0));
                (piece.position_mm - motion.end).amax() <= half_mm
                    && same_speed(piece.speed_factor)
                    && turned.is_none_or(|(to, from)| self.path.turned(&to, &from) <= SAME_RAD)
            });
        if plan.kept || unchanged {
            return Vec::new();
        }
        let to_own = self.work_object_from_path(number);
        // Between two ends the tool stands as halfway between them.
        let mut last = motion.orientation(0.0);
        let mut halfway = |to: Option<UnitQuaternion<f64>>| {
            let from = std::mem::replace(&mut last, to);
            from.zip(to).map(|(from, to)| from.slerp(&to, 0.5))
        };
        let angles = by_angles(motion);
        let mut pieces: Vec<Piece> = plan
            .pieces
            .iter()
            .map(|piece| Piece {
                motion: number,
                position_mm: (to_own * nalgebra::Point3::from(piece.position_mm)).coords,
                orientation: (piece.orientation)
                    .filter(|_| angles.is_none())
                    .map(|o| self.as_stated(own, to_own.rotation * o)),
                rotary_deg: angles
                    .map(|turn| angles_of_piece(&self.path.path.tool_axis, turn, piece)),
                via_mm: piece
                    .via_mm
                    .map(|via| (to_own * nalgebra::Point3::from(via)).coords),
                share: Some(piece.share_to),
                centre_mm: piece
                    .arc
                    .map(|arc| (to_own * nalgebra::Point3::from(arc.centre_mm)).coords),
                via_orientation: halfway(piece.orientation).map(|o| to_own.rotation * o),
                speed_factor: match same_speed(piece.speed_factor) {
                    true => 1.0,
                    false => piece.speed_factor,
                },
            })
            .collect();
        // A circle so short that one piece follows it, or of which only the end is known, stays one.
        if let (MotionKind::Circular { via }, [piece]) = (&own.kind, pieces.as_mut_slice())
            && piece.via_mm.is_none()
        {
            let end = own
                .target
                .pose()
                .map_or(piece.position_mm, |end| end.position_mm);
            let shift = piece.position_mm - end;
            piece.via_mm = via.pose().map(|via| via.position_mm + shift);
        }
        pieces
    }

    /// The moves of which the pieces may be circles: those whose language says them by places that can be written.
    fn circles(&self) -> Vec<Circles> {
        let of = |number: &usize| {
            let motion = &self.program.motions[*number];
            let site = motion.site.via.as_ref().map(|(_, site)| site);
            let language = self.program.language;
            if language.has_centres() && matches!(motion.kind, MotionKind::Arc { .. }) {
                return Circles::AboutAxis;
            }
            let is_fixed = site.is_none_or(|site| matches!(site, TargetSite::Fixed(_)));
            let written = language.writes_circles(is_fixed);
            match written && motion.site.indivisible.is_none() {
                true => Circles::ThroughPlace,
                false => Circles::Straight,
            }
        };
        self.path.motions.iter().map(of).collect()
    }

    /// Reads the written program again: the ends of all pieces.
    fn written_moves(
        &self,
        plan: &Plan<'_>,
        changed: &[bool],
        files: &[(String, Vec<u8>)],
    ) -> Result<(Vec<WrittenMove>, Vec<Vec<f64>>), PathWriteError> {
        let (_, again) = self.read_again(files)?;
        let mut moves = again.path.moves.iter();
        let mut written = Vec::with_capacity(plan.moves().len());
        let mut angles = Vec::new();
        for ((index, planned), changed) in plan.moves().iter().enumerate().zip(changed) {
            let count = planned.pieces.len();
            // The orientation follows from the angles of rotary axes: written directions have fewer digits.
            let stands = |motion: &Move| {
                let turn = motion.tool_turn.as_ref();
                turn.is_none_or(|turn| turn.rotary.is_none())
                    .then(|| motion.orientation(1.0))?
            };
            let made: Vec<&Move> = moves.by_ref().take(count).collect();
            for (made, piece) in made.iter().zip(&planned.pieces) {
                angles.push(angles_as_written(&self.path.path, index, made, piece)?);
            }
            let ends: Vec<_> = (made.into_iter().zip(&planned.pieces))
                .map(|(m, piece)| WrittenEnd {
                    position_mm: m.end,
                    orientation: stands(m),
                    line: m.line,
                    circle: match (&m.curve, piece.via_mm.is_some() || piece.arc.is_some()) {
                        (Curve::Arc(arc), true) => Some(*arc),
                        _ => None,
                    },
                })
                .collect();
            if ends.len() != count {
                return Err(broken(
                    self.path.path.moves[index].line,
                    0,
                    "it has fewer motions than were written".to_owned(),
                ));
            }
            written.push(WrittenMove {
                ends,
                same: !changed,
            });
        }
        if moves.next().is_some() {
            return Err(broken(
                0,
                0,
                "it has more motions than were written".to_owned(),
            ));
        }
        Ok((written, angles))
    }

    fn read_again(
        &self,
        files: &[(String, Vec<u8>)],
    ) -> Result<(RobotProgram, RobotPath), PathWriteError> {
        let sources = files
            .iter()
            .map(|(name, bytes)| SourceFile::new(name.clone(), bytes.clone()));
        let program =
            read(self.program.language, sources.collect(), self.reading).map_err(unreadable)?;
        let path = path_of(&program, self.making).map_err(unreadable)?;
        Ok((program, path))
    }

    fn files(&self, written: &Corrected) -> Vec<(String, Vec<u8>)> {
        let mut beside = written.beside.iter();
        let files = self.program.files.iter().enumerate();
        files
            .map(|(index, file)| match index == self.path.file {
                true => (file.name().to_owned(), written.bytes.clone()),
                false => beside.next().cloned().unwrap_or_default(),
            })
            .collect()
    }
}

/// Longest line of a header: teach pendants show 80 characters or fewer.
const LINE_BYTES: usize = 80;

/// Relative change of a speed that is not worth writing, as in G-code.
const SAME_SPEED: f64 = 5e-4;

fn unreadable<E: std::fmt::Display>(errors: Vec<E>) -> PathWriteError {
    let first = errors.first().map(E::to_string).unwrap_or_default();
    broken(0, 0, format!("it cannot be read again: {first}"))
}

fn of_text(error: WriteError) -> PathWriteError {
    match error {
        WriteError::Motion {
            line,
            reason,
            remedy,
            ..
        } => PathWriteError::Motion {
            line,
            reason,
            remedy,
        },
        other => broken(0, 0, other.to_string()),
    }
}

impl MachineProgram for Correctable<'_> {
    fn bytes(&self) -> &[u8] {
        self.program
            .files
            .get(self.path.file)
            .map_or(&[], SourceFile::bytes)
    }

    fn statement_count(&self) -> usize {
        self.program.motions.len()
    }

    fn path(&self) -> &Path {
        &self.path.path
    }

    fn mark_line(&self) -> Option<usize> {
        self.program.files.get(self.path.file).and_then(mark_line)
    }

    fn write(
        &self,
        field: &dyn CorrectionField,
        options: &PathWriteOptions,
        monitor: &dyn Monitor,
    ) -> Result<Corrected, PathWriteError> {
        if let Some(line) = self.mark_line()
            && !options.again
        {
            return Err(PathWriteError::AlreadyCompensated { line });
        }
        let turns_axes =
            field.turns_tool() && self.path.path.moves.iter().any(|m| by_angles(m).is_some());
        let circles = match turns_axes {
            true => vec![Circles::Straight; self.path.motions.len()],
            false => self.circles(),
        };
        let plan = Plan::with_circles(&self.path.path, field, options, &circles, monitor)?;
        refuse_lost_turn(&self.path.path, &plan)?;
        refuse_lost_orientation(self.program, self.path, &plan)?;
        let half_mm = 0.5 * options.last_digit_mm(1.0);
        let planned = plan.moves().iter().enumerate();
        let pieces: Vec<Vec<Piece>> = planned
            .map(|(index, plan)| self.pieces(index, plan, half_mm))
            .collect();
        let changed: Vec<bool> = pieces.iter().map(|pieces| !pieces.is_empty()).collect();
        let flat: Vec<Piece> = pieces.into_iter().flatten().collect();
        let mut files = write(self.program, &flat, &self.text(options)).map_err(of_text)?;
        let mut header_lines = 0;
        if let (Some(texts), Some((_, bytes))) = (&options.header, files.get_mut(self.path.file))
            && changed.contains(&true)
        {
            let language = self.program.language;
            (*bytes, header_lines) = with_header(
                language,
                bytes,
                texts,
                options.max_line_bytes.min(LINE_BYTES),
            );
        }
        let (written, angles) = self.written_moves(&plan, &changed, &files)?;
        let bytes = match self.path.file < files.len() {
            true => files.remove(self.path.file).1,
            false => Vec::new(),
        };
        let bytes_in = self.bytes().len();
        let mut corrected = plan.corrected(self.statement_count(), bytes_in, &written, bytes);
        corrected.beside = files;
        if turns_axes {
            corrected.rotary_deg = angles;
        }
        corrected.accounting.header_lines = header_lines;
        Ok(corrected)
    }

    fn verify(
        &self,
        written: &Corrected,
        options: &PathWriteOptions,
    ) -> Result<Verification, PathWriteError> {
        let files = self.files(written);
        let (program, again) = self.read_again(&files)?;
        let input = ReadProgram {
            program: self.program,
            path: self.path,
        };
        let output = ReadProgram {
            program: &program,
            path: &again,
        };
        check(input, output, written, options)
    }
}
