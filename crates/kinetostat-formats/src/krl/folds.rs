//! FOLDs: what the pendant shows of the statements in them. They are carried; nothing here trusts their text.

use std::ops::Range;

use crate::interpreter::token::TokenFile;
use crate::krl::lex::{closes, opens};
use crate::model::frame::FrameUse;

/// For each line the line that opens the fold around it.
pub(crate) fn folds_of(file: &TokenFile<'_>) -> Vec<Option<usize>> {
    let mut open: Vec<usize> = Vec::new();
    let mut around = Vec::with_capacity(file.lines.len());
    for (index, line) in file.lines.iter().enumerate() {
        let comment = line.comment.as_ref().map(|span| file.source.part(span));
        if comment.is_some_and(closes) {
            open.pop();
        }
        around.push(open.last().copied());
        if comment.is_some_and(opens) {
            open.push(index);
        }
    }
    around
}

/// The number behind `Tool[` or `Base[` in the text of a fold.
fn shown(text: &str, array: &str) -> Option<u32> {
    let (_, rest) = text.split_once(array)?;
    rest.split(']').next()?.trim().parse().ok()
}

/// Contradiction between the text of a motion's fold and its statements.
pub(crate) fn contradiction(text: &[u8], tool: &FrameUse, base: &FrameUse) -> Option<String> {
    let text = String::from_utf8_lossy(text).to_uppercase();
    for (frame, array, in_force) in [(tool, "TOOL[", "TOOL_DATA["), (base, "BASE[", "BASE_DATA[")] {
        let in_force = shown(&frame.name, in_force);
        if let (Some(shown), Some(in_force)) = (shown(&text, array), in_force)
            && shown != in_force
        {
            let word = match array {
                "TOOL[" => "Tool",
                _ => "Base",
            };
            return Some(format!(
                "the text of the FOLD says {word}[{shown}], its statements set {}: the statements count",
                frame.name
            ));
        }
    }
    None
}

/// The comment of the line that opens a fold.
pub(crate) fn text_of<'f>(file: &'f TokenFile<'_>, line: usize) -> &'f [u8] {
    let span: Range<usize> = file.lines[line].comment.clone().unwrap_or(0..0);
    file.source.part(&span)
}

/// Limit of the lines of a file that are reported as unpaired folds.
const MOST_TOLD: usize = 100;

/// Lines (counted from 1) of folds that are not opened or not closed, and what is wrong with each: no controller minds, but the
/// pendant shows other folds than are meant.
pub(crate) fn not_paired(file: &TokenFile<'_>) -> Vec<(usize, &'static str)> {
    let mut open = Vec::new();
    let mut found = Vec::new();
    for line in &file.lines {
        let Some(span) = &line.comment else {
            continue;
        };
        let comment = file.source.part(span);
        if opens(comment) {
            open.push(span.start);
        } else if closes(comment) && open.pop().is_none() {
            found.push((span.start, "no FOLD is open that this ENDFOLD could close"));
        }
    }
    found.extend(open.into_iter().map(|at| (at, "this FOLD has no ENDFOLD")));
    found.sort_unstable();
    found.truncate(MOST_TOLD);
    let line_of = |(at, message)| (file.source.line_of(at), message);
    found.into_iter().map(line_of).collect()
}
