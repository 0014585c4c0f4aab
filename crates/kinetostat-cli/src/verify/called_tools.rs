//! Tools that programs of Heidenhain controls and APT call for.

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::other_word::{FaultKind, Lines, OtherWord};

/// Something that is called for, and its line.
#[derive(Clone, PartialEq)]
struct Call {
    word: String,
    line: usize,
}

/// Calls that only one of both programs makes.
pub(crate) fn called_tools(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Vec<OtherWord> {
    let (own, of_original) = (calls(verified), calls(original));
    let only = |ours: &[Call], theirs: &[Call]| -> Vec<Call> {
        let is_known = |call: &Call| theirs.iter().any(|other| other.word == call.word);
        let mut found: Vec<Call> = Vec::new();
        for call in ours.iter().filter(|call| !is_known(call)) {
            if !found.iter().any(|known| known.word == call.word) {
                found.push(call.clone());
            }
        }
        found
    };
    let found = |call: Call, lines: Lines| {
        let text = OtherWord::only_in_one(&call.word, lines);
        OtherWord::new(call.word, Some(FaultKind::Tool), lines, text)
    };
    let added = only(&own, &of_original).into_iter().map(|call| {
        let lines = [Some(call.line), None];
        found(call, lines)
    });
    let left_out = only(&of_original, &own).into_iter().map(|call| {
        let lines = [None, Some(call.line)];
        found(call, lines)
    });
    added.chain(left_out).collect()
}

fn calls(read: &RobotRead<'_>) -> Vec<Call> {
    let of_line: fn(&str) -> Option<String> = match read.program.language {
        Language::Heidenhain => of_heidenhain,
        Language::Apt => of_apt,
        _ => return Vec::new(),
    };
    let calls = read.lines_in_capitals();
    calls
        .filter_map(|(line, text)| of_line(&text).map(|word| Call { word, line }))
        .collect()
}

/// `TOOL CALL 1 Z S5000`: the tool.
fn of_heidenhain(line: &str) -> Option<String> {
    let text = line.split(';').next().unwrap_or_default();
    let words: Vec<&str> = text.split_whitespace().collect();
    let at = words.windows(2).position(|pair| pair == ["TOOL", "CALL"])?;
    let tool = words
        .get(at + 2)
        .filter(|word| !matches!(**word, "X" | "Y" | "Z"))?;
    Some(format!("TOOL CALL {}", number(tool)))
}

/// A number without leading zeros; else as it is.
fn number(text: &str) -> String {
    text.parse::<f64>()
        .map_or(text.to_owned(), |number| number.to_string())
}

/// `LOADTL/2` and `TURRET/2`, without what is said of the tool; speeds of the spindle are compared along the path.
fn of_apt(line: &str) -> Option<String> {
    let text = line.split("$$").next().unwrap_or_default();
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let (word, tool) = text.split_once('/')?;
    let tool = tool.split(',').next().unwrap_or_default();
    matches!(word, "LOADTL" | "TURRET").then(|| format!("{word}/{}", number(tool)))
}
