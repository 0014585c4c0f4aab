//! Statements that are calls: `name(value, option=value)`.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression};
use crate::interpreter::run::{Dialect, Run};
use crate::interpreter::symbols::Scope;
use crate::interpreter::tree::Flow;
use crate::interpreter::value::Datum;
use crate::table::Treatment;
use crate::text::Name;

/// An argument by its name in capitals, or by its place among the parameters.
pub(crate) fn argument<'e>(
    parameters: &[&str],
    arguments: &'e [Argument],
    name: &str,
) -> Option<&'e Expression> {
    let mut all = arguments.iter();
    let named = all.find(|own| own.option.is_some_and(|own| own.is(name)));
    let place = parameters.iter().position(|own| *own == name);
    let in_place = || arguments.get(place?).filter(|own| own.option.is_none());
    named.or_else(in_place)?.value.as_ref()
}

impl<D: Dialect> Run<'_, '_, D> {
    /// The result of a function that is in none of the files: as it is computed here, or why it is not.
    pub(crate) fn called_function(
        &mut self,
        name: &Name,
        arguments: &[Argument],
        whole: &Expression,
    ) -> Option<Datum> {
        let values = arguments.iter().filter_map(|own| own.value.as_ref());
        let values: Vec<Datum> = values.map(|value| self.value(value)).collect();
        let is_ordered = arguments.iter().all(|own| own.option.is_none());
        let found = is_ordered.then(|| D::computed(name, &values)).flatten();
        if found.is_some() {
            return found;
        }
        let row = D::row(name.letters());
        self.note_call(row, &whole.tokens);
        row.filter(|row| row.treatment == Treatment::Understood)?;
        let reason = values.iter().find_map(Datum::unknown_reason)?;
        Some(Datum::unknown(reason.clone()))
    }

    /// Runs a motion, a routine of the files, or what the table of the language says of it.
    pub(crate) fn run_call(&mut self, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let word = file.word(tokens.start);
        let name = Name::of(word);
        let open = tokens.clone().find(|at| file.is(*at, b'('));
        let arguments = D::arguments_of(file, open.unwrap_or(tokens.start + 1)..tokens.end);
        if name.is_some_and(|name| D::is_motion(&name)) {
            if !self.begins_motion(tokens) {
                return Flow::Ends;
            }
            match D::motion(self, tokens, &arguments) {
                Ok(motion) => self.push_motion(motion),
                Err(reason) => {
                    self.fault(tokens, reason);
                    self.here = None;
                }
            }
            self.log_motion(tokens);
            return Flow::Next;
        }
        if let (Some(name), Scope::Routine(from)) = (&name, self.scope)
            && let Some(called) = self.symbols.routine(from, name)
        {
            return match self.call_with(called, &arguments, tokens) {
                Flow::Ends => Flow::Ends,
                _ => Flow::Next,
            };
        }
        self.log_instruction(tokens);
        for value in arguments.iter().filter_map(|own| own.value.as_ref()) {
            self.value(value);
        }
        // A call `object.method(...)` changes the object.
        if file.is(tokens.start + 1, b'.') {
            let object = D::expression_of(file, tokens.start..tokens.start + 1);
            let reason = self.changed(&object);
            self.lose(&object, &reason);
        }
        self.note_call(D::row(word), tokens);
        if let Some((word, effect)) = D::EFFECTS.iter().find(|(own, _)| word == own.as_bytes()) {
            let message = format!("{word} {effect}: it is carried, and not followed");
            self.find(tokens, message);
        }
        if let Some(value) = arguments.first().and_then(|own| own.value.as_ref()) {
            D::sets(self, word, value);
        }
        Flow::Next
    }
}
