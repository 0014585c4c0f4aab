//! A block by the word that it begins with: followed, carried or refused; path blocks with their feed, compensation and functions.

use std::ops::Range;

use crate::heidenhain::blocks::Block;
use crate::heidenhain::flow::{NOT_ALONE, called_name, is_called, label_name};
use crate::heidenhain::path_words::{FeedWord, Odd, PathWords};
use crate::heidenhain::reading::walker::{BUILDERS, BY_PARAMETER, EXPAND, Reader};
use crate::heidenhain::reading::ways::Acts;
use crate::heidenhain::state::Aside;
use crate::heidenhain::table::{Function, function, row};
use crate::heidenhain::words::{EXPONENT, Value, Word, exponent};
use crate::model::program::OutsideCall;
use crate::model::stated_value::{SLASHED, SlashBlocks};
use crate::options::CutterCompensation;
use crate::table::Treatment;
use crate::text::Name;

impl Reader<'_> {
    /// Follows a block; whether the program ends behind it.
    pub(crate) fn block(&mut self, block: &Block) -> bool {
        let words = block.words(self.file.bytes());
        let Some(first) = words.first() else {
            return false;
        };
        let span = first.span.start..words[words.len() - 1].span.end;
        if block.skipped {
            match self.options.slash_blocks {
                SlashBlocks::Refused => self.fault(&span, SLASHED.0, SLASHED.1),
                SlashBlocks::Run => self.remark(&span, "a block behind a slash", "runs"),
                SlashBlocks::Skipped => {
                    self.remark(&span, "a block behind a slash", "does not run");
                    return false;
                }
            }
        }
        if let Some(word) = exponent(&words) {
            self.fault(&word.span, EXPONENT.0, EXPONENT.1);
            self.state.lost();
            return false;
        }
        if self.has_corners {
            if first.is("RND") || first.is("CHF") {
                self.note_corner(block, &words, &span);
            } else {
                self.line = None;
                let ends = self.statement(block, &words, &span);
                let line = self.line.clone();
                self.settle_corner(line.as_ref());
                return ends;
            }
        }
        self.statement(block, &words, &span)
    }

    /// Dispatches a block by its first word.
    fn statement(&mut self, block: &Block, words: &[Word], span: &Range<usize>) -> bool {
        let first = &words[0];
        let sets = |word: &Word| word.is("Q") && matches!(word.whole(), Some(120..=122));
        if words.iter().any(sets) {
            // A value of the program's own takes the place of the angle that the control computed.
            self.state.tilt.across = None;
        }
        match first.letters.letters() {
            b"L" | b"LN" | b"LP" | b"C" | b"CP" | b"CR" | b"CT" | b"CTP" | b"M" | b"F" => {
                return self.path(block, words, span);
            }
            b"STOP" => return self.path(block, words, span),
            b"CC" => self.pole(words, span),
            b"BEGIN" => self.begin(words, span),
            b"END" => return true,
            b"TOOL" => self.tool(words, span),
            b"CYCL" | b"CYCLE" => self.cycle(block, words, span),
            b"TRANS" => self.trans(words, span),
            b"PLANE" => self.plane(words, span),
            b"FUNCTION" => self.function(words, span),
            b"CALL" => self.call(block, words, span),
            b"LBL" if words.len() > 1 => self.fault(span, NOT_ALONE.0, NOT_ALONE.1),
            b"FN" => self.parameter_function(first, span),
            b"X" | b"Y" | b"Z" | b"IX" | b"IY" | b"IZ" => {
                self.fault(
                    span,
                    "the block has coordinates and no L",
                    "write L before them",
                );
            }
            letters => match row(letters).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
                Some(_) => {}
                None => self.fault(
                    span,
                    "the statement is not known, and may move the tool",
                    "take it out, or make it a comment (;)",
                ),
            },
        }
        false
    }

    fn function(&mut self, words: &[Word], span: &Range<usize>) {
        let known = [
            "TCPM",
            "RESET",
            "MODE",
            "S",
            "FEED",
            "PARAXCOMP",
            "DWELL",
            "COUNT",
        ];
        self.tip_function(words);
        if words.get(1).is_some_and(|word| word.is("MODE"))
            && !words.get(2).is_some_and(|word| word.is("MILL"))
        {
            return self.fault(
                span,
                "the machine turns or grinds from here on: X is a diameter, and cycles are others",
                "take this part into a program of its own, written for milling (FUNCTION MODE MILL)",
            );
        }
        self.not_below_zero(&words[1..], &["TIME"], "the dwell");
        let named = words.get(1);
        if !named.is_some_and(|word| known.iter().any(|name| word.is(name))) {
            self.fault(span, "what this function moves is not known", "take it out");
        }
    }

    fn call(&mut self, block: &Block, words: &[Word], span: &Range<usize>) {
        match words.get(1) {
            Some(word) if word.is("PGM") => {
                let name = called_name(self.file.bytes(), block, word);
                let mut files = self.files.iter();
                if name.is_empty() || files.any(|file| is_called(file, &name)) {
                    return self.fault(
                        span,
                        "it runs another program",
                        "give the programs together and write them flat (--expand)",
                    );
                }
                self.found.outside_calls.push(OutsideCall {
                    file: self.index,
                    line: self.file.line_of(span.start),
                    name: Some(name),
                });
            }
            Some(word) if word.is("LBL") => {
                if words.get(2).is_some_and(|word| word.is("REP")) {
                    self.fault(span, "it runs a part of the program again", EXPAND);
                } else if words.len() > 2 {
                    self.fault(span, NOT_ALONE.0, NOT_ALONE.1);
                } else if label_name(self.file.bytes(), word).is_none() {
                    self.fault(span, "the label has no number and no name", "state it");
                }
            }
            _ => self.fault(
                span,
                "it runs a program whose name is not stated",
                "call it by its name (CALL PGM)",
            ),
        }
    }

    /// FN: jumps and what writes into the control are refused.
    fn parameter_function(&mut self, first: &Word, span: &Range<usize>) {
        match first.whole() {
            Some(9..=12) => self.fault(span, "it jumps where a Q parameter says", EXPAND),
            Some(17 | 25) => self.fault(
                span,
                "it writes data of the control, which may move the coordinates",
                "take it into a program of its own",
            ),
            _ => {}
        }
    }

    /// A path block, or one of functions alone; whether the program ends behind it.
    pub(crate) fn path(&mut self, block: &Block, words: &[Word], span: &Range<usize>) -> bool {
        // Blocks of functions alone have no word before.
        let alone = words[0].is("M") || words[0].is("F");
        let own: Vec<Word>;
        let words = match alone {
            true => {
                let mut all = vec![Word {
                    span: span.start..span.start,
                    letters: Name::empty(),
                    value: Value::None,
                }];
                all.extend_from_slice(words);
                own = all;
                &own[..]
            }
            false => words,
        };
        let rest = self.turn_to_plane(words, span);
        let words = rest.as_deref().unwrap_or(words);
        let parsed = match PathWords::of(words) {
            Ok(parsed) => parsed,
            Err(odd) => {
                let (at, reason, remedy) = match odd {
                    Odd::Parameter(at) => (at, BY_PARAMETER, EXPAND),
                    Odd::Unknown(at) => (
                        at,
                        "the word is not known here, or has no number",
                        "write the block as the control shows it",
                    ),
                    Odd::Twice(at) => (at, "the word is there twice", "take one out"),
                };
                self.fault(&words[at].span.clone(), reason, remedy);
                self.state.lost();
                return false;
            }
        };
        let acts = self.functions(words, &parsed);
        match parsed.feed {
            FeedWord::Number(_, value) => {
                self.state.feed = Some(value);
                self.state.feed_text = format!("F{value}");
            }
            FeedWord::Auto => {
                self.state.feed = self.state.tool_feed;
                self.state.feed_text = "FAUTO".to_owned();
            }
            FeedWord::Other => {
                self.state.feed = None;
                self.state.feed_text = "F".to_owned();
            }
            FeedWord::None | FeedWord::Max => {}
        }
        if parsed.aside
            && self.options.cutter_compensation == CutterCompensation::Refused
            && self.state.aside.is_none()
        {
            self.fault(
                span,
                "the control moves the path aside by the tool's radius",
                "state the tool's radius in the program (TOOL DEF 1 L+0 R+5) and write it flat first (--expand), or say so if the places are those of the tool's centre (cutter_compensation = \"centre_path\" under [robot] in a job file)",
            );
        }
        if let Some(at) = parsed.compensation {
            self.state.aside = match () {
                () if words[at].is("RL") => Some(Aside::Left),
                () if words[at].is("RR") => Some(Aside::Right),
                () => None,
            };
        }
        let turns = self.turn_axes(words, &parsed, span, acts.machine);
        self.follow_plane();
        self.moved(block, words, &parsed, turns, span, &acts);
        let functions = parsed.functions.iter().map(|(_, number)| *number);
        for number in functions.filter(|number| matches!(number, 127 | 129)) {
            self.axis_function(number);
        }
        acts.ends
    }

    fn functions(&mut self, words: &[Word], parsed: &PathWords) -> Acts {
        let mut acts = Acts::default();
        for (at, number) in &parsed.functions {
            let span = words[*at].span.clone();
            match number {
                3 | 4 | 13 | 14 => self.state.spindle_on = true,
                // At the end of its block, and no cut follows in it.
                0 | 2 | 5 | 6 | 30 => self.state.spindle_on = false,
                _ => {}
            }
            match function(*number) {
                Function::AtStart => self.axis_function(*number),
                Function::AtEnd => acts.ends |= matches!(number, 2 | 30),
                Function::Machine => acts.machine = true,
                Function::Retracts => acts.retracts = true,
                Function::Calls if *number == 89 => self.state.calls = true,
                Function::Calls => acts.calls = true,
                Function::PerTurn => self.state.per_turn = true,
                Function::PerMinute => self.state.per_turn = false,
                Function::Refused(reason) => self.fault(&span, reason, "take it out"),
                Function::Unknown => self.remark(&span, &format!("M{number}"), BUILDERS),
            }
        }
        acts.calls |= self.state.calls && parsed.moves();
        if parsed.functions.iter().any(|(_, number)| *number == 99) {
            self.state.calls = false;
        }
        acts
    }
}
