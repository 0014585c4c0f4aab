//! Remedies of an unknown speed, in words of the language of the program.

use crate::model::language::Language;
use crate::program_language::SPEED_REMEDY_OF_BLOCKS;

/// Remedy of an unknown speed of a motion at feed.
pub(crate) fn speed_remedy(language: Option<Language>) -> &'static str {
    language.map_or(SPEED_REMEDY_OF_BLOCKS, |language| language.speed_remedy())
}
