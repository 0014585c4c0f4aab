//! Events of a robot's program beside its motions.

use std::ops::Range;

use kinetostat_program::SpindleChange;

use crate::making::course::place_of;
use crate::making::events::{EventAction, EventKind, SourceEvent};
use crate::making::heidenhain_events::events_of_heidenhain;
use crate::making::motion_events::{
    comment_behind, events_of_motions, kind_of, of_line, orders_only,
};
use crate::making::siemens_events::events_of_siemens;
use crate::model::Language;
use crate::model::program::RobotProgram;
use crate::text::source::SourceFile;

/// The events of a robot's program: statements beside its motions, of the file with the motions.
///
/// ```
/// use kinetostat_formats::{EventKind, ReadOptions, SourceFile, events_of_robot, read_rapid};
///
/// let text = "MODULE M\nPROC main()\nSetDO doSpindle,1;\n! groove\n\
///     MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0;\nENDPROC\nENDMODULE";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let kinds: Vec<_> = events_of_robot(&program).iter().map(|event| (event.line, event.kind)).collect();
/// assert_eq!(kinds, [(3, EventKind::Other), (4, EventKind::Comment)]);
/// ```
#[must_use]
pub fn events_of_robot(program: &RobotProgram) -> Vec<SourceEvent> {
    let file = program.motions.first().map_or(0, |motion| motion.file);
    let Some(source) = program.files.get(file) else {
        return Vec::new();
    };
    let moving = program.lines_of_targets(file);
    match program.language {
        Language::Heidenhain => return events_of_heidenhain(source).0,
        Language::Siemens => return events_of_siemens(source, &moving).0,
        _ => {}
    }
    let spindle = program.language.spindle_changes(source);
    let mut events = events_of_motions(program, file);
    for line in instructions(program.language, source) {
        if moving.contains(&line) {
            continue;
        }
        let text = String::from_utf8_lossy(source.line(line).unwrap_or_default()).into_owned();
        let text = program.language.statement_in(&text);
        let upper = text.to_ascii_uppercase();
        if text.is_empty() {
            continue;
        }
        if orders_only(program.language, text) {
            // Modal changes are followed; other statements on the line and comments are kept.
            let further = of_line(program.language, line, text);
            let comment = comment_behind(program.language, text).filter(|_| further.is_empty());
            events.extend(further);
            events.extend(
                comment.map(|text| SourceEvent::words_alone(line, EventKind::Comment, text)),
            );
            continue;
        }
        let kind = kind_of(program.language, &upper);
        let from = spindle.partition_point(|change| change.line < line);
        let turned = spindle.get(from).filter(|change| change.line == line);
        match turned.map(|change| change.spindle) {
            Some(spindle) if kind == EventKind::Spindle => {
                let action = EventAction::Spindle {
                    rotation: spindle.rotation,
                    rpm: spindle.speed,
                };
                events.push(SourceEvent {
                    // A range, an angle, a speed of the surface: no other language has that.
                    rest: (!is_turn_alone(&upper)).then_some(kind),
                    ..SourceEvent::acting(line, action, text)
                });
            }
            _ => events.extend(of_line(program.language, line, text)),
        }
    }
    events.sort_by_key(|event| place_of(event, event.line));
    events
}

/// Spindle changes of a program in blocks (SINUMERIK, Heidenhain), for [`kinetostat_program::Path`]; empty for other languages.
#[must_use]
pub fn spindle_of_blocks(program: &RobotProgram) -> Vec<SpindleChange> {
    let file = program.motions.first().map_or(0, |motion| motion.file);
    match (program.language, program.files.get(file)) {
        (Language::Heidenhain, Some(source)) => events_of_heidenhain(source).1,
        (Language::Siemens, Some(source)) => {
            events_of_siemens(source, &program.lines_of_targets(file)).1
        }
        _ => Vec::new(),
    }
}

/// True if `SPINDL` states only the sense and the speed of the spindle.
fn is_turn_alone(statement: &str) -> bool {
    let code = statement.split("$$").next().unwrap_or_default();
    let mut words = code.split(['/', ',']).map(str::trim).skip(1);
    words.all(|word| {
        let known = ["RPM", "CLW", "CCLW", "ON", "OFF"].contains(&word);
        known || word.parse::<f64>().is_ok()
    })
}

/// Lines that hold instructions.
pub(crate) fn instructions(language: Language, source: &SourceFile) -> Range<usize> {
    let count = source.line_count() + 1;
    let begins = |word: &[u8]| {
        (1..count).find(|line| {
            let text = source.line(*line).unwrap_or_default().trim_ascii();
            text.to_ascii_uppercase().starts_with(word)
        })
    };
    language.section().map_or(1..count, |[head, end]| {
        begins(head).unwrap_or(1)..begins(end).unwrap_or(count)
    })
}
