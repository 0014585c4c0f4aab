//! Values that the caller states.

use std::collections::BTreeMap;

use crate::text::finding::Finding;

/// A value that only the controller knows, as the caller states it.
#[derive(Debug, Clone, PartialEq)]
pub enum StatedValue {
    /// A number.
    Number(f64),
    /// TRUE or FALSE.
    Truth(bool),
    /// Any other text.
    Text(String),
}

/// Findings on the values that the caller states for a program in blocks, checked against its bytes.
pub(crate) fn told_of_values(values: &BTreeMap<String, StatedValue>, bytes: &[u8]) -> Vec<Finding> {
    let text = String::from_utf8_lossy(bytes).to_ascii_uppercase();
    let names = |name: &str| {
        let mut found = text.match_indices(name);
        found
            .any(|(at, _)| !text[at + name.len()..].starts_with(|next: char| next.is_ascii_digit()))
    };
    let finding = |(name, value): (&String, &StatedValue)| {
        let name = name.to_ascii_uppercase();
        let value = match value {
            StatedValue::Number(number) => number.to_string(),
            StatedValue::Truth(truth) => truth.to_string(),
            StatedValue::Text(text) => text.clone(),
        };
        let message = match names(&name) {
            true => format!(
                "`{name}` is {value}, as is stated, unless the program gives it another value"
            ),
            false => format!("a value of `{name}` is stated, and the program does not name it"),
        };
        Finding {
            file: 0,
            line: 1,
            message,
        }
    };
    values.iter().map(finding).collect()
}
