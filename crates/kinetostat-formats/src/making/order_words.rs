//! Statements that only order a program: nothing of it is lost without them.

use crate::model::language::Language;

/// Whether a statement only orders its program: nothing of it is lost.
pub(crate) fn orders_only(language: Language, statement: &str) -> bool {
    let upper = statement.to_ascii_uppercase();
    (language.order_words().iter()).any(|word| begins(&upper, word))
}

/// Whether a statement begins with a word as a whole; what begins with a sign may go on.
fn begins(statement: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is_whole = word.starts_with('$') || !word.ends_with(is_part);
    let behind = statement.strip_prefix(word);
    behind.is_some_and(|rest| is_whole || !rest.starts_with(is_part))
}
