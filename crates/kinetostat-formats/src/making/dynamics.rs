//! Accelerations, speeds of turning and of joint motions in a source, which no made program states: they are named.

use crate::making::configurations::in_words;
use crate::making::fault::MakeFinding;
use crate::making::routines::words_of;
use crate::model::program::{Language, RobotProgram};

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

/// Whether a line states such a thing.
fn states(language: Language, words: &[String]) -> bool {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match (language, words.as_slice()) {
        (Language::Krl, ["VEL", "ORI1" | "ORI2", ..]) => true,
        (Language::Krl, ["BAS", what, ..]) => OF_BAS.contains(what),
        (Language::Krl, [first, _, ..]) => OF_KRL.contains(first),
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
            "accelerations, and speeds of turning and of joint motions, are not those of the source ({}): joint_speed_percent and acceleration_m_per_s2 of the template state what is written",
            in_words(&lines)
        ),
    ))
}
