//! Values of Q parameters.

use std::collections::BTreeMap;

use crate::heidenhain::expand::expression::Parameters;
use crate::heidenhain::words::Word;

/// Values of parameters; none where the machine alone knows it.
pub(crate) struct Values(pub BTreeMap<String, f64>);

impl Parameters for Values {
    fn value(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }
}

/// Whether a word is the sign before a value.
pub(crate) fn begins_value(word: &Word, bytes: &[u8]) -> bool {
    bytes.get(word.span.start) == Some(&b'=')
}
