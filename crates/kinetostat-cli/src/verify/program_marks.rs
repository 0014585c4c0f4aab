//! The marks of a program, from what its reader gives: motions, statements of the run, words of blocks.

use kinetostat_formats::{
    BlockWord, EventKind, Motion, MotionKind, RobotProgram, Runs, Target, each_block,
    options_of_motion, statements_of_run,
};
use kinetostat_program::{MoveKind, Path, Program};

use crate::job::program::ReadProgram;
use crate::job::robot::read_program::RobotRead;
use crate::verify::marks::{AGAIN, Kind, Mark, Marks, ONCE, Value, Way};

/// Statements that say how fast all motions run.
const OVERRIDES: [&str; 5] = ["VELSET", "SPEEDREFRESH", "$OV_PRO", "$OV_ROB", "OVERRIDE"];

/// A motion of which it is not known where the tool is.
const UNSEEN: &str = "a motion by joint values or to a place that is not known";

impl<'r> Marks<'r> {
    pub(crate) fn of(read: &'r ReadProgram<'_>) -> Self {
        match (read.gcode(), read.robot()) {
            (Some((program, path)), _) => Self::of_gcode(program, path),
            (_, Some(robot)) => Self::of_robot(robot),
            _ => Self::along(read.path(), |_| Way::Feed),
        }
    }

    fn of_gcode(program: &Program, path: &'r Path) -> Self {
        let mut marks = Self::along(path, |index| way_of(path, index));
        for line in 1..=program.line_count() {
            let bytes = program.line_bytes(line).unwrap_or_default();
            let is_optional = bytes.trim_ascii_start().starts_with(b"/");
            let slash = is_optional.then(|| BlockWord {
                name: "/".to_owned(),
                text: "/".to_owned(),
                is_in_path: false,
            });
            let words = program.words_on(line).map(|(letter, number)| BlockWord {
                name: letter.to_string(),
                text: format!("{letter}{number}"),
                is_in_path: false,
            });
            let words: Vec<BlockWord> = slash.into_iter().chain(words).collect();
            marks.add_block(line, None, &words);
        }
        // A shift after a known position is already in the path that was read.
        let counts = |mark: &Mark<'_>| mark.kind != Kind::Shift || mark.at == 0;
        marks.all.retain(counts);
        marks
    }

    fn of_robot(read: &'r RobotRead<'_>) -> Self {
        let (program, path) = (read.program, &read.path.path);
        let motion_of = |index: usize| program.motions.get(*read.path.motions.get(index)?);
        let mut marks = Self::along(path, |index| {
            let is_joint = motion_of(index).is_some_and(|own| own.kind == MotionKind::Joint);
            if is_joint {
                Way::Joints
            } else {
                way_of(path, index)
            }
        });
        for index in 0..path.moves.len() {
            if let Some(motion) = motion_of(index) {
                marks.add_motion(index, program, motion);
            }
        }
        let language = program.language;
        each_block(program, |line, words| {
            marks.add_block(line, Some(language), words);
        });
        if !language.is_in_blocks() {
            marks.add_statements(program);
        }
        marks
    }

    fn add_motion(&mut self, index: usize, program: &RobotProgram, motion: &'r Motion) {
        let mut add = |kind: Kind, value: Value<'r>| {
            self.add([index, motion.line], kind, String::new(), value);
        };
        let runs = match motion.runs {
            Runs::Once => ONCE,
            Runs::OnCondition => "statements under a condition",
            Runs::Repeatedly => AGAIN,
            Runs::Elsewhere => "statements that nothing leads to",
        };
        add(Kind::Runs, Value::Text(runs.to_owned()));
        add(Kind::Zone, Value::Zone(motion.zone));
        let options = match options_of_motion(program, motion) {
            none if none.is_empty() => "no options".to_owned(),
            options => options,
        };
        add(Kind::Options, Value::Text(options));
        match &motion.target {
            Target::Pose(pose) => {
                add(Kind::Frame, Value::WorkObject(&motion.work_object));
                add(Kind::Tool, Value::Tool(&motion.tool));
                let stands = pose.configuration.text.replace(char::is_whitespace, "");
                if !stands.is_empty() {
                    let stands = format!("configuration {stands}");
                    add(Kind::Configuration, Value::Text(stands));
                }
            }
            _ => add(Kind::Unseen, Value::Text(UNSEEN.to_owned())),
        }
    }

    /// Statements beside motions, and what motions do beside their way.
    fn add_statements(&mut self, program: &RobotProgram) {
        for statement in statements_of_run(program) {
            let text = statement.text;
            let kind = match statement.kind {
                // APT has the spindle along the path.
                EventKind::Spindle if program.language.spindle_is_in_path() => continue,
                EventKind::Stop => Kind::Stop,
                EventKind::Endless => Kind::Endless,
                _ if OVERRIDES.iter().any(|word| text.starts_with(word)) => Kind::Override,
                _ if statement.mode.is_some() => Kind::PathMode,
                _ if text.contains("SPIND") => Kind::Spindle,
                _ => Kind::Other,
            };
            let name = statement.mode.unwrap_or_default();
            let place = [statement.motions_before, statement.line];
            self.add(place, kind, name, Value::Text(text));
        }
    }
}

fn way_of(path: &Path, index: usize) -> Way {
    match path.moves[index].kind {
        MoveKind::Rapid => Way::Rapid,
        _ => Way::Feed,
    }
}
