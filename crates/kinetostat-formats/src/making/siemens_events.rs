//! The words of SINUMERIK programs that are no motion, and their effects.

use std::collections::BTreeSet;

use kinetostat_program::{SpeedMode, SpindleChange, SpindleRotation};

use crate::making::events::{EventKind, SourceEvent};
use crate::making::words::{InForce, Said, Turning, Word, Words, kind_of_m, word_of_m};
use crate::siemens::block::{Block, Item, What};
use crate::siemens::declarations::define;
use crate::siemens::expression::Expression;
use crate::siemens::reader::has_change;
use crate::siemens::table::row;
use crate::siemens::tokens::Token;
use crate::siemens::turned_axes::OTHER_AXES;
use crate::siemens::values::{Variables, whole};
use crate::table::Treatment;
use crate::text::source::SourceFile;

/// The events of a file with motions on some of its lines, and where its spindle begins to turn otherwise.
pub(crate) fn events_of_siemens(
    source: &SourceFile,
    moving: &BTreeSet<usize>,
) -> (Vec<SourceEvent>, Vec<SpindleChange>) {
    let mut walk = Walk {
        source,
        variables: Variables::default(),
        master: Master {
            turning: Turning::default(),
            number: Some(1),
        },
        changes_by_m6: has_change(source.bytes()),
    };
    let lines = 1..=source.line_count();
    let events = lines
        .flat_map(|line| walk.line(line, moving.contains(&line)))
        .collect();
    (events, walk.master.turning.changes())
}

struct Walk<'w> {
    source: &'w SourceFile,
    variables: Variables,
    master: Master,
    /// True if tools change at M6, otherwise at T.
    changes_by_m6: bool,
}

impl Walk<'_> {
    fn line(&mut self, line: usize, moves: bool) -> Vec<SourceEvent> {
        let bytes = self.source.bytes();
        let range = self.source.range_of(line);
        let Ok((block, tokens)) = Block::of(bytes, range.clone()) else {
            let text = String::from_utf8_lossy(self.source.part(&range)).into_owned();
            return vec![SourceEvent::words_alone(
                line,
                EventKind::Other,
                text.trim(),
            )];
        };
        let has = |letter: &[u8], numbers: &[f64]| {
            let is = |item: &Item| self.is(item, letter, numbers);
            block.items.iter().any(is)
        };
        let changes_tool = match self.changes_by_m6 {
            true => has(b"M", &[6.0]),
            false => has(b"T", &[]),
        };
        let mut purpose = Purpose {
            moves,
            dwells: has(b"G", &[4.0]),
            limits: has(b"G", &[25.0, 26.0]),
            stops_late: false,
            dwell_s: None,
        };
        if changes_tool {
            self.master.turning.turn(SpindleRotation::Stopped);
        }
        let mut said: Vec<Said> = Vec::new();
        for item in &block.items {
            if let Some(own) = self.item(item, &tokens, &mut purpose) {
                said.push(own);
            }
        }
        if self.changes_by_m6 && !changes_tool {
            let of_tools = said.iter_mut().filter(|own| own.kind == EventKind::Tool);
            of_tools.for_each(|own| own.word = Word::NextTool);
        }
        let comment = comment(self.source.part(&(block.span.end..range.end)));
        if let Some(comment) = comment {
            said.push(Said::early(EventKind::Comment, Word::Other, comment));
        }
        let texts: Vec<&str> = said.iter().map(|said| said.text.as_str()).collect();
        let words = Words {
            text: texts.join(" "),
            is_optional: block.skip,
            said,
        };
        let force = InForce {
            dwell_s: purpose.dwell_s,
            spindle: self.master.turning.now(),
        };
        self.master.turning.note(line);
        if purpose.stops_late {
            self.master.turning.turn(SpindleRotation::Stopped);
            self.master.turning.note(line + 1);
        }
        if block.skip && words.said.iter().any(|s| s.kind == EventKind::Spindle) {
            self.master.turning.forget();
        }
        words.events(line, force)
    }

    /// True if a word has this letter and one of these numbers; an empty list accepts any number.
    fn is(&self, item: &Item, letter: &[u8], numbers: &[f64]) -> bool {
        let own = self.source.part(&item.name).eq_ignore_ascii_case(letter);
        own && match &item.what {
            What::Value {
                value: Expression::Number(number),
                ..
            } => numbers.is_empty() || numbers.contains(number),
            _ => numbers.is_empty(),
        }
    }

    /// Decodes a word; `None` if it is part of a motion, or only structures the program.
    fn item(&mut self, item: &Item, tokens: &[Token], purpose: &mut Purpose) -> Option<Said> {
        let name = String::from_utf8_lossy(self.source.part(&item.name)).to_ascii_uppercase();
        let text = String::from_utf8_lossy(self.source.part(&item.span));
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        let other = |kind: EventKind| Some(Said::early(kind, Word::Other, text.clone()));
        match &item.what {
            What::Statement if matches!(name.as_str(), "DEF" | "PROC" | "EXTERN") => {
                let from = tokens.iter().position(|token| token.span == item.name)?;
                if name == "DEF" {
                    // The reader has told what is wrong with it.
                    define(self.source.bytes(), &tokens[from..], &mut self.variables).ok();
                }
                None
            }
            What::Statement => other(EventKind::Other),
            What::Name if name == "RET" => Some(late(EventKind::End, Word::Other, text)),
            What::Name | What::Call(_) => {
                if name == "SETMS" {
                    self.set_master(item);
                }
                match is_followed(&name) {
                    true => None,
                    false => other(kind_of_name(&name)),
                }
            }
            What::Value { indices, value, .. } => {
                let bytes = self.source.bytes();
                let is_parameter = name != "R" || !indices.is_empty();
                if is_parameter && self.variables.knows(name.as_bytes()) {
                    let places: Result<Vec<f64>, String> = (indices.iter())
                        .map(|index| self.variables.number(bytes, index))
                        .collect();
                    if let (Ok(places), Ok(value)) = (places, self.variables.value(bytes, value)) {
                        let own = self.source.part(&item.name);
                        self.variables.set(own, &places, value).ok();
                    }
                    return other(EventKind::Other);
                }
                if matches!(name.as_str(), "SPOS" | "SPOSA") && indices.is_empty() {
                    self.master.turning.turn(SpindleRotation::Stopped);
                }
                let number = self.variables.number(bytes, value).ok();
                self.master.value(&name, text, number, purpose)
            }
        }
    }

    /// The number of the master spindle, from SETMS.
    fn set_master(&mut self, item: &Item) {
        self.master.number = match &item.what {
            What::Call(arguments) => arguments
                .first()
                .and_then(|argument| argument.value.as_ref())
                .and_then(|value| self.variables.number(self.source.bytes(), value).ok())
                .and_then(whole),
            _ => Some(1),
        };
        self.master.turning.forget();
    }
}

