//! Tools, spindle speeds and path modes of SINUMERIK programs, and of Heidenhain's what a call adds to a tool, by what is in force at
//! each cut.

use std::collections::BTreeSet;

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::in_force::InForce;
use crate::verify::other_word::{FaultKind, Lines, OTHER_PATH_MODE, OtherWord};

/// Words of which the last one is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Tool,
    Edge,
    Speed,
    Rotation,
    PathMode,
}

const KINDS: [Kind; 5] = [
    Kind::Tool,
    Kind::Edge,
    Kind::Speed,
    Kind::Rotation,
    Kind::PathMode,
];

/// At the start, and behind a change of tools, which stops the spindle.
const STANDS: &str = "no M3 or M4 since the change of tools";

impl Kind {
    fn fault(self, forces_from_cut: bool) -> Option<FaultKind> {
        match self {
            Self::Tool | Self::Edge => Some(FaultKind::Tool),
            Self::Speed => forces_from_cut.then_some(FaultKind::Spindle),
            Self::Rotation => Some(FaultKind::Rotation),
            Self::PathMode => None,
        }
    }

    /// Whether a cut may be made with one word for another: with a spindle of which the original says nothing.
    fn may_be(self, of_original: &str) -> bool {
        self == Self::Rotation && !matches!(of_original, "M3" | "M4")
    }

    fn follows(self) -> String {
        match self {
            Self::PathMode => format!(": {OTHER_PATH_MODE}"),
            _ => String::new(),
        }
    }
}

/// Words that only one of both programs has, and cuts that are made with others; `cut_lines` are lines of the program verified and
/// of the original.
pub(crate) fn control_words(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    (cut_lines, forces_from_cut): (&[[usize; 2]], bool),
) -> Vec<OtherWord> {
    let [own, of_original] = [verified, original].map(all_words);
    let mut found = Vec::new();
    for kind in KINDS {
        let fault = kind.fault(forces_from_cut);
        // What the spindle does where nothing is cut is no fault.
        let fault_of_word = fault.filter(|_| kind != Kind::Rotation);
        let follows = kind.follows();
        let of_kind = |all: &[(usize, Kind, String)]| -> Vec<(usize, String)> {
            let own = all.iter().filter(|(_, of, _)| *of == kind);
            own.map(|(line, _, word)| (*line, word.clone())).collect()
        };
        let [own, of_original] = [&own, &of_original].map(|all| of_kind(all));
        let in_force = |all: &[(usize, String)]| InForce::new("none", all.iter().cloned());
        let may_be = |_: &str, wanted: &str| kind.may_be(wanted);
        let elsewhere = in_force(&own).elsewhere(&in_force(&of_original), cut_lines, may_be);
        let is_said = |word: &str| {
            let mut said = elsewhere.iter();
            said.any(|found| found.word == word || found.of_original == word)
        };
        let mut only =
            |ours: &[(usize, String)], theirs: &[(usize, String)], lines: fn(usize) -> Lines| {
                let known: BTreeSet<&str> = theirs.iter().map(|(_, word)| word.as_str()).collect();
                let mut seen: BTreeSet<&str> = BTreeSet::new();
                for (line, word) in ours {
                    if known.contains(word.as_str()) || is_said(word) || !seen.insert(word) {
                        continue;
                    }
                    let text = format!("{}{follows}", OtherWord::only_in_one(word, lines(*line)));
                    found.push(OtherWord::new(
                        word.as_str(),
                        fault_of_word,
                        lines(*line),
                        text,
                    ));
                }
            };
        only(&own, &of_original, |line| [Some(line), None]);
        only(&of_original, &own, |line| [None, Some(line)]);
        found.extend(elsewhere.into_iter().map(|found| {
            let stands = found.word == "S0";
            let fault = fault.or_else(|| stands.then_some(FaultKind::Rotation));
            found.other_word(fault, &follows)
        }));
    }
    found
}

fn all_words(read: &RobotRead<'_>) -> Vec<(usize, Kind, String)> {
    let of_line: fn(&str) -> Vec<(Kind, String)> = match read.program.language {
        Language::Siemens => of_siemens,
        Language::Heidenhain => of_heidenhain,
        _ => return Vec::new(),
    };
    let words = read.lines_in_capitals().flat_map(|(line, text)| {
        let found = with_one_path_mode(of_line(&text)).into_iter();
        found.map(move |(kind, word)| (line, kind, word))
    });
    let at_start = (0, Kind::Rotation, STANDS.to_owned());
    std::iter::once(at_start).chain(words).collect()
}

/// What a line says of the path mode is one word, in whatever order it says it.
fn with_one_path_mode(words: Vec<(Kind, String)>) -> Vec<(Kind, String)> {
    let (mut modes, mut found): (Vec<_>, Vec<_>) = words
        .into_iter()
        .partition(|(kind, _)| *kind == Kind::PathMode);
    modes.sort_by(|a, b| b.1.cmp(&a.1));
    let modes: Vec<String> = modes.into_iter().map(|(_, word)| word).collect();
    if !modes.is_empty() {
        found.push((Kind::PathMode, modes.join(" ")));
    }
    found
}

