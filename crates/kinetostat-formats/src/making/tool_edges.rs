//! Cutting edges of tools of SINUMERIK (`D2`): each has a length of its own, and a template tells one tip for each tool.
//!
//! Source: Siemens, SINUMERIK 840D sl, Fundamentals, "Tool offset call (D)": D1 counts behind a change of tools where none is programmed.

use std::collections::BTreeMap;

use kinetostat_program::{Knowledge, Path};

use crate::making::course::Course;
use crate::making::event_kind::EventKind;
use crate::making::fault::MakeError;
use crate::making::limits::MakeLanguage;
use crate::model::language::Language;

/// The edge of which the tip counts where none is programmed.
const USUAL: u64 = 1;

/// Moves with another edge of a tool than those before, once each.
pub(crate) fn other_edges(path: &Path, course: &Course, language: MakeLanguage) -> Vec<MakeError> {
    if course.language != Some(Language::Siemens) || !language.is_of_an_arm() {
        return Vec::new();
    }
    let mut edge = (USUAL, None);
    let mut of_tools: BTreeMap<Option<u32>, u64> = BTreeMap::new();
    let mut faults: Vec<MakeError> = Vec::new();
    let mut events = course.events.iter().peekable();
    for (index, motion) in path.moves.iter().enumerate() {
        let order = course.of_move(index, motion.line);
        while let Some((_, event)) = events.next_if(|(at, _)| *at < order) {
            if event.kind == EventKind::Comment {
                continue;
            }
            if let Some(stated) = edge_of(&event.text) {
                edge = (stated, Some(event.line));
            }
        }
        if motion.known == Knowledge::Nothing {
            continue;
        }
        let own = *of_tools.entry(course.tool_at(order)).or_insert(edge.0);
        let line = edge.1.unwrap_or(motion.line);
        if own != edge.0 && faults.iter().all(|fault| fault.line != Some(line)) {
            faults.push(MakeError::at(
                line,
                format!("D{} is another edge of the tool than D{own} before, with a tip of its own, and a template tells one tip for each tool", edge.0),
                "write one program for each edge, or leave the word out where the tip is the same",
            ));
        }
    }
    faults
}

/// The edge that words of a block name: that of D, or the usual one of another tool.
fn edge_of(text: &str) -> Option<u64> {
    let code = text.split(';').next().unwrap_or_default();
    let words: Vec<&str> = code
        .split(|c: char| c.is_whitespace() || c == '(')
        .collect();
    let number = |word: &&str| {
        let digits = word.strip_prefix(['D', 'd'])?;
        digits.trim_start_matches('=').parse().ok()
    };
    let changes = |word: &&str| {
        ["M6", "M06"]
            .iter()
            .any(|own| word.eq_ignore_ascii_case(own))
    };
    (words.iter().find_map(number)).or(words.iter().any(changes).then_some(USUAL))
}
