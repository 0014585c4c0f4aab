//! Maps errors of the flat program to the lines of its source files.

use std::collections::BTreeMap;

use crate::error::ProgramError;
use crate::expanding::expanded::Origin;

/// Error of a flat block, mapped to its source line.
pub(crate) fn of_source(error: ProgramError, line: usize, file: &str) -> ProgramError {
    let (reason, remedy) = while_expanding(error.reason, error.remedy);
    let reason = match file {
        "" => reason,
        name => format!("in the subprogram '{name}': {reason}"),
    };
    ProgramError {
        line,
        reason,
        remedy,
        ..error
    }
}

/// Rewrites remedies that advise `--expand`, which is under way here.
fn while_expanding(reason: String, remedy: String) -> (String, String) {
    if !remedy.starts_with("add --expand") {
        return (reason, remedy);
    }
    let remedy = match (
        reason.contains("control structure"),
        reason.contains("variables"),
    ) {
        (true, _) => "write it in a line of its own, as in IF [#1 GT 0] GOTO 10",
        (false, true) => "write a value as a letter and an expression in brackets, as in X[#1 + 2]",
        (false, false) => {
            "this call is not followed: write M98 and P, an O word with call, or the blocks of the subprogram"
        }
    };
    let what = reason.split(';').next().unwrap_or_default();
    (what.to_owned(), remedy.to_owned())
}

/// `line 12` of the flat program as the line that it came from.
pub(crate) fn in_source_lines(
    text: &str,
    origins: &[Origin],
    files: &BTreeMap<usize, String>,
) -> String {
    const WORD: &str = "line ";
    let mut made = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(WORD) {
        let (before, behind) = rest.split_at(at + WORD.len());
        made.push_str(before);
        let digits = behind.bytes().take_while(u8::is_ascii_digit).count();
        let (number, behind) = behind.split_at(digits);
        let origin = number.parse::<usize>().ok();
        match origin.and_then(|line| origins.get(line.checked_sub(1)?)) {
            Some(origin) => {
                made.push_str(&origin.line.to_string());
                match files.get(&origin.file).map_or("", String::as_str) {
                    "" => {}
                    file => made.push_str(&format!(" of the subprogram '{file}'")),
                }
            }
            None => made.push_str(number),
        }
        rest = behind;
    }
    made + rest
}
