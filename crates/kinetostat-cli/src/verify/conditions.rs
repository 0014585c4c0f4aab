//! Feeds, speeds and tools that differ from those of the original, in words.

use kinetostat_machining::{Condition, OtherCondition, Warning, WarningCode};

use crate::verify::other_language::SPINDLE;
use crate::verify::other_word::{FaultKind, OtherWord};

/// What differs, as a sentence; `source` says where the line of the original came from.
pub(crate) fn said(other: &OtherCondition, forces_from_cut: bool, source: &str) -> String {
    let what = match other.condition {
        Condition::Feed => FaultKind::Feed.words(),
        Condition::Spindle => FaultKind::Spindle.words(),
        Condition::Rotation => FaultKind::Rotation.words(),
        Condition::Tool => FaultKind::Tool.words(),
    };
    let [first, last] = other.lines;
    let lines = match first == last {
        true => format!("at line {first}"),
        false => format!("at lines {first} to {last}"),
    };
    let follows = match (other.condition, forces_from_cut) {
        (Condition::Feed | Condition::Spindle, true) => {
            ": the forces that the program is corrected for come from that cut"
        }
        (Condition::Tool, _) => ": its length may be another",
        _ => "",
    };
    format!(
        "{what} {lines}: {}, where the original has {} (line {}{source} there){follows}.",
        other.of_program, other.of_original, other.line_of_original
    )
}

/// What differs and is no fault.
pub(crate) fn warnings(words: &[OtherWord]) -> Vec<Warning> {
    let words = words.iter().filter(|word| word.fault.is_none());
    let words = words.map(|word| {
        let code = match word.word == SPINDLE {
            true => WarningCode::SpindleNotStarted,
            false => WarningCode::OtherThanOriginal,
        };
        Warning::new(code, word.text.clone())
    });
    words.collect()
}
