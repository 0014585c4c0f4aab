//! Edits of files from pieces of motions, and lines that became longer than a controller takes.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::WriteError;
use crate::model::external::ways_of_external_axes;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::target::Target;
use crate::options::WriteOptions;
use crate::text::number::in_words;
use crate::text::source::{Edits, SourceFile};
use crate::writing::divided::{AxesOfPiece, shared_axes};
use crate::writing::ends::{Demands, Names, Writer, text_of};
use crate::writing::piece::{Piece, REPEATED, REPEATED_FOR_GOOD, Reason, SAME_MM, SAME_RAD};
use crate::writing::syntax::Syntax;

/// True if two runs of one statement take the same pieces: its numbers stand once.
fn is_same_way(first: &Motion, pieces: &[&Piece], again: &Motion, others: &[&Piece]) -> bool {
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
            if !is_same_way(&program.motions[first], before, motion, pieces) {
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
        let axes = shared_axes(program, motion, ways, text, pieces)?;
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

/// Limit of the reasons that are named beside the first one.
const MOST_OTHERS: usize = 8;

/// Motions that are refused for one reason.
struct OfOne {
    reason: Reason,
    /// File and lines of the motions.
    lines: BTreeMap<usize, Vec<usize>>,
}

/// The motions that were refused up to here.
#[derive(Default)]
pub(super) struct Refused {
    by_reason: Vec<OfOne>,
}

impl Refused {
    /// One more.
    pub(super) fn add(&mut self, motion: &Motion, reason: Reason) {
        let known = self.by_reason.iter().position(|own| own.reason == reason);
        let index = known.unwrap_or_else(|| {
            self.by_reason.push(OfOne {
                reason,
                lines: BTreeMap::new(),
            });
            self.by_reason.len() - 1
        });
        if let Some(own) = self.by_reason.get_mut(index) {
            own.lines.entry(motion.file).or_default().push(motion.line);
        }
    }

    /// The error of the first one, which names all others with their lines.
    pub(super) fn error(mut self, program: &RobotProgram) -> Option<WriteError> {
        let name = |file: usize| program.files.get(file).map_or("", |file| file.name());
        let first = self.by_reason.first_mut()?;
        let (file, lines) = first.lines.iter_mut().next()?;
        let (file, line) = (*file, lines.remove(0));
        let named = |own: &OfOne| {
            let all = own.lines.iter().filter(|(_, lines)| !lines.is_empty());
            let all = all.map(|(of, lines)| {
                let mut lines = lines.clone();
                lines.sort_unstable();
                lines.dedup();
                match *of == file {
                    true => in_words(&lines),
                    false => format!("{} of {}", in_words(&lines), name(*of)),
                }
            });
            all.collect::<Vec<_>>().join(", ")
        };
        let (first, others) = self.by_reason.split_first()?;
        let mut reason = first.reason.0.to_owned();
        let further = named(first);
        if !further.is_empty() {
            reason.push_str(&format!("; so on {further}"));
        }
        for other in others.iter().take(MOST_OTHERS) {
            reason.push_str(&format!("; {}: {}", named(other), other.reason.0));
        }
        Some(WriteError::Motion {
            file: name(file).to_owned(),
            line,
            reason,
            remedy: first.reason.1.to_owned(),
        })
    }
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