/// `TOOL CALL 1 Z S5000 DL+0.1`: what it adds to the tool, and its speed; M3 to M5 anywhere; `CYCL DEF 32.1 T0.5`: by how much corners may
/// be left.
fn of_heidenhain(line: &str) -> Vec<(Kind, String)> {
    let text = line.split(';').next().unwrap_or_default();
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut found = Vec::new();
    if let Some(cycle) = words.iter().position(|word| *word == "32.1") {
        let with = words[cycle + 1..].join(" ");
        found.push((Kind::PathMode, format!("cycle 32 with {with}")));
    }
    let call = words.windows(2).position(|pair| pair == ["TOOL", "CALL"]);
    let called = call.and_then(|call| words.get(call + 2));
    if called.is_some_and(|word| !matches!(*word, "X" | "Y" | "Z") && !word.starts_with('S')) {
        found.push((Kind::Rotation, STANDS.to_owned()));
    }
    for word in &words {
        let rotation = match *word {
            "M3" | "M03" | "M13" => "M3",
            "M4" | "M04" | "M14" => "M4",
            "M5" | "M05" => "M5",
            "M19" => "M19",
            "M6" | "M06" => STANDS,
            _ => continue,
        };
        found.push((Kind::Rotation, rotation.to_owned()));
    }
    if call.is_some() {
        let mut added: Vec<String> = Vec::new();
        for word in &words {
            for name in ["DL", "DR", "S"] {
                let value = word.strip_prefix(name).map(str::parse::<f64>);
                match (value, name) {
                    (Some(Ok(value)), "S") => found.push((Kind::Speed, format!("S{value}"))),
                    (Some(Ok(value)), _) if value != 0.0 => added.push(format!("{name}{value:+}")),
                    _ => {}
                }
            }
        }
        added.sort();
        let added = match added.is_empty() {
            true => "no DL and DR".to_owned(),
            false => added.join(" "),
        };
        found.push((Kind::Edge, added));
    }
    found
}

/// `T="MILL"`, `D1`, `S6000`, `M3`, `G642 ADIS=1`, `CYCLE832(0.5, 1)`.
fn of_siemens(line: &str) -> Vec<(Kind, String)> {
    let mut found = Vec::new();
    for (name, value) in words_of(line) {
        let word = match (name.as_str(), value.as_str()) {
            ("T", value) => (Kind::Tool, format!("T{}", value.trim_start_matches('='))),
            ("D", value) => (Kind::Edge, format!("D{}", value.trim_start_matches('='))),
            ("S" | "S1", value) => (Kind::Speed, format!("S{}", value.trim_start_matches('='))),
            ("M", "3" | "4" | "5") => (Kind::Rotation, format!("M{value}")),
            ("M", "6") => (Kind::Rotation, STANDS.to_owned()),
            ("M", "19" | "70") => (Kind::Rotation, format!("M{value}")),
            ("SPOS" | "SPOSA", _) => (Kind::Rotation, name.clone()),
            ("G", "60" | "64" | "601" | "602" | "603" | "641" | "642" | "643" | "644" | "645") => {
                (Kind::PathMode, format!("G{value}"))
            }
            ("ADIS" | "ADISPOS", value) => (Kind::PathMode, format!("{name}{value}")),
            ("CYCLE832", value) => (Kind::PathMode, format!("CYCLE832{value}")),
            _ => continue,
        };
        found.push(word);
    }
    found
}

/// Words of a line: an address with its number (`X10`, without leading zeros), a name with `=` and what is behind it, or a name with
/// brackets.
fn words_of(line: &str) -> Vec<(String, String)> {
    let mut rest = line.chars().peekable();
    let mut found = Vec::new();
    while let Some(c) = rest.next() {
        if c == ';' {
            break;
        }
        if !c.is_ascii_alphabetic() {
            continue;
        }
        let mut name = String::from(c);
        let is_number = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-');
        let mut value = String::new();
        if rest.peek().is_some_and(is_number) {
            while let Some(digit) = rest.next_if(is_number) {
                value.push(digit);
            }
            if rest.peek() == Some(&'=') {
                // Of a certain spindle: S1=3000.
                name.push_str(&value);
                value.clear();
            } else if let Ok(number) = value.parse::<f64>() {
                value = number.to_string();
            }
        } else {
            while let Some(letter) = rest.next_if(|c| c.is_ascii_alphanumeric() || *c == '_') {
                name.push(letter);
            }
        }
        let mut ahead = rest.clone();
        while ahead.next_if(|c| c.is_whitespace()).is_some() {}
        if value.is_empty() && ahead.next_if_eq(&'=').is_some() {
            while ahead.next_if(|c| c.is_whitespace()).is_some() {}
            rest = ahead;
            value.push('=');
            if let Some(quote) = rest.next_if_eq(&'"') {
                value.push(quote);
                for next in rest.by_ref() {
                    value.push(next);
                    if next == quote {
                        break;
                    }
                }
            } else {
                while let Some(next) = rest.next_if(|c| !c.is_whitespace() && *c != ';') {
                    value.push(next);
                }
            }
        } else if value.is_empty() && rest.peek() == Some(&'(') {
            for next in rest.by_ref() {
                if !next.is_whitespace() {
                    value.push(next);
                }
                if next == ')' {
                    break;
                }
            }
        }
        found.push((name, value));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_line_without_blanks() {
        let said = |line: &str| -> Vec<String> {
            of_siemens(line).into_iter().map(|(_, word)| word).collect()
        };
        assert_eq!(said("N10G0X10Y5S6000M03"), ["S6000", "M3"]);
        assert_eq!(
            said("T=\"END MILL\" M6 D1"),
            ["T\"END MILL\"", STANDS, "D1"]
        );
        assert_eq!(said("T = \"MILL\"M6"), ["T\"MILL\"", STANDS]);
        assert_eq!(
            said("S1=3000 M1=3 G642 ADIS=0.5 ; S1"),
            ["S3000", "G642", "ADIS=0.5"]
        );
        assert_eq!(said("CYCLE832(0.5, 1, 1)"), ["CYCLE832(0.5,1,1)"]);
    }
}
