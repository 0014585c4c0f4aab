//! Adapter of the writer for RAPID.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::interpreter::token::words_of;
use crate::model::motion::{Motion, Zone};
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::rapid::lex::tokens_of;
use crate::rapid::table::{MotionRow, motion_row};
use crate::text::edits::Edits;
use crate::text::name::Name;
use crate::text::number::Width;
use crate::text::source::SourceFile;
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, names_of, put, replace_word};

/// RAPID.
pub(crate) struct RapidSyntax;

/// The row of the word with which a motion begins.
fn row_of(program: &RobotProgram, motion: &Motion) -> Option<&'static MotionRow> {
    let word = program.files.get(motion.file)?.part(&motion.site.keyword);
    motion_row(&Name::of(word)?)
}

impl Syntax for RapidSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        names_of(program, |bytes| words_of(&tokens_of(bytes)))
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
        let (word, _) = row_of(program, motion)?.straight?;
        let site = &motion.site;
        let mut edits = Edits::default();
        let written = file.part(&site.keyword);
        match (&literals.via, &site.via) {
            (Some((span, via)), _) => {
                replace_word(written, &circular(word), &site.keyword, &mut edits);
                edits.replace(span.clone(), via.clone());
            }
            (None, via) => {
                replace_word(written, word, &site.keyword, &mut edits);
                if let Some((span, _)) = via {
                    leave_out(span, &site.keyword, &mut edits);
                }
            }
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        if let (Some(zone), Zone::Exact) = (&site.zone, motion.zone) {
            edits.replace(zone.clone(), "z0");
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn is_written_flat(&self) -> bool {
        true
    }

    fn replaced(
        &self,
        file: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let turn = [rotation.w, rotation.i, rotation.j, rotation.k];
        let place = wanted.position_mm.as_slice();
        let list = |values: &[f64], decimals: usize| {
            let values = values.iter().map(|value| format!("{value:.decimals$}"));
            format!("[{}]", values.collect::<Vec<String>>().join(","))
        };
        let decimals = [options.position_decimals, options.quaternion_decimals];
        // Names in the aggregate stay.
        if let Some(parts) = &text.parts {
            let mut edits = Edits::default();
            let same_sign = match parts[1]
                .numbers
                .iter()
                .zip(turn)
                .map(|(n, t)| n.value * t)
                .sum::<f64>()
                < 0.0
            {
                true => turn.map(|part| -part),
                false => turn,
            };
            let turns = wanted.orientation.is_some();
            let values = [(place, true), (&same_sign[..], turns)];
            for ((part, (values, is_wanted)), decimals) in parts.iter().zip(values).zip(decimals) {
                if !is_wanted {
                    continue;
                }
                if part.numbers.is_empty() {
                    edits.replace(part.span.clone(), list(values, decimals));
                }
                for (number, value) in part.numbers.iter().zip(values) {
                    put(file, number, *value, decimals, Width::Free, &mut edits);
                }
            }
            return edits.applied_to_part(file.bytes(), &text.span);
        }
        let external = |axis: usize| {
            let wanted = wanted.external.get(axis).copied().flatten();
            let value = wanted.or_else(|| text.pose.external.get(axis).copied().flatten());
            value.map_or_else(|| "9E9".to_owned(), |value| value.to_string())
        };
        let axes = [0, 1, 2, 3, 4, 5].map(external).join(",");
        let configuration = &text.pose.configuration.text;
        let [place, turn] = [list(place, decimals[0]), list(&turn, decimals[1])];
        Some(format!("[{place},{turn},{configuration},[{axes}]]").into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        let site = &motion.site;
        let words = row_of(program, motion).and_then(|row| row.straight);
        if let (Some((_, word)), Some((span, _))) = (words, &site.via) {
            let written = program.files[motion.file].part(&site.keyword);
            replace_word(written, word, &site.keyword, edits);
            leave_out(span, &site.keyword, edits);
        }
    }
}

/// The word of a circle for that of a straight motion: `MoveC` for `MoveL`, `ArcC1` for `ArcL1`.
fn circular(straight: &str) -> String {
    match straight.rfind('L') {
        Some(at) => format!("{}C{}", &straight[..at], &straight[at + 1..]),
        None => straight.to_owned(),
    }
}

/// Takes the pose on a circle out; a blank stays between the word and what follows (`MoveC[[...]],p1`).
fn leave_out(via: &Range<usize>, keyword: &Range<usize>, edits: &mut Edits) {
    let blank = match via.start == keyword.end {
        true => " ",
        false => "",
    };
    edits.replace(via.clone(), blank);
}
