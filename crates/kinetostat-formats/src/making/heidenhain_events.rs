//! The words of Heidenhain programs that are no motion.
//!
//! Source: HEIDENHAIN, user's manuals of TNC 426 to TNC 640: which M functions act at the start of their block and which at its
//! end ([`function`]), M13 and M14 (spindle and coolant), STOP, cycle 9 and FUNCTION DWELL (seconds).

use kinetostat_program::{SpindleChange, SpindleRotation};

use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::path_words::has_words;
use crate::heidenhain::table::{Function, function};
use crate::heidenhain::words::{Value, Word as Written};
use crate::making::events::{Coolant, EventAction, EventKind, SourceEvent};
use crate::making::words::{InForce, Said, Turning, Word, Words, kind_of_m, word_of_m};
use crate::text::source::{SourceFile, in_one_line};

/// The events of a file, and where its spindle begins to turn otherwise.
pub(crate) fn events_of_heidenhain(source: &SourceFile) -> (Vec<SourceEvent>, Vec<SpindleChange>) {
    let blocks = blocks_of(source.bytes());
    let mut walk = Walk {
        source,
        turning: Turning::default(),
        tool: None,
        is_aside: false,
    };
    let mut events = Vec::new();
    for (index, block) in blocks.iter().enumerate() {
        // A dwell is in two blocks, and acts in the second.
        let part = |block: &Block| dwell_part(&block.words(source.bytes()));
        let is_begun = part(block) == Some(0) && blocks.get(index + 1).and_then(part) == Some(1);
        if !is_begun {
            events.extend(walk.block(block));
        }
    }
    (events, walk.turning.changes())
}

struct Walk<'w> {
    source: &'w SourceFile,
    turning: Turning,
    /// Tool name of the last TOOL CALL.
    tool: Option<Vec<u8>>,
    /// RL or RR.
    is_aside: bool,
}

