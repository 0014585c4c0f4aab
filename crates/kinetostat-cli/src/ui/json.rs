//! Results as JSON, and with it on the screen.

use crate::ui::failure::{Answer, Failure};
use crate::ui::screen::{self, Stream};

/// A result as JSON with a final newline.
pub(crate) fn json<T: serde::Serialize>(value: &T) -> Answer<String> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| {
        Failure::input(format!("the result cannot be written as JSON: {error}"))
    })?;
    text.push('\n');
    Ok(text)
}

/// The text of an answer; with `as_json` the answer itself on the standard output, and the text beside it.
pub(crate) fn print_answer<T: serde::Serialize>(
    text: &str,
    answer: &T,
    as_json: bool,
) -> Answer<()> {
    if as_json {
        screen::print(Stream::Err, text)?;
        return screen::print_bytes(json(answer)?.as_bytes());
    }
    screen::print(Stream::Out, text)
}
