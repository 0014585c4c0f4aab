//! The blocks of a program as they run: numbers in place of expressions, without labels and assignments.

use crate::flat_run::Runs;
use crate::model::stated_value::{SLASHED, SlashBlocks};
use crate::siemens::block::{Block, Item, What};
use crate::siemens::expression::Expression;
use crate::siemens::flat::drilling::is_drilling;
use crate::siemens::flat::holes::drilling_of;
use crate::siemens::flat::modes::is_frame;
use crate::siemens::flat::runner::{Fault, Runner};
use crate::siemens::flat::structure::Line;
use crate::siemens::values::Value;
use crate::siemens::writing::place::number_text;
use crate::text::source::Edits;

/// Ends of programs.
pub(super) enum End {
    No,
    Subprogram,
    Program,
}

impl Runner<'_> {
    /// Runs the words of a line; whether the next line is next.
    pub(super) fn words(&mut self, line: &Line) -> Result<bool, Fault> {
        let items = &line.block.items;
        let file = self.file();
        let in_main = self.levels.len() == 1;
        if items.is_empty() {
            let text = file.part(&line.block.line);
            let is_head = text.trim_ascii_start().starts_with(b"%")
                || text.to_ascii_uppercase().starts_with(b";$PATH");
            if in_main && line.block.label.is_none()
                || !in_main && !is_head && line.block.label.is_none()
            {
                let text = text.to_vec();
                self.write_line(&text);
            }
            return Ok(true);
        }
        let acts = |item: &Item| self.is_assignment(&item.name, &item.what);
        if line.block.skip && self.slash_blocks == SlashBlocks::Refused {
            // Blocks that stay in the flat program are judged by the reader.
            let runs = items.iter().any(acts) || self.call(items)?.is_some();
            if runs || !matches!(self.end(items)?, End::No) {
                return Err(self.fault(&line.block.span, SLASHED.0, SLASHED.1));
            }
        }
        if let Some(call) = self.call(items)? {
            if call.times == 0 {
                return Ok(true);
            }
            self.enter(&call)?;
            return Ok(false);
        }
        if self.drill(items)? {
            return Ok(true);
        }
        let end = self.end(items)?;
        let mut edits = Edits::default();
        let mut left = 0;
        for item in items {
            if self.is_assignment(&item.name, &item.what) {
                if let What::Value { indices, value, .. } = &item.what {
                    self.assign(&item.name, indices, value)?;
                }
                edits.replace(item.span.clone(), "");
                continue;
            }
            let ends = matches!(end, End::Subprogram) && !in_main && self.is_end(item);
            match ends {
                true => edits.replace(item.span.clone(), ""),
                false => {
                    left += 1;
                    self.word(item, &mut edits)?;
                }
            }
        }
        if left > 0 {
            self.write_words(&line.block, edits)?;
        }
        let across = self.modes.normal();
        let places = items.iter().any(|item| {
            let name = file.part(&item.name).to_ascii_uppercase();
            matches!(item.what, What::Value { .. })
                && matches!(name.as_slice(), b"X" | b"Y" | b"Z")
                && name != [across as u8]
        });
        if let (Some(drilling), true) = (self.drilling.clone(), places) {
            self.drill_here(&drilling)?;
        }
        if let (End::No, true, Some(call)) = (&end, places, self.modal_call()?) {
            self.enter(&call)?;
            return Ok(false);
        }
        match (end, in_main) {
            (End::No, _) => return Ok(true),
            (End::Subprogram, false) => self.leave()?,
            (End::Program, false) => {
                return Err(self.fault(
                    &line.block.span,
                    "the end of the main program stands in a subprogram",
                    "end the subprogram by M17 or RET",
                ));
            }
            // The end of the main program, wherever it stands.
            _ => self.levels.clear(),
        }
        Ok(false)
    }

    /// Writes a block with its edits, without its label.
    fn write_words(&mut self, block: &Block, mut edits: Edits) -> Result<(), Fault> {
        let file = self.file();
        let overlap = |text: Option<Vec<u8>>| {
            text.ok_or_else(|| self.fault(&block.span, "it cannot be written", "report this"))
        };
        let named = |item: &Item| file.part(&item.name).to_ascii_uppercase();
        let frame = block.items.iter().map(named).find(|name| is_frame(name));
        let words = match frame {
            Some(name) => {
                let words = block.words_at..block.span.end;
                let text = edits.clone().applied_to_part(file.bytes(), &words);
                Some((name, overlap(text)?))
            }
            None => None,
        };
        if let Some(label) = &block.label {
            edits.replace(label.start..block.words_at, "");
        }
        let text = overlap(edits.applied_to_part(file.bytes(), &block.line))?;
        self.write_line(&text);
        if let Some((name, text)) = words {
            self.frames.state(&name, &text, self.modes);
        }
        Ok(())
    }

    fn is_end(&self, item: &Item) -> bool {
        let name = self.file().part(&item.name).to_ascii_uppercase();
        let m17 = matches!(&item.what, What::Value { value: Expression::Number(value), .. } if *value == 17.0);
        name == b"RET" || name == b"M" && m17
    }

    pub(super) fn end(&self, items: &[Item]) -> Result<End, Fault> {
        for item in items {
            if self.is_end(item) {
                return Ok(End::Subprogram);
            }
            let is_m = self.file().part(&item.name).eq_ignore_ascii_case(b"M");
            if let (true, What::Value { value, .. }) = (is_m, &item.what)
                && matches!(self.number(value)?, 2.0 | 30.0)
            {
                return Ok(End::Program);
            }
        }
        Ok(End::No)
    }

    /// Numbers in place of the expressions of a word, and the modes that it puts in force.
    fn word(&mut self, item: &Item, edits: &mut Edits) -> Result<(), Fault> {
        let bytes = self.file().bytes();
        let name = String::from_utf8_lossy(self.file().part(&item.name)).to_ascii_uppercase();
        match &item.what {
            What::Value {
                value,
                span,
                indices,
                ..
            } => {
                let literal = is_literal(value);
                if !literal {
                    let found = self.variables.value(bytes, value).map_err(|why| {
                        self.fault(
                            &item.span,
                            why,
                            "give it a value in the program, or state it (--set NAME=VALUE)",
                        )
                    })?;
                    edits.replace(span.clone(), text_of(&found));
                }
                if indices.is_empty()
                    && matches!(name.as_str(), "G" | "F")
                    && let Ok(found) = self.number(value)
                {
                    match name.as_str() {
                        "G" => self.modes.state(&format!("G{found}")),
                        _ => self.feed = Some(found),
                    }
                }
            }
            What::Call(arguments) => {
                for argument in arguments {
                    let value = argument.value.as_ref().filter(|value| has_variable(value));
                    // Words of the control, as _FINISH, stay.
                    let found = value.and_then(|value| self.variables.value(bytes, value).ok());
                    if let Some(found) = found {
                        edits.replace(argument.span.clone(), text_of(&found));
                    }
                }
            }
            What::Name => self.modes.state(&name),
            What::Statement => {}
        }
        Ok(())
    }

    fn drill(&mut self, items: &[Item]) -> Result<bool, Fault> {
        let name = |item: &Item| self.file().part(&item.name).to_ascii_uppercase();
        let first = name(&items[0]);
        match items {
            [item] if first == b"MCALL" && item.what == What::Name => {
                self.drilling = None;
                self.modal_call = None;
                Ok(true)
            }
            [_, cycle] if first == b"MCALL" && is_drilling(&name(cycle)) => {
                let drilling = drilling_of(self, cycle)?;
                self.drilling = Some(drilling);
                self.modal_call = None;
                Ok(true)
            }
            [cycle] if is_drilling(&first) => {
                let drilling = drilling_of(self, cycle)?;
                self.drill_here(&drilling)?;
                Ok(true)
            }
            [pattern] if matches!(first.as_slice(), b"HOLES1" | b"HOLES2") => {
                self.holes(pattern)?;
                Ok(true)
            }
            [_, _] if first == b"MCALL" && self.call(&items[1..])?.is_some() => {
                self.drilling = None;
                let level = self.levels.len();
                self.modal_call = self.at().map(|place| (place, level));
                Ok(true)
            }
            [item, ..] if first == b"MCALL" => Err(self.fault(
                &item.span,
                "what it calls at each place, is not followed",
                "write the calls out, give the file of the subprogram, or drill by CYCLE81 to CYCLE89",
            )),
            [.., cycle] if items.iter().any(|item| is_drilling(&name(item))) => Err(self.fault(
                &cycle.span,
                "more stands in the block of a cycle",
                "write the cycle as a block of its own",
            )),
            _ => Ok(false),
        }
    }
}

fn is_literal(value: &Expression) -> bool {
    match value {
        Expression::Number(_) | Expression::Text(_) => true,
        Expression::Negative(inner) => matches!(**inner, Expression::Number(_)),
        _ => false,
    }
}

fn has_variable(value: &Expression) -> bool {
    match value {
        Expression::Number(_) | Expression::Text(_) => false,
        Expression::Variable { .. } => true,
        Expression::Negative(inner) | Expression::Not(inner) => has_variable(inner),
        Expression::Binary(_, sides) => has_variable(&sides.0) || has_variable(&sides.1),
        Expression::Call { arguments, .. } => arguments.iter().any(has_variable),
    }
}

fn text_of(value: &Value) -> Vec<u8> {
    match value {
        Value::Number(value) => number_text(*value).into_bytes(),
        Value::Text(text) => [b"\"", text.as_slice(), b"\""].concat(),
    }
}