/// The text of a comment behind a block; none where nothing is in it, or the control's own words.
fn comment(bytes: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim().strip_prefix(';')?;
    (!text.is_empty() && !text.starts_with("$PATH")).then(|| text.trim().to_owned())
}

// Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Fundamentals: M0, M1, M2, M17 and M30 act behind the motion of
// their block; `M1=3` and `S1=500` are those of spindle 1; G4 takes seconds (F) or turns of the spindle (S).

/// Context of a block's words.
pub(crate) struct Purpose {
    pub moves: bool,
    pub dwells: bool,
    /// G25, G26: its numbers are limits.
    pub limits: bool,
    /// A word stops the spindle behind the motion.
    pub stops_late: bool,
    pub dwell_s: Option<f64>,
}

/// The spindle that words without another's number are of.
pub(crate) struct Master {
    pub turning: Turning,
    /// Spindle number; `None` if unknown.
    pub number: Option<u32>,
}

impl Master {
    /// A letter or a name with its number.
    pub(crate) fn value(
        &mut self,
        name: &str,
        text: String,
        number: Option<f64>,
        purpose: &mut Purpose,
    ) -> Option<Said> {
        let early = |kind: EventKind, word: Word| Some(Said::early(kind, word, text.clone()));
        let (letter, extension) = name.split_at_checked(1)?;
        let extension: Option<u32> = match extension {
            "" => Some(0),
            digits => digits.parse().ok(),
        };
        let is_master = extension == Some(0) || extension.is_some() && extension == self.number;
        match (letter, extension) {
            ("G", Some(0)) => return self.code(number.and_then(whole), text, purpose),
            ("M", Some(extension)) => {
                let number = number.and_then(whole);
                return Some(self.function(number, extension, is_master, text, purpose));
            }
            ("S", Some(_)) if purpose.limits => return early(EventKind::Spindle, Word::Other),
            ("S", Some(_)) if purpose.dwells => return early(EventKind::Dwell, Word::Other),
            ("S", Some(_)) => {
                let turns = number.is_none_or(|number| number > 0.0);
                if is_master {
                    self.turning.speed(number.filter(|_| turns));
                }
                return match is_master && turns {
                    true => early(EventKind::Spindle, Word::Spindle),
                    false => early(EventKind::Spindle, Word::Other),
                };
            }
            ("F", Some(0)) if purpose.dwells => {
                purpose.dwell_s = number.filter(|seconds| *seconds >= 0.0);
                return early(EventKind::Dwell, Word::Dwell);
            }
            ("T" | "D", Some(_)) => return early(EventKind::Tool, Word::Other),
            ("H", Some(_)) => return early(EventKind::Other, Word::Other),
            _ => {}
        }
        let is_axis = |first: u8| OTHER_AXES.contains(&first) || b"XYZ".contains(&first);
        let first = name.bytes().next().unwrap_or_default();
        let is_coordinate = extension.is_some() && is_axis(first);
        match is_coordinate && !purpose.limits || is_followed(name) {
            true => None,
            false => early(kind_of_name(name), Word::Other),
        }
    }

