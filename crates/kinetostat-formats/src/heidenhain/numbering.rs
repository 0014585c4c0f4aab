//! Block numbers: a control shows and loads blocks that are numbered one after another.

use crate::heidenhain::blocks::blocks_of;
use crate::text::edits::Edits;

/// A program whose numbered blocks are numbered one after another from its first number. Blanks behind a number give way
/// where it becomes longer.
pub(crate) fn numbered_again(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    let mut last: Option<u64> = None;
    for block in blocks_of(bytes) {
        let Some(place) = block.number else {
            continue;
        };
        let digits = &bytes[place.clone()];
        let Ok(stated) = String::from_utf8_lossy(digits).parse::<u64>() else {
            continue;
        };
        let number = last.map_or(stated, |last| last.saturating_add(1));
        last = Some(number);
        if number == stated {
            continue;
        }
        let text = number.to_string();
        let blanks = bytes[place.end..block.lines.end]
            .iter()
            .take_while(|byte| **byte == b' ')
            .count();
        let longer = text.len().saturating_sub(digits.len());
        let taken = longer.min(blanks.saturating_sub(1));
        edits.replace(place.start..place.end + taken, text);
    }
    edits.applied_to(bytes)
}

/// True if the first block has a number: then all blocks have one.
pub(crate) fn is_numbered(bytes: &[u8]) -> bool {
    let mut blocks = blocks_of(bytes).into_iter();
    let begins = |words: &[crate::heidenhain::words::Word]| {
        words.first().is_some_and(|word| word.is("BEGIN"))
    };
    blocks.any(|block| block.number.is_some() && begins(&block.words(bytes)))
}
