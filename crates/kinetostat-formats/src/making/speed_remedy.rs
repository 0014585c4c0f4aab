//! What is said where the speed of a motion is not known, in words of the language of the program.

use crate::model::language::Language;
use crate::program_language::SPEED_REMEDY_OF_BLOCKS;

/// What to do where the speed of a motion at feed is not known.
pub(crate) fn speed_remedy(language: Option<Language>) -> &'static str {
    language.map_or(SPEED_REMEDY_OF_BLOCKS, |language| language.speed_remedy())
}
