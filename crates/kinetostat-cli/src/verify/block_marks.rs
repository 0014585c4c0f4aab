//! Marks of the words of a block: for G-code, SINUMERIK and Heidenhain.

use kinetostat_formats::{BlockWord, Language, mode_of};

use crate::job::reading::work_offset;
use crate::verify::marks::{Kind, Marks, NOTHING_ADDED, Value};

/// G words of G-code that are in the path that was read, with feeds and speeds of the spindle: rounds of cycles, units, planes, kinds of
/// feed.
const IN_PATH: &[&str] = &[
    "0", "1", "2", "3", "5", "5.1", "5.2", "5.3", "7", "8", "17", "18", "19", "20", "21", "70",
    "71", "73", "74", "76", "80", "81", "82", "83", "84", "85", "86", "87", "88", "89", "90",
    "90.1", "91", "91.1", "92.1", "92.2", "92.3", "93", "94", "95", "96", "97", "98", "99",
];

/// Words that are done behind the motion of their block.
const BEHIND_MOTIONS: [&str; 9] = ["M0", "M1", "M2", "M5", "M9", "M17", "M30", "M60", "M99"];

/// Value of a block without a slash.
const NO_SLASH: &str = "no /";

impl Marks<'_> {
    /// The marks of a block, of G-code where no language is named.
    pub(crate) fn add_block(&mut self, line: usize, of: Option<Language>, words: &[BlockWord]) {
        let found = match of {
            None => of_gcode(words),
            Some(Language::Heidenhain) => of_heidenhain(words),
            Some(_) => of_siemens(words),
        };
        let has_slash = words.first().is_some_and(|word| word.name == "/");
        let slash = if has_slash { "/" } else { NO_SLASH };
        let is_move = self.before_line(line, false) < self.before_line(line, true);
        let slash = is_move.then(|| (Kind::Optional, slash.to_owned()));
        for (kind, text) in found.into_iter().chain(slash) {
            let is_behind = BEHIND_MOTIONS.contains(&text.as_str());
            let name = match (kind, of) {
                (Kind::PathMode, Some(language)) => mode_of(language, &text).unwrap_or_default(),
                _ => String::new(),
            };
            let place = [self.before_line(line, is_behind), line];
            self.add(place, kind, name, Value::Text(text));
        }
    }
}

/// Words of these names, each behind a blank, in this order whichever they have.
fn with(words: &[BlockWord], names: &[&str]) -> String {
    let of = |name: &&str| {
        let own = words.iter().filter(move |word| word.name == *name);
        own.map(|word| format!(" {}", word.text))
            .collect::<String>()
    };
    names.iter().map(of).collect()
}

/// All words of a block but its number.
fn joined(words: &[BlockWord]) -> String {
    let counts = |word: &&BlockWord| !matches!(word.name.as_str(), "N" | "/");
    let texts = words.iter().filter(counts).map(|word| word.text.as_str());
    texts.collect::<Vec<_>>().join(" ")
}

