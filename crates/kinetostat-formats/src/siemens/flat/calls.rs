//! Calls of subprograms, and the way back: behind one with SAVE the G codes in force at its call, the settable zero and the programmable
//! frame come back.
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, programming manual, job planning, "Save modal G functions (SAVE)", and function manual,
//! basic functions, K2 "Subprograms with SAVE attribute": behind the call the frame that was active before it is active again.

use crate::flat_run::{Behind, Runs};
use crate::siemens::block::{Argument, Item, What};
use crate::siemens::called::{key_of_call, named_by};
use crate::siemens::expression::Expression;
use crate::siemens::flat::runner::{Fault, Level, Runner};
use crate::siemens::values::{Value, Variable};

/// A subprogram that a block calls.
pub(super) struct Call<'b> {
    pub unit: usize,
    pub arguments: &'b [Argument],
    pub times: u32,
}

impl<'r> Runner<'r> {
    /// The subprogram that the words of a block call, if they do.
    pub(super) fn call<'b>(&self, items: &'b [Item]) -> Result<Option<Call<'b>>, Fault> {
        let name = |item: &Item| self.file().part(&item.name).to_ascii_uppercase();
        let Some(first) = items.first() else {
            return Ok(None);
        };
        let Some((named, rest)) = named_by(self.file(), items) else {
            return Err(self.fault(
                &first.span,
                "what it calls is not stated",
                "call it by its name",
            ));
        };
        let arguments: &[Argument] = match &named.what {
            What::Call(arguments) => arguments,
            _ => &[],
        };
        let called = key_of_call(self.file().part(&named.name));
        let is_value = matches!(first.what, What::Value { .. });
        let Some(unit) = self.names.get(&called).copied().filter(|_| !is_value) else {
            // The reader of the flat text says what is assumed of a call that no file holds.
            return Ok(None);
        };
        let times = match rest {
            [] => 1,
            [item] => match (&item.what, name(item).as_slice()) {
                (What::Value { value, .. }, b"P") => self.runs(&item.span, value)?,
                _ => return Err(self.not_alone(item)),
            },
            [item, ..] => return Err(self.not_alone(item)),
        };
        Ok(Some(Call {
            unit,
            arguments,
            times,
        }))
    }

    /// The subprogram that MCALL calls behind each block with a place, in the program that states it.
    pub(super) fn modal_call(&self) -> Result<Option<Call<'r>>, Fault> {
        let Some((at, _)) = self
            .modal_call
            .filter(|(_, level)| *level == self.levels.len())
        else {
            return Ok(None);
        };
        let units = self.units;
        self.call(&units[at.file].lines[at.block].block.items[1..])
    }

    fn not_alone(&self, item: &Item) -> Fault {
        self.fault(
            &item.span,
            "more stands in the block of a call",
            "write the call as a block of its own",
        )
    }

    /// Begins a subprogram.
    pub(super) fn enter(&mut self, call: &Call<'_>) -> Result<(), Fault> {
        self.may_call()?;
        let units = self.units;
        let unit = &units[call.unit];
        let bytes = self.file().bytes();
        if let Some(argument) = call.arguments.get(unit.parameters.len()) {
            return Err(self.fault(
                &argument.span,
                "the subprogram has fewer parameters",
                "mend the call",
            ));
        }
        let mut level = Level::of(call.unit);
        let mut own = std::collections::BTreeMap::new();
        for (index, parameter) in unit.parameters.iter().enumerate() {
            let argument = call
                .arguments
                .get(index)
                .and_then(|given| given.value.as_ref());
            let named = match argument {
                Some(Expression::Variable { name, indices }) => {
                    Some((self.file().part(name).to_ascii_uppercase(), indices))
                }
                _ => None,
            };
            if let (true, Some((name, indices))) = (parameter.by_reference, &named) {
                let places = indices.iter().map(|index| self.number(index));
                let places: Result<Vec<f64>, Fault> = places.collect();
                let back = (parameter.name.clone(), name.clone(), places?);
                level.back.push(back);
            }
            let whole = named.filter(|(_, indices)| indices.is_empty());
            let whole = whole.and_then(|(name, _)| self.variables.own.get(&name));
            // Arrays are given as they are.
            let given = whole.filter(|found| parameter.by_reference || !found.sizes.is_empty());
            let (bytes, value) = match argument {
                Some(value) => (bytes, Some(value)),
                None => (self.files[call.unit].bytes(), parameter.default.as_ref()),
            };
            let variable = match (given, value) {
                (Some(given), _) => given.clone(),
                (None, Some(value)) => Variable {
                    kind: parameter.kind,
                    sizes: Vec::new(),
                    values: vec![self.value_of(bytes, value)?],
                },
                (None, None) => Variable::zero(parameter.kind),
            };
            own.insert(parameter.name.clone(), variable);
        }
        level.caller = std::mem::replace(&mut self.variables.own, own);
        level.again = call.times.saturating_sub(1);
        level.modes = self.modes;
        level.frames = self.frames.clone();
        self.levels.push(level);
        Ok(())
    }

    fn value_of(&self, bytes: &[u8], value: &Expression) -> Result<Value, Fault> {
        let value = self.variables.value(bytes, value);
        value.map_err(|why| self.fault(&self.span(), why, "give the argument a value"))
    }

    /// The way back from a program at its end.
    pub(super) fn leave(&mut self) -> Result<(), Fault> {
        let units = self.units;
        let Some(level) = self.levels.pop() else {
            return Ok(());
        };
        if self.levels.is_empty() {
            return Ok(());
        }
        let depth = self.levels.len();
        self.modal_call = self.modal_call.filter(|(_, level)| *level <= depth);
        if units[level.unit].saves {
            self.restore(&level);
        }
        let inner = std::mem::replace(&mut self.variables.own, level.caller);
        for (parameter, name, places) in &level.back {
            let Some(found) = inner.get(parameter) else {
                continue;
            };
            match (self.variables.own.get_mut(name), places.is_empty()) {
                (Some(held), true) => *held = found.clone(),
                _ => {
                    let value = found.values.first().cloned();
                    let value = value.unwrap_or(Value::Number(0.0));
                    let done = self.variables.set(name, places, value);
                    done.map_err(|why| self.fault(&self.span(), why, "declare it by DEF"))?;
                }
            }
        }
        if level.again > 0 {
            return self.enter_again(level.again);
        }
        let line = self.levels.last().map_or(0, |level| level.line);
        self.arrive(line + 1, false);
        Ok(())
    }

    /// Writes what puts back the codes and the frame of a call.
    ///
    /// What the machine alone knows is refused at the call.
    fn restore(&mut self, level: &Level) {
        match level.modes.restored_from(&self.modes) {
            Ok(codes) if codes.is_empty() => {}
            Ok(codes) => self.write_line(codes.as_bytes()),
            Err(code) => {
                let fault = self.fault(
                    &self.span(),
                    format!("the subprogram states {code} and gives back at its end (SAVE) what was before, which the program does not state"),
                    "state the code that holds before the call",
                );
                self.refuse(fault, Behind::Same);
            }
        }
        self.modes = level.modes;
        if self.frames.is(&level.frames) {
            return;
        }
        self.frames = level.frames.clone();
        let mut now = self.modes;
        if !level
            .frames
            .statements()
            .first()
            .is_some_and(|first| first.instead)
        {
            self.write_line(b"TRANS");
        }
        for statement in level.frames.statements() {
            let codes = statement.modes.of_frame_from(&mut now);
            if !codes.is_empty() {
                self.write_line(codes.as_bytes());
            }
            self.write_line(&statement.text);
        }
        let codes = self.modes.of_frame_from(&mut now);
        if !codes.is_empty() {
            self.write_line(codes.as_bytes());
        }
    }

    /// Runs the subprogram of the block in force once more.
    fn enter_again(&mut self, times: u32) -> Result<(), Fault> {
        let units = self.units;
        let Some(level) = self.levels.last() else {
            return Ok(());
        };
        let items = &units[level.unit].lines[level.line].block.items;
        if let Some(mut call) = self.call(items)? {
            call.times = times;
            self.enter(&call)?;
        }
        Ok(())
    }
}
