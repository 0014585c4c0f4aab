//! Decodes a block and updates the modal state.

use std::ops::Range;

use crate::corner::Cut;
use crate::siemens::block::{Block, How, Item, What};
use crate::siemens::expression::Expression;
use crate::siemens::state::Feed;
use crate::siemens::table::row;
use crate::siemens::turned_axes::OTHER_AXES;
use crate::siemens::values::{Value, whole};
use crate::siemens::walker::{Corners, Reader};
use crate::siemens::words::{Group, Purpose, Words, coordinate, coordinate_of};

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
                if name.len() == 1 && !indices.is_empty() {
                    return self.fault(
                        &item.span,
                        "the number in brackets says which axis, group or spindle is meant, and that is not followed",
                        "write the code, or the axis by its name",
                    );
                }
                if let Some((group, axis)) = coordinate(&name) {
                    return self.coordinate(item, group, axis, *how, value, words);
                }
                self.other_word(&name, item, value, span, *how, words);
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
            "FGROUP" => self.feed_group(item),
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

    /// FGROUP names the axes whose way F counts; without names they are those of the machine's own setting [SINUMERIK, fundamentals,
    /// FGROUP]. X, Y and Z, or none: the way of the tool's tip, as F is taken.
    fn feed_group(&mut self, item: &Item) {
        let What::Call(arguments) = &item.what else {
            return self.by_table("FGROUP", item);
        };
        let names: Vec<String> = (arguments.iter())
            .map(|argument| self.name(&argument.span).trim().to_owned())
            .collect();
        let of_tip = ["X", "Y", "Z"]
            .iter()
            .all(|axis| names.iter().any(|name| name == axis));
        if names.is_empty() || of_tip && names.len() == 3 {
            return;
        }
        self.finding(
            &item.span,
            format!(
                "F counts the way of the axes {} here (FGROUP), and is taken as that of the tool's tip: where others move, too, the cut is faster or slower",
                names.join(", ")
            ),
        );
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
                "give it a value in the program, or state it (--set NAME=VALUE)",
            );
        }
    }

    fn coordinate(
        &mut self,
        item: &Item,
        group: Group,
        axis: usize,
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
                self.unit_assumed(item, words);
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

    /// Says once that the unit is assumed to be mm: without G70, G71, G700 or G710 it is that of the machine's basic setting (SINUMERIK 840D sl,
    /// Programming Manual, Fundamentals, "Inch or metric dimensions"; machine data 10240).
    fn unit_assumed(&mut self, item: &Item, words: &Words) {
        if self.state.unit_stated || words.purpose == Purpose::Machine {
            return;
        }
        self.state.unit_stated = true;
        self.finding(
            &item.span,
            "no G70, G71, G700 or G710 states the unit up to here: it is assumed to be mm"
                .to_owned(),
        );
    }

    /// Words that are neither variables nor coordinates.
    fn other_word(
        &mut self,
        name: &str,
        item: &Item,
        value: &Expression,
        span: &Range<usize>,
        how: How,
        words: &mut Words,
    ) {
        let first = name.bytes().next().unwrap_or_default();
        let numbered = name.len() > 1 && name[1..].bytes().all(|byte| byte.is_ascii_digit());
        if let (1, Some(place)) = (name.len(), self.state.standing.place_of_letter(first)) {
            return self.rotary_word(item, place, how, value, words);
        }
        match name {
            "G" => {}
            "N" => self.not_below_zero(item, value, "the number of the block"),
            "LIMS" => self.not_below_zero(item, value, "the largest speed of the spindle"),
            "M" => self.m_word(item, value, words),
            "F" => {
                let number = matches!(value, Expression::Number(_)).then(|| span.clone());
                words.feed = Some((item.span.clone(), number));
                if words.purpose == Purpose::Dwell {
                    self.not_below_zero(item, value, "the dwell");
                } else if let Some(value) = self.number(&item.span, value) {
                    let text = String::from_utf8_lossy(self.file.part(&item.span)).into_owned();
                    self.state.feed = Some(Feed { value, text });
                    self.state.stated.feed = true;
                }
            }
            "T" => self.tool(item, value),
            "D" => {
                let edge = self.whole_number(item, value).map(u64::from);
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
            "RND" | "CHF" | "CHR" if self.corners == Corners::Followed => {
                // Also where its size is not known.
                self.out.corner_words.push(item.span.clone());
                let Some(value) = self.number(&item.span, value) else {
                    return;
                };
                let size = value * self.state.unit_mm;
                let cut = match name {
                    "RND" => Cut::Rounded(size),
                    "CHF" => Cut::Length(size),
                    _ => Cut::Sides(size),
                };
                words.corner = Some((item.span.clone(), cut));
            }
            "S" => {
                self.not_below_zero(item, value, "S");
                if words.purpose == Purpose::Motion {
                    let speed = self.variables.number(self.file.bytes(), value).ok();
                    self.state.spindle.state(speed);
                }
            }
            "H" => {}
            // The number of the spindle that cuts is unknown.
            _ if numbered && first == b'S' => {
                self.not_below_zero(item, value, "S");
                self.state.spindle.state(None);
            }
            _ if numbered && first == b'M' => {
                self.whole_number(item, value);
                self.state.spindle.state(None);
            }
            _ if numbered && first == b'H' => {}
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
        match self.whole_number(item, value) {
            Some(number @ (3..=5 | 19 | 70)) => self.state.spindle.on = matches!(number, 3 | 4),
            Some(6) => words.changes_tool = true,
            Some(2 | 17 | 30) => {
                words.at_end.push(item.span.clone());
                self.state.ended = true;
            }
            Some(0 | 1) => words.at_end.push(item.span.clone()),
            _ => {}
        }
    }

    /// The number of a code, a tool or an edge.
    fn whole_number(&mut self, item: &Item, value: &Expression) -> Option<u32> {
        let number = self.number(&item.span, value)?;
        let found = whole(number);
        if found.is_none() {
            self.fault(
                &item.span,
                format!("{number} is no whole number of zero or above"),
                "mend the number",
            );
        }
        found
    }

    /// Times and speeds, as far as they are known.
    fn not_below_zero(&mut self, item: &Item, value: &Expression, what: &str) {
        let number = self.variables.number(self.file.bytes(), value);
        if let Ok(number) = number
            && number < 0.0
        {
            let reason = format!("{what} is below zero ({number})");
            self.fault(&item.span, reason, "write zero or more");
        }
    }

    fn tool(&mut self, item: &Item, value: &Expression) {
        let name = match self.variables.value(self.file.bytes(), value) {
            Ok(Value::Number(number)) if whole(number).is_none() => {
                self.whole_number(item, value);
                return;
            }
            Ok(Value::Number(number)) => format!("T{number}"),
            Ok(Value::Text(text)) => format!("T {}", String::from_utf8_lossy(&text)),
            Err(why) => {
                return self.fault(&item.span, why, "write the tool's number or name");
            }
        };
        self.state.next_tool = Some(name);
    }
}
