//! Path blocks and blocks of functions alone: their feed, their radius compensation, what their functions do.

use std::ops::Range;

use crate::heidenhain::aside::Aside;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::path_words::{FeedWord, Odd, PathWords};
use crate::heidenhain::reading::walker::{BUILDERS, BY_PARAMETER, EXPAND, Reader};
use crate::heidenhain::reading::ways::Acts;
use crate::heidenhain::table::{Function, function};
use crate::heidenhain::words::{Value, Word};
use crate::options::CutterCompensation;
use crate::text::name::Name;

impl Reader<'_> {
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