impl Walk<'_> {
    fn block(&mut self, block: &Block) -> Vec<SourceEvent> {
        let bytes = self.source.bytes();
        let words = block.words(bytes);
        let text = self.source.part(&block.text);
        let at = comment_at(text).unwrap_or(text.len());
        let comment = in_one_line(&text[at..]);
        let comment = comment.trim_start_matches([';', '*', ' ']);
        let mut said = match words.first() {
            Some(first) => self.statement(first, &words, in_one_line(&text[..at])),
            None => Vec::new(),
        };
        if !comment.is_empty() {
            said.push(Said::early(EventKind::Comment, Word::Other, comment));
        }
        // One word may be two things, as M13 is.
        let mut texts: Vec<&str> = said.iter().map(|said| said.text.as_str()).collect();
        texts.retain(|text| !text.is_empty());
        let force = InForce {
            dwell_s: dwell_seconds(&words),
            spindle: self.turning.now(),
        };
        // M5, and M6, too.
        let stops = |said: &Said| {
            said.is_late && (said.word == Word::SpindleStop || said.kind == EventKind::Tool)
        };
        let line = self.source.line_of(block.text.start);
        self.turning.note(line);
        if said.iter().any(stops) {
            self.turning.turn(SpindleRotation::Stopped);
            self.turning.note(line + 1);
        }
        let text = texts.join(" ");
        let words = Words {
            text,
            said,
            is_optional: block.skipped,
        };
        words.events(line, force)
    }

    /// Decodes the words of a statement beside a motion.
    fn statement(&mut self, first: &Written, words: &[Written], whole: String) -> Vec<Said> {
        let one = |kind: EventKind| vec![Said::early(kind, Word::Other, whole.clone())];
        let second = |names: &[&str]| {
            let word = words.get(1);
            word.is_some_and(|word| names.iter().any(|name| word.is(name)))
        };
        match first.letters.letters() {
            b"BEGIN" | b"END" | b"BLK" | b"CC" | b"LBL" | b"TRANS" => Vec::new(),
            b"L" | b"LN" | b"LP" | b"C" | b"CP" | b"CR" | b"CT" | b"CTP" | b"M" | b"F"
            | b"STOP" => self.path(words),
            b"TOOL" if second(&["CALL"]) => self.tool(words, whole),
            b"TOOL" if second(&["DEF"]) => {
                vec![Said::early(EventKind::Tool, Word::NextTool, whole)]
            }
            b"TOOL" => one(EventKind::Tool),
            b"CYCL" | b"CYCLE" => match cycle_of(words) {
                // Coordinate transformations are contained in the positions.
                Some((7 | 8 | 10 | 11 | 19 | 247, _)) => Vec::new(),
                Some((9, _)) => vec![Said::early(EventKind::Dwell, Word::Dwell, whole)],
                Some((13, _)) => {
                    self.turning.turn(SpindleRotation::Stopped);
                    one(EventKind::Spindle)
                }
                _ => one(EventKind::Other),
            },
            b"FUNCTION" => match () {
                () if second(&["TCPM"]) => Vec::new(),
                () if second(&["DWELL"]) => {
                    vec![Said::early(EventKind::Dwell, Word::Dwell, whole)]
                }
                () if second(&["RESET"]) && words.get(2).is_some_and(|word| word.is("TCPM")) => {
                    Vec::new()
                }
                () => one(EventKind::Other),
            },
            _ => one(EventKind::Other),
        }
    }

    /// TOOL CALL: another tool, its allowances, the speed of the spindle.
    fn tool(&mut self, words: &[Written], text: String) -> Vec<Said> {
        let called = words.get(1).filter(|word| word.value != Value::None);
        if let Some(word) = called {
            let name = self.source.part(&word.span).to_ascii_uppercase();
            if self.tool.replace(name.clone()).as_ref() != Some(&name) {
                // A tool change stops the spindle.
                self.turning.turn(SpindleRotation::Stopped);
            }
        }
        let is_of_tool = |word: &Written| word.is("DL") || word.is("DR");
        let speed = words.iter().find(|word| word.is("S"));
        if called.is_some() || speed.is_none() || words.iter().any(is_of_tool) {
            let tool = Said::early(EventKind::Tool, Word::Other, text);
            let speed = speed.map(|word| self.speed(word, String::new()));
            return std::iter::once(tool).chain(speed).collect();
        }
        speed
            .map(|word| self.speed(word, text))
            .into_iter()
            .collect()
    }

    fn speed(&mut self, word: &Written, text: String) -> Said {
        let turns = word.value().is_none_or(|speed| speed > 0.0);
        self.turning.speed(word.value().filter(|_| turns));
        let does = match turns {
            true => Word::Spindle,
            false => Word::Other,
        };
        Said::early(EventKind::Spindle, does, text)
    }

    /// The words of a path block, and of one of functions alone.
    fn path(&mut self, words: &[Written]) -> Vec<Said> {
        let mut said = Vec::new();
        let mut at = 0;
        while let Some(word) = words.get(at) {
            let mut next = at + 1;
            if let (true, Some(number)) = (word.is("M"), word.whole()) {
                // Some functions have words of their own after them.
                let own = words[next..].iter().take_while(|word| !word.is("M"));
                next += own.count() * usize::from(has_words(number));
                let text = self.text(&words[at..next]);
                said.extend(self.function(number, text));
            } else if word.is("STOP") {
                let stop = Word::Action(EventAction::Stop);
                said.push(Said {
                    is_late: true,
                    ..Said::early(EventKind::Stop, stop, self.text(&words[at..next]))
                });
            } else if word.is("S") {
                let text = self.text(&words[at..next]);
                said.push(self.speed(word, text));
            } else if word.is("RL") || word.is("RR") {
                if !std::mem::replace(&mut self.is_aside, true) {
                    let text = self.text(&words[at..next]);
                    said.push(Said::early(EventKind::Other, Word::Other, text));
                }
            } else if word.is("R") && word.value() == Some(0.0) {
                self.is_aside = false;
            }
            at = next;
        }
        said
    }

    /// An M function.
    fn function(&mut self, number: u32, text: String) -> Vec<Said> {
        match number {
            3 | 13 => self.turning.turn(SpindleRotation::Clockwise),
            4 | 14 => self.turning.turn(SpindleRotation::CounterClockwise),
            19 => self.turning.turn(SpindleRotation::Stopped),
            _ => {}
        }
        let is_late = function(number) == Function::AtEnd;
        let said = |kind: EventKind, word: Word, text: String| Said {
            is_late,
            ..Said::early(kind, word, text)
        };
        match number {
            // They are in the places and feeds.
            91 | 92 | 126..=129 | 136 | 137 | 140 => Vec::new(),
            13 | 14 => vec![
                said(EventKind::Spindle, Word::Spindle, text),
                said(
                    EventKind::Coolant,
                    Word::Action(EventAction::Coolant(Coolant::Flood)),
                    String::new(),
                ),
            ],
            60 => vec![said(EventKind::Other, Word::Other, text)],
            _ => vec![said(kind_of_m(number), word_of_m(number), text)],
        }
    }

    fn text(&self, words: &[Written]) -> String {
        let ends = words.first().zip(words.last());
        let span = ends.map_or(0..0, |(first, last)| first.span.start..last.span.end);
        in_one_line(self.source.part(&span))
    }
}

/// Cycle and part of `CYCL DEF 9.1`.
fn cycle_of(words: &[Written]) -> Option<(u32, u32)> {
    let number = words.get(1).filter(|word| word.is("DEF"))?.value()?;
    let tenths = (10.0 * number).round();
    (0.0..1e6)
        .contains(&tenths)
        .then_some((tenths as u32 / 10, tenths as u32 % 10))
}

/// Number of the line of a dwell cycle.
fn dwell_part(words: &[Written]) -> Option<u32> {
    let is_cycle = words.first()?.is("CYCL") || words.first()?.is("CYCLE");
    let (cycle, part) = cycle_of(words).filter(|_| is_cycle)?;
    (cycle == 9).then_some(part)
}

/// Dwell of `CYCL DEF 9.1 DWELL 2.5` or `FUNCTION DWELL TIME2.5`, s.
fn dwell_seconds(words: &[Written]) -> Option<f64> {
    let is_function = words.first()?.is("FUNCTION") && words.get(1)?.is("DWELL");
    let seconds = match (dwell_part(words), is_function) {
        (Some(1), _) => words.get(2..)?.iter().rev().find_map(Written::value),
        (None, true) => words.iter().find(|word| word.is("TIME"))?.value(),
        _ => None,
    };
    seconds.filter(|seconds| *seconds >= 0.0)
}

/// Start of the comment of a block: at the first `;` outside of a text, or at a leading `*`.
fn comment_at(text: &[u8]) -> Option<usize> {
    if text.first() == Some(&b'*') {
        return Some(0);
    }
    let mut in_text = false;
    text.iter().position(|byte| {
        in_text ^= *byte == b'"';
        *byte == b';' && !in_text
    })
}
