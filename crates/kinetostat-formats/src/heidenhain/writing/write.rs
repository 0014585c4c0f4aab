//! The writer of Heidenhain conversational programs.
//!
//! What a block does not say stays as it was: where one block is corrected, those behind it must say again what they took over.
//! So all motions are gone through in their order, with the place and the feed that the written blocks leave behind. A piece
//! of a motion is a block before it, with its feed and radius compensation; functions that act at the beginning of the block go to the
//! first piece, those that act at the end stay. Arcs that change become arcs about centres of their own (`CC` and `C`, or `CP` where
//! they rise), or `L` blocks, polar blocks become `L` blocks. If a file that numbers
//! its blocks gets further ones, all are numbered again.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::heidenhain::blocks::numbered_again;
use crate::heidenhain::reading::reader::interpret;
use crate::heidenhain::reading::walker::{Found, Way};
use crate::heidenhain::writing::writer::{Reason, Writer};
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::text::source::{Edits, SourceFile};
use crate::writing::motions::check_lines;
use crate::writing::piece::Piece;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_heidenhain(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let files = program.files.iter();
    if pieces.is_empty() {
        let same = files.map(|file| (file.name().to_owned(), file.bytes().to_vec()));
        return Ok(same.collect());
    }
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
    let reading = ReadOptions {
        rotary_axes: program.rotary.letters.clone(),
        slash_blocks: program.slash_blocks,
        ..ReadOptions::default().as_written()
    };
    let Found { ways, shown, .. } = interpret(&program.files, &reading);
    let mut writer = Writer {
        program,
        shown,
        options,
        edits: files.map(|_| Edits::default()).collect(),
        signs: program.files.iter().map(has_signs).collect(),
        added: vec![false; program.files.len()],
        off: Vector3::zeros(),
        feed: None,
        polar_broken: false,
        pole: None,
        axis: None,
        turned_deg: Vec::new(),
        angles_now: Vec::new(),
        off_at: Vec::with_capacity(program.motions.len()),
        changed: Vec::with_capacity(program.motions.len()),
        file: 0,
    };
    for (index, motion) in program.motions.iter().enumerate() {
        let own = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
        let way = ways
            .get(index)
            .filter(|way| way.block.text.start <= motion.span.start);
        let way = way.ok_or_else(|| WriteError::Overlap {
            file: program.files[motion.file].name().to_owned(),
        })?;
        let written = writer.motion(motion, way, own);
        written.map_err(|(reason, remedy)| WriteError::Motion {
            file: program.files[motion.file].name().to_owned(),
            line: motion.line,
            reason,
            remedy: remedy.to_owned(),
        })?;
    }
    let Writer { edits, added, .. } = writer;
    let mut written = Vec::with_capacity(program.files.len());
    for ((file, edits), added) in program.files.iter().zip(edits).zip(added) {
        let overlap = || WriteError::Overlap {
            file: file.name().to_owned(),
        };
        let mut bytes = edits.applied_to(file.bytes()).ok_or_else(overlap)?;
        if added {
            bytes = numbered_again(&bytes).ok_or_else(overlap)?;
        }
        check_lines(file, &bytes, options)?;
        written.push((file.name().to_owned(), bytes));
    }
    Ok(written)
}

/// True if a file writes signs before positive coordinates: its first coordinate shows it.
fn has_signs(file: &SourceFile) -> bool {
    let bytes = file.bytes();
    let letters = bytes
        .windows(2)
        .filter(|pair| matches!(pair[0], b'X' | b'Y' | b'Z'));
    let mut found = letters.filter_map(|pair| match pair[1] {
        b'+' => Some(true),
        b'0'..=b'9' => Some(false),
        _ => None,
    });
    found.next().unwrap_or(true)
}

impl Writer<'_> {
    fn motion(&mut self, motion: &Motion, way: &Way, pieces: &[&Piece]) -> Result<(), Reason> {
        if motion.file != self.file {
            self.file = motion.file;
            self.off = Vector3::zeros();
            self.feed = None;
            self.polar_broken = false;
            self.pole = None;
            self.axis = None;
            self.turned_deg.clear();
        }
        self.changed
            .push(!pieces.is_empty() || self.off != Vector3::zeros());
        let result = match pieces.split_last() {
            None => self.kept(motion, way),
            Some((last, before)) => self.pieces(motion, way, last, before),
        };
        self.off_at.push(self.off != Vector3::zeros());
        result
    }
}
