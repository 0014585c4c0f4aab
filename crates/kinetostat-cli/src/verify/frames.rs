//! Words of a program that move its places as the control has it set up, and not as the program says.

use kinetostat_program::{Path, Program, ReadOptions};

use crate::verify::other_word::{FaultKind, Lines, OtherWord};

/// Frames of G-code, in the order of their origins under `[reading]`.
const FRAMES: [&str; 9] = [
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

/// Lengths and radii of the tool that the control adds.
const OFFSETS: [&str; 6] = ["G43", "G43.1", "G43.2", "G44", "G41", "G42"];

/// Before the first place is known it says where the machine stands, in a frame that it moves.
const SHIFT: &str = "G92";

/// Modes in which the control follows the path: from exact stops to rounded corners.
const PATH_MODES: [&str; 3] = ["G61", "G61.1", "G64"];

/// The words that only one of both programs has. Frames whose origins are stated are where the programs are read, and the first of
/// them is in force without a word.
pub(crate) fn other_words(
    original: (&Program, &Path),
    verified: (&Program, &Path),
    reading: &ReadOptions,
) -> Vec<OtherWord> {
    let known = |(program, path): (&Program, &Path)| {
        let first = path.moves.first().map_or(usize::MAX, |first| first.line);
        let mut found = words(program);
        // Behind a place that is known a shift is in the path that was read.
        found.retain(|(word, line)| word != SHIFT || *line < first);
        found
    };
    let (of_original, of_verified) = (known(original), known(verified));
    let is_unknown = |word: &str| match FRAMES.iter().position(|frame| *frame == word) {
        Some(index) => reading.work_offsets_mm[index].is_none(),
        None => OFFSETS.contains(&word) || word == SHIFT || is_path_mode(word),
    };
    let has_frame = |words: &[(String, usize)]| {
        let mut words = words.iter();
        words.any(|(word, _)| FRAMES.contains(&word.as_str()))
    };
    let only = |own: &[(String, usize)], others: &[(String, usize)]| -> Vec<(String, usize)> {
        let missing = own.iter().filter(|(word, _)| {
            let known = others.iter().any(|(other, _)| other == word);
            let usual = word == FRAMES[0] && !has_frame(others);
            is_unknown(word) && !known && !usual
        });
        missing.cloned().collect()
    };
    let mut added = only(&of_verified, &of_original);
    // Whoever stops at corners follows the path no worse.
    added.retain(|(word, _)| !word.starts_with("G61"));
    let left_out = only(&of_original, &of_verified);
    let added = added.into_iter();
    let added = added.map(|(word, line)| only_in_one(&word, [Some(line), None]));
    let left_out = left_out.into_iter();
    let left_out = left_out.map(|(word, line)| only_in_one(&word, [None, Some(line)]));
    added.chain(left_out).collect()
}

/// A word that only one of both has, and what follows from it.
fn only_in_one(word: &str, lines: Lines) -> OtherWord {
    let what = OtherWord::only_in_one(word, lines);
    let is_frame = FRAMES.contains(&word) || word == SHIFT;
    let follows = if is_path_mode(word) {
        "the control follows the path otherwise, and leaves its corners by what that allows; nothing here has that in it"
    } else if word == SHIFT {
        "before the program has said where the tool is, it shifts the frame by what the control knows"
    } else if is_frame {
        "it is not known where the control has this frame (state its origin with --work-offset if it is the one that the program is made for)"
    } else {
        "the control moves the tool by what its table has there"
    };
    let fault = is_frame.then_some(FaultKind::Frame);
    OtherWord::new(word, fault, lines, format!("{what}: {follows}"))
}

fn is_path_mode(word: &str) -> bool {
    PATH_MODES.contains(&word.split(' ').next().unwrap_or_default())
}

/// Words with G, each with the first line that has it.
fn words(program: &Program) -> Vec<(String, usize)> {
    let mut found: Vec<(String, usize)> = Vec::new();
    for line in 1..=program.line_count() {
        let text = String::from_utf8_lossy(program.line_bytes(line).unwrap_or_default());
        for word in words_of(&text) {
            if !found.iter().any(|(known, _)| *known == word) {
                found.push((word, line));
            }
        }
    }
    found
}

/// Words with G of a line, without blanks, leading zeros and zeros behind the point.
fn words_of(line: &str) -> Vec<String> {
    let mut rest = line.chars().filter(|c| !c.is_whitespace()).peekable();
    let mut found = Vec::new();
    let mut depth = 0_usize;
    while let Some(c) = rest.next() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ';' if depth == 0 => break,
            'g' | 'G' if depth == 0 => {
                let mut number = String::new();
                while let Some(digit) = rest.next_if(|c| c.is_ascii_digit() || *c == '.') {
                    number.push(digit);
                }
                if let Ok(value) = number.parse::<f64>() {
                    let tolerances = match value == 64.0 {
                        true => tolerances(rest.clone()),
                        false => String::new(),
                    };
                    found.push(format!("G{value}{tolerances}"));
                }
            }
            _ => {}
        }
    }
    found
}

/// By how much the control may leave the path, as G64 has it behind itself on its line: ` P0.5 Q0.1`.
fn tolerances(rest: impl Iterator<Item = char>) -> String {
    let mut rest = rest
        .take_while(|c| !matches!(c, '(' | ';'))
        .map(|c| c.to_ascii_uppercase())
        .peekable();
    let mut found = String::new();
    while let Some(c) = rest.next() {
        if matches!(c, 'P' | 'Q') {
            let mut number = String::new();
            while let Some(digit) = rest.next_if(|c| c.is_ascii_digit() || matches!(c, '.' | '-')) {
                number.push(digit);
            }
            let number = number.parse::<f64>().map_or(number, |x| x.to_string());
            found.push_str(&format!(" {c}{number}"));
        }
    }
    found
}
