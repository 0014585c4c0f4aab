//! Joint motions of a source that take the arm to another configuration, which no straight way does.

use std::collections::{BTreeMap, BTreeSet};

use crate::making::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::routines::{running_lines, words_of};
use crate::model::Language;
use crate::model::motion::MotionKind;
use crate::model::program::RobotProgram;
use crate::model::target::{Configuration, Target};
use crate::path::of_program::RobotPath;
use crate::text::number::in_words;

/// Numbers of the moves of a path that do so: what they state is not what was stated last, or nothing was.
pub(crate) fn changes(program: &RobotProgram, robot: &RobotPath) -> BTreeSet<usize> {
    let switches = Switches::of(program, robot.file);
    let mut found = BTreeSet::new();
    let mut last: Option<&Configuration> = None;
    let mut has_begun = false;
    for (number, index) in robot.motions.iter().enumerate() {
        let Some(motion) = program.motions.get(*index) else {
            continue;
        };
        let Target::Pose(pose) = &motion.target else {
            // The configuration at joint values, and at an unknown position, is unknown.
            last = None;
            continue;
        };
        // To the first pose the arm goes from wherever it is, by joints in every made program.
        let is_first = !std::mem::replace(&mut has_begun, true);
        let configuration = &pose.configuration;
        if text_of(program.language, configuration).is_none() {
            continue;
        }
        let is_joint = motion.kind == MotionKind::Joint;
        let is_followed = !switches.is_off_at(motion.line);
        if is_joint && !is_followed {
            // The arm takes the nearest one.
            last = None;
            continue;
        }
        let is_other = last.is_none_or(|last| !is_same(program.language, last, configuration));
        if is_joint && is_other && !is_first {
            found.insert(number);
        }
        last = Some(configuration);
    }
    found
}

/// True if two configurations are equivalent.
fn is_same(language: Language, one: &Configuration, other: &Configuration) -> bool {
    match language {
        // The letters of the arm stand before the numbers of turns.
        Language::FanucLs => {
            let words = |stated: &Configuration| -> Vec<String> {
                let parts = stated.text.split([',', ' ']).map(str::trim);
                let parts = parts.filter(|part| !part.is_empty());
                parts.map(str::to_ascii_uppercase).collect()
            };
            words(one) == words(other)
        }
        _ => one.numbers == other.numbers,
    }
}

/// Findings on configurations: kept if the made program can state their ends, else lost.
pub(crate) fn findings(
    program: &RobotProgram,
    robot: &RobotPath,
    is_kept: bool,
    stated: Option<&str>,
    language: MakeLanguage,
) -> Option<MakeFinding> {
    if !language.is_of_an_arm() {
        return None;
    }
    let moves = changes(program, robot);
    let of_move = |number: &usize| Some(program.motions.get(*robot.motions.get(*number)?)?.line);
    let lines: Vec<usize> = moves.iter().filter_map(of_move).collect();
    let first = *lines.first()?;
    let named = in_words(&lines);
    let (they, takes) = match lines.len() {
        1 => ("this joint motion", "takes"),
        _ => ("these joint motions, here first,", "take"),
    };
    let message = if is_kept {
        format!(
            "{they} {takes} the arm to another configuration, and so joint motions stay joint motions there ({named})"
        )
    } else {
        let keeps = match (language, stated) {
            (MakeLanguage::FanucLs, Some(stated)) => {
                format!("every position has the template's '{stated}'")
            }
            (MakeLanguage::FanucLs, None) => "every position has the same CONFIG here".to_owned(),
            _ => "the arm keeps the one that it has here".to_owned(),
        };
        format!(
            "{they} {takes} the arm to another configuration ({named}), and {keeps}: divide the source there and make a program of each part with its own `configuration` in the template, or write such a joint motion into the made program by hand"
        )
    };
    Some(MakeFinding::of(first, message))
}

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
