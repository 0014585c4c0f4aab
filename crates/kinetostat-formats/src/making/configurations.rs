//! Arm configurations of the poses of a source: kept in the same language, reported as lost in another.

use crate::making::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::reconfigured::{Switches, changes, text_of};
use crate::making::step::StatedConfiguration;
use crate::model::Language;
use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::target::Target;
use crate::path::of_program::RobotPath;
use crate::text::number::in_words;

/// True if a program is made in the language of its source and that language's targets state configurations.
pub(crate) fn is_same(source: Language, made: MakeLanguage) -> bool {
    source.is_of_robot() && made.language() == Some(source)
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

/// Finding on lost configurations of the source, with their lines.
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

/// Reason why configurations cannot be kept in another language.
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
