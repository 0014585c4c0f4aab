//! The text of the pieces of one block: words replaced in place, added, taken out.
//!
//! Knows: the block as it stands ([`BlockText`]), its move and what the controller holds before it. Takes the pieces of the block,
//! gives their lines ([`block_writer`]): the words that say how to move, where to and how fast ([`words`],
//! [`crate::writing::blocks::arc_words`]), and the shares of other axes.

pub(crate) mod arc_words;
pub(crate) mod block_writer;
pub(crate) mod words;

use std::ops::Range;

use crate::reading::moment::is_written_last;
use crate::text::program::Program;
use crate::text::{Line, Word};

/// Letters of the coordinates.
pub(crate) const AXES: [u8; 3] = *b"XYZ";

/// The word among these that says how to move.
pub(crate) fn motion_word(words: &[Word]) -> Option<&Word> {
    words
        .iter()
        .find(|word| word.letter == b'G' && [0.0, 1.0, 2.0, 3.0].contains(&word.value))
}

/// True if a word acts after the block's motion.
pub(crate) fn is_after_motion(word: &Word) -> bool {
    is_written_last(word.letter, word.tenths())
}

/// Bytes of the number of a word.
pub(crate) fn number_span(word: &Word) -> Range<usize> {
    word.number as usize..word.end as usize
}

/// The line of the block itself, or one of those behind it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    OwnLine,
    FurtherLine,
}

/// Changes of a line.
#[derive(Default)]
pub(crate) struct Edits {
    /// Replaced bytes and their new text.
    pub replaced: Vec<(Range<usize>, String)>,
    /// Words that the line has not.
    pub added: String,
}

/// A block of the input.
#[derive(Clone, Copy)]
pub(crate) struct BlockText<'a> {
    pub program: &'a Program,
    pub line: &'a Line,
    pub words: &'a [Word],
    /// Separator between two words.
    pub separator: &'static str,
    lower_case: bool,
}

impl<'a> BlockText<'a> {
    pub fn of(program: &'a Program, line: &'a Line) -> Self {
        let words = program.words(line);
        let bytes = program.bytes();
        let spaced = words.len() < 2
            || words[1..]
                .iter()
                .any(|word| matches!(bytes[word.start as usize - 1], b' ' | b'\t'));
        Self {
            program,
            line,
            words,
            separator: if spaced { " " } else { "" },
            lower_case: words
                .iter()
                .any(|word| bytes[word.start as usize].is_ascii_lowercase()),
        }
    }

    pub fn word(&self, letter: u8) -> Option<&'a Word> {
        self.words.iter().find(|word| word.letter == letter)
    }

    /// The number of a word, in the unit of the program.
    pub fn number_of(&self, letter: u8) -> Option<f64> {
        self.word(letter).map(|word| word.value)
    }

    /// Adds a word to a text.
    pub fn add_word(&self, text: &mut String, letter: u8, number: &str) {
        text.push_str(self.separator);
        text.push(self.cased(letter));
        text.push_str(number);
    }

    /// A letter as the block writes them.
    pub fn cased(&self, letter: u8) -> char {
        let letter = char::from(letter);
        match self.lower_case {
            true => letter.to_ascii_lowercase(),
            false => letter,
        }
    }

    /// A word with this number: the one that stands there with another number, or an added one.
    pub fn edit_word(&self, edits: &mut Edits, letter: u8, number: String) {
        match self.word(letter) {
            Some(word) => edits.replaced.push((number_span(word), number)),
            None => self.add_word(&mut edits.added, letter, &number),
        }
    }

    /// Takes a word out.
    pub fn remove_word(&self, edits: &mut Edits, word: &Word) {
        edits
            .replaced
            .push((self.with_blanks_before(word), String::new()));
    }

    /// Words that act when the motion is over.
    pub fn words_after_motion(&self) -> impl Iterator<Item = &'a Word> {
        self.words.iter().filter(|word| is_after_motion(word))
    }

    /// True if the block ends the program.
    pub fn ends_program(&self) -> bool {
        let ends = |word: &Word| word.letter == b'M' && [2.0, 30.0].contains(&word.value);
        self.words.iter().any(ends)
    }

    fn with_blanks_before(&self, word: &Word) -> Range<usize> {
        let content = self.program.content(self.line);
        let bytes = self.program.bytes();
        let mut start = word.start as usize;
        while start > content.start && matches!(bytes[start - 1], b' ' | b'\t') {
            start -= 1;
        }
        start..word.end as usize
    }

    /// Position for added words: after the last coordinate word, else where the arc's words stood, else after the
    /// last axis word, else at the end of the words.
    pub fn place_for_added(&self) -> usize {
        let last = |letters: &[u8]| {
            self.words
                .iter()
                .rev()
                .find(|word| letters.contains(&word.letter))
        };
        if let Some(word) = last(&AXES) {
            return word.end as usize;
        }
        if let Some(word) = self
            .words
            .iter()
            .find(|word| b"IJKR".contains(&word.letter))
        {
            return self.with_blanks_before(word).start;
        }
        last(b"ABCEUVW")
            .or(self.words.last())
            .map_or(0, |word| word.end as usize)
    }

    /// The line with its changes, of which the added words stand at a place.
    pub fn edited(&self, edits: Edits, place_for_added: usize) -> Vec<u8> {
        let content = self.program.content(self.line);
        let bytes = self.program.bytes();
        let Edits {
            mut replaced,
            added,
        } = edits;
        if !added.is_empty() {
            let added = match place_for_added == content.start {
                true => added.trim_start().to_owned(),
                false => added,
            };
            replaced.push((place_for_added..place_for_added, added));
        }
        replaced.sort_by_key(|(span, _)| (span.start, span.end));
        let mut line = Vec::with_capacity(content.len() + 24);
        let mut at = content.start;
        for (span, text) in replaced {
            line.extend_from_slice(&bytes[at..span.start]);
            line.extend_from_slice(text.as_bytes());
            at = span.end;
        }
        line.extend_from_slice(&bytes[at..content.end]);
        line
    }
}
