//! Arm configurations stated by targets, and the range in which RAPID monitors them.

use std::collections::BTreeMap;

use crate::making::routines::{running_lines, words_of};
use crate::model::language::Language;
use crate::model::program::RobotProgram;
use crate::model::target::Configuration;

/// The text of a configuration; none where nothing is stated.
pub(crate) fn text_of(language: Language, configuration: &Configuration) -> Option<String> {
    if configuration.text.trim().is_empty() {
        return None;
    }
    Some(match language {
        // Spaces and ends of lines of the source are none of its meaning.
        Language::Rapid => {
            let numbers = configuration.numbers.iter().map(|n| format!("{n:.0}"));
            format!("[{}]", numbers.collect::<Vec<_>>().join(","))
        }
        _ => configuration.text.trim().to_owned(),
    })
}

/// Switches of `ConfJ` in a RAPID program, by their place.
#[derive(Default)]
pub(crate) struct Switches {
    /// Lines with motions behind `ConfJ\Off`.
    off: BTreeMap<usize, bool>,
    /// The order of the lines is unknown, and a switch exists.
    somewhere: bool,
}

impl Switches {
    pub(crate) fn of(program: &RobotProgram, file: usize) -> Self {
        let mut found = Self::default();
        let source = match program.files.get(file) {
            Some(source) if program.language == Language::Rapid => source,
            _ => return found,
        };
        let switch = |line: usize| {
            let words = words_of(program.language, source, line);
            let mut pairs = words.windows(2).rev();
            pairs.find_map(|pair| match (pair[0].as_str(), pair[1].as_str()) {
                ("CONFJ", "OFF") => Some(true),
                ("CONFJ", "ON") => Some(false),
                _ => None,
            })
        };
        let Some(running) = running_lines(program, file) else {
            found.somewhere = (1..=source.line_count()).any(|line| switch(line) == Some(true));
            return found;
        };
        let mut is_off = false;
        for running in running {
            is_off = switch(running.line).unwrap_or(is_off);
            found.off.entry(running.line).or_insert(is_off);
        }
        found
    }

    pub(crate) fn is_off_at(&self, line: usize) -> bool {
        self.off.get(&line).copied().unwrap_or(self.somewhere)
    }
}
