//! Negative numbers on the command line, which its reader would take for options.

use std::ffi::OsString;

/// Negative numbers as in `-5e-12` and `-.5` in plain digits: the reader of the command line takes them
/// for options. The value stays the same to the last bit.
pub(crate) fn plain_numbers(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut options_ended = false;
    words
        .map(|word| {
            options_ended |= word == "--";
            let plain = word
                .to_str()
                .filter(|w| !options_ended && looks_negative(w))
                .and_then(|w| w.parse::<f64>().ok())
                .filter(|value| value.is_finite());
            // Written in full by Rust: the shortest digits that give the same number again.
            plain.map_or(word, |value| format!("{value}").into())
        })
        .collect()
}

/// `-inf` or `-nan` where a number belongs, and the option before it: the reader of the command line would take it
/// for an option `-i` or `-n`.
pub(crate) fn no_number(words: &[OsString]) -> Option<String> {
    let words = words.iter().map(|w| w.to_str().unwrap_or_default());
    let mut option = "";
    for word in words.take_while(|w| *w != "--") {
        if word.starts_with("--") {
            option = word;
        }
        let lower = word.to_lowercase();
        if matches!(lower.as_str(), "-inf" | "-infinity" | "-nan") {
            let place = match option {
                "" => String::new(),
                option => format!("{option}: "),
            };
            return Some(format!(
                "{place}'{word}' is no finite number; write one as in -12.5"
            ));
        }
    }
    None
}

/// A minus and a digit, or a point.
fn looks_negative(word: &str) -> bool {
    let after = word.strip_prefix('-').and_then(|w| w.chars().next());
    after.is_some_and(|c| c.is_ascii_digit() || c == '.')
}
