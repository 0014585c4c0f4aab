//! From pieces of motions to edits of files.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::UnitQuaternion;

use crate::error::WriteError;
use crate::model::external::ways_of_external_axes;
use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::{Language, RobotProgram};
use crate::model::site::{OffsetAxes, PoseText, SpeedSite, TargetSite};
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::text::number::Width;
use crate::text::source::SourceFile;
use crate::writing::declared::{Demands, Names};
use crate::writing::external_axes::{AxesOfPiece, shared_axes};
use crate::writing::joints::{put_joints, row_of_joints};
use crate::writing::literal::{Wanted, literal_of, put, put_pose};
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Syntax};

/// The files of a program with the pieces in place of its motions.
pub(crate) fn write_with(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
    syntax: &dyn Syntax,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let mut of_motion: BTreeMap<usize, Vec<&Piece>> = BTreeMap::new();
    for piece in pieces {
        if piece.motion >= program.motions.len() {
            return Err(WriteError::NoSuchMotion {
                motion: piece.motion,
                motions: program.motions.len(),
            });
        }
        of_motion.entry(piece.motion).or_default().push(piece);
    }
    let mut writer = Writer {
        program,
        options,
        syntax,
        edits: program.files.iter().map(|_| Edits::default()).collect(),
        demands: Demands::default(),
        names: Names::default(),
    };
    let ways = ways_of_external_axes(program);
    for ((index, motion), ways) in program.motions.iter().enumerate().zip(&ways) {
        let pieces = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
        let text = text_of(program, &motion.site.target);
        let axes = shared_axes(program, motion, ways, (text, pieces))?;
        let pieces: Vec<(&Piece, &AxesOfPiece)> = pieces.iter().copied().zip(&axes).collect();
        let written = writer.motion(motion, &pieces);
        written.map_err(|(reason, remedy)| WriteError::Motion {
            file: program.files[motion.file].name().to_owned(),
            line: motion.line,
            reason: reason.to_owned(),
            remedy: remedy.to_owned(),
        })?;
    }
    let Writer {
        mut edits,
        demands,
        mut names,
        ..
    } = writer;
    let overlap = |file: usize| WriteError::Overlap {
        file: program.files[file].name().to_owned(),
    };
    let written = demands.write(program, syntax, &mut names, &mut edits);
    written.ok_or_else(|| WriteError::NoFreeName {
        file: program
            .files
            .first()
            .map_or("", |file| file.name())
            .to_owned(),
    })?;
    (edits.into_iter().enumerate())
        .map(|(index, edits)| {
            let file = &program.files[index];
            let bytes = edits.applied_to(file.bytes());
            let bytes = bytes.ok_or_else(|| overlap(index))?;
            check_lines(file, &bytes, options)?;
            Ok((file.name().to_owned(), bytes))
        })
        .collect()
}

/// No line that changed is longer than allowed.
pub(crate) fn check_lines(
    file: &SourceFile,
    written: &[u8],
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let Some(limit) = options.max_line_bytes else {
        return Ok(());
    };
    let old = file.bytes().split(|byte| *byte == b'\n');
    let old: BTreeSet<&[u8]> = old.filter(|line| line.len() > limit).collect();
    for (index, line) in written.split(|byte| *byte == b'\n').enumerate() {
        let bytes = line.strip_suffix(b"\r").unwrap_or(line).len();
        if bytes > limit && !old.contains(line) {
            return Err(WriteError::LineTooLong {
                file: file.name().to_owned(),
                line: index + 1,
                bytes,
                limit,
            });
        }
    }
    Ok(())
}

/// Why a motion cannot be written, and what to do.
pub(crate) type Reason = (&'static str, &'static str);

const NO_END: Reason = (
    "the motion has no pose that could be corrected",
    "leave its pieces out",
);

const NO_VIA: Reason = (
    "through which place its circle goes is not known from the text",
    "leave its pieces out, or state that place",
);

const NO_JOINTS: Reason = (
    "no joint values next to those of the row give the corrected pose",
    "keep away from singular postures and from the end of the reach",
);

const NO_NAME: Reason = (
    "no name or number is free for a further pose",
    "give fewer pieces, or divide the program",
);

struct Writer<'a> {
    program: &'a RobotProgram,
    options: &'a WriteOptions,
    syntax: &'a dyn Syntax,
    /// One for each file.
    edits: Vec<Edits>,
    demands: Demands,
    names: Names,
}

