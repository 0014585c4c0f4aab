//! The positions of a program: its section `/POS`, their arm configurations and their names.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::Vector3;

use crate::ls::lines::{Fault, index_of, number_of};
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::site::{Declaration, DeclarationCopy, PoseText};
use crate::model::target::{Configuration, PoseTarget};
use crate::text::number::{NumberText, Width};
use crate::text::source::SourceFile;

/// Content of a position.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Held {
    /// A pose, an index of the declarations.
    Pose(usize),
    /// The joints of group 1, degrees or mm.
    Joints(Vec<f64>),
    /// Unusable position, with the reason.
    Nothing(&'static str),
}

/// A position of the program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Position {
    pub span: Range<usize>,
    pub held: Held,
    /// User frame of group 1; `None` for `F`, the frame in force.
    pub frame: Option<u32>,
    pub tool: Option<u32>,
    /// External axes of group 1 and all of further groups.
    pub external: Vec<Option<f64>>,
}

/// The positions of a program by number, and the poses among them.
#[derive(Debug, Default)]
pub(crate) struct Positions {
    pub all: BTreeMap<u32, Position>,
    pub faults: Vec<Fault>,
}

const GIVE: &str = "give the program as the controller prints it";

impl Positions {
    /// Parses a section of a file; poses are added to `declarations`.
    pub(crate) fn of(
        bytes: &[u8],
        section: Range<usize>,
        file: usize,
        declarations: &mut Vec<Declaration>,
    ) -> Self {
        let mut found = Self::default();
        let (mut at, mut closes) = (section.start, true);
        while let Some(start) = (at..section.end).find(|at| !bytes[*at].is_ascii_whitespace()) {
            let rest = &bytes[start..section.end];
            let end_of_line = rest.iter().position(|byte| *byte == b'\n');
            let first = &rest[..end_of_line.unwrap_or(rest.len())];
            let head = first.iter().position(|byte| *byte == b'{');
            let close = match closes {
                true => rest.iter().position(|byte| *byte == b'}'),
                false => None,
            };
            closes = close.is_some();
            let (Some(head), Some(close), true) = (head, close, rest.starts_with(b"P[")) else {
                let span = start..start + first.trim_ascii_end().len();
                found
                    .faults
                    .push((span, "a position begins `P[number]{` and ends `};`", GIVE));
                at = start + first.len();
                continue;
            };
            let end = start + close + 1;
            let end = match bytes.get(end) {
                Some(b';') if end < section.end => end + 1,
                _ => end,
            };
            let name = first[..head].iter().rposition(|byte| *byte == b']');
            let name = name.and_then(|close| index_of(bytes, &(start + 1..start + close + 1)));
            match name {
                Some((number, name)) => {
                    let body = start + head + 1..start + close;
                    let parts = Parts::of(bytes, body);
                    let position = parts.position(bytes, file, start..end, name, declarations);
                    if found.all.insert(number, position).is_some() {
                        let span = start..start + head;
                        let twice = "there is a position of this number above";
                        found.faults.push((span, twice, "number it otherwise"));
                    }
                }
                None => {
                    found
                        .faults
                        .push((start..start + head, "the position has no number", GIVE))
                }
            }
            at = end;
        }
        found
    }
}

/// Members of a position.
#[derive(Default)]
struct Parts {
    group: u32,
    frame: Option<u32>,
    tool: Option<u32>,
    configuration: Option<String>,
    numbers: BTreeMap<&'static str, NumberText>,
    joints: Vec<f64>,
    external: Vec<External>,
    wrong: Option<&'static str>,
}

/// An external axis, or an axis of a further group.
struct External {
    value: f64,
    /// Number that can be replaced.
    number: Option<NumberText>,
}

const LETTERS: [&str; 6] = ["X", "Y", "Z", "W", "P", "R"];

impl Parts {
    fn of(bytes: &[u8], body: Range<usize>) -> Self {
        let mut parts = Self::default();
        let mut at = body.start;
        while at < body.end {
            let byte = bytes[at];
            if byte.is_ascii_whitespace() || byte == b',' {
                at += 1;
                continue;
            }
            let is_key = |byte: &u8| byte.is_ascii_alphanumeric();
            let length = bytes[at..body.end].iter().take_while(|b| is_key(b)).count();
            let key = at..at + length;
            let sign = (key.end..body.end).find(|at| !matches!(bytes[*at], b' ' | b'\t'));
            let sign = sign.filter(|at| length > 0 && matches!(bytes[*at], b':' | b'='));
            let Some(sign) = sign else {
                parts.wrong = Some("it holds more than groups, frames, configuration and axes");
                return parts;
            };
            at = parts.value(bytes, key, sign + 1, body.end);
        }
        parts
    }

