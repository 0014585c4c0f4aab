//! Modal codes: G codes and words like them.

use crate::options::CutterCompensation;
use crate::siemens::block::{Item, What};
use crate::siemens::expression::Expression;
use crate::siemens::state::{Angles, Code, FeedMode};
use crate::siemens::table::row;
use crate::siemens::values::whole;
use crate::siemens::walker::Reader;
use crate::siemens::words::{Change, Purpose, Words};
use crate::table::Treatment;

/// Words that are understood and have no value.
const ALONE: [&str; 16] = [
    "SUPA", "CIP", "TRANS", "ATRANS", "ROT", "AROT", "RET", "TRAORI", "TRAFOOF", "ORIWKS",
    "ORIMKS", "ORIEULER", "ORIRPY", "ORIAXES", "ORIVECT", "ORIPLANE",
];

impl Reader<'_> {
    /// Takes what puts modes in force.
    pub(crate) fn code(&mut self, item: &Item, words: &mut Words) {
        let name = self.name(&item.name);
        if let What::Value { value, .. } = &item.what {
            if name != "G" {
                return;
            }
            let number = match value {
                Expression::Number(number) => whole(*number),
                _ => None,
            };
            let Some(number) = number else {
                return self.fault(
                    &item.span,
                    "its number is no whole one: the control has no such code",
                    "correct it",
                );
            };
            return self.g_code(number, item, words);
        }
        match name.as_str() {
            "CIP" => self.motion_code(Code::Through, item, words),
            "SUPA" => words.purpose = Purpose::Machine,
            "TRAORI" => {
                if !self.state.oriented {
                    self.state.forget();
                }
                self.state.oriented = true;
            }
            "TRAFOOF" => {
                if self.state.oriented {
                    self.state.forget();
                }
                self.state.oriented = false;
                self.state.direction = None;
            }
            "ORIWKS" => self.state.machine_orientation = false,
            "ORIMKS" => self.state.machine_orientation = true,
            "ORIAXES" => self.state.even_axes = Some(true),
            "ORIVECT" | "ORIPLANE" => self.state.even_axes = Some(false),
            "ORIEULER" => self.state.angles = Some(Angles::Euler),
            "ORIRPY" => self.state.angles = Some(Angles::Rpy),
            _ => words.frame = Change::of(&name).or(words.frame),
        }
    }

    fn motion_code(&mut self, code: Code, item: &Item, words: &mut Words) {
        if words.code.is_some() {
            return self.fault(
                &item.span,
                "two codes of motion stand in one block",
                "keep one",
            );
        }
        words.code = Some(item.span.clone());
        self.state.code = code;
        self.state.stated.code = true;
    }

    fn g_code(&mut self, number: u32, item: &Item, words: &mut Words) {
        let state = &mut self.state;
        match number {
            0..=3 => {
                let code = Code::of(&format!("G{number}")).unwrap_or(Code::Line);
                self.motion_code(code, item, words);
            }
            4 => words.purpose = Purpose::Dwell,
            9 => {
                words.exact = true;
                words.at_end.push(item.span.clone());
            }
            17..=19 => state.normal = 19 - number as usize,
            25 | 26 => words.purpose = Purpose::Limits,
            40 => {}
            41 | 42 if self.options.cutter_compensation == CutterCompensation::Refused => self
                .fault(
                    &item.span,
                    "the controller moves the path aside by the tool's radius",
                    "if the places are those of the tool's centre, say so (cutter_compensation = \"centre_path\" under [robot] in a job file)",
                ),
            41 | 42 => {}
            53 | 74 | 75 | 153 => words.purpose = Purpose::Machine,
            54..=57 | 500 | 505..=599 => {
                let name = format!("G{number}");
                if state.work_object != name {
                    state.forget();
                    state.work_object = name;
                }
            }
            60 => state.exact = true,
            64 | 641..=645 => state.exact = false,
            70 | 71 | 700 | 710 => {
                state.unit_stated = true;
                let inches = matches!(number, 70 | 700);
                state.unit_mm = match inches {
                    true => 25.4,
                    false => 1.0,
                };
                // G70 and G71 speak of lengths alone.
                state.feed_unit_mm = match number {
                    700 => 25.4,
                    _ => 1.0,
                };
            }
            90 => state.steps = false,
            91 => state.steps = true,
            94 => state.feed_mode = FeedMode::PerMinute,
            95 => state.feed_mode = FeedMode::PerTurn,
            96 | 97 => {
                state.feed_mode = FeedMode::PerTurn;
                state.spindle.count(number == 96);
            }
            961 | 971 => {
                state.feed_mode = FeedMode::PerMinute;
                state.spindle.count(number == 961);
            }
            _ => self.by_table(&format!("G{number}"), item),
        }
    }

    /// Treats a word as the table of statements states it.
    pub(crate) fn by_table(&mut self, name: &str, item: &Item) {
        let span = &item.span;
        match row(name).map(|row| row.treatment) {
            Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
            Some(Treatment::Understood) if !ALONE.contains(&name) => self.fault(
                span,
                "its value is missing, or it takes none",
                "write it as the manual of the control states it",
            ),
            Some(_) => {}
            None if name.starts_with('$') => self.fault(
                span,
                "it sets a value of the control itself",
                "take it out, if it moves neither the tool nor a frame",
            ),
            None => self.fault(
                span,
                "it is not known: a subprogram, a variable without DEF, or a word of this machine",
                "give the subprogram with the program (--expand), or take it out",
            ),
        }
    }
}
