//! Name and unit that the first and the last block of a program state.

use crate::error::ProgramError;
use crate::heidenhain::blocks::Block;
use crate::text::source::SourceFile;

/// Name and unit (MM or INCH) of BEGIN PGM and END PGM; empty if missing.
fn stated(file: &SourceFile, block: &Block) -> [String; 2] {
    let mut parts = file.part(&block.text).split(|byte| *byte == b';');
    let text = String::from_utf8_lossy(parts.next().unwrap_or_default()).to_uppercase();
    let mut words: Vec<&str> = text.split_whitespace().skip(2).collect();
    let unit = words.pop_if(|word| *word == "MM" || *word == "INCH");
    [words.join(" "), unit.unwrap_or_default().to_owned()]
}

/// An END PGM that is that of another program.
pub(crate) struct OtherEnd {
    pub fault: ProgramError,
    /// The unit differs, not only the name.
    pub has_other_unit: bool,
}

/// The END PGM of a program that states another name or unit than its BEGIN PGM, if it does.
///
/// The control writes both from one name and one unit: HEIDENHAIN, TNC 640, user's manual, Klartext programming, "Creating and
/// writing programs".
pub(crate) fn other_end(file: &SourceFile, blocks: &[Block], begin: usize) -> Option<OtherEnd> {
    let is_end = |block: &&Block| {
        let words = block.words(file.bytes());
        words.first().is_some_and(|word| word.is("END"))
    };
    let end = blocks.get(begin..)?.iter().find(is_end)?;
    let (first, last) = (stated(file, &blocks[begin]), stated(file, end));
    let differs = |part: &usize| {
        let both = [&first[*part], &last[*part]];
        first[*part] != last[*part] && both.iter().all(|text| !text.is_empty())
    };
    // The unit counts most.
    let part = [1, 0].into_iter().find(differs)?;
    let line = file.line_of(blocks[begin].text.start);
    let reason = format!(
        "the program ends as {} and begins as {} in line {line}",
        last[part], first[part]
    );
    let remedy =
        "give one whole program, with one name and one unit in its first and its last block";
    Some(OtherEnd {
        fault: ProgramError::at(file, end.text.clone(), reason, remedy),
        has_other_unit: part == 1,
    })
}
