//! Statements that only structure a program; a converted program does not need them.

use crate::model::language::Language;

/// True if a statement only structures its program.
pub(crate) fn orders_only(language: Language, statement: &str) -> bool {
    let upper = statement.to_ascii_uppercase();
    (language.order_words().iter()).any(|word| begins(&upper, word))
}

/// True if a statement begins with a whole word; a word that ends in a sign may be continued.
fn begins(statement: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is_whole = word.starts_with('$') || !word.ends_with(is_part);
    let behind = statement.strip_prefix(word);
    behind.is_some_and(|rest| is_whole || !rest.starts_with(is_part))
}
