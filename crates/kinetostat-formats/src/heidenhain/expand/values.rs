//! Values of Q parameters.

use std::collections::BTreeMap;

use crate::heidenhain::words::{Word, parameter_at};
use crate::model::stated_value::StatedValue;
use crate::options::ReadOptions;

/// Values of parameters by their names in capitals; none where there is none.
pub(crate) trait Parameters {
    fn value(&self, name: &str) -> Option<f64>;
}

/// Values of parameters; none where the machine alone knows it.
///
/// Q and QR parameters are those of all programs, QL parameters those of one program: HEIDENHAIN, TNC 640, user's manual,
/// Klartext programming, "Q parameters: principle and overview of functions" ("QL: parameters only effective locally within one
/// NC program").
#[derive(Default)]
pub(crate) struct Values {
    shared: BTreeMap<String, f64>,
    local: BTreeMap<String, f64>,
    /// Values of machine parameters, as the caller states them.
    stated: BTreeMap<String, f64>,
}

/// QL parameters of one program.
pub(crate) struct Local(BTreeMap<String, f64>);

/// True if a parameter is local to one program.
fn is_local(name: &str) -> bool {
    name.starts_with("QL")
}

impl Values {
    fn of_kind(&mut self, name: &str) -> &mut BTreeMap<String, f64> {
        match is_local(name) {
            true => &mut self.local,
            false => &mut self.shared,
        }
    }

    /// Parameters begin with the values that the caller states; those that are none, with the reason.
    pub(crate) fn of(options: &ReadOptions) -> Result<Self, (String, &'static str)> {
        let mut values = Self::default();
        for (name, value) in &options.values {
            let key = name.to_ascii_uppercase();
            let is_name = parameter_at(key.as_bytes(), 0, key.len()) == Some(0..key.len());
            match value {
                StatedValue::Number(number) if is_name && number.is_finite() => {
                    values.insert(key.clone(), *number);
                    values.stated.insert(key, *number);
                }
                _ => {
                    return Err((
                        format!(
                            "a value of `{name}` is stated, and it is no Q parameter with a number"
                        ),
                        "state it so: --set Q11=5.5",
                    ));
                }
            }
        }
        Ok(values)
    }

    /// The machine gives a parameter a value: none is known but one that the caller states.
    pub(crate) fn read_from_machine(&mut self, name: &str) {
        match self.stated.get(name) {
            Some(value) => self.insert(name.to_owned(), *value),
            None => self.remove(name),
        }
    }

    pub(crate) fn insert(&mut self, name: String, value: f64) {
        self.of_kind(&name).insert(name, value);
    }

    pub(crate) fn remove(&mut self, name: &str) {
        self.of_kind(name).remove(name);
    }

    /// Another program begins, without QL parameters: those of the program that calls.
    pub(crate) fn called(&mut self) -> Local {
        Local(std::mem::take(&mut self.local))
    }

    /// The program that called goes on with its own.
    pub(crate) fn back(&mut self, local: Local) {
        self.local = local.0;
    }
}

impl Parameters for Values {
    fn value(&self, name: &str) -> Option<f64> {
        let held = match is_local(name) {
            true => &self.local,
            false => &self.shared,
        };
        held.get(name).copied()
    }
}

/// Reason why a parameter has no value; the control has none either.
pub(crate) fn no_value(name: &str) -> String {
    match is_local(name) {
        true => format!(
            "{name} has no value that its program states (QL parameters are those of one program: one that is called has its own)"
        ),
        false => format!("{name} has no value that the program states"),
    }
}

/// Remedy of a parameter without a value.
pub(crate) const STATE_VALUE: &str =
    "state it before (FN 0: Q1 = +5), or give the value that it has on the machine (--set Q1=5)";

/// True if a word is the `=` before a value.
pub(crate) fn begins_value(word: &Word, bytes: &[u8]) -> bool {
    bytes.get(word.span.start) == Some(&b'=')
}
