//! Values that the caller states for what only the controller knows.

use std::collections::{BTreeMap, BTreeSet};

use crate::interpreter::value::{Datum, Value};
use crate::model::stated_value::StatedValue;
use crate::options::ReadOptions;
use crate::text::finding::Finding;
use crate::text::name::Name;

/// Stated values, and which of them the run asked for.
pub(crate) struct StatedValues<'o> {
    options: &'o ReadOptions,
    values: BTreeMap<Name, Datum>,
    used: BTreeSet<Name>,
}

impl<'o> StatedValues<'o> {
    /// Values of the caller's options.
    pub(crate) fn of(options: &'o ReadOptions) -> Self {
        let values = options.values.iter().filter_map(|(name, value)| {
            let value = match value {
                StatedValue::Number(number) => Value::Number(*number),
                StatedValue::Truth(truth) => Value::Truth(*truth),
                StatedValue::Text(text) => Value::Text(text.as_str().into()),
            };
            Some((Name::of(name.as_bytes())?, Datum::of(value)))
        });
        Self {
            options,
            values: values.collect(),
            used: BTreeSet::new(),
        }
    }

    /// True where nothing is stated.
    pub(crate) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The value of a name, which the run asks for.
    pub(crate) fn ask(&mut self, name: &Name) -> Option<Datum> {
        let value = self.values.get(name)?;
        self.used.insert(*name);
        Some(value.clone())
    }

    /// Values that decide the way of the program, and those that the run does not ask for.
    pub(crate) fn findings(&self) -> impl Iterator<Item = Finding> {
        self.options.values.iter().map(|(name, value)| {
            let is_used = Name::of(name.as_bytes()).is_some_and(|own| self.used.contains(&own));
            let message = match (is_used, value) {
                (false, _) => {
                    format!("a value of `{name}` is stated, and the run does not ask for it")
                }
                (true, StatedValue::Number(number)) => {
                    format!("`{name}` is {number}, as is stated")
                }
                (true, StatedValue::Truth(truth)) => format!("`{name}` is {truth}, as is stated"),
                (true, StatedValue::Text(text)) => format!("`{name}` is \"{text}\", as is stated"),
            };
            Finding {
                file: 0,
                line: 1,
                message,
            }
        })
    }
}
