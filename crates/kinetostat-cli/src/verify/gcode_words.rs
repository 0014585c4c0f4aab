//! Words of G-code beside its places.

use kinetostat_program::{Path, Program, ReadOptions};

use crate::verify::other_word::OtherWord;
use crate::verify::words::{Kind, Word, Words, compared};

/// Frames of G-code, in the order of their origins under `[reading]`.
const FRAMES: [&str; 9] = [
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

/// Words that are in the path that was read, with feeds and speeds of the spindle: rounds of cycles, units, planes, kinds of feed.
const IN_PATH: &[&str] = &[
    "0", "1", "2", "3", "5", "5.1", "5.2", "5.3", "7", "8", "17", "18", "19", "20", "21", "70",
    "71", "73", "74", "76", "80", "81", "82", "83", "84", "85", "86", "87", "88", "89", "90",
    "90.1", "91", "91.1", "92.1", "92.2", "92.3", "93", "94", "95", "96", "97", "98", "99",
];

/// The words that both programs do not have alike. Frames whose origins are stated are where the programs are read, and the first of
/// them is in force without a word.
pub(crate) fn other_words(
    original: (&Program, &Path),
    verified: (&Program, &Path),
    (reading, cut_lines): (&ReadOptions, &[[usize; 2]]),
) -> Vec<OtherWord> {
    let is_stated = |word: &str| {
        let frame = FRAMES.iter().position(|frame| *frame == word);
        frame.is_some_and(|index| reading.work_offsets_mm[index].is_some())
    };
    let [own, of_original] = [verified, original].map(all_words);
    let mut found = compared(&own, &of_original, cut_lines, &is_stated);
    found.extend(optional_cut((original.0, verified.0), cut_lines));
    found
}

/// The first cut that the control leaves out where a switch says so, and not in the original.
fn optional_cut(
    (original, verified): (&Program, &Program),
    cut_lines: &[[usize; 2]],
) -> Option<OtherWord> {
    let is_optional = |program: &Program, line: usize| {
        let text = program.line_bytes(line).unwrap_or_default();
        text.trim_ascii_start().starts_with(b"/")
    };
    let differs =
        |lines: &&[usize; 2]| is_optional(verified, lines[0]) && !is_optional(original, lines[1]);
    let all = cut_lines.iter().filter(differs).count();
    let [line, there] = *cut_lines.iter().find(differs)?;
    let more = match all {
        1 => String::new(),
        _ => format!(" and {} more", all - 1),
    };
    let text = format!(
        "/ begins line {line}{more}, line {there} of the original does not: where the control is switched to leave such blocks out, they are not made"
    );
    Some(OtherWord::new("/", None, [Some(line), Some(there)], text))
}

fn all_words((program, path): (&Program, &Path)) -> Words {
    let first = path.moves.first().map_or(usize::MAX, |first| first.line);
    let lines = 1..=program.line_count();
    let words = lines.flat_map(|line| {
        let text = String::from_utf8_lossy(program.line_bytes(line).unwrap_or_default());
        let words = words_of(&text).into_iter();
        words.map(move |(kind, text)| Word { line, kind, text })
    });
    Words {
        // Behind a place that is known a shift is in the path that was read.
        all: words
            .filter(|word| word.kind != Kind::Shift || word.line < first)
            .collect(),
        move_lines: path.moves.iter().map(|motion| motion.line).collect(),
        has_loops: false,
    }
}

/// Words of a line, without blanks, leading zeros and zeros behind the point, each with the words that belong to it: `G64 P0.5 Q0.1`,
/// `G43 H2`, `G4 P1`.
fn words_of(line: &str) -> Vec<(Kind, String)> {
    let letters = letters_of(line);
    let with = |belong: &str| -> String {
        // In one order, whichever they have.
        let of = |belongs: char| letters.iter().filter(move |(letter, _)| *letter == belongs);
        let own = belong.chars().flat_map(of);
        own.map(|(letter, number)| format!(" {letter}{number}"))
            .collect()
    };
    let word = |(letter, number): &(char, String)| {
        let (kind, belong) = match (*letter, number.as_str()) {
            ('G', "92") => (Kind::Shift, ""),
            ('G', "40") => (Kind::Radius, ""),
            ('G', "41" | "42") => (Kind::Radius, "D"),
            ('G', "43" | "43.2" | "43.4" | "44") => (Kind::Length, "H"),
            ('G', "43.1") => (Kind::Length, "XYZ"),
            ('G', "49") => (Kind::Length, ""),
            ('G', "61" | "61.1") => (Kind::PathMode, ""),
            ('G', "64") => (Kind::PathMode, "PQ"),
            ('G', "4") => (Kind::Other, "PXUS"),
            ('G', number) if IN_PATH.contains(&number) => return None,
            ('G', number) if FRAMES.iter().any(|frame| frame[1..] == *number) => (Kind::Frame, ""),
            ('M', number) if number.len() > 1 => (Kind::Other, "PQ"),
            ('G' | 'M', _) => (Kind::Other, ""),
            // H names a tool, too, where no T does.
            ('T', _) => (Kind::Tool, ""),
            _ => return None,
        };
        Some((kind, format!("{letter}{number}{}", with(belong))))
    };
    letters.iter().filter_map(word).collect()
}

/// Letters of a line with the numbers behind them; comments are none of it.
fn letters_of(line: &str) -> Vec<(char, String)> {
    let mut rest = line.chars().filter(|c| !c.is_whitespace()).peekable();
    let mut found = Vec::new();
    let mut depth = 0_usize;
    while let Some(c) = rest.next() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ';' if depth == 0 => break,
            letter if depth == 0 && letter.is_ascii_alphabetic() => {
                let mut number = String::new();
                let is_digit = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
                while let Some(digit) = rest.next_if(is_digit) {
                    number.push(digit);
                }
                if let Ok(value) = number.parse::<f64>() {
                    found.push((letter.to_ascii_uppercase(), value.to_string()));
                }
            }
            _ => {}
        }
    }
    found
}
