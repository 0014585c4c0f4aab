//! Adapter of the writer for FANUC TP programs.
//!
//! A piece of a motion is a line before it with a position of its own at the end of `/POS`. Then the lines are numbered
//! again from the first that is wrong, and `LINE_COUNT` grows by the lines that were added: a controller loads a program
//! only where its lines follow one another.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::WriteError;
use crate::ls::lines::Layout;
use crate::ls::positions::Positions;
use crate::model::motion::{Motion, Zone};
use crate::model::program::RobotProgram;
use crate::model::site::{Declaration, TargetSite};
use crate::options::WriteOptions;
use crate::text::source::{Edits, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Renamed, Syntax};

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_ls(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let layouts: Vec<Layout> = program
        .files
        .iter()
        .map(|file| Layout::of(file.bytes()))
        .collect();
    let ends = layouts.iter().map(|layout| layout.positions.clone());
    let syntax = LsSyntax {
        ends: ends
            .map(|section| section.map_or(0, |span| span.end))
            .collect(),
    };
    let pieces: Vec<Piece> = (pieces.iter())
        .map(|piece| without_offset(program, piece))
        .collect();
    let mut written = write_with(program, &pieces, options, &syntax)?;
    for ((name, bytes), before) in written.iter_mut().zip(&layouts) {
        let now = Layout::of(bytes);
        if now.lines.len() != before.lines.len() {
            let added = now.lines.len() as f64 - before.lines.len() as f64;
            let numbered = numbered(bytes, &now, added);
            *bytes = numbered.ok_or_else(|| WriteError::Overlap { file: name.clone() })?;
        }
    }
    Ok(written)
}

/// A piece as its position states it: the offset of its motion is written with it, and shifts it again.
fn without_offset(program: &RobotProgram, piece: &Piece) -> Piece {
    let mut piece = piece.clone();
    let motion = program.motions.get(piece.motion);
    let Some((motion, end)) = motion.and_then(|motion| Some((motion, motion.target.pose()?)))
    else {
        return piece;
    };
    let TargetSite::Declared { declaration, .. } = &motion.site.target else {
        return piece;
    };
    let Some(declared) = program.declarations.get(*declaration) else {
        return piece;
    };
    let by = end.position_mm - declared.pose.position_mm;
    let text = program.files[motion.file].part(&motion.span);
    let is_of_tool = text.windows(11).any(|part| part == b"Tool_Offset");
    piece.position_mm -= match (is_of_tool, piece.orientation) {
        (true, Some(turned)) => turned * (end.orientation.inverse() * by),
        _ => by,
    };
    piece
}

/// A program to which one line was added, numbered again.
pub(crate) fn numbered_again(bytes: &[u8]) -> Option<Vec<u8>> {
    numbered(bytes, &Layout::of(bytes), 1.0)
}

/// A program whose lines are numbered one after another.
pub(super) fn numbered(bytes: &[u8], layout: &Layout, added: f64) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    if let Some(count) = &layout.line_count {
        edits.replace(count.span.clone(), format!("{}", count.value + added));
    }
    let mut last: Option<u64> = None;
    for line in &layout.lines {
        let digits = &bytes[line.number.clone()];
        let Ok(stated) = String::from_utf8_lossy(digits).parse::<u64>() else {
            continue;
        };
        let number = last.map_or(stated, |last| last.saturating_add(1));
        last = Some(number);
        if number != stated {
            // A longer number takes of the blanks before it.
            let text = number.to_string();
            let longer = text.len().saturating_sub(digits.len());
            let blanks = bytes[..line.number.start]
                .iter()
                .rev()
                .take_while(|byte| **byte == b' ')
                .count();
            edits.replace(
                line.number.start - longer.min(blanks)..line.number.end,
                text,
            );
        }
    }
    edits.applied_to(bytes)
}

/// FANUC TP programs.
struct LsSyntax {
    /// Position after the last taught position, by file.
    ends: Vec<usize>,
}

/// The R of `PR[` before the number of a position register: a position of the program takes its place.
fn of_register(file: &SourceFile, name: &Range<usize>) -> Option<Range<usize>> {
    let before = file.part(&(0..name.start)).trim_ascii_end();
    let letter = before.len().checked_sub(2)?;
    before.ends_with(b"PR[").then_some(letter..letter + 1)
}

/// Highest number of a position.
const HIGHEST: u32 = 32_766;

/// A number such that more are greater as text, too.
fn key(number: u32) -> Vec<u8> {
    format!("{number:010}").into_bytes()
}

impl Syntax for LsSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        let mut names = BTreeSet::new();
        for (index, file) in program.files.iter().enumerate() {
            let section = Layout::of(file.bytes()).positions.unwrap_or_default();
            let found = Positions::of(file.bytes(), section, index, &mut Vec::new());
            names.extend(found.all.keys().map(|number| key(*number)));
        }
        names
    }

    fn free_name(
        &self,
        _near: &[u8],
        _number: &mut usize,
        taken: &mut BTreeSet<Vec<u8>>,
    ) -> Option<Vec<u8>> {
        let last = taken
            .last()
            .map_or(Some(0), |last| std::str::from_utf8(last).ok()?.parse().ok())?;
        let number: u32 = last + 1;
        taken.insert(key(number));
        (number <= HIGHEST).then(|| number.to_string().into_bytes())
    }

    fn declares_pieces(&self) -> bool {
        true
    }

    fn copies_at(&self, _program: &RobotProgram, declaration: &Declaration) -> usize {
        let end = self.ends.get(declaration.text.file).copied();
        end.unwrap_or(declaration.statement.start)
    }

    fn writes_circles(&self) -> bool {
        true
    }

    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let (file, site) = (program.files.get(motion.file)?, &motion.site);
        let TargetSite::Declared { name, .. } = &site.target else {
            return None;
        };
        let mut edits = Edits::default();
        match &literals.via {
            Some((span, via)) => edits.replace(span.clone(), via.clone()),
            None => self.straighten(program, motion, &mut edits),
        }
        edits.replace(name.clone(), literals.end.clone());
        let via = literals.via.iter().map(|(via, _)| via);
        for letter in via.chain([name]).filter_map(|name| of_register(file, name)) {
            edits.replace(letter, "");
        }
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        if let (Some(zone), Zone::Exact) = (&site.zone, motion.zone) {
            // With CNT0 the arm would come to rest at every piece; where pieces meet the path hardly turns.
            edits.replace(zone.clone(), "CNT100");
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn renamed(&self, program: &RobotProgram, names: &[Renamed], edits: &mut [Edits]) {
        for Renamed { file, place, .. } in names {
            if let Some(letter) = of_register(&program.files[*file], place) {
                edits[*file].replace(letter, "");
            }
        }
    }

    fn straighten(&self, _program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        if let Some((span, _)) = &motion.site.via {
            edits.replace(motion.site.keyword.clone(), "L");
            edits.replace(span.clone(), "");
        }
    }
}
