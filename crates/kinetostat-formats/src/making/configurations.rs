//! How the arm reaches the poses of a source: kept in the same language, named as lost in another.

use std::collections::BTreeMap;

use crate::making::fault::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::reconfigured::changes;
use crate::making::routines::{running_lines, words_of};
use crate::making::step::StatedConfiguration;
use crate::model::motion::{Motion, MotionKind};
use crate::model::program::{Language, RobotProgram};
use crate::model::target::{Configuration, Target};
use crate::path::of_program::RobotPath;
use crate::text::line_words::in_words;

/// Whether a program is made in the language of its source, of those whose targets state configurations.
pub(crate) fn is_same(source: Language, made: MakeLanguage) -> bool {
    matches!(
        (source, made),
        (Language::Krl, MakeLanguage::Krl)
            | (Language::Rapid, MakeLanguage::Rapid)
            | (Language::FanucLs, MakeLanguage::FanucLs)
    )
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

/// The configurations of every move of a path, where the source is in the same language.
pub(crate) fn kept(
    program: &RobotProgram,
    robot: &RobotPath,
    language: MakeLanguage,
) -> Vec<StatedConfiguration> {
    if !is_same(program.language, language) {
        return Vec::new();
    }
    let switches = Switches::of(program, robot.file);
    let changes = changes(program, robot);
    let of_target = |target: &Target| text_of(program.language, &target.pose()?.configuration);
    let motions = robot.motions.iter().enumerate();
    let stated = motions.map(|(number, index)| {
        let Some(motion) = program.motions.get(*index) else {
            return StatedConfiguration::default();
        };
        let via = match &motion.kind {
            MotionKind::Circular { via } => of_target(via),
            _ => None,
        };
        StatedConfiguration {
            end: of_target(&motion.target),
            via,
            is_followed: !switches.is_off_at(motion.line),
            changes: changes.contains(&number),
        }
    });
    stated.collect()
}

/// Where `ConfJ` of RAPID switches what joint motions do with configurations.
pub(crate) struct Switches {
    /// Lines with motions behind `ConfJ\Off`.
    off: BTreeMap<usize, bool>,
    /// Where the order of the lines is not known, and it stands somewhere.
    somewhere: bool,
}

impl Switches {
    pub(crate) fn of(program: &RobotProgram, file: usize) -> Self {
        let mut found = Self {
            off: BTreeMap::new(),
            somewhere: false,
        };
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

/// That configurations of the source are not those of the made program, with their lines.
pub(crate) fn lost(program: &RobotProgram, why: &str) -> Option<MakeFinding> {
    let states = |motion: &&Motion| {
        let stated = |target: &Target| {
            let pose = target.pose();
            pose.is_some_and(|pose| text_of(program.language, &pose.configuration).is_some())
        };
        let via = match &motion.kind {
            MotionKind::Circular { via } => stated(via),
            _ => false,
        };
        via || stated(&motion.target)
    };
    let motions = program.motions.iter().filter(states);
    let mut lines: Vec<usize> = motions.map(|motion| motion.line).collect();
    lines.sort_unstable();
    lines.dedup();
    let first = *lines.first()?;
    Some(MakeFinding::of(
        first,
        format!(
            "how the arm reaches its poses (the configurations of the source: {}) is not kept: {why}",
            in_words(&lines)
        ),
    ))
}

/// Why configurations cannot be kept in another language.
pub(crate) fn why_lost(language: MakeLanguage, stated: Option<&str>) -> String {
    match language {
        MakeLanguage::Krl | MakeLanguage::Rapid | MakeLanguage::FanucLs => format!(
            "{} counts it in another way, from the axes of its own arm; {}",
            match language {
                MakeLanguage::Krl => "KRL (S and T)",
                MakeLanguage::Rapid => "RAPID (confdata)",
                _ => "a TP program (CONFIG)",
            },
            match stated {
                Some(stated) => format!("the template states `{stated}` (configuration)"),
                None => "state that of the first pose in the template (configuration)".to_owned(),
            }
        ),
        _ => format!("{} does not state it", language.title()),
    }
}
