//! The writer of SINUMERIK programs.
//!
//! The first piece of a motion stands in its own block, further ones in blocks of their own behind it, without numbers: the
//! control needs none, and jumps only to those that are there. What acts at the end of a block (M0, M30, G9) goes to the last
//! one. An arc that is corrected becomes circles through places (CIP), which may lean, or straight. G codes, feeds and places
//! that are modal are stated again where what is
//! written differs from what the next block counts on.

use std::collections::BTreeMap;

use crate::error::WriteError;
use crate::model::motion::MotionKind;
use crate::model::program::RobotProgram;
use crate::model::stated_axes::AxesStated;
use crate::options::{ReadOptions, WriteOptions};
use crate::siemens::scan::scan;
use crate::siemens::writing::writer::{Held, Reason, SAME, Writer};
use crate::text::edits::Edits;
use crate::writing::line_length::check_lines;
use crate::writing::piece::{Piece, check_pieces};

/// Limit of the bytes of a block.
const LONGEST_BLOCK: usize = 512;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_siemens(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
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
    let overlap = |file: usize| WriteError::Overlap {
        file: program
            .files
            .get(file)
            .map_or("", |file| file.name())
            .to_owned(),
    };
    let mut edits: Vec<Edits> = program.files.iter().map(|_| Edits::default()).collect();
    if !pieces.is_empty() {
        let reading = ReadOptions {
            rotary_axes: program.rotary.letters.clone(),
            slash_blocks: program.slash_blocks,
            ..ReadOptions::default().as_written()
        };
        let found = scan(&program.files, &reading);
        if found.written.len() != program.motions.len() {
            return Err(overlap(0));
        }
        let mut held = Held::default();
        let mut file = None;
        for (index, (motion, written)) in program.motions.iter().zip(&found.written).enumerate() {
            if file.replace(motion.file) != Some(motion.file) {
                held = Held::default();
            }
            let source = &program.files[motion.file];
            let mut writer = Writer {
                letters: &program.rotary.letters,
                angles: match program.rotary.motions.get(&index) {
                    Some(AxesStated::Angles { start, end }) => Some([start, end]),
                    _ => None,
                },
                shown: &found.shown,
                file: source,
                motion,
                written,
                options,
                edits: &mut edits[motion.file],
                held: &mut held,
            };
            let pieces = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
            writer
                .motion(pieces)
                .map_err(|(reason, remedy)| WriteError::Motion {
                    file: source.name().to_owned(),
                    line: motion.line,
                    reason: reason.to_owned(),
                    remedy: remedy.to_owned(),
                })?;
        }
    }
    let limits = WriteOptions {
        max_line_bytes: Some(
            options
                .max_line_bytes
                .map_or(LONGEST_BLOCK, |most| most.min(LONGEST_BLOCK)),
        ),
        ..options.clone()
    };
    (edits.into_iter().enumerate())
        .map(|(index, edits)| {
            let file = &program.files[index];
            let bytes = edits.applied_to(file.bytes());
            let bytes = bytes.ok_or_else(|| overlap(index))?;
            check_lines(file, &bytes, &limits)?;
            Ok((file.name().to_owned(), bytes))
        })
        .collect()
}

impl Writer<'_> {
    fn motion(&mut self, pieces: &[&Piece]) -> Result<(), Reason> {
        let written = self.written;
        if written.stated.code {
            self.held.code = None;
        }
        if written.stated.feed {
            self.held.feed = None;
        }
        let Some(end) = self.motion.target.pose() else {
            if !pieces.is_empty() {
                return Err((
                    "the motion has no pose that could be corrected",
                    "write its place as numbers",
                ));
            }
            self.left();
            return Ok(());
        };
        check_pieces(pieces)?;
        if !pieces.is_empty() {
            return self.pieces(pieces);
        }
        let is_elsewhere = |axis: usize| written.counts_behind_frame(axis, self.held.stated[axis]);
        let displaced = self.held.off.norm() > SAME || (0..3).any(is_elsewhere);
        let is_arc = matches!(self.motion.kind, MotionKind::Arc { .. });
        // The last digit of the place before: controls take arcs that are off by more.
        let last_digit = 0.1_f64.powi(self.options.position_decimals as i32);
        if displaced && is_arc && self.held.off.norm() <= last_digit {
            self.left();
            return Ok(());
        }
        if displaced && is_arc {
            return Err((
                "the arc begins at a place that changes, and is then none about its written centre",
                "divide it into straight pieces, too, or keep its start",
            ));
        }
        let mut own = Piece::to(0, end.position_mm);
        if let MotionKind::Circular { via } = &self.motion.kind {
            own.via_mm = via.pose().map(|via| via.position_mm);
        }
        let keeps_direction = self.held.direction.is_none();
        let keeps_angles = self.angles_stand();
        match displaced || !keeps_direction || !keeps_angles {
            true => self.pieces(&[&own]),
            false => {
                self.keep_stated();
                self.angles_left();
                self.code(written.code);
                self.feed(1.0)?;
                Ok(())
            }
        }
    }

    /// Steps of axes that a motion has words of count from these.
    fn keep_stated(&mut self) {
        for (stated, word) in self.held.stated.iter_mut().zip(&self.written.axes) {
            *stated &= word.is_none();
        }
    }

    /// A motion that stays as it is written.
    fn left(&mut self) {
        let written = self.written;
        self.keep_stated();
        let mut off = written.frame.rotation.inverse() * self.held.off;
        for axis in 0..3 {
            let reset = written.axes[axis]
                .as_ref()
                .is_some_and(|word| written.machine || !word.step);
            if reset {
                off[axis] = 0.0;
            }
        }
        self.held.off = written.frame.rotation * off;
        if !written.direction_words.is_empty() {
            self.held.direction = None;
        }
        self.angles_left();
        self.code(written.code);
        // A feed that is not known cannot be another one.
        let _ = self.feed(1.0);
    }
}