impl Writer<'_> {
    fn motion(
        &mut self,
        motion: &Motion,
        with_axes: &[(&Piece, &AxesOfPiece)],
    ) -> Result<(), Reason> {
        let Some(((last, last_axes), before)) = with_axes.split_last() else {
            self.end(motion, &motion.site.target, None)?;
            return match &motion.site.via {
                Some((_, site)) => self.end(motion, site, None),
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
        // Places of APT may have an axis from before: its own writer knows.
        if self.program.language != Language::Apt
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
            self.end(motion, site, Some(wanted))?;
        }
        let wanted = Wanted {
            position_mm: last.position_mm,
            orientation: last
                .orientation
                .filter(|to| to.angle_to(&end.orientation) > SAME_RAD),
            external: &last_axes.end,
        };
        self.end(motion, &motion.site.target, Some(wanted))?;
        (self.syntax).moved(self.program, motion, &mut self.edits[motion.file]);
        // Where a speed stays in force, each piece states its own, and the speed of before is restored behind them.
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
        if before.is_empty() && !becomes_straight {
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
        let mut inserted = Vec::new();
        for (piece, axes) in before {
            let speed = speed_of(motion, piece, stated)?.map(|(_, text)| text);
            inserted.extend(self.inserted(motion, (piece, axes), speed.as_deref())?);
        }
        self.edits[motion.file].replace(motion.span.start..motion.span.start, inserted);
        self.state_speed(motion, own_speed);
        Ok(())
    }

    /// The statement of a piece before the end of a motion, with what parts it from that motion.
    fn inserted(
        &mut self,
        motion: &Motion,
        (piece, axes): (&Piece, &AxesOfPiece),
        speed: Option<&[u8]>,
    ) -> Result<Vec<u8>, Reason> {
        let end = motion.target.pose().ok_or(NO_END)?;
        let wanted = Wanted {
            position_mm: piece.position_mm,
            orientation: Some(piece.orientation.unwrap_or(end.orientation)),
            external: &axes.end,
        };
        let mut literals = PieceLiterals {
            end: self.literal(motion, &motion.site.target, &wanted)?,
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
            literals.via = Some((span_of(site), self.literal(motion, site, &wanted)?));
        }
        let (program, options) = (self.program, self.options);
        let statement = self
            .syntax
            .piece(program, motion, &literals, speed, options);
        let mut statement = statement.ok_or(NO_END)?;
        let file = &program.files[motion.file];
        statement.extend_from_slice(file.line_ending());
        statement.extend_from_slice(file.indentation(motion.span.start));
        Ok(statement)
    }

    /// A pose like that of a target: a literal, or the name of a further declaration.
    fn literal(
        &mut self,
        motion: &Motion,
        site: &TargetSite,
        wanted: &Wanted<'_>,
    ) -> Result<Vec<u8>, Reason> {
        if let TargetSite::Joints(text) = site {
            let end = motion.target.pose().ok_or(NO_END)?;
            let file = &self.program.files[motion.file];
            return row_of_joints(file, text, (wanted, end.orientation)).ok_or(NO_JOINTS);
        }
        let text = text_of(self.program, site).ok_or(NO_END)?;
        let home = &self.program.files[text.file];
        let literal = literal_of(home, text, wanted, self.options).ok_or(NO_END)?;
        match (self.syntax.declares_pieces(), site) {
            (true, TargetSite::Declared { declaration, .. }) => {
                let declared = self.program.declarations.get(*declaration).ok_or(NO_END)?;
                let (program, syntax) = (self.program, self.syntax);
                (self.names)
                    .declare(program, syntax, declared, &literal, &mut 2, &mut self.edits)
                    .ok_or(NO_NAME)
            }
            _ => Ok(literal),
        }
    }

    fn state_speed(&mut self, motion: &Motion, speed: Option<(&SpeedSite, Vec<u8>)>) {
        if let Some((site, text)) = speed {
            self.edits[motion.file].replace(site.span.clone(), text);
        }
    }

    /// Writes one pose of a motion; without a wanted one it stays, which other uses of its declaration must know.
    fn end(
        &mut self,
        motion: &Motion,
        site: &TargetSite,
        wanted: Option<Wanted<'_>>,
    ) -> Result<(), Reason> {
        let program = self.program;
        let edits = &mut self.edits[motion.file];
        let file = &program.files[motion.file];
        match (site, wanted) {
            (TargetSite::Declared { declaration, name }, wanted) => {
                let declared = program.declarations.get(*declaration).ok_or(NO_END)?;
                let home = &program.files[declared.text.file];
                let literal = match &wanted {
                    Some(wanted) => literal_of(home, &declared.text, wanted, self.options),
                    None => Some(home.part(&declared.text.whole).to_vec()),
                };
                let literal = literal.ok_or(NO_END)?;
                (self.demands).demand(*declaration, motion.file, name.clone(), literal);
            }
            (_, None) => {}
            (TargetSite::Literal(text), Some(wanted)) => {
                put_pose(file, text, &wanted, self.options, edits);
            }
            (TargetSite::Joints(text), Some(wanted)) => {
                let own = motion.target.pose().ok_or(NO_END)?.orientation;
                put_joints(file, text, (&wanted, own), edits).ok_or(NO_JOINTS)?;
            }
            (TargetSite::Offset { call, literal, .. }, Some(wanted))
                if wanted.orientation.is_some() =>
            {
                // The arguments cannot turn the tool: the end itself is written in place of the call.
                let home = &program.files[literal.file];
                let text = literal_of(home, literal, &wanted, self.options).ok_or(NO_END)?;
                edits.replace(call.clone(), text);
            }
            (
                TargetSite::Offset {
                    arguments,
                    axes,
                    base,
                    ..
                },
                Some(wanted),
            ) => {
                let by = wanted.position_mm - base.position_mm;
                let by = match axes {
                    OffsetAxes::WorkObject => by,
                    OffsetAxes::Tool => base.orientation.inverse() * by,
                };
                let least = self.options.position_decimals;
                for (number, value) in arguments.iter().zip(by.iter()) {
                    put(file, number, *value, least, Width::Free, edits);
                }
            }
            // What KRL leaves open is stated before.
            (TargetSite::Partial(_), Some(_)) => return Err(NO_END),
            (TargetSite::Fixed(reason), Some(_)) => return Err((reason, NO_END.1)),
        }
        Ok(())
    }
}

/// The literal that says the configuration of an end.
fn text_of<'s>(program: &'s RobotProgram, site: &'s TargetSite) -> Option<&'s PoseText> {
    match site {
        TargetSite::Literal(text) => Some(text),
        TargetSite::Declared { declaration, .. } => {
            Some(&program.declarations.get(*declaration)?.text)
        }
        TargetSite::Offset { literal, .. } => Some(literal),
        TargetSite::Partial(_) | TargetSite::Joints(_) | TargetSite::Fixed(_) => None,
    }
}

/// Where a target stands that has a literal.
fn span_of(site: &TargetSite) -> Range<usize> {
    match site {
        TargetSite::Literal(text) => text.whole.clone(),
        TargetSite::Declared { name, .. } => name.clone(),
        TargetSite::Offset { call, .. } => call.clone(),
        TargetSite::Partial(_) | TargetSite::Joints(_) | TargetSite::Fixed(_) => 0..0,
    }
}

/// Whether pieces are numbers.
pub(crate) fn check_pieces(pieces: &[&Piece]) -> Result<(), Reason> {
    let finite = |piece: &&Piece| {
        let via = piece.via_mm.unwrap_or_default();
        let far = |value: &f64| value.abs() < FARTHEST_MM;
        piece.position_mm.iter().chain(via.iter()).all(far)
            && piece.speed_factor.is_finite()
            && piece.speed_factor > 0.0
            && piece
                .orientation
                .iter()
                .chain(&piece.via_orientation)
                .all(|q| q.coords.iter().all(|part| part.is_finite()))
    };
    if pieces.iter().any(|piece| piece.centre_mm.is_some()) {
        return Err((
            "a piece goes about a centre, and only Heidenhain programs are written so",
            "give it a place between its ends, or make it straight",
        ));
    }
    match pieces.iter().all(finite) {
        true => Ok(()),
        false => Err((
            "a piece has no finite place, orientation or speed, or one farther than 1 km",
            "mend the correction",
        )),
    }
}

/// Orientations nearer than this are the same: the text of the orientation stays.
const SAME_RAD: f64 = 1e-9;

/// Farther than any robot reaches, mm.
pub(crate) const FARTHEST_MM: f64 = 1e6;

/// When the speed of a piece is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stated {
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
    let number = format!("{:.4}", speed * piece.speed_factor);
    let number = number.trim_end_matches('0').trim_end_matches('.');
    let text = [&site.before, number, &site.after].concat();
    Ok(Some((site, text.into_bytes())))
}
