//! A robot's program read, with its path.

use std::borrow::Cow;
use std::sync::Arc;

use kinetostat::Directions;
use kinetostat_formats::{
    Correctable, Motion, ProgramFault, RobotPath, RobotProgram, Target, Zone, all_faults, path_of,
    read, spindle_of_blocks,
};
use kinetostat_machining::{Assumption, AssumptionKind};
use kinetostat_program::{Move, StatedBy, Warning};

use crate::job::robot::read_once::ReadOnce;
use crate::job::robot::settings::RobotSettings;
use crate::job::robot::source::RobotSource;
use crate::job::robot::stated_frames::warnings;
use crate::job::robot::system_frames::taken;
use crate::ui::failure::{Answer, Failure};
use crate::ui::fault_list::fault_list_text;

/// Upper limit of the call names in one sentence.
const MOST_CALLS: usize = 5;

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
        let calls = self.program.calls_taken_to_stay();
        let named = |(name, line): &(&str, usize)| format!("{name} (line {line})");
        let shown: Vec<String> = calls.iter().take(MOST_CALLS).map(named).collect();
        let more = match calls.len().saturating_sub(MOST_CALLS) {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        let (calls, are) = match calls.len() {
            0 => return None,
            1 => ("The call of", "is"),
            _ => ("The calls of", "are"),
        };
        let text = format!(
            "{calls} {}{more}, in none of the files, {are} taken not to move the tool and not to change speed, tool or frame.",
            shown.join(", ")
        );
        Some(Assumption::new(AssumptionKind::OutsideCalls, None, text))
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
        refused(&all, ProgramFault::reason)
    })?;
    let joints = |motion: &&Motion| matches!(motion.target, Target::Joints { .. });
    if let (true, Some(motion)) = (
        source.language.is_list(),
        program.motions.iter().find(joints),
    ) {
        return Err(Failure::input(format!(
            "line {}: the table states joint values; which poses they give only a model says, and none is asked here: compensate with a model, or let the CAM system or the controller write poses (x_mm, y_mm, z_mm, qw, qx, qy, qz)",
            motion.line
        )));
    }
    let mut calls = program.findings.iter();
    let call = calls.find(|finding| {
        let said = |text| finding.message.contains(text);
        said("if it moves the tool") || said("taken not to move the tool")
    });
    if let (true, Some(first)) = (program.motions.is_empty(), call) {
        let file = program.files.get(first.file).map_or("", |file| file.name());
        return Err(Failure::input(format!(
            "{file}, line {}: the program has no motion of its own, and {}; compensate the files with the motions one by one",
            first.line, first.message
        )));
    }
    let mut path = path_of(&program, &settings.making)
        .map_err(|all| refused(&all, |fault| fault.reason.as_str()))?;
    if path.file != 0 {
        let name = program.files[path.file].name();
        return Err(Failure::input(format!(
            "the motions stand in '{name}': give that file as the program, and this one among files under [robot]"
        )));
    }
    path.path
        .spindle_changes
        .extend(spindle_of_blocks(&program));
    path.path.warnings.extend(warnings(source, &program));
    path.path.warnings.extend(taken(source, &program));
    path.path
        .warnings
        .extend(settings.joints_are.map(|words| Warning {
            line: 1,
            text: words.to_owned(),
        }));
    path.path.warnings.extend(settings.beyond_limits.clone());
    let mut moves = path.path.moves.iter();
    if settings.corrected == Directions::ALL && moves.all(|motion| motion.tool_turn.is_none()) {
        return Err(Failure::input(
            "the program does not state how its tool stands, so that its orientation cannot be corrected: leave out --correct pose (correct = \"pose\" under [robot])",
        ));
    }
    let by_direction = |motion: &Move| {
        let turn = motion.tool_turn.as_ref();
        let rotary = turn.and_then(|turn| turn.rotary.as_ref());
        rotary.is_some_and(|rotary| rotary.stated == StatedBy::Direction)
    };
    if settings.corrected == Directions::ALL && path.path.moves.iter().any(by_direction) {
        return Err(Failure::input(
            "the program states directions of the tool, and rotary axes that follow them are not corrected: leave out --correct pose (correct = \"pose\" under [robot]), or let the CAM system write their angles",
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

pub(crate) fn refused<'f, F: std::fmt::Display>(
    all: &'f [F],
    reason: impl Fn(&'f F) -> &'f str,
) -> Failure {
    let Some(first) = all.first() else {
        return Failure::input("the program is refused");
    };
    let mut text = fault_list_text("lines", first, all, reason);
    let named = |(words, _): &&(&str, &str)| text.contains(words);
    let mut keys: Vec<&str> = KEYS.iter().filter(named).map(|(_, key)| *key).collect();
    keys.dedup();
    if !keys.is_empty() {
        text.push_str(&format!(
            "\nIn a job file, under [robot]:  {}",
            keys.join("  or  ")
        ));
    }
    Failure::input(text)
}