    /// Reads the value of a key; says where it ends.
    fn value(&mut self, bytes: &[u8], key: Range<usize>, from: usize, end: usize) -> usize {
        let name = &bytes[key];
        if let Some(group) = name.strip_prefix(b"GP") {
            self.group = number_of(group).unwrap_or(0.0) as u32;
            return from;
        }
        let quoted = (from..end).find(|at| !bytes[*at].is_ascii_whitespace());
        if name == b"CONFIG" {
            let inside = quoted.filter(|at| bytes[*at] == b'\'').map(|at| at + 1);
            let close = inside.and_then(|from| (from..end).find(|at| bytes[*at] == b'\''));
            let (Some(inside), Some(close)) = (inside, close) else {
                self.wrong = Some("its CONFIG is not in quotes");
                return end;
            };
            let text = String::from_utf8_lossy(&bytes[inside..close]).into_owned();
            if self.group <= 1 {
                if !is_configuration(&text) {
                    self.wrong = Some(
                        "its CONFIG is not of letters and three turns, as 'N U T, 0, 0, 0': F or N, L or R, U or D, T or B",
                    );
                }
                self.configuration = Some(text);
            }
            return close + 1;
        }
        let until = (from..end).find(|at| matches!(bytes[*at], b',' | b'\n' | b'\r'));
        let until = until.unwrap_or(end);
        let text = &bytes[from..until];
        let mut words = text
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        let (first, unit) = (words.next().unwrap_or_default(), words.next());
        if matches!(name, b"UF" | b"UT") {
            let number = number_of(first).map(|number| number as u32);
            match (name, self.group <= 1) {
                (b"UF", true) => self.frame = number,
                (b"UT", true) => self.tool = number,
                _ => {}
            }
            if number.is_none() && first != b"F" {
                self.wrong = Some("UF and UT are numbers, or F");
            }
            return until;
        }
        let Some(value) = number_of(first) else {
            self.wrong = Some("it is not taught: it holds no numbers");
            return until;
        };
        let start = from
            + text
                .iter()
                .position(|b| !b.is_ascii_whitespace())
                .unwrap_or(0);
        // Columns stay, with one blank behind the sign.
        let span = (from + 1).min(start)..start + first.len();
        self.number(name, unit, NumberText { span, value });
        until
    }

    fn number(&mut self, name: &[u8], unit: Option<&[u8]>, number: NumberText) {
        let letter = LETTERS.iter().find(|letter| letter.as_bytes() == name);
        let numbered = name.len() == 2 && name[1].is_ascii_digit();
        let wanted: &[u8] = match letter {
            Some(&"X" | &"Y" | &"Z") => b"mm",
            _ => b"deg",
        };
        match (letter, name.first()) {
            (Some(letter), _) if self.group <= 1 => {
                if unit != Some(wanted) {
                    self.wrong = Some("X, Y, Z are in mm, and W, P, R in deg");
                }
                if number.value.abs() > 360.0 && wanted == b"deg" {
                    self.wrong = Some("W, P, R are from -360 to 360 deg");
                }
                self.numbers.insert(letter, number);
            }
            (None, Some(b'J')) if numbered && self.group <= 1 => self.joints.push(number.value),
            // A pose of a further group does not go evenly from number to number.
            (Some(_), _) => self.external.push(External {
                value: number.value,
                number: None,
            }),
            (None, Some(b'J' | b'E')) if numbered => self.external.push(External {
                value: number.value,
                number: Some(number),
            }),
            _ => self.wrong = Some("it holds axes that are not known"),
        }
    }

