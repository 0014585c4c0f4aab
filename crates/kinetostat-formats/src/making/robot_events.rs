//! What a robot's program says beside its motions.

use std::ops::Range;

use crate::making::events::{EventKind, SourceEvent};
use crate::model::program::{Language, RobotProgram};

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
        Language::Heidenhain => &["BEGIN PGM", "END PGM", "BLK FORM", "CC ", "L ", "LBL "],
        Language::Siemens => &[
            "%", ";$PATH", "DEF ", "PROC ", "G0", "G1", "G2", "G3", "G5", "G6", "G7", "G9", "F",
            "M30", "M17", "RET",
        ],
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
    let mut events = Vec::new();
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
        events.push(SourceEvent {
            line,
            kind: kind_of(program.language, &upper),
            text: text.to_owned(),
            place: format!("line {line}"),
            seconds: None,
        });
    }
    events
}

/// Lines that hold instructions.
fn instructions(language: Language, source: &crate::text::source::SourceFile) -> Range<usize> {
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
fn body(language: Language, text: &str) -> &str {
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
        Language::Heidenhain => text.trim_start_matches(|c: char| c.is_ascii_digit()).trim(),
        Language::Siemens => {
            let numbered = text.strip_prefix(['N', 'n', ':']);
            let behind = numbered.map(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()));
            behind
                .filter(|rest| Some(*rest) != numbered)
                .unwrap_or(text)
                .trim()
        }
        _ => text,
    }
}

fn kind_of(language: Language, upper: &str) -> EventKind {
    let has = |words: &[&str]| words.iter().any(|word| upper.starts_with(word));
    let comment = match language {
        Language::Rapid | Language::FanucLs => "!",
        Language::Krl | Language::Siemens | Language::Heidenhain => ";",
        Language::Poses => "#",
        Language::Apt => "$$",
    };
    match () {
        () if upper.starts_with(comment) || has(&["PPRINT", "REMARK"]) => EventKind::Comment,
        () if language == Language::Heidenhain && upper.starts_with('*') => EventKind::Comment,
        () if has(&["TOOL CALL", "TOOL DEF"]) => EventKind::Tool,
        () if has(&["SPINDL"]) => EventKind::Spindle,
        () if has(&["COOLNT"]) => EventKind::Coolant,
        () if has(&["LOAD", "TOOLNO", "TOOL PATH", "TLDATA"]) => EventKind::Tool,
        () if has(&["WAIT", "DELAY"]) => EventKind::Dwell,
        () if has(&["STOP", "HALT", "PAUSE", "OPSTOP"]) => EventKind::Stop,
        () => EventKind::Other,
    }
}
