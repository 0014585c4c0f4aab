//! The marks of a program, from what its reader gives: motions, events, words of blocks.

use kinetostat_formats::{BlockWord, EventKind, Motion, Runs, Target, each_block, events_of_robot};
use kinetostat_program::{Path, Program};

use crate::job::program::ReadProgram;
use crate::job::robot::read_program::RobotRead;
use crate::verify::marks::{AGAIN, Kind, Mark, Marks, ONCE, Value};

/// Statements that say how fast all motions run.
const OVERRIDES: [&str; 5] = ["VELSET", "SPEEDREFRESH", "$OV_PRO", "$OV_ROB", "OVERRIDE"];

/// A motion of which it is not known where the tool is.
const UNSEEN: &str = "a motion by joint values or to a place that is not known";

impl<'r> Marks<'r> {
    pub(crate) fn of(read: &'r ReadProgram<'_>) -> Self {
        match (read.gcode(), read.robot()) {
            (Some((program, path)), _) => Self::of_gcode(program, path),
            (_, Some(robot)) => Self::of_robot(robot),
            _ => Self::default(),
        }
    }

    fn of_gcode(program: &Program, path: &Path) -> Self {
        let mut marks = Self::default();
        let first = path.moves.first().map_or(usize::MAX, |first| first.line);
        marks.move_lines = path.moves.iter().map(|motion| motion.line).collect();
        marks.move_lines.sort_unstable();
        for line in 1..=program.line_count() {
            let bytes = program.line_bytes(line).unwrap_or_default();
            let is_optional = bytes.trim_ascii_start().starts_with(b"/");
            let slash = is_optional.then(|| BlockWord {
                name: "/".to_owned(),
                text: "/".to_owned(),
            });
            let words = program.words_on(line).map(|(letter, number)| BlockWord {
                name: letter.to_string(),
                text: format!("{letter}{number}"),
            });
            let words: Vec<BlockWord> = slash.into_iter().chain(words).collect();
            marks.add_block(line, None, &words);
        }
        // A shift after a known position is already in the path that was read.
        let counts = |mark: &Mark<'_>| mark.kind != Kind::Shift || mark.line < first;
        marks.all.retain(counts);
        marks
    }

    fn of_robot(read: &'r RobotRead<'_>) -> Self {
        let mut marks = Self::default();
        let motions = read.program.motions.iter();
        let motions = motions.filter(|motion| motion.file == read.path.file);
        let mut motions: Vec<&Motion> = motions.collect();
        motions.sort_by_key(|motion| motion.line);
        for motion in motions {
            marks.move_lines.push(motion.line);
            marks.add_motion(motion);
        }
        let language = read.program.language;
        each_block(read.program, |line, words| {
            marks.add_block(line, Some(language), words);
        });
        if !language.is_in_blocks() {
            marks.add_statements(read);
        }
        marks
    }

    fn add_motion(&mut self, motion: &'r Motion) {
        let mut add = |kind: Kind, value: Value<'r>| self.add(motion.line, kind, value, false);
        let runs = match motion.runs {
            Runs::Once => ONCE,
            Runs::OnCondition => "statements under a condition",
            Runs::Repeatedly => AGAIN,
            Runs::Elsewhere => "statements that nothing leads to",
        };
        add(Kind::Runs, Value::Text(runs.to_owned()));
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
    fn add_statements(&mut self, read: &RobotRead<'_>) {
        let language = read.program.language;
        for event in events_of_robot(read.program) {
            let text = event.text.to_ascii_uppercase();
            let words = language.code_of(&text).split_whitespace();
            let text = words.collect::<Vec<_>>().join(" ");
            // Targets are in the places, and APT has the spindle along the path.
            let dense = text.replace(' ', "");
            let is_place =
                dense.contains("={") || dense.contains(":=[") || dense.starts_with("PR[");
            let is_compared = match event.kind {
                EventKind::Comment | EventKind::End => true,
                EventKind::Spindle => language.spindle_is_in_path(),
                _ => is_place || text.is_empty(),
            };
            if is_compared {
                continue;
            }
            let kind = match event.kind {
                EventKind::Stop => Kind::Stop,
                _ if OVERRIDES.iter().any(|word| text.starts_with(word)) => Kind::Override,
                _ if text.contains("SPIND") => Kind::Spindle,
                _ => Kind::Other,
            };
            self.add(event.line, kind, Value::Text(text), event.is_of_motion());
        }
    }
}