/// Marks of G-code with the words that belong to them: `G64 P0.5 Q0.1`, `G43 H2`, `G4 P1`.
fn of_gcode(words: &[BlockWord]) -> Vec<(Kind, String)> {
    // A call of a subprogram, and a cycle that only the control makes, are what all of their words say.
    let is_whole = |word: &BlockWord| {
        let stays = ["G65", "G74", "G76", "G84", "G87", "G88", "M98"];
        stays.contains(&word.text.as_str())
    };
    if words.iter().any(is_whole) {
        return vec![(Kind::Other, joined(words))];
    }
    let mark = |word: &BlockWord| {
        let number = word.text.get(1..).unwrap_or_default();
        let (kind, belong): (Kind, &[&str]) = match (word.name.as_str(), number) {
            ("G", "92") => (Kind::Shift, &[]),
            ("G", "40") => (Kind::Radius, &[]),
            ("G", "41" | "42") => (Kind::Radius, &["D"]),
            ("G", "43" | "43.2" | "43.4" | "44") => (Kind::Length, &["H"]),
            ("G", "43.1") => (Kind::Length, &["X", "Y", "Z"]),
            ("G", "49") => (Kind::Length, &[]),
            ("G", "61" | "61.1") => (Kind::PathMode, &[]),
            ("G", "64") => (Kind::PathMode, &["P", "Q"]),
            ("G", "4") => (Kind::Other, &["P", "X", "U", "S"]),
            ("G", number) if IN_PATH.contains(&number) => return None,
            ("G", _) if work_offset(&word.text).is_some() => (Kind::Frame, &[]),
            ("M", number) if number.len() > 1 => (Kind::Other, &["P", "Q"]),
            ("G" | "M", _) => (Kind::Other, &[]),
            // H names a tool, too, where no T does.
            ("T", _) => (Kind::Tool, &[]),
            _ => return None,
        };
        Some((kind, format!("{}{}", word.text, with(words, belong))))
    };
    words.iter().filter_map(mark).collect()
}

/// `D1`, `M8`, `G642`, `ADIS=1`, `CYCLE832(0.5,1)`, `G4 F2`, and other words that are not in the path that was read.
fn of_siemens(words: &[BlockWord]) -> Vec<(Kind, String)> {
    let waits = words.iter().any(|word| word.text == "G4");
    let mark = |word: &BlockWord| {
        Some(match word.name.as_str() {
            "F" | "S" if waits => (Kind::Other, format!("G4 {}", word.text)),
            "D" => (Kind::Edge, word.text.replace('=', "")),
            "M" => (Kind::Other, word.text.clone()),
            "OVR" | "OVRRAP" => (Kind::Override, word.text.clone()),
            _ if mode_of(Language::Siemens, &word.text).is_some() => {
                (Kind::PathMode, word.text.clone())
            }
            _ if word.is_in_path => return None,
            _ => (Kind::Other, word.text.clone()),
        })
    };
    words.iter().filter_map(mark).collect()
}

/// Marks of Heidenhain: additions to a tool in `TOOL CALL 1 Z DL+0.1`; words with M and `STOP`; the corner tolerance `CYCL DEF
/// 32.1 T0.5`; `CYCL DEF 9.1 DWELL 2`.
fn of_heidenhain(words: &[BlockWord]) -> Vec<(Kind, String)> {
    let texts: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
    let mut found: Vec<(Kind, String)> = (words.iter())
        .filter(|word| word.name == "M" || word.name == "STOP")
        .map(|word| (Kind::Other, word.text.clone()))
        .collect();
    match texts.as_slice() {
        [_, "DEF32.1", with @ ..] => {
            found.push((Kind::PathMode, format!("cycle 32 with {}", with.join(" "))));
        }
        [_, "DEF9.1", with @ ..] => found.push((Kind::Other, with.join(" "))),
        ["CALL", ..] | ["CYCL", "CALL", ..] => found.push((Kind::Other, joined(words))),
        ["CYCL", define, ..] if define.starts_with("DEF2") && !define.contains('.') => {
            found.push((Kind::Other, joined(words)));
        }
        ["FUNCTION", "DWELL", ..] => found.push((Kind::Other, texts[1..].join(" "))),
        ["FUNCTION", ..] => found.push((Kind::Other, texts.join(" "))),
        ["TOOL", call, ..] if call.starts_with("CALL") => {
            let is_zero =
                |text: &str| text.trim_start_matches(|c: char| !c.is_ascii_digit()) == "0";
            let added = with(words, &["DL", "DR"]);
            let added = added.split_whitespace().filter(|text| !is_zero(text));
            let added: Vec<&str> = added.collect();
            found.push((
                Kind::Edge,
                match added.is_empty() {
                    true => NOTHING_ADDED.to_owned(),
                    false => added.join(" "),
                },
            ));
        }
        _ => {}
    }
    found
}
