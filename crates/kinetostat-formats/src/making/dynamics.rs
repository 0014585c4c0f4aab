//! Data and motions of a source that no made program can state: accelerations, speeds of turning and of joint motions, unknown speeds.

use kinetostat_program::Knowledge;

use crate::making::fault::{MakeError, MakeFinding};
use crate::making::limits::MakeLanguage;
use crate::making::rapid::OTHER_SPEEDS;
use crate::making::routines::words_of;
use crate::model::language::Language;
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;
use crate::program_language::SPEED_REMEDY_OF_BLOCKS;
use crate::text::number::in_words;

/// Names the lines of the file with the motions that state such a thing.
pub(crate) fn dynamics(program: &RobotProgram, file: usize) -> Option<MakeFinding> {
    let source = program.files.get(file)?;
    let states = |line: &usize| {
        let words = words_of(program.language, source, *line);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        program.language.states_dynamics(&words)
    };
    let lines: Vec<usize> = (1..=source.line_count()).filter(states).collect();
    Some(MakeFinding::of(
        *lines.first()?,
        format!(
            "accelerations, overrides, and speeds of turning and of joint motions, are not those of the source ({}): joint_speed_percent and acceleration_m_per_s2 of the template state what is written",
            in_words(&lines)
        ),
    ))
}

/// Speeds of turning and of external axes in the data of a RAPID speed, where they are not those of the speeds with names.
fn own_speeds(motion: &Motion) -> Option<&str> {
    let others = motion.site.other_speeds.as_deref()?;
    (others != OTHER_SPEEDS).then_some(others)
}

/// True if a made program states them.
fn has_them(program: &RobotProgram, language: MakeLanguage) -> bool {
    (program.language, language) == (Language::Rapid, MakeLanguage::Rapid)
}

/// Other speeds of every move of a path, if the made program can state them.
pub(crate) fn other_speeds(
    program: &RobotProgram,
    robot: &RobotPath,
    language: MakeLanguage,
) -> Vec<Option<Box<str>>> {
    if !has_them(program, language) {
        return Vec::new();
    }
    let motions = robot.motions.iter();
    let own = motions.map(|index| Some(own_speeds(program.motions.get(*index)?)?.into()));
    own.collect()
}

/// The lines where they are lost.
pub(crate) fn turning_speeds(program: &RobotProgram, language: MakeLanguage) -> Vec<MakeFinding> {
    if program.language != Language::Rapid {
        return Vec::new();
    }
    let with = |is_one: &dyn Fn(&Motion) -> bool| {
        let feeds = (program.motions.iter()).filter(|motion| motion.kind != MotionKind::Joint);
        let mut lines: Vec<usize> = feeds
            .filter(|motion| is_one(motion))
            .map(|motion| motion.line)
            .collect();
        lines.sort_unstable();
        lines.dedup();
        lines
    };
    let is_lost = |motion: &Motion| !has_them(program, language) && own_speeds(motion).is_some();
    let (lost, unknown) = (
        with(&is_lost),
        with(&|motion| motion.site.other_speeds.is_none()),
    );
    let first = program.motions.iter().find(|motion| is_lost(motion));
    let stated = first.and_then(own_speeds).unwrap_or_default();
    let said = [
        (
            lost,
            format!("the speeds of turning and of external axes that the source states ({stated}; "),
        ),
        (
            unknown,
            "the speeds of turning and of external axes of the source are not known: its data of the speed are declared elsewhere, or change (".to_owned(),
        ),
    ];
    let named = said.into_iter().filter_map(|(lines, what)| {
        let first = *lines.first()?;
        Some(MakeFinding::of(
            first,
            format!(
                "{what}{}) are not kept: where the tool turns, check how fast it does",
                in_words(&lines)
            ),
        ))
    });
    named.collect()
}

/// Motions that do not run exactly once.
pub(crate) fn not_once(program: &RobotProgram) -> Vec<MakeError> {
    let others = program
        .motions
        .iter()
        .filter(|motion| motion.runs != Runs::Once);
    let mut faults: Vec<MakeError> = others
        .map(|motion| {
            let reason = match motion.runs {
                Runs::OnCondition => "the motion is in a branch, or behind what may end the program or its routine before: whether it runs is not known",
                Runs::Elsewhere => "nothing in these files leads to this motion: it never runs (its routine is not called, a jump leaves it out, or the program ends before)",
                _ => "the motion is in a loop, or in a routine that is called more than once",
            };
            MakeError::at(
                motion.line,
                reason,
                "write its motions one after another, or take them out",
            )
        })
        .collect();
    faults.sort_by_key(|fault| fault.line);
    // A statement that runs several times gives several motions.
    faults.dedup();
    faults
}

/// Arcs whose way is not known: it depends on where they begin.
pub(crate) fn arcs_from_elsewhere(program: &RobotProgram, robot: &RobotPath) -> Vec<MakeError> {
    let moves = robot.path.moves.iter().zip(&robot.motions);
    let known = moves.filter(|(own, _)| own.known != Knowledge::Nothing);
    // To the first place the arm goes from wherever it is.
    let arcs = known.skip(1).filter(|(own, motion)| {
        let is_arc = program.motions.get(**motion).is_some_and(|motion| {
            matches!(
                motion.kind,
                MotionKind::Circular { .. } | MotionKind::Arc { .. }
            )
        });
        own.known == Knowledge::End && is_arc
    });
    arcs.map(|(own, _)| {
        MakeError::at(
            own.line,
            "where this arc begins, or the place on it, is not known: behind a routine that is not in these files, or a place that only the run knows",
            "write a motion to a stated place before the arc, or give the routine with the program",
        )
    })
    .collect()
}

/// Remedy of an unknown speed of a motion at feed.
pub(crate) fn speed_remedy(language: Option<Language>) -> &'static str {
    language.map_or(SPEED_REMEDY_OF_BLOCKS, |language| language.speed_remedy())
}
