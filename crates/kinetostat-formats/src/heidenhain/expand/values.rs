//! Values of Q parameters.

use std::collections::BTreeMap;

use crate::heidenhain::words::Word;

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
}

/// QL parameters of one program.
pub(crate) struct Local(BTreeMap<String, f64>);

/// Whether a parameter is that of one program alone.
fn is_local(name: &str) -> bool {
    name.starts_with("QL")
}

impl Values {
    fn of(&mut self, name: &str) -> &mut BTreeMap<String, f64> {
        match is_local(name) {
            true => &mut self.local,
            false => &mut self.shared,
        }
    }

    pub(crate) fn insert(&mut self, name: String, value: f64) {
        self.of(&name).insert(name, value);
    }

    pub(crate) fn remove(&mut self, name: &str) {
        self.of(name).remove(name);
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

/// Why a parameter has no value. The control knows no value of it either.
pub(crate) fn no_value(name: &str) -> String {
    match is_local(name) {
        true => format!(
            "{name} has no value that its program states (QL parameters are those of one program: one that is called has its own)"
        ),
        false => format!("{name} has no value that the program states"),
    }
}

/// Whether a word is the sign before a value.
pub(crate) fn begins_value(word: &Word, bytes: &[u8]) -> bool {
    bytes.get(word.span.start) == Some(&b'=')
}
