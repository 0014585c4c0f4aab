//! What a robot's program does in the statements of its motions and on their lines: outputs, procedures, triggers.

use crate::ls::motion::event_of;
use crate::making::event_kind::EventKind;
use crate::making::events::SourceEvent;
use crate::model::motion::Motion;
use crate::model::program::{Language, RobotProgram};
use crate::text::source::SourceFile;

/// The events of all motions of a file.
pub(crate) fn events_of_motions(program: &RobotProgram, file: usize) -> Vec<SourceEvent> {
    let own = || program.motions.iter().filter(|motion| motion.file == file);
    let mut starts: Vec<usize> = own().map(|motion| motion.span.start).collect();
    starts.sort_unstable();
    let mut events = Vec::new();
    for motion in own() {
        let next = starts.partition_point(|start| *start < motion.span.end);
        let next = starts.get(next).copied().unwrap_or(usize::MAX);
        events.extend(events_of_motion(program, motion, next));
    }
    events
}

/// The events in the statement of a motion, and behind it on its line up to where the next one begins.
fn events_of_motion(program: &RobotProgram, motion: &Motion, next: usize) -> Vec<SourceEvent> {
    let Some(source) = program.files.get(motion.file) else {
        return Vec::new();
    };
    let found = match program.language {
        Language::Rapid => of_rapid(source, motion),
        Language::FanucLs => {
            let event = event_of(source.bytes(), &motion.span);
            let text = event.map(|span| words(source.part(&span)));
            text.map(|text| (text.trim_end_matches(';').trim_end().to_owned(), true))
        }
        _ => None,
    };
    let (line, last) = (
        motion.line,
        source.line_of(motion.span.end.saturating_sub(1)),
    );
    let mut events = Vec::new();
    if let Some((text, is_behind)) = found {
        events.push(SourceEvent {
            is_behind,
            ..SourceEvent::words_alone(line, EventKind::Other, text)
        });
    }
    if program.language == Language::Rapid {
        let end = source.range_of(last).end.min(next);
        let text = words(source.part(&(motion.span.end.min(end)..end)));
        if !text.is_empty() && !text.starts_with('!') {
            events.push(SourceEvent {
                is_behind: true,
                place: format!("line {last}"),
                ..SourceEvent::words_alone(line, EventKind::Other, text)
            });
        }
    }
    events
}

/// What an instruction of RAPID does beside its motion, and whether it does so behind it.
fn of_rapid(source: &SourceFile, motion: &Motion) -> Option<(String, bool)> {
    let keyword = words(source.part(&motion.site.keyword));
    let upper = keyword.to_ascii_uppercase();
    let is_circle = upper.starts_with("MOVEC") || upper == "TRIGGC";
    let from = match upper.as_str() {
        "TRIGGL" | "TRIGGJ" | "TRIGGC" => 2,
        _ if ["DO", "AO", "GO", "SYNC"]
            .iter()
            .any(|end| upper.ends_with(end)) =>
        {
            4
        }
        _ => return None,
    } + usize::from(is_circle);
    let statement = words(source.part(&(motion.site.keyword.end..motion.span.end)));
    let arguments = arguments_of(statement.trim_end_matches(';'));
    let to = match upper.starts_with("TRIGG") {
        // Zone and tool follow.
        true => arguments.len().saturating_sub(2),
        false => arguments.len(),
    };
    let own = arguments.get(from..to)?.join(",");
    Some((format!("{keyword} {own}"), !upper.starts_with("TRIGG")))
}

/// Arguments between the commas that no bracket and no text holds; switches before the first are left out.
fn arguments_of(text: &str) -> Vec<String> {
    let mut arguments = vec![String::new()];
    let (mut open, mut in_text) = (0_usize, false);
    for letter in text.chars() {
        match letter {
            '"' => in_text = !in_text,
            '(' | '[' | '{' if !in_text => open += 1,
            ')' | ']' | '}' if !in_text => open = open.saturating_sub(1),
            ',' if !in_text && open == 0 => {
                arguments.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = arguments.last_mut() {
            last.push(letter);
        }
    }
    let is_switch = |argument: &String| argument.trim_start().starts_with('\\');
    let switches = arguments
        .iter()
        .take_while(|argument| is_switch(argument))
        .count();
    arguments.drain(..switches);
    arguments
        .iter()
        .map(|argument| argument.trim().to_owned())
        .collect()
}

/// A part of a file in one line.
fn words(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
