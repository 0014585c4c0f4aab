//! Frames that the job states, beside what the program says itself.

use std::collections::BTreeMap;

use kinetostat_formats::{FrameUse, RobotProgram, read};
use kinetostat_program::Warning;

use crate::job::robot::frame_distance::distance;
use crate::job::robot::source::RobotSource;
use crate::ui::numbers::short;

/// Differences below this are those of digits, mm and rad.
const SAME: f64 = 1e-6;

/// A name as programs compare it.
fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}

/// Frames of the job that no motion uses, or that the program states otherwise.
pub(crate) fn warnings(source: &RobotSource, program: &RobotProgram) -> Vec<Warning> {
    let stated = &source.settings.reading.frames;
    if stated.is_empty() {
        return Vec::new();
    }
    let used = frames(program);
    let mut warnings: Vec<Warning> = (stated.keys())
        // Systems of APT lie in the part.
        .filter(|name| !used.contains_key(&key(name)) && key(name) != "PART")
        .map(|name| {
            let names: Vec<String> = used.values().map(|(_, used)| format!("`{}`", used.name)).collect();
            Warning {
                line: 1,
                text: format!(
                    "frames.\"{name}\" under [robot] is no tool or work object of a motion of this program, which has {}",
                    names.join(", ")
                ),
            }
        })
        .collect();
    warnings.extend(otherwise(source, &used));
    warnings
}

/// Tools and work objects of the motions, with the line of the first use.
fn frames(program: &RobotProgram) -> BTreeMap<String, (usize, &FrameUse)> {
    let mut used = BTreeMap::new();
    for motion in &program.motions {
        for frame in [&motion.tool, &motion.work_object] {
            used.entry(key(&frame.name)).or_insert((motion.line, frame));
        }
    }
    used
}

/// True if a program may define a frame by itself: it assigns the name, or the controller has it.
fn may_state(source: &RobotSource, name: &str) -> bool {
    let name = key(name);
    let is_first = ["TOOL0", "WOBJ0"].contains(&name.as_str())
        || name.ends_with("[0]")
        || name.ends_with(":0");
    // `UTOOL[9]=PR[9]` gives `UT:9` a value.
    let written = ["UF:", "UT:"].into_iter().zip(["UFRAME[", "UTOOL["]);
    let mut written =
        written.filter_map(|(of, word)| Some(format!("{word}{}]", name.strip_prefix(of)?)));
    let name = written.next().unwrap_or(name);
    is_first
        || source
            .files
            .iter()
            .any(|file| assigns(file.bytes(), name.as_bytes()))
}

/// True if the text contains `name =` or `name :=`, in capitals or not, with blanks or without.
fn assigns(text: &[u8], name: &[u8]) -> bool {
    let Some(first) = name.first() else {
        return false;
    };
    let begins = (text.iter().enumerate()).filter(|(_, byte)| byte.eq_ignore_ascii_case(first));
    begins.into_iter().any(|(at, _)| {
        let mut rest = text[at..]
            .iter()
            .filter(|byte| !matches!(byte, b' ' | b'\t'));
        let is_name = name.iter().all(|letter| {
            let next = rest.next();
            next.is_some_and(|next| next.eq_ignore_ascii_case(letter))
        });
        is_name
            && matches!(
                (rest.next(), rest.next()),
                (Some(b'='), _) | (Some(b':'), Some(b'='))
            )
    })
}

/// Frames that the program states, too, and not the same: the job counts.
fn otherwise(source: &RobotSource, used: &BTreeMap<String, (usize, &FrameUse)>) -> Vec<Warning> {
    let mut reading = source.settings.reading.clone();
    // A large program is not read a second time for a frame that it does not state.
    let mut names = reading.frames.keys();
    if !names.any(|name| used.contains_key(&key(name)) && may_state(source, name)) {
        return Vec::new();
    }
    reading.frames.clear();
    let Ok(own) = read(source.language, source.files.clone(), &reading) else {
        return Vec::new();
    };
    let own = frames(&own);
    let differs = |(name, (line, frame)): (&String, &(usize, &FrameUse))| {
        let (job, (_, program)) = (frame.known()?, own.get(name)?);
        let [away, turned] = distance(job, program.known()?);
        (away > SAME || turned > SAME).then(|| Warning {
            line: *line,
            text: format!(
                "`{}` of the job, under [robot.frames], is not what the program says it is, {} mm away and turned by {} deg: the job counts",
                frame.name,
                short(away),
                short(turned.to_degrees())
            ),
        })
    };
    used.iter().filter_map(differs).collect()
}
