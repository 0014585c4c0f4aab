//! From the words of a block to what they say, with what they put in force.

use std::ops::Range;

use crate::options::CutterCompensation;
use crate::siemens::block::{Block, How, Item, What};
use crate::siemens::expression::Expression;
use crate::siemens::frames::Change;
use crate::siemens::state::{Angles, Code, FeedMode};
use crate::siemens::table::row;
use crate::siemens::values::{Value, whole};
use crate::siemens::walker::Reader;
use crate::siemens::words::{Group, Purpose, Words, coordinate, coordinate_of};
use crate::table::Treatment;

/// Letters of axes beside X, Y and Z.
const OTHER_AXES: &[u8] = b"ABCUVWQE";

/// Words that are understood and have no value.
const ALONE: [&str; 13] = [
    "SUPA", "CIP", "TRANS", "ATRANS", "ROT", "AROT", "RET", "TRAORI", "TRAFOOF", "ORIWKS",
    "ORIMKS", "ORIEULER", "ORIRPY",
];

impl Reader<'_> {
    /// The words of a block; what is refused among them is noted.
    pub(crate) fn words(&mut self, block: &Block) -> Words {
        let mut words = Words::default();
        // G codes of a block act on all of its coordinates, wherever they stand.
        for item in &block.items {
            self.code(item, &mut words);
        }
        for item in &block.items {
            self.word(item, &mut words);
        }
        words
    }

    /// Takes what puts modes in force.
    fn code(&mut self, item: &Item, words: &mut Words) {
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
                return self.fault(&item.span, "its number is no whole one", "write it as G1");
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
        self.state.code_stated = true;
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
                    "say by an option that the places are those of the tool's centre, if they are",
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
            93 => state.feed_mode = FeedMode::Inverse,
            94 | 961 | 971 => state.feed_mode = FeedMode::PerMinute,
            95..=97 => state.feed_mode = FeedMode::PerTurn,
            _ => self.by_table(&format!("G{number}"), item),
        }
    }

    /// What the table says of a word.
    fn by_table(&mut self, name: &str, item: &Item) {
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

    /// Takes what a word says.
    fn word(&mut self, item: &Item, words: &mut Words) {
        let name = self.name(&item.name);
        match &item.what {
            What::Statement => {}
            What::Name | What::Call(_) => self.keyword(&name, item, words),
            What::Value {
                indices,
                how,
                value,
                span,
                ..
            } => {
                if self.variables.knows(name.as_bytes()) && name != "R"
                    || name == "R" && !indices.is_empty()
                {
                    return self.assign(item, indices, value);
                }
                if let Some((group, axis)) = coordinate(&name) {
                    return self.coordinate(item, (group, axis), *how, value, words);
                }
                self.other_word(&name, item, (value, span), *how, words);
            }
        }
    }

    fn keyword(&mut self, name: &str, item: &Item, words: &mut Words) {
        match name {
            "RET" => {
                words.at_end.push(item.span.clone());
                self.state.ended = true;
            }
            "CYCLE800" if matches!(&item.what, What::Call(arguments) if arguments.is_empty()) => {}
            "SCALE" | "MIRROR" if words.axes.iter().all(Option::is_none) => {}
            _ if name.len() > 1
                && name.starts_with('L')
                && name[1..].bytes().all(|byte| byte.is_ascii_digit()) =>
            {
                self.by_table("L", item);
            }
            _ => self.by_table(name, item),
        }
    }

    fn assign(&mut self, item: &Item, indices: &[Expression], value: &Expression) {
        let bytes = self.file.bytes();
        let places: Result<Vec<f64>, String> = indices
            .iter()
            .map(|index| self.variables.number(bytes, index))
            .collect();
        let name = self.file.part(&item.name);
        let done = places.and_then(|places| {
            let value = self.variables.value(bytes, value)?;
            self.variables.set(name, &places, value)
        });
        if let Err(why) = done {
            self.fault(
                &item.span,
                why,
                "give it a value in the program, or write the number",
            );
        }
    }

    fn coordinate(
        &mut self,
        item: &Item,
        (group, axis): (Group, usize),
        how: How,
        value: &Expression,
        words: &mut Words,
    ) {
        let Some(written) = self.number(&item.span, value) else {
            return;
        };
        // A centre counts from the start, whatever G90 says; a place on the arc as an end does.
        let step = match (group, how) {
            (_, How::Absolute | How::Rotary) => false,
            (Group::Centre, _) | (_, How::Step) => true,
            _ => self.state.steps,
        };
        let twice = match group {
            Group::Direction | Group::Angle => {
                let held = match group {
                    Group::Direction => &mut words.direction[axis],
                    _ => &mut words.angles[axis],
                };
                held.replace((item.span.clone(), written)).is_some()
            }
            _ => {
                let unit_mm = self.state.unit_mm;
                let made = coordinate_of(item, written, unit_mm, step);
                let held = match group {
                    Group::Axis => &mut words.axes[axis],
                    Group::Centre => &mut words.centre[axis],
                    _ => &mut words.via[axis],
                };
                std::mem::replace(held, made).is_some()
            }
        };
        if twice {
            self.fault(&item.span, "the word stands twice in the block", "keep one");
        }
    }

    /// Words that are neither variables nor coordinates.
    fn other_word(
        &mut self,
        name: &str,
        item: &Item,
        (value, span): (&Expression, &Range<usize>),
        how: How,
        words: &mut Words,
    ) {
        let first = name.bytes().next().unwrap_or_default();
        let numbered = name.len() > 1 && name[1..].bytes().all(|byte| byte.is_ascii_digit());
        match name {
            "G" | "N" => {}
            "M" => self.m_word(item, value, words),
            "F" => {
                let number = matches!(value, Expression::Number(_)).then(|| span.clone());
                words.feed = Some((item.span.clone(), number));
                if words.purpose != Purpose::Dwell
                    && let Some(value) = self.number(&item.span, value)
                {
                    let text = String::from_utf8_lossy(self.file.part(&item.span)).into_owned();
                    self.state.feed = Some(super::state::Feed { value, text });
                    self.state.feed_stated = true;
                }
            }
            "T" => self.tool(item, value),
            "D" => {
                let edge = self
                    .number(&item.span, value)
                    .and_then(whole)
                    .map(u64::from);
                if edge != self.state.edge {
                    // The tool's length counts otherwise: along it the tip is elsewhere.
                    match self.state.oriented {
                        true => self.state.forget(),
                        false => self.state.place[self.state.normal] = None,
                    }
                    self.state.edge = edge;
                }
            }
            "CR" | "AR" | "RPL" => {
                let Some(mut value) = self.number(&item.span, value) else {
                    return;
                };
                if name == "CR" {
                    value *= self.state.unit_mm;
                }
                match name {
                    "CR" => words.radius = Some((item.span.clone(), value)),
                    "AR" => words.opening = Some((item.span.clone(), value)),
                    _ => words.in_plane = Some(value),
                }
            }
            "S" | "H" => {}
            _ if numbered && matches!(first, b'S' | b'H' | b'M') => {}
            _ if numbered && first == b'T' => self.tool(item, value),
            _ if name.len() == 1 && OTHER_AXES.contains(&first)
                || numbered
                    && (OTHER_AXES.contains(&first) || b"XYZ".contains(&first))
                    && row(name).is_none() =>
            {
                if words.purpose != Purpose::Limits
                    && let Some(value) = self.number(&item.span, value)
                {
                    self.other_axis(name, item, value, how, words.purpose);
                }
            }
            _ => self.by_table(name, item),
        }
    }

    fn m_word(&mut self, item: &Item, value: &Expression, words: &mut Words) {
        match self.number(&item.span, value).and_then(whole) {
            Some(6) => words.changes_tool = true,
            Some(2 | 17 | 30) => {
                words.at_end.push(item.span.clone());
                self.state.ended = true;
            }
            Some(0 | 1) => words.at_end.push(item.span.clone()),
            _ => {}
        }
    }

    fn tool(&mut self, item: &Item, value: &Expression) {
        let name = match self.variables.value(self.file.bytes(), value) {
            Ok(Value::Number(number)) => format!("T{number}"),
            Ok(Value::Text(text)) => format!("T {}", String::from_utf8_lossy(&text)),
            Err(why) => {
                return self.fault(&item.span, why, "write the tool's number or name");
            }
        };
        self.state.next_tool = Some(name);
    }

    /// An axis beside X, Y, Z: it may stand, and not move.
    fn other_axis(&mut self, name: &str, item: &Item, value: f64, how: How, purpose: Purpose) {
        let steps = how == How::Step || how == How::Modal && self.state.steps;
        let code = self.state.code;
        let axis = self
            .state
            .others
            .entry(name.as_bytes().to_vec())
            .or_default();
        match (purpose, axis.at) {
            (Purpose::Machine, _) => axis.elsewhere = true,
            (_, _) if steps && value == 0.0 => {}
            // From wherever it stands, beside a motion of the tool.
            (Purpose::Motion, None) if !steps && value != 0.0 && code != Code::Rapid => {
                axis.at = Some(value);
                self.moves_aside(name, item);
            }
            (_, None) if !steps => {
                axis.at = Some(value);
                axis.elsewhere = false;
                if value != 0.0 {
                    self.finding(
                        &item.span,
                        format!("{name} stands at {value}: the part is taken to lie as the frame in force says then"),
                    );
                }
            }
            (_, Some(at)) if !steps && at == value => axis.elsewhere = false,
            _ => {
                // All that follows stands there.
                axis.at = (!steps).then_some(value);
                axis.elsewhere = false;
                self.moves_aside(name, item);
            }
        }
    }

    fn moves_aside(&mut self, name: &str, item: &Item) {
        self.fault(
            &item.span,
            format!("the axis {name} moves: where the tool stands on the part then, needs the kinematics of the machine"),
            "give the parts of the program between such motions one by one, or let the CAM system write directions (A3, B3, C3) with TRAORI",
        );
    }
}
