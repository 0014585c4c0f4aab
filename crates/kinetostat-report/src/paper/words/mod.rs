//! The words of papers: one table of short texts for each language, with the same names in each, and one function for each kind of
//! sentence, which is matched in full. A text that a language lacks does not compile.

mod english;
mod french;
mod german;
mod shared;
pub(crate) mod table;

use crate::paper::language::Language;
use crate::paper::words::table::Words;
use crate::run::Shown;
use crate::run::facts::Left;
use crate::run::meaning::Statement;

/// The words of a language.
pub(crate) fn words(language: Language) -> &'static Words {
    match language {
        Language::English => &english::WORDS,
        Language::French => &french::WORDS,
        Language::German => &german::WORDS,
    }
}

/// A statement of the verdict; none where it says nothing of this run.
pub(crate) fn statement(
    language: Language,
    statement: &Statement,
    result: &Shown<'_>,
) -> Option<String> {
    match language {
        Language::English => Some(statement.sentence(result)),
        Language::French => french::statement(statement, result),
        Language::German => german::statement(statement, result),
    }
}

/// Name, size and explanation of what a program leaves.
pub(crate) fn left(language: Language, left: Left, result: &Shown<'_>) -> [String; 3] {
    match language {
        Language::English => [left.name().to_owned(), left.size(result), left.text(result)],
        Language::French => french::left(left, result),
        Language::German => german::left(left, result),
    }
}
