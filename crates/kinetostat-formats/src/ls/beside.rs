//! Programs that a statement makes run beside the motions, or at another time: at the end of a motion (`TB .10sec,CALL X`), while a
//! condition is watched (`MONITOR X`, `WHEN DI[1]=ON,CALL X`), behind an error (`ERROR_PROG=X`, `RESUME_PROG=X`).
//!
//! Source: FANUC Robotics, SYSTEM R-J3iB/R-30iA HandlingTool, setup and operations manual: time before and after, condition monitor,
//! automatic error recovery.

use std::ops::Range;

use crate::ls::step::name_from;
use crate::ls::table::row;
use crate::ls::words::words_of;

/// The names of such programs in a statement; none where a register says it.
pub(crate) fn run_beside(bytes: &[u8], text: &Range<usize>) -> Vec<Option<Range<usize>>> {
    let blanks = |from: usize| {
        let part = bytes.get(from..text.end).unwrap_or_default();
        from + part.len() - part.trim_ascii_start().len()
    };
    let start = blanks(text.start);
    let Some(row) = row(bytes.get(start..text.end).unwrap_or_default()) else {
        return Vec::new();
    };
    let behind = start + row.name.len();
    match row.name {
        // `MONITOR END X` ends it.
        "MONITOR" => {
            let from = blanks(behind);
            let part = bytes.get(from..text.end).unwrap_or_default();
            let ends = part.starts_with(b"END") && part.get(3).is_some_and(u8::is_ascii_whitespace);
            match ends || part.is_empty() {
                true => Vec::new(),
                false => vec![name_from(bytes, from..text.end)],
            }
        }
        "ERROR_PROG" | "RESUME_PROG" => {
            let equals = bytes.get(behind..text.end).unwrap_or_default();
            let equals = equals.iter().position(|byte| *byte == b'=');
            let name = equals.map(|at| name_from(bytes, behind + at + 1..text.end));
            name.into_iter().collect()
        }
        "J" | "L" | "C" | "WHEN" => {
            let words = words_of(bytes, &(start..text.end)).into_iter();
            let calls = words.filter(|word| bytes[word.span.clone()] == *b"CALL");
            calls
                .map(|word| name_from(bytes, word.span.end..text.end))
                .collect()
        }
        _ => Vec::new(),
    }
}