    fn position(
        self,
        bytes: &[u8],
        file: usize,
        span: Range<usize>,
        name: Range<usize>,
        declarations: &mut Vec<Declaration>,
    ) -> Position {
        let numbers: Vec<&NumberText> = LETTERS
            .iter()
            .filter_map(|letter| self.numbers.get(letter))
            .collect();
        let external: Vec<Option<f64>> = (self.external.iter())
            .map(|axis| Some(axis.value))
            .collect();
        let held = match (self.wrong, numbers.as_slice()) {
            (Some(reason), _) => Held::Nothing(reason),
            (None, []) if !self.joints.is_empty() => Held::Joints(self.joints.clone()),
            (None, &[_, _, _, _, _, _]) if self.configuration.is_none() => Held::Nothing(
                "it has no CONFIG: with which posture the arm gets there is not stated",
            ),
            (None, &[x, y, z, w, p, r]) => {
                let angles = [w, p, r].map(|number| number.value);
                match OrientationText::Wpr.rotation_of(&angles) {
                    Some(orientation) => {
                        let text = self.configuration.clone().unwrap_or_default();
                        let turns = text.split(',').filter_map(|part| part.trim().parse().ok());
                        let open = (span.start..span.end).find(|at| bytes[*at] == b'{');
                        declarations.push(Declaration {
                            statement: span.clone(),
                            name,
                            text: PoseText {
                                file,
                                whole: open.unwrap_or(span.start)..span.end,
                                position: [x.clone(), y.clone(), z.clone()],
                                orientation: [w, p, r].map(NumberText::clone).to_vec(),
                                unit_mm: 1.0,
                                convention: OrientationText::Wpr,
                                external: (self.external.iter())
                                    .map(|axis| axis.number.clone())
                                    .collect(),
                                width: Width::Kept,
                            },
                            pose: PoseTarget {
                                position_mm: Vector3::new(x.value, y.value, z.value),
                                orientation,
                                configuration: Configuration {
                                    numbers: turns.collect(),
                                    text,
                                },
                                external: external.clone(),
                            },
                            keeps_value: false,
                            copy: DeclarationCopy::Statement,
                        });
                        Held::Pose(declarations.len() - 1)
                    }
                    None => Held::Nothing("its angles are not numbers"),
                }
            }
            (None, _) => {
                Held::Nothing("it is not taught: it holds neither X to R nor joints of group 1")
            }
        };
        Position {
            span,
            held,
            frame: self.frame,
            tool: self.tool,
            external,
        }
    }
}

// Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure".

/// Letters of which a configuration has at most one each: wrist, side, elbow, and whether the arm reaches over its back.
const PAIRS: [[u8; 2]; 4] = [*b"FN", *b"LR", *b"UD", *b"TB"];

/// True if a text is an arm configuration: letters, and the turns of three axes.
pub(crate) fn is_configuration(text: &str) -> bool {
    let mut parts = text.split(',');
    let letters = parts.next().unwrap_or_default().bytes();
    let letters: Vec<u8> = letters.filter(|byte| *byte != b' ').collect();
    let pair = |letter: &u8| PAIRS.iter().position(|pair| pair.contains(letter));
    let pairs: Option<BTreeSet<usize>> = letters.iter().map(pair).collect();
    let turns: Vec<bool> = parts
        .map(|part| part.trim().parse::<i8>().is_ok())
        .collect();
    // A letter twice, or with its opposite, is one pair.
    let is_once = pairs.is_some_and(|pairs| pairs.len() == letters.len() && !pairs.is_empty());
    is_once && turns == [true; 3]
}

// Names that people give positions: `P[3:"corner"]` in the section `/POS`, `P[3:corner]` in a motion.

/// Number and name in `P[3:"corner"]`, with which a text begins; none without a name.
fn named(text: &str) -> Option<(u32, &str)> {
    let inside = text.strip_prefix("P[")?;
    let end = inside.find(']')?;
    let (number, name) = inside[..end].split_once(':')?;
    let name = name.trim().trim_matches('"').trim();
    Some((number.trim().parse().ok()?, name)).filter(|_| !name.is_empty())
}

/// The names of the positions of a program.
pub(crate) fn position_names(source: &SourceFile) -> BTreeMap<u32, String> {
    let lines = (1..=source.line_count()).filter_map(|line| source.line(line));
    let heads = lines
        .map(<[u8]>::trim_ascii)
        .filter(|line| line.starts_with(b"P[") && line.ends_with(b"{"));
    let named = heads.filter_map(|line| {
        let text = String::from_utf8_lossy(line);
        let (number, name) = named(&text)?;
        Some((number, name.to_owned()))
    });
    named.collect()
}

/// Name of the end of a motion of a TP program: `P[3]: corner`.
pub(crate) fn named_end(
    source: &SourceFile,
    motion: &Motion,
    names: &BTreeMap<u32, String>,
) -> Option<String> {
    let text = String::from_utf8_lossy(source.part(&motion.site.target_span));
    if let Some((number, name)) = named(&text) {
        return Some(format!("P[{number}]: {name}"));
    }
    let number = text.strip_prefix("P[")?.split([']', ':']).next()?;
    let number: u32 = number.trim().parse().ok()?;
    Some(format!("P[{number}]: {}", names.get(&number)?))
}
