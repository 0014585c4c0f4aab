//! Results as JSON.

use crate::ui::failure::{Answer, Failure};

/// A result as JSON with a final newline.
pub(crate) fn json<T: serde::Serialize>(value: &T) -> Answer<String> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| {
        Failure::input(format!("the result cannot be written as JSON: {error}"))
    })?;
    text.push('\n');
    Ok(text)
}
