//! A robot's program read, with its path.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use kinetostat::Directions;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    Correctable, FlatText, FrameUse, Motion, ProgramFault, RobotPath, RobotProgram, Target, Zone,
    all_faults, expand, path_of, read, spindle_of_blocks,
};
use kinetostat_machining::{Assumption, FlatProgram};
use kinetostat_program::{Move, StatedBy, Warning};

use crate::job::robot::frame_distance::distance;
use crate::job::robot::read_once::ReadOnce;
use crate::job::robot::settings::RobotSettings;
use crate::job::robot::source::RobotSource;
use crate::job::robot::system_frames::taken;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::fault_list::{Fault, fault_list_text, with_text};
use crate::ui::numbers::short;

/// A robot's program with its path.
#[derive(Debug)]
pub(crate) struct RobotRead<'s> {
    pub(crate) program: &'s RobotProgram,
    pub(crate) path: Cow<'s, RobotPath>,
    pub(crate) settings: &'s RobotSettings,
}

impl RobotRead<'_> {
    /// Corrected directions of the tool's pose.
    pub(crate) fn corrected(&self) -> Directions {
        self.settings.corrected
    }

    /// Line and radius (mm) of the widest zone between two moves at feed, whose corner it cuts.
    pub(crate) fn widest_zone(&self) -> Option<(usize, f64)> {
        let corners = self.path.path.moves.windows(2).zip(&self.path.motions);
        let zones = corners.filter_map(|(moves, motion)| {
            let is_cut = moves.iter().all(Move::is_known_feed);
            match self.program.motions[*motion].zone {
                Zone::Radius(mm) if is_cut => Some((moves[0].line, mm)),
                _ => None,
            }
        });
        zones.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The tool's axis is not stated, and the language has no convention for it.
    pub(crate) fn axis_is_open(&self) -> bool {
        self.program.language.tool_axis_is_open() && !self.settings.axis_is_stated
    }

    /// Assumption that calls of unknown routines do not move the tool.
    pub(crate) fn assumed_of_calls(&self) -> Option<Assumption> {
        of_calls(self.program)
    }

    /// The program as a run takes it.
    pub(crate) fn correctable(&self) -> Correctable<'_> {
        Correctable {
            program: self.program,
            path: &self.path,
            reading: &self.settings.reading,
            making: &self.settings.making,
            writing: &self.settings.writing,
        }
    }
}

/// Assumption that calls of what is in none of the files do not move the tool.
pub(crate) fn of_calls(program: &RobotProgram) -> Option<Assumption> {
    let calls = program.calls_taken_to_stay().into_iter();
    let calls: Vec<(String, usize)> = calls.map(|(name, line)| (name.to_owned(), line)).collect();
    Assumption::of_calls(&calls)
}

/// The program, read when it is first asked for; of a faulty one all faults.
pub(crate) fn read_robot(source: &RobotSource) -> Answer<RobotRead<'_>> {
    let read = match source.reading.get() {
        Some(read) => read,
        None => {
            let read = Arc::new(read_files(source)?);
            source.reading.get_or_init(|| read)
        }
    };
    Ok(RobotRead {
        program: &read.program,
        path: Cow::Borrowed(&read.path),
        settings: &source.settings,
    })
}

fn read_files(source: &RobotSource) -> Answer<ReadOnce> {
    let settings = &source.settings;
    let program = read(source.language, source.files.clone(), &settings.reading).map_err(|_| {
        // All in one run: those of the motions that could be read, too.
        let mut all = all_faults(source.language, source.files.clone(), &settings.reading);
        for fault in &mut all {
            if let (ProgramFault::Text(fault), Some(before)) = (fault, &source.before)
                && source
                    .files
                    .first()
                    .is_some_and(|file| file.name() == fault.file)
            {
                fault.show_source(&before.origins, &before.files);
            }
        }
        refused(&all)
    })?;
    let joints = |motion: &&Motion| matches!(motion.target, Target::Joints { .. });
    if let (true, Some(motion)) = (
        source.language.is_list(),
        program.motions.iter().find(joints),
    ) {
        return Err(ErrorCode::ProgramUnsuited.failure(format!(
                "line {}: the table states joint values; which poses they give only a model says, and none is asked here: compensate with a model, or let the CAM system or the controller write poses (x_mm, y_mm, z_mm, qw, qx, qy, qz)",
                motion.line
            ),
        ));
    }
    if let (true, Some(first)) = (program.motions.is_empty(), program.first_outside_call()) {
        let file = program.files.get(first.file).map_or("", |file| file.name());
        return Err(ErrorCode::ProgramUnsuited.failure(format!(
                "{file}, line {}: the program has no motion of its own, and {}; compensate the files with the motions one by one",
                first.line, first.message
            ),
        ));
    }
    let mut path = path_of(&program, &settings.making).map_err(|all| refused(&all))?;
    if path.file != 0 {
        let name = program.files[path.file].name();
        return Err(ErrorCode::ProgramUnsuited.failure(format!(
                "the motions stand in '{name}': give that file as the program, and this one among files under [robot]"
            ),
        ));
    }
    path.path
        .spindle_changes
        .extend(spindle_of_blocks(&program));
    path.path.warnings.extend(warnings(source, &program));
    path.path.warnings.extend(taken(source, &program));
    path.path.warnings.extend(
        settings
            .joints_are
            .map(|words| Warning::new(1, words.to_owned())),
    );
    path.path.warnings.extend(settings.beyond_limits.clone());
    let mut moves = path.path.moves.iter();
    if settings.corrected == Directions::ALL && moves.all(|motion| motion.tool_turn.is_none()) {
        return Err(ErrorCode::ProgramUnsuited.failure("the program does not state how its tool stands, so that its orientation cannot be corrected: leave out --correct pose (correct = \"pose\" under [robot])",
        ));
    }
    let by_direction = |motion: &Move| {
        let turn = motion.tool_turn.as_ref();
        let rotary = turn.and_then(|turn| turn.rotary.as_ref());
        rotary.is_some_and(|rotary| rotary.stated == StatedBy::Direction)
    };
    if settings.corrected == Directions::ALL && path.path.moves.iter().any(by_direction) {
        return Err(ErrorCode::ProgramUnsuited.failure("the program states directions of the tool, and rotary axes that follow them are not corrected: leave out --correct pose (correct = \"pose\" under [robot]), or let the CAM system write their angles",
        ));
    }
    Ok(ReadOnce { program, path })
}

