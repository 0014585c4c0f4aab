//! Warnings that concern many lines: each text is given once, with its first lines and their number.

use crate::path::moves::{Warning, WarningTopic};

/// Lines that are named; further ones are counted.
const LINES_NAMED: usize = 6;

/// Warnings by their text, in the order in which they were first given.
#[derive(Default)]
pub(crate) struct Repeated {
    all: Vec<Lines>,
}

struct Lines {
    text: String,
    topic: WarningTopic,
    /// The first of them.
    named: Vec<usize>,
    count: usize,
}

impl Repeated {
    /// Counts a line for a text; only the first [`LINES_NAMED`] of them are kept.
    pub(crate) fn note(&mut self, line: usize, text: &str) {
        self.add(line, text, WarningTopic::Program);
    }

    /// The same for a text that matters only where the program is corrected.
    pub(crate) fn note_of_corrections(&mut self, line: usize, text: &str) {
        self.add(line, text, WarningTopic::Corrections);
    }

    fn add(&mut self, line: usize, text: &str, topic: WarningTopic) {
        match self.all.iter_mut().find(|known| known.text == text) {
            Some(known) => {
                known.count += 1;
                if known.named.len() < LINES_NAMED {
                    known.named.push(line);
                }
            }
            None => self.all.push(Lines {
                text: text.to_owned(),
                topic,
                named: vec![line],
                count: 1,
            }),
        }
    }

    /// One warning for each text, at its first line.
    pub(crate) fn finish(self) -> impl Iterator<Item = Warning> {
        self.all.into_iter().map(|lines| Warning {
            topic: lines.topic,
            ..Warning::new(
                lines.named[0],
                format!("{}{}", lines.text, lines.description()),
            )
        })
    }
}

impl Lines {
    /// "; so on lines 4, 8 and 9"; nothing where there is one line only, which stands before the text.
    fn description(&self) -> String {
        let named: Vec<String> = self.named.iter().map(ToString::to_string).collect();
        match (self.count - named.len(), named.split_last()) {
            (0, Some((last, rest))) if !rest.is_empty() => {
                format!("; so on lines {} and {last}", rest.join(", "))
            }
            (0, _) => String::new(),
            (more, _) => format!(
                "; so on {} lines: {} and {more} more",
                self.count,
                named.join(", ")
            ),
        }
    }
}
