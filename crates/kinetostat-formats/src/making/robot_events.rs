//! What a robot's program says beside its motions.

use std::ops::Range;

use crate::apt::spindle::spindle_changes;
use crate::making::action::EventAction;
use crate::making::course::place_of;
use crate::making::event_kind::EventKind;
use crate::making::events::SourceEvent;
use crate::making::heidenhain_events::events_of_heidenhain;
use crate::making::motion_events::events_of_motions;
use crate::making::robot_actions::{action_of, kind_of};
use crate::making::siemens_events::events_of_siemens;
use crate::model::program::{Language, RobotProgram};
use crate::text::source::SourceFile;

/// Words with which lines begin that only order a program: nothing of it is lost.
fn of_form(language: Language) -> &'static [&'static str] {
    match language {
        Language::Rapid => &[
            "MODULE",
            "ENDMODULE",
            "PROC",
            "ENDPROC",
            "CONST",
            "PERS",
            "VAR",
            "LOCAL",
            "TASK",
            "%%%",
            "VERSION",
            "LANGUAGE",
        ],
        Language::Krl => &[
            "&",
            "DEF",
            "END",
            "DECL",
            ";FOLD",
            ";ENDFOLD",
            "; ENDFOLD",
            "INI",
            "$BASE",
            "$TOOL",
            "$VEL",
            "$APO",
            "PDAT_ACT",
            "FDAT_ACT",
            "LDAT_ACT",
            "BAS",
            "$BWDSTART",
            "EXT",
            "INT ",
            "REAL ",
            "BOOL ",
            "E6POS ",
            "FRAME ",
            "POS ",
            "$ACC",
        ],
        Language::FanucLs => &["/", "UFRAME_NUM", "UTOOL_NUM"],
        Language::Apt => &[
            "GOTO", "RAPID", "FEDRAT", "UNITS", "UNIT", "MULTAX", "PARTNO", "TRNTYP", "FINI", "END",
        ],
        // Their words are looked at one by one.
        Language::Heidenhain | Language::Siemens => &[],
        // Rows and keys state poses; the rest of a list goes with its pose.
        Language::Poses => &[""],
    }
}

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
        Language::Heidenhain => return events_of_heidenhain(source),
        Language::Siemens => return events_of_siemens(source, &moving),
        _ => {}
    }
    let spindle = match program.language {
        Language::Apt => spindle_changes(source),
        _ => Vec::new(),
    };
    let mut events = events_of_motions(program, file);
    for line in instructions(program.language, source) {
        if moving.contains(&line) {
            continue;
        }
        let text = String::from_utf8_lossy(source.line(line).unwrap_or_default()).into_owned();
        let text = body(program.language, &text);
        let upper = text.to_ascii_uppercase();
        let words = of_form(program.language);
        if text.is_empty() || words.iter().any(|word| upper.starts_with(word)) {
            continue;
        }
        let kind = kind_of(program.language, &upper);
        let from = spindle.partition_point(|change| change.line < line);
        let turned = spindle.get(from).filter(|change| change.line == line);
        let action = match turned.map(|change| change.spindle) {
            Some(spindle) if kind == EventKind::Spindle => Some(EventAction::Spindle {
                rotation: spindle.rotation,
                rpm: spindle.speed,
            }),
            _ => action_of(program.language, text),
        };
        events.push(match action {
            Some(action) => SourceEvent::acting(line, action, text),
            None => SourceEvent::words_alone(line, kind, text),
        });
    }
    events.sort_by_key(|event| place_of(event, event.line));
    events
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
    match language {
        Language::FanucLs => begins(b"/MN").unwrap_or(1)..begins(b"/POS").unwrap_or(count),
        _ => 1..count,
    }
}

/// The statement of a line: without the number and the end of a line of a TP program.
pub(crate) fn body(language: Language, text: &str) -> &str {
    let text = text.trim();
    match language {
        Language::FanucLs => {
            let behind = text.split_once(':').map_or(text, |(number, rest)| {
                match number.trim().bytes().all(|byte| byte.is_ascii_digit()) {
                    true => rest,
                    false => text,
                }
            });
            behind.trim().trim_end_matches(';').trim()
        }
        _ => text,
    }
}