/// Words of remedies, and their keys in a job file under `[robot]`.
const KEYS: [(&str, &str); 9] = [
    (
        "(`turn_about_axis`)",
        "turn_about_axis = { tool = \"x\", part = [1, 0, 0] }",
    ),
    (
        "give its file together with this one",
        "files = [\"other.h\"]",
    ),
    (
        "give its file together with the program",
        "files = [\"other.spf\"]",
    ),
    ("give the subprogram with", "files = [\"other.spf\"]"),
    (
        "as written when reading",
        "unknown_targets = \"left_as_written\"",
    ),
    ("external axes carried", "external_axes = \"carried\""),
    (
        "the frame when reading",
        "frames.\"NAME\" = { position_mm = [0, 0, 0] }",
    ),
    (
        "(`frames`)",
        "frames.\"NAME\" = { position_mm = [0, 0, 0] }",
    ),
    ("give the .dat file", "files = [\"other.dat\"]"),
];

pub(crate) fn refused<F: Fault>(all: &[F]) -> Failure {
    let Some(first) = all.first() else {
        return ErrorCode::ProgramRefused.failure("the program is refused");
    };
    let mut text = fault_list_text("lines", first, all);
    let named = |(words, _): &&(&str, &str)| text.contains(words);
    let mut keys: Vec<&str> = KEYS.iter().filter(named).map(|(_, key)| *key).collect();
    keys.dedup();
    if !keys.is_empty() {
        text.push_str(&format!(
            "\nIn a job file, under [robot]:  {}",
            keys.join("  or  ")
        ));
    }
    with_text(ErrorCode::ProgramRefused, text, first, all)
}

/// Differences below this are those of digits, mm and rad.
const SAME: f64 = 1e-6;

/// A name as programs compare it.
fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}

/// Frames of the job that no motion uses, or that the program states otherwise.
fn warnings(source: &RobotSource, program: &RobotProgram) -> Vec<Warning> {
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
            Warning::new(1, format!(
                    "frames.\"{name}\" under [robot] is no tool or work object of a motion of this program, which has {}",
                    names.join(", ")
                ))
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
        (away > SAME || turned > SAME).then(|| Warning::new(*line, format!(
                "`{}` of the job, under [robot.frames], is not what the program says it is, {} mm away and turned by {} deg: the job counts",
                frame.name,
                short(away),
                short(turned.to_degrees())
            )))
    };
    used.iter().filter_map(differs).collect()
}

/// The flat program, and where its lines came from; `comments`: its blocks say it, too.
pub(crate) fn flat_text(source: &RobotSource, comments: bool) -> Answer<(FlatText, FlatProgram)> {
    let files = source.files.clone();
    let names: Vec<String> = files.iter().map(|file| file.name().to_owned()).collect();
    let done = expand(source.language, files, &source.settings.reading)
        .map_err(|all| refused(&all).of_program())?;
    let Some(text) = done else {
        return Err(ErrorCode::Unused.failure("--expand and [expand] are for programs, and a list of poses is read as it stands: leave them out",
        ));
    };
    let text = match comments {
        true => text.with_origins(source.language, &names),
        false => text,
    };
    let index = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let origins = text.origins.iter();
    let origins = origins.map(|(file, line)| (index(*file), index(*line)));
    let flat = FlatProgram::new(names, text.origins.len(), origins.collect());
    Ok((text, flat))
}

/// Assumptions of the run at uncertain source lines, at the first flat line of each.
pub(crate) fn notes_of(text: &FlatText) -> Vec<Warning> {
    let notes = text.findings.iter().map(|finding| {
        let of_it = |origin: &(usize, usize)| *origin == (finding.file, finding.line);
        let line = text.origins.iter().position(of_it);
        Warning::new(line.map_or(1, |index| index + 1), finding.message.clone())
    });
    notes.collect()
}
