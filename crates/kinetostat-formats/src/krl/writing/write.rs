//! Adapter of the writer for KRL.

use std::collections::BTreeSet;

use crate::error::WriteError;
use crate::interpreter::token::Kind;
use crate::krl::lex::token_file;
use crate::krl::position::{PLACE, kept_angles};
use crate::krl::table::{MotionRow, motion_row};
use crate::krl::writing::renamed::rename_in_folds;
use crate::krl::writing::stated::with_stated_ends;
use crate::model::motion::{Motion, Zone};
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::text::name::Name;
use crate::text::source::{Edits, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Renamed, Syntax, Wanted, replace_word};

/// Limit of the characters of a name.
const LONGEST: usize = 24;

/// KRL.
struct KrlSyntax;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_krl(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let stated = with_stated_ends(program, pieces)?;
    write_with(
        stated.as_ref().unwrap_or(program),
        pieces,
        options,
        &KrlSyntax,
    )
}

/// The row of the word with which a motion begins.
fn row_of(program: &RobotProgram, motion: &Motion) -> Option<&'static MotionRow> {
    let word = program.files.get(motion.file)?.part(&motion.site.keyword);
    motion_row(&Name::of(word)?)
}

impl Syntax for KrlSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        let mut names = BTreeSet::new();
        for (index, source) in program.files.iter().enumerate() {
            let file = token_file(index, source);
            for token in &file.tokens {
                if token.kind == Kind::Word {
                    names.insert(source.part(&token.bytes()).to_ascii_uppercase());
                }
            }
        }
        names
    }

    fn free_name(
        &self,
        near: &[u8],
        number: &mut usize,
        taken: &mut BTreeSet<Vec<u8>>,
    ) -> Option<Vec<u8>> {
        // The loop tries more names than are taken.
        for _ in 0..=2 * taken.len() + 2 {
            let end = format!("_{number}");
            *number += 1;
            let kept = near.len().min(LONGEST.checked_sub(end.len())?);
            let name = [&near[..kept], end.as_bytes()].concat();
            let upper = name.to_ascii_uppercase();
            // A point of an inline form has its data beside it: XP1 and FP1.
            let data = [b"F", upper.get(1..).unwrap_or_default()].concat();
            if !taken.contains(&data) && taken.insert(upper) {
                return Some(name);
            }
        }
        None
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
        let file = program.files.get(motion.file)?;
        let row = row_of(program, motion)?;
        let site = &motion.site;
        let mut edits = Edits::default();
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        let straight = row.straight?;
        match (&literals.via, &site.via) {
            (Some((span, via)), _) => edits.replace(span.clone(), via.clone()),
            (None, via) => {
                let written = file.part(&site.keyword);
                replace_word(written, straight, &site.keyword, &mut edits);
                if let Some((span, _)) = via {
                    edits.replace(span.clone(), "");
                }
            }
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if motion.zone == Zone::Exact {
            let end = site.target_span.end;
            edits.replace(end..end, format!(" {}", row.pass));
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn is_written_flat(&self) -> bool {
        true
    }

    fn replaced(
        &self,
        _file: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let decimals = [options.position_decimals, options.angle_decimals];
        let place = wanted.position_mm.iter().copied();
        let values = place.chain(kept_angles(&rotation));
        let mut members: Vec<String> = (PLACE.iter().zip(values).enumerate())
            .map(|(at, (name, value))| format!("{name} {value:.*}", decimals[at / 3]))
            .collect();
        let configuration = &text.pose.configuration.text;
        members.extend((!configuration.is_empty()).then(|| configuration.clone()));
        for (axis, before) in text.pose.external.iter().enumerate() {
            let changed = wanted.external.get(axis).copied().flatten();
            let value = changed
                .or(*before)
                .map(|value| format!("E{} {value}", axis + 1));
            members.extend(value);
        }
        Some(format!("{{{}}}", members.join(",")).into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        let site = &motion.site;
        let word = row_of(program, motion).and_then(|row| row.straight);
        if let (Some(word), Some((span, _))) = (word, &site.via) {
            let written = program.files[motion.file].part(&site.keyword);
            replace_word(written, word, &site.keyword, edits);
            edits.replace(span.clone(), "");
        }
    }

    fn restored_speed(&self, program: &RobotProgram, motion: &Motion) -> Option<(usize, Vec<u8>)> {
        let file = program.files.get(motion.file)?;
        let site = motion.site.speed.as_ref()?;
        // A speed in WITH applies to the motion alone.
        let is_before = site.span == (motion.span.start..motion.span.start);
        let site = is_before.then_some(site)?;
        let metres_per_s = motion.speed.mm_per_s? / 1000.0;
        let rest = file.bytes().get(motion.span.end..)?;
        let to_end = rest
            .iter()
            .position(|byte| *byte == b'\n')
            .unwrap_or(rest.len());
        let kept = rest[..to_end]
            .strip_suffix(b"\r")
            .map_or(to_end, <[u8]>::len);
        let mut text = file.line_ending().to_vec();
        text.extend_from_slice(file.indentation(motion.span.start));
        text.extend_from_slice(format!("{}{metres_per_s}", site.before).as_bytes());
        Some((motion.span.end + kept, text))
    }

    fn renamed(&self, program: &RobotProgram, names: &[Renamed], edits: &mut [Edits]) {
        rename_in_folds(program, names, edits);
    }
}
