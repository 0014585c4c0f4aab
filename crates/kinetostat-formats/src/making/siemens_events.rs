//! The words of SINUMERIK programs that are no motion.

use std::collections::BTreeSet;

use kinetostat_program::{SpindleChange, SpindleRotation};

use crate::making::event_kind::EventKind;
use crate::making::events::SourceEvent;
use crate::making::siemens_words::{Master, Purpose, is_followed, kind_of_name, late};
use crate::making::turning::Turning;
use crate::making::words::{InForce, Said, Word, Words};
use crate::siemens::block::{Block, Item, What};
use crate::siemens::declarations::define;
use crate::siemens::expression::Expression;
use crate::siemens::scan::has_change;
use crate::siemens::tokens::Token;
use crate::siemens::values::{Variables, whole};
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
