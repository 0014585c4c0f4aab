//! Edits of files from pieces of motions.

use std::collections::BTreeMap;

use crate::error::WriteError;
use crate::model::external::ways_of_external_axes;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::target::Target;
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::writing::declared::{Demands, Names};
use crate::writing::ends::Writer;
use crate::writing::external_axes::{AxesOfPiece, shared_axes};
use crate::writing::line_length::check_lines;
use crate::writing::piece::Piece;
use crate::writing::refusals::{REPEATED, REPEATED_FOR_GOOD, SAME_MM, SAME_RAD};
use crate::writing::refused::Refused;
use crate::writing::syntax::Syntax;
use crate::writing::target_texts::text_of;

/// True if two runs of one statement take the same pieces: its numbers stand once.
fn is_same_way(
    (first, pieces): (&Motion, &[&Piece]),
    (again, others): (&Motion, &[&Piece]),
) -> bool {
    let near = |one: &Piece, other: &Piece| {
        let turn = match (one.orientation, other.orientation) {
            (Some(one), Some(other)) => one.angle_to(&other) <= SAME_RAD,
            (one, other) => one == other,
        };
        let via = match (one.via_mm, other.via_mm) {
            (Some(one), Some(other)) => (one - other).norm() <= SAME_MM,
            (one, other) => one == other,
        };
        let speed = (one.speed_factor - other.speed_factor).abs() <= SAME_MM;
        turn && via && speed && (one.position_mm - other.position_mm).norm() <= SAME_MM
    };
    let mut pairs = pieces.iter().zip(others);
    let is_same_end = match (&first.target, &again.target) {
        (Target::Pose(one), Target::Pose(other)) => {
            (one.position_mm - other.position_mm).norm() <= SAME_MM
                && one.orientation.angle_to(&other.orientation) <= SAME_RAD
        }
        (one, other) => one == other,
    };
    let is_same_speed = first.speed.mm_per_s == again.speed.mm_per_s
        || pieces.iter().all(|piece| piece.speed_factor == 1.0);
    pieces.len() == others.len()
        && is_same_speed
        && pairs.all(|(one, other)| near(one, other))
        && (pieces.is_empty() || is_same_end)
}

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
    let mut refused = Refused::default();
    let mut first_runs: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for ((index, motion), ways) in program.motions.iter().enumerate().zip(&ways) {
        let pieces = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
        let first = *(first_runs.entry((motion.file, motion.span.start))).or_insert(index);
        if first != index {
            let before = of_motion.get(&first).map_or(&[][..], Vec::as_slice);
            if !is_same_way((&program.motions[first], before), (motion, pieces)) {
                refused.add(
                    motion,
                    match syntax.is_written_flat() {
                        true => REPEATED,
                        false => REPEATED_FOR_GOOD,
                    },
                );
            }
            continue;
        }
        let text = text_of(program, &motion.site.target);
        let axes = shared_axes(program, motion, ways, (text, pieces))?;
        let pieces: Vec<(&Piece, &AxesOfPiece)> = pieces.iter().copied().zip(&axes).collect();
        if let Err(reason) = writer.write_motion(motion, &pieces) {
            refused.add(motion, reason);
        }
    }
    refused.error(program).map_or(Ok(()), Err)?;
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
