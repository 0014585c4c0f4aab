//! A TP program that was run once and written flat: the lines of its run one after the other, in place of those of its file.
//!
//! Registers get the same values in the same order, so that lines stay as they are. Counters of loops are assigned, arguments of
//! calls are put in as values, and positions of called programs follow those of the first one.

use std::ops::Range;

use crate::flat_run::not_flat;
use crate::interpreter::value::{Datum, Value};
use crate::ls::expression::indices_of;
use crate::ls::run::Run;
use crate::ls::step::{Step, comma_in};
use crate::ls::words::{Kind, index_of, words_of};
use crate::text::edits::Edits;
use crate::text::name::Name;

impl Run<'_, '_> {
    /// Writes a line that ran, without the condition on which it ran.
    pub(super) fn write_action(&mut self, at: usize) {
        let program = self.program();
        let line = self.all.layouts[program].lines[at].text.clone();
        let mut step = &self.all.programs[program].steps[at];
        let mut from = line.start;
        while let Step::Perhaps(_) | Step::Case(_) = step {
            let comma = comma_in(self.file().bytes(), &(from..line.end));
            from = comma.map_or(from, |comma| comma + 1);
            step = match step {
                Step::Perhaps(own) => &own.1,
                Step::Case(own) => &own.action,
                _ => break,
            };
        }
        self.write_part(at, from..line.end);
    }

    /// Writes a line as it stands.
    pub(super) fn write_whole(&mut self, at: usize) {
        let line = self.all.layouts[self.program()].lines[at].text.clone();
        self.write_part(at, line);
    }

    /// Writes the value that a counter gets.
    pub(super) fn write_counter(&mut self, at: usize, counter: &Name, value: f64) {
        let (program, line) = (self.program(), self.line(at));
        if let Some(flat) = &mut self.flat {
            flat.is_changed = true;
            let text = [counter.letters(), b"=", printed(value).as_bytes(), b" "].concat();
            flat.line(&text, program, line);
        }
    }

    fn write_part(&mut self, at: usize, part: Range<usize>) {
        if self.flat.is_none() {
            return;
        }
        let program = self.program();
        let (file, number) = (self.file(), self.line(at));
        let mut edits = Edits::default();
        let is_remark = file.part(&part).trim_ascii_start().starts_with(b"!");
        if program > 0 && !is_remark {
            self.put_positions(at, &part, &mut edits);
            self.put_arguments(at, &part, &mut edits);
        }
        let text = edits.applied_to_part(file.bytes(), &part);
        let line = &self.all.layouts[program].lines[at];
        let Some(flat) = &mut self.flat else {
            return;
        };
        flat.is_changed |= program > 0 || at != flat.count || part != line.text;
        flat.count += 1;
        flat.line(&text.unwrap_or_default(), program, number);
    }

    /// Puts the values of arguments in place of `AR[1]`.
    fn put_arguments(&mut self, at: usize, part: &Range<usize>, edits: &mut Edits) {
        let file = self.file();
        let mut from = part.start;
        while let Some(found) =
            (file.bytes()[from..part.end].windows(3)).position(|of| of == b"AR[")
        {
            let start = from + found;
            from = start + 3;
            let close = file.bytes()[from..part.end]
                .iter()
                .position(|byte| *byte == b']');
            let end = close.map_or(part.end, |close| from + close + 1);
            let number = index_of(file.bytes(), &(start + 2..end)).map(|(number, _)| number);
            let arguments = self.calls.last().map(|called| called.arguments.as_slice());
            let value = number.and_then(|number| arguments?.get(number.checked_sub(1)? as usize));
            let text = match value.map(|value| &value.value) {
                Some(Value::Text(text)) => Some(format!("'{text}'")),
                _ => value.and_then(Datum::as_number).map(printed),
            };
            match text {
                _ if edits.touches(&(start..from)) => {}
                Some(text) => edits.replace(start..end, text),
                None => self.not_flat(at, "an argument of its call has no value that is known"),
            }
        }
    }

    /// Puts new numbers in place of those of positions of a called program.
    fn put_positions(&mut self, at: usize, part: &Range<usize>, edits: &mut Edits) {
        let bytes = self.file().bytes();
        for pair in words_of(bytes, part).windows(2) {
            let bracket = &pair[1].span;
            if bytes[pair[0].span.clone()] != *b"P" || pair[1].kind != Kind::Bracket {
                continue;
            }
            let index = indices_of(bytes, bracket).and_then(|all| all.into_iter().next());
            match index.and_then(|index| self.index(&index)) {
                Some(number) => {
                    let new = self.new_number(number);
                    edits.replace(bracket.clone(), format!("[{new}]"));
                }
                None => self.not_flat(at, "which position it uses is not known"),
            }
        }
    }

    /// The number in the first program of a position of the program that runs.
    fn new_number(&mut self, number: u32) -> u32 {
        let program = self.program();
        let last = self.all.positions[0].all.keys().next_back();
        let last = last.copied().unwrap_or(0);
        let Some(flat) = &mut self.flat else {
            return number;
        };
        let count = flat.positions.len() as u32;
        *flat
            .positions
            .entry((program, number))
            .or_insert(last + 1 + count)
    }

    pub(super) fn not_flat(&mut self, at: usize, why: &str) {
        if self.flat.is_some() {
            let (reason, remedy) = not_flat(why);
            self.fault(at, reason, remedy);
        }
    }
}

/// A number as a statement has it.
fn printed(value: f64) -> String {
    match value < 0.0 {
        true => format!("({value})"),
        false => format!("{value}"),
    }
}
