//! Adapter of the writer for URScript.

use std::collections::BTreeSet;

use crate::interpreter::lexing::tokens_of;
use crate::interpreter::token::words_of;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::text::number::short;
use crate::text::source::SourceFile;
use crate::urscript::grammar::WORDS;
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, names_of, replace_word};

/// Blend with which a piece passes its end: 0.1 mm. Where blends overlap the controller leaves motions out.
const PASSING: &str = "0.0001";

/// URScript.
pub(crate) struct UrScriptSyntax;

/// Makes a circle straight: another word, without the place on the circle and the mode. But for these, movep has the same parameters.
fn straight(source: &SourceFile, motion: &Motion, edits: &mut Edits) {
    let site = &motion.site;
    let Some((via, _)) = &site.via else { return };
    let keyword = &site.keyword;
    replace_word(source.part(keyword), "movep", keyword, edits);
    edits.replace(via.clone(), "");
    // Arguments after the end: acceleration, speed, blend, mode.
    let mut at = site.target_span.end;
    let rest = source.part(&(at..motion.span.end - 1));
    for (index, part) in rest.split(|byte| *byte == b',').enumerate() {
        let text = part.trim_ascii();
        if text.starts_with(b"mode") || index == 4 && !text.contains(&b'=') {
            edits.replace(at - 1..at + part.len(), "");
        }
        at += part.len() + 1;
    }
}

impl Syntax for UrScriptSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        names_of(program, |bytes| words_of(&tokens_of(&WORDS.marks, bytes)))
    }

    fn writes_circles(&self) -> bool {
        true
    }

    fn is_written_flat(&self) -> bool {
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
        let site = &motion.site;
        let mut edits = Edits::default();
        match &literals.via {
            Some((span, via)) => edits.replace(span.clone(), via.clone()),
            None => straight(file, motion, &mut edits),
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        match &site.zone {
            Some(zone) => edits.replace(zone.clone(), PASSING),
            None => {
                let close = motion.span.end - 1;
                edits.replace(close..close, format!(", r={PASSING}"));
            }
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn replaced(
        &self,
        _: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let (place, turn) = (1e-3 * wanted.position_mm, rotation.scaled_axis());
        let decimals = [options.position_decimals + 3, options.quaternion_decimals];
        let place = place.iter().map(|part| short(*part, decimals[0]));
        let turn = turn.iter().map(|part| short(*part, decimals[1]));
        let numbers: Vec<String> = place.chain(turn).collect();
        Some(format!("p[{}]", numbers.join(",")).into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        straight(&program.files[motion.file], motion, edits);
    }
}
