//! Values as a language writes them.

use crate::interpreter::reading::Grammar;
use crate::interpreter::value::{Datum, Value};

/// A value by the grammar of a language; `None` if a part of it is unknown.
pub(crate) fn printed(grammar: &Grammar, datum: &Datum) -> Option<String> {
    let list = |before: &str, parts: &mut dyn Iterator<Item = &Datum>| {
        let [open, close] = grammar.list?.map(char::from);
        let parts: Option<Vec<String>> = parts.map(|part| printed(grammar, part)).collect();
        Some(format!("{before}{open}{}{close}", parts?.join(",")))
    };
    Some(match &datum.value {
        Value::Number(value) => value.to_string(),
        Value::Truth(value) => grammar.truths[usize::from(*value)].to_owned(),
        Value::Text(text) => format!("\"{text}\""),
        Value::List(parts) => list("", &mut parts.iter())?,
        Value::Members(members) => {
            let (word, _) = grammar.aggregate?;
            list(word, &mut members.iter().map(|(_, part)| part))?
        }
        Value::Unknown(_) => return None,
    })
}
