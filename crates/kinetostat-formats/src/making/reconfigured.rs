//! Joint motions of a source that take the arm to another configuration, which no straight way does.

use std::collections::BTreeSet;

use crate::making::fault::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::stated_configurations::{Switches, text_of};
use crate::model::language::Language;
use crate::model::motion::MotionKind;
use crate::model::program::RobotProgram;
use crate::model::target::{Configuration, Target};
use crate::path::of_program::RobotPath;
use crate::text::line_words::in_words;

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
    (is_kept, stated, language): (bool, Option<&str>, MakeLanguage),
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
