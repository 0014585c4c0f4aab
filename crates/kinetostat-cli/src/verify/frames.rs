//! Words of a program that move its places as the control has it set up, and not as the program says.

use std::collections::BTreeSet;

use kinetostat_program::{Path, Program, ReadOptions};

use crate::verify::in_force::InForce;
use crate::verify::other_word::{FaultKind, Lines, OTHER_PATH_MODE, OtherWord};

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

/// The words that only one of both programs has, and those with which the lines of cuts (of the program verified, of the
/// original) are not made in both. Frames whose origins are stated are where the programs are read, and the first of
/// them is in force without a word.
pub(crate) fn other_words(
    original: (&Program, &Path),
    verified: (&Program, &Path),
    (reading, cut_lines): (&ReadOptions, &[[usize; 2]]),
) -> Vec<OtherWord> {
    let [own, of_original] = [verified.0, original.0].map(all_words);
    let is_stated = |word: &str| {
        let frame = FRAMES.iter().position(|frame| *frame == word);
        frame.is_some_and(|index| reading.work_offsets_mm[index].is_some())
    };
    let mut elsewhere = Vec::new();
    for kind in KINDS {
        let [own, of_original] = [&own, &of_original].map(|all| kind.in_force(all));
        let same = |own: &str, of_original: &str| match kind {
            // Places in frames with stated origins are compared as places.
            Kind::Frame => is_stated(own) && is_stated(of_original),
            // Whoever stops at corners follows the path no worse.
            Kind::PathMode => own.starts_with("G61"),
            Kind::Length | Kind::Radius => false,
        };
        let found = own.elsewhere(&of_original, cut_lines, same);
        elsewhere.extend(found.into_iter().map(|found| (kind, found)));
    }
    let is_said = |word: &str| {
        let mut said = elsewhere.iter();
        said.any(|(_, found)| found.word == word || found.of_original == word)
    };
    let known = |all: &[(usize, String)], path: &Path| {
        let first = path.moves.first().map_or(usize::MAX, |first| first.line);
        let mut found = first_words(all);
        let used = in_force_on_moves(all, path);
        // Behind a place that is known a shift is in the path that was read; a word that another one follows before any move says nothing.
        found.retain(|(word, line)| match word == SHIFT {
            true => *line < first,
            false => used.contains(word),
        });
        found
    };
    let (of_original, of_verified) = (known(&of_original, original.1), known(&own, verified.1));
    let is_unknown = |word: &str| match FRAMES.iter().position(|frame| *frame == word) {
        Some(index) => reading.work_offsets_mm[index].is_none(),
        None => OFFSETS.contains(&code(word)) || word == SHIFT || is_path_mode(word),
    };
    let has_frame = |words: &[(String, usize)]| {
        let mut words = words.iter();
        words.any(|(word, _)| FRAMES.contains(&word.as_str()))
    };
    let only = |own: &[(String, usize)], others: &[(String, usize)]| -> Vec<(String, usize)> {
        let missing = own.iter().filter(|(word, _)| {
            let known = others.iter().any(|(other, _)| other == word);
            let usual = word == FRAMES[0] && !has_frame(others);
            is_unknown(word) && !known && !usual && !is_said(word)
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
    let mut found: Vec<OtherWord> = added.chain(left_out).collect();
    found.extend((elsewhere.into_iter()).map(|(kind, found)| found.other_word(kind.fault(), "")));
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

/// Words of which the last one is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Frame,
    Length,
    Radius,
    PathMode,
}

const KINDS: [Kind; 4] = [Kind::Frame, Kind::Length, Kind::Radius, Kind::PathMode];

impl Kind {
    fn of(word: &str) -> Option<Self> {
        match code(word) {
            frame if FRAMES.contains(&frame) => Some(Self::Frame),
            "G43" | "G43.1" | "G43.2" | "G44" | "G49" => Some(Self::Length),
            "G40" | "G41" | "G42" => Some(Self::Radius),
            _ if is_path_mode(word) => Some(Self::PathMode),
            _ => None,
        }
    }

    /// What is in force without a word.
    fn usual(self) -> &'static str {
        match self {
            Self::Frame => FRAMES[0],
            Self::Length => "G49",
            Self::Radius => "G40",
            Self::PathMode => "what the control is set up for",
        }
    }

    fn in_force(self, all: &[(usize, String)]) -> InForce {
        let own = all.iter().filter(|(_, word)| Self::of(word) == Some(self));
        InForce::new(self.usual(), own.cloned())
    }

    /// Both programs have such words, so that one of them is wrong.
    fn fault(self) -> Option<FaultKind> {
        match self {
            Self::Frame => Some(FaultKind::Frame),
            Self::Length | Self::Radius => Some(FaultKind::Tool),
            Self::PathMode => None,
        }
    }
}

/// Words that are in force on moves.
fn in_force_on_moves(all: &[(usize, String)], path: &Path) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for kind in KINDS {
        let in_force = kind.in_force(all);
        for motion in &path.moves {
            let word = in_force.on(motion.line);
            if !used.contains(word) {
                used.insert(word.to_owned());
            }
        }
    }
    used
}

/// A word that only one of both has, and what follows from it.
fn only_in_one(word: &str, lines: Lines) -> OtherWord {
    let what = OtherWord::only_in_one(word, lines);
    let is_frame = FRAMES.contains(&word) || word == SHIFT;
    let follows = if is_path_mode(word) {
        OTHER_PATH_MODE
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
    PATH_MODES.contains(&code(word))
}

/// A word without what belongs to it.
fn code(word: &str) -> &str {
    word.split(' ').next().unwrap_or_default()
}

/// Each word with the first line that has it.
fn first_words(all: &[(usize, String)]) -> Vec<(String, usize)> {
    let mut found: Vec<(String, usize)> = Vec::new();
    for (line, word) in all {
        if !found.iter().any(|(known, _)| known == word) {
            found.push((word.clone(), *line));
        }
    }
    found
}

/// Words with G that this looks at, with their lines.
fn all_words(program: &Program) -> Vec<(usize, String)> {
    let lines = 1..=program.line_count();
    let words = lines.flat_map(|line| {
        let text = String::from_utf8_lossy(program.line_bytes(line).unwrap_or_default());
        let words = words_of(&text).into_iter();
        words.map(move |word| (line, word))
    });
    let is_looked_at = |word: &str| word == SHIFT || Kind::of(word).is_some();
    words.filter(|(_, word)| is_looked_at(word)).collect()
}

/// Words with G of a line, without blanks, leading zeros and zeros behind the point, each with the words that belong to it:
/// `G64 P0.5 Q0.1`, `G43 H2`.
fn words_of(line: &str) -> Vec<String> {
    let letters = letters_of(line);
    let codes = letters.iter().filter(|(letter, _)| *letter == 'G');
    let with = |belong: &str| -> String {
        // In one order, whichever they have.
        let of = |belongs: char| letters.iter().filter(move |(letter, _)| *letter == belongs);
        let own = belong.chars().flat_map(of);
        own.map(|(letter, number)| format!(" {letter}{number}"))
            .collect()
    };
    let word = |(_, number): &(char, String)| {
        let belong = match number.as_str() {
            "64" => "PQ",
            "43" | "43.2" | "44" => "H",
            "43.1" => "XYZ",
            "41" | "42" => "D",
            _ => "",
        };
        format!("G{number}{}", with(belong))
    };
    codes.map(word).collect()
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