    /// A G code.
    fn code(&mut self, number: Option<u32>, text: String, purpose: &Purpose) -> Option<Said> {
        let number = number?;
        let (kind, word) = match number {
            4 if purpose.dwells => (EventKind::Dwell, Word::Dwell),
            // The places are those of the tool's centre.
            41 | 42 => (EventKind::Other, Word::Other),
            96 | 961 => {
                self.turning
                    .count(SpeedMode::ConstantSurface { most_rpm: None });
                (EventKind::Spindle, Word::Other)
            }
            97 | 971 => {
                self.turning.count(SpeedMode::Constant);
                (EventKind::Spindle, Word::Spindle)
            }
            // They take it back, too.
            93..=95 => {
                self.turning.count(SpeedMode::Constant);
                return None;
            }
            505..=599 => return None,
            _ if is_followed(&format!("G{number}")) => return None,
            _ => (EventKind::Other, Word::Other),
        };
        Some(Said::early(kind, word, text))
    }

    /// An M function, of a spindle where its address has an extension.
    fn function(
        &mut self,
        number: Option<u32>,
        extension: u32,
        is_master: bool,
        text: String,
        purpose: &mut Purpose,
    ) -> Said {
        let of_spindle = matches!(number, Some(3..=5 | 19 | 40..=45 | 70));
        let Some(number) = number.filter(|_| extension == 0 || of_spindle) else {
            return Said::early(EventKind::Other, Word::Other, text);
        };
        if of_spindle && !is_master {
            return Said::early(EventKind::Spindle, Word::Other, text);
        }
        match number {
            3 => self.turning.turn(SpindleRotation::Clockwise),
            4 => self.turning.turn(SpindleRotation::CounterClockwise),
            // The control puts it out with the motion, and waits for no standstill. Here it comes behind the motion, as in
            // G-code: a spindle that stops while the tool still cuts does harm, a little later does none.
            5 if purpose.moves => purpose.stops_late = true,
            5 | 19 | 70 => self.turning.turn(SpindleRotation::Stopped),
            _ => {}
        }
        let (kind, word) = match number {
            17 => (EventKind::End, Word::Other),
            40..=45 | 70 => (EventKind::Spindle, Word::Other),
            // The machine's builder says what it does.
            60 => (EventKind::Other, Word::Other),
            _ => (kind_of_m(number), word_of_m(number)),
        };
        match number {
            0 | 1 | 2 | 17 | 30 => late(kind, word, text),
            5 | 9 if purpose.moves => late(kind, word, text),
            _ => Said::early(kind, word, text),
        }
    }
}

pub(crate) fn late(kind: EventKind, word: Word, text: String) -> Said {
    Said {
        is_late: true,
        ..Said::early(kind, word, text)
    }
}

/// True if a word is fully represented in positions, feeds and directions.
pub(crate) fn is_followed(name: &str) -> bool {
    row(name).is_some_and(|row| row.treatment == Treatment::Understood)
}

/// Subject of a carried word.
pub(crate) fn kind_of_name(name: &str) -> EventKind {
    match name {
        "SPOS" | "SPOSA" | "SPCON" | "SPCOF" | "SETMS" | "WAITS" | "LIMS" => EventKind::Spindle,
        _ => EventKind::Other,
    }
}
