//! Words of SINUMERIK and Heidenhain programs beside their places, and the tools of APT.

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::words::{Kind, NOTHING_ADDED, STANDS, Word};

/// Words of a program, by its lines.
pub(crate) fn control_words(read: &RobotRead<'_>) -> Vec<Word> {
    let of_line: fn(&str) -> Vec<(Kind, String)> = match read.program.language {
        Language::Siemens => of_siemens,
        Language::Heidenhain => of_heidenhain,
        Language::Apt => of_apt,
        _ => return Vec::new(),
    };
    let words = read.lines_in_capitals().flat_map(|(line, text)| {
        let found = with_one_path_mode(of_line(&text)).into_iter();
        found.map(move |(kind, text)| Word { line, kind, text })
    });
    words.collect()
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

/// `LOADTL/2` and `TURRET/2`, without what is said of the tool; speeds of the spindle are compared along the path.
fn of_apt(line: &str) -> Vec<(Kind, String)> {
    let text = line.split("$$").next().unwrap_or_default();
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let tool = text.split_once('/').and_then(|(word, tool)| {
        let tool = tool.split(',').next().unwrap_or_default();
        matches!(word, "LOADTL" | "TURRET").then(|| format!("{word}/{}", number(tool)))
    });
    tool.map(|tool| (Kind::Tool, tool)).into_iter().collect()
}

/// A number without leading zeros; else as it is.
fn number(text: &str) -> String {
    text.parse::<f64>()
        .map_or(text.to_owned(), |number| number.to_string())
}

/// What the spindle does behind a word with M.
fn rotation(number: &str) -> Option<&'static str> {
    Some(match number {
        "3" | "13" => "M3",
        "4" | "14" => "M4",
        "5" => "M5",
        "6" => STANDS,
        "19" => "M19",
        "70" => "M70",
        _ => return None,
    })
}

/// A word with M, which may turn or stop the spindle or end the program.
fn of_m(number: &str) -> impl Iterator<Item = (Kind, String)> {
    let kind = match number {
        "2" | "17" | "30" => Kind::End,
        _ => Kind::Other,
    };
    let rotation = rotation(number).map(|word| (Kind::Rotation, word.to_owned()));
    rotation
        .into_iter()
        .chain(std::iter::once((kind, format!("M{number}"))))
}

/// `TOOL CALL 1 Z S5000 DL+0.1`: the tool, what it adds to that, and its speed; words with M and `STOP` anywhere; `CYCL DEF 32.1 T0.5`: by how
/// much corners may be left; `CYCL DEF 9.1 DWELL 2`.
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
    let is_tool = |word: &&&str| !matches!(**word, "X" | "Y" | "Z") && !word.starts_with('S');
    if let Some(tool) = called.filter(is_tool) {
        found.push((Kind::Tool, format!("TOOL CALL {}", number(tool))));
        found.push((Kind::Rotation, STANDS.to_owned()));
    }
    for (index, word) in words.iter().enumerate() {
        let m = word.strip_prefix('M').map(str::parse::<u32>);
        match (*word, m) {
            ("STOP", _) => found.push((Kind::Other, "STOP".to_owned())),
            ("DWELL" | "V.ZEIT", _) => found.push((Kind::Other, words[index..].join(" "))),
            (_, Some(Ok(m))) => found.extend(of_m(&m.to_string())),
            _ => {}
        }
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
            true => NOTHING_ADDED.to_owned(),
            false => added.join(" "),
        };
        found.push((Kind::Edge, added));
    }
    found
}

/// `T="MILL"`, `D1`, `S6000`, `M3`, `G55`, `G642 ADIS=1`, `CYCLE832(0.5, 1)`, `G4 F2`.
fn of_siemens(line: &str) -> Vec<(Kind, String)> {
    let mut found = Vec::new();
    let words = words_of(line);
    let waits = words
        .iter()
        .any(|(name, value)| name == "G" && value == "4");
    for (name, value) in words {
        let word = match (name.as_str(), value.as_str()) {
            ("F" | "S", value) if waits => (Kind::Other, format!("G4 {name}{value}")),
            ("T", value) => (Kind::Tool, format!("T{}", value.trim_start_matches('='))),
            ("D", value) => (Kind::Edge, format!("D{}", value.trim_start_matches('='))),
            ("S" | "S1", value) => (Kind::Speed, format!("S{}", value.trim_start_matches('='))),
            ("M", value) => {
                found.extend(of_m(value));
                continue;
            }
            ("SPOS" | "SPOSA", _) => (Kind::Rotation, name.clone()),
            ("G", "54" | "55" | "56" | "57" | "500") => (Kind::Frame, format!("G{value}")),
            ("G", number) if number.len() == 3 && number.starts_with('5') => {
                (Kind::Frame, format!("G{value}"))
            }
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
        assert_eq!(said("N10G0X10Y5S6000M03"), ["S6000", "M3", "M3"]);
        assert_eq!(
            said("T=\"END MILL\" M6 D1"),
            ["T\"END MILL\"", STANDS, "M6", "D1"]
        );
        assert_eq!(said("T = \"MILL\"M6"), ["T\"MILL\"", STANDS, "M6"]);
        assert_eq!(
            said("S1=3000 M1=3 G642 ADIS=0.5 ; S1"),
            ["S3000", "G642", "ADIS=0.5"]
        );
        assert_eq!(said("CYCLE832(0.5, 1, 1)"), ["CYCLE832(0.5,1,1)"]);
    }
}
