//! Words that are in force until another one of their kind takes their place, and which of them each cut is made with.

use crate::verify::other_word::{FaultKind, OtherWord};

/// Words of one kind as they come into force, each with its line.
#[derive(Clone, Debug)]
pub(crate) struct InForce {
    /// In force before any of them.
    usual: &'static str,
    changes: Vec<(usize, String)>,
}

/// A run of cuts that are made with another word than in the original.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Elsewhere {
    pub(crate) word: String,
    pub(crate) of_original: String,
    /// First and last line of the program, and the line of the original that the first belongs to.
    pub(crate) lines: [usize; 2],
    pub(crate) line_of_original: usize,
}

/// Runs beyond these are not listed.
const MOST: usize = 10;

impl InForce {
    /// Words in the order of their lines.
    pub(crate) fn new(
        usual: &'static str,
        words: impl IntoIterator<Item = (usize, String)>,
    ) -> Self {
        Self {
            usual,
            changes: words.into_iter().collect(),
        }
    }

    /// The word that is in force behind what a line says.
    pub(crate) fn on(&self, line: usize) -> &str {
        let behind = self.changes.partition_point(|(at, _)| *at <= line);
        let last = behind.checked_sub(1).map(|last| &self.changes[last].1);
        last.map_or(self.usual, String::as_str)
    }

    /// Where cuts are made with another word than in the original: `cut_lines` are lines of this program and of the original.
    pub(crate) fn elsewhere(
        &self,
        of_original: &Self,
        cut_lines: &[[usize; 2]],
        same: impl Fn(&str, &str) -> bool,
    ) -> Vec<Elsewhere> {
        let mut found: Vec<Elsewhere> = Vec::new();
        let mut goes_on = false;
        for [line, there] in cut_lines {
            let (word, wanted) = (self.on(*line), of_original.on(*there));
            if word == wanted || same(word, wanted) {
                goes_on = false;
                continue;
            }
            let last = found
                .last_mut()
                .filter(|last| goes_on && last.word == word && last.of_original == wanted);
            goes_on = true;
            match last {
                Some(last) => last.lines[1] = *line,
                None => found.push(Elsewhere {
                    word: word.to_owned(),
                    of_original: wanted.to_owned(),
                    lines: [*line; 2],
                    line_of_original: *there,
                }),
            }
            if found.len() > MOST {
                found.pop();
                break;
            }
        }
        found
    }
}

impl Elsewhere {
    /// What is said of it.
    pub(crate) fn other_word(self, fault: Option<FaultKind>, follows: &str) -> OtherWord {
        let [first, last] = self.lines;
        let cut = match first == last {
            true => format!("line {first} cuts"),
            false => format!("lines {first} to {last} cut"),
        };
        let text = format!(
            "{cut} with {}, the original with {} (line {} there){follows}",
            self.word, self.of_original, self.line_of_original
        );
        let lines = [Some(first), Some(self.line_of_original)];
        OtherWord::new(self.word, fault, lines, text)
    }
}
