//! Accelerations, speeds of turning and of joint motions in a source, which no made program states: they are named.

use crate::making::fault::MakeFinding;
use crate::making::limits::MakeLanguage;
use crate::making::rapid::OTHER_SPEEDS;
use crate::making::routines::words_of;
use crate::model::language::Language;
use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;
use crate::text::line_words::in_words;

/// Variables of KRL that say how fast the arm moves beside `$VEL.CP`.
const OF_KRL: [&str; 8] = [
    "ACC",
    "ACC_AXIS",
    "VEL_AXIS",
    "ACC_AXIS_C",
    "VEL_AXIS_C",
    "ACC_EXTAX",
    "VEL_EXTAX",
    "OV_PRO",
];

/// What `BAS` sets of it.
const OF_BAS: [&str; 5] = ["VEL_PTP", "ACC_PTP", "ACC_CP", "PTP_PARAMS", "PTP_DAT"];

/// Instructions of RAPID that do, wherever they stand on their line.
const OF_RAPID: [&str; 5] = [
    "VELSET",
    "SPEEDREFRESH",
    "ACCSET",
    "PATHACCLIM",
    "WORLDACCLIM",
];

/// Statements of TP programs.
const OF_TP: [&str; 3] = ["OVERRIDE", "JOINT_MAX_SPEED", "LINEAR_MAX_SPEED"];

/// Whether a line states such a thing.
fn states(language: Language, words: &[String]) -> bool {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match (language, words.as_slice()) {
        (Language::Krl, ["VEL", "ORI1" | "ORI2", ..]) => true,
        (Language::Krl, ["BAS", what, ..]) => OF_BAS.contains(what),
        (Language::Krl, [first, rest @ ..]) => {
            // Behind WITH they hold for a motion.
            let with = rest.iter().position(|word| *word == "WITH");
            let own = with.map_or(&[][..], |with| &rest[with..]);
            (OF_KRL.contains(first) && !rest.is_empty())
                || own.iter().any(|word| OF_KRL.contains(word))
        }
        (Language::Rapid, all) => all.iter().any(|word| OF_RAPID.contains(word)),
        (Language::FanucLs, [first, ..]) if OF_TP.contains(first) => true,
        // Behind the zone of a motion.
        (Language::FanucLs, ["J" | "L" | "C" | "A", others @ ..]) => others.iter().any(|word| {
            let percent = word.strip_prefix("ACC");
            percent.is_some_and(|percent| percent.bytes().all(|byte| byte.is_ascii_digit()))
        }),
        _ => false,
    }
}

/// The lines of the file with the motions that do.
pub(crate) fn dynamics(program: &RobotProgram, file: usize) -> Option<MakeFinding> {
    let source = program.files.get(file)?;
    let lines: Vec<usize> = (1..=source.line_count())
        .filter(|line| states(program.language, &words_of(program.language, source, *line)))
        .collect();
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

/// Whether a made program has them.
fn has_them(program: &RobotProgram, language: MakeLanguage) -> bool {
    (program.language, language) == (Language::Rapid, MakeLanguage::Rapid)
}

/// Those of every move of a path, where the made program can state them.
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
