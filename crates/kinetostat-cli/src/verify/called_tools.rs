//! Tools and spindle speeds that programs of Heidenhain controls and APT call for.

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::other_word::{FaultKind, Lines, OtherWord};

/// Something that is called for, and its line.
#[derive(Clone, PartialEq)]
struct Call {
    what: FaultKind,
    word: String,
    line: usize,
}

/// Calls that only one of both programs makes.
pub(crate) fn called_tools(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    forces_from_cut: bool,
) -> Vec<OtherWord> {
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
        let fault = Some(call.what).filter(|what| *what == FaultKind::Tool || forces_from_cut);
        let text = OtherWord::only_in_one(&call.word, lines);
        OtherWord::new(call.word, fault, lines, text)
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
    let file = &read.program.files[read.path.file];
    let of_line: fn(&str) -> Vec<(FaultKind, String)> = match read.program.language {
        Language::Heidenhain => of_heidenhain,
        Language::Apt => of_apt,
        _ => return Vec::new(),
    };
    let lines = (1..=file.line_count()).filter_map(|line| Some((line, file.line(line)?)));
    lines
        .flat_map(|(line, bytes)| {
            let text = String::from_utf8_lossy(bytes).to_ascii_uppercase();
            let found = of_line(&text).into_iter();
            found.map(move |(what, word)| Call { what, word, line })
        })
        .collect()
}

/// `TOOL CALL 1 Z S5000 DL+0.1`, and M3 and M4 anywhere.
fn of_heidenhain(line: &str) -> Vec<(FaultKind, String)> {
    let text = line.split(';').next().unwrap_or_default();
    let mut words: Vec<&str> = text.split_whitespace().collect();
    if words
        .first()
        .is_some_and(|word| word.parse::<u64>().is_ok())
    {
        words.remove(0);
    }
    let turns = |word: &&&str| matches!(**word, "M3" | "M03" | "M13" | "M4" | "M04" | "M14");
    let mut found: Vec<(FaultKind, String)> = (words.iter().filter(turns))
        .map(|word| (FaultKind::Spindle, word.replace("M0", "M")))
        .collect();
    if let ["TOOL", "CALL", rest @ ..] = &words[..] {
        for (index, word) in rest.iter().enumerate() {
            let is_tool = index == 0 && !matches!(*word, "X" | "Y" | "Z");
            if is_tool {
                found.push((FaultKind::Tool, format!("TOOL CALL {word}")));
            } else if word.starts_with("DL") || word.starts_with("DR") {
                found.push((FaultKind::Tool, (*word).to_owned()));
            } else if word.starts_with('S') {
                found.push((FaultKind::Spindle, (*word).to_owned()));
            }
        }
    }
    found
}

/// `LOADTL/2` and `TURRET/2`; speeds of the spindle are compared along the path.
fn of_apt(line: &str) -> Vec<(FaultKind, String)> {
    let text = line.split("$$").next().unwrap_or_default();
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let loads = ["LOADTL/", "TURRET/"];
    match loads.iter().any(|word| text.starts_with(word)) {
        true => vec![(FaultKind::Tool, text)],
        false => Vec::new(),
    }
}
