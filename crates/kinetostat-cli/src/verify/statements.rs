//! Statements of robots' programs that end them, leave parts of them out or change how fast they run.

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::other_word::{FaultKind, OtherWord};

/// Statements behind which the motions that follow may not be made.
fn ends(language: Language) -> &'static [&'static str] {
    match language {
        Language::Rapid => &["EXIT", "EXITCYCLE", "RETURN", "GOTO", "BREAK"],
        Language::Krl => &["EXIT", "RETURN", "HALT", "GOTO"],
        Language::FanucLs => &["END", "ABORT", "JMP"],
        Language::Apt => &["FINI", "END", "JUMPTO"],
        Language::Siemens => &[
            "M2", "M02", "M30", "M17", "RET", "GOTO", "GOTOF", "GOTOB", "GOTOS",
        ],
        _ => &[],
    }
}

/// Statements that say how fast all motions run, or that call what is not read here.
fn others(language: Language) -> &'static [&'static str] {
    match language {
        Language::Rapid => &["VELSET", "ACCSET", "SPEEDREFRESH"],
        Language::Krl => &["$OV_PRO", "$OV_ROB"],
        Language::FanucLs => &["OVERRIDE", "CALL", "RUN"],
        Language::Siemens => &["OVR", "OVRRAP"],
        _ => &[],
    }
}

/// Statements of these kinds that the original does not have so often.
pub(crate) fn statements(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Vec<OtherWord> {
    let language = verified.program.language;
    let [own, of_original] = [verified, original].map(all_statements);
    let last_motion = verified.program.motions.iter().map(|m| m.line).max();
    let count = |all: &[(usize, String)], text: &str| {
        let same = all.iter().filter(|(_, other)| other == text);
        same.count()
    };
    let mut found = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    for (line, text) in &own {
        let is_new = count(&own, text) > count(&of_original, text);
        if !is_new || seen.contains(&text.as_str()) {
            continue;
        }
        seen.push(text);
        let lines = [Some(*line), None];
        // Of several like it the last may be the one that the original has too.
        let lies_before = last_motion.is_some_and(|last| *line < last);
        if begins_with(text, ends(language)) && lies_before {
            let what = OtherWord::only_in_one(text, lines);
            let text = format!("{what}: motions behind it may not be made");
            found.push(OtherWord::new("end", Some(FaultKind::Course), lines, text));
        } else if begins_with(text, others(language)) {
            let what = OtherWord::only_in_one(text, lines);
            let text =
                format!("{what}, and what it does to speeds or motions is not in these figures");
            found.push(OtherWord::new("statement", None, lines, text));
        }
    }
    found
}

/// Statements that this looks at, with their lines.
fn all_statements(read: &RobotRead<'_>) -> Vec<(usize, String)> {
    let language = read.program.language;
    let file = &read.program.files[read.path.file];
    let lines = (1..=file.line_count()).filter_map(|line| Some((line, file.line(line)?)));
    let mut found = Vec::new();
    for (line, bytes) in lines {
        let text = String::from_utf8_lossy(bytes).to_ascii_uppercase();
        let text = code(&text, language);
        if begins_with(text, ends(language)) || begins_with(text, others(language)) {
            found.push((line, text.split_whitespace().collect::<Vec<_>>().join(" ")));
        }
    }
    found
}

/// A line without its number and its comment.
fn code(line: &str, language: Language) -> &str {
    let comment = match language {
        Language::Rapid | Language::FanucLs => "!",
        Language::Apt => "$$",
        _ => ";",
    };
    let text = line.split(comment).next().unwrap_or_default().trim();
    match language {
        Language::FanucLs => {
            let behind = text.split_once(':').map_or(text, |(_, behind)| behind);
            behind.trim().trim_end_matches(';').trim()
        }
        Language::Siemens => {
            let numbered = text
                .strip_prefix('N')
                .map(|t| t.trim_start_matches(|c: char| c.is_ascii_digit()));
            numbered.unwrap_or(text).trim()
        }
        _ => text.trim_end_matches(';').trim(),
    }
}

/// Whether a text begins with one of these as a whole word.
fn begins_with(text: &str, words: &[&str]) -> bool {
    words.iter().any(|word| {
        text.strip_prefix(word).is_some_and(|behind| {
            !behind.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
        })
    })
}
