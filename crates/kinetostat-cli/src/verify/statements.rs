//! Statements of robots' programs that end them, leave parts of them out or change how fast they run.

use std::collections::BTreeSet;

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::cut_lines::{CutLines, Left};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Statements of a language that this looks at.
struct Words {
    /// Those behind which the motions that follow may not be made.
    ends: &'static [&'static str],
    /// Those that make motions behind them under a condition, or again.
    branches: &'static [&'static str],
    /// Those that say how fast all motions run, or that call what is not read here.
    others: &'static [&'static str],
}

impl Words {
    fn of(language: Language) -> Self {
        match language {
            Language::Rapid => Self {
                ends: &[
                    "EXIT",
                    "EXITCYCLE",
                    "RETURN",
                    "GOTO",
                    "BREAK",
                    "STOP",
                    "RAISE",
                ],
                branches: &["IF", "ELSEIF", "ELSE", "TEST", "CASE", "FOR", "WHILE"],
                others: &["VELSET", "ACCSET", "SPEEDREFRESH"],
            },
            Language::Krl => Self {
                ends: &["EXIT", "RETURN", "HALT", "GOTO"],
                branches: &[
                    "IF", "ELSE", "SWITCH", "CASE", "FOR", "WHILE", "LOOP", "REPEAT",
                ],
                others: &["$OV_PRO", "$OV_ROB"],
            },
            Language::FanucLs => Self {
                ends: &["END", "ABORT", "JMP", "PAUSE"],
                branches: &["IF", "ELSE", "SELECT", "FOR"],
                others: &["OVERRIDE", "CALL", "RUN"],
            },
            Language::Apt => Self {
                ends: &["FINI", "END", "JUMPTO", "STOP"],
                branches: &["IF", "LOOPST"],
                others: &[],
            },
            Language::Siemens => Self {
                ends: &[
                    "M2", "M02", "M30", "M17", "RET", "GOTO", "GOTOF", "GOTOB", "GOTOS",
                ],
                branches: &["IF", "ELSE", "CASE", "FOR", "WHILE", "LOOP", "REPEAT"],
                others: &["OVR", "OVRRAP"],
            },
            _ => Self {
                ends: &[],
                branches: &[],
                others: &[],
            },
        }
    }
}

/// A statement: where it stands, what it says, and behind which cut, as a line of the original (zero before all cuts).
struct Statement {
    line: usize,
    text: String,
    behind: usize,
}

/// Statements of these kinds that the original does not have behind the same cut; `cut_lines` are lines of the program verified and of the
/// original.
pub(crate) fn statements(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    cut_lines: &[[usize; 2]],
) -> Vec<OtherWord> {
    let language = verified.program.language;
    let words = Words::of(language);
    let cuts = CutLines::of(cut_lines);
    let own = all_statements(verified, |line| cuts.before_own(line));
    let of_original = all_statements(original, |line| cuts.before(line));
    let of_statement = |statement: &Statement| (statement.text.clone(), statement.behind);
    let mut left = Left::of(of_original.iter().map(of_statement));
    let last_motion = verified.program.motions.iter().map(|m| m.line).max();
    let mut found = Vec::new();
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    for statement in &own {
        let Statement { line, text, .. } = statement;
        if left.take(&of_statement(statement)) || !seen.insert(text) {
            continue;
        }
        let lines = [Some(*line), None];
        let is_elsewhere = of_original.iter().any(|other| other.text == *text);
        let what = match is_elsewhere {
            true => format!("{text} at line {line} stands elsewhere in the original"),
            false => OtherWord::only_in_one(text, lines),
        };
        let lies_before = last_motion.is_some_and(|last| *line < last);
        let leads_on = begins_with(text, words.branches);
        if (is_end(text, (language, &words)) || leads_on) && lies_before {
            let text = match leads_on {
                true => format!("{what}: motions behind it may not be made, or more than once"),
                false => format!("{what}: motions behind it may not be made"),
            };
            found.push(OtherWord::new("end", Some(FaultKind::Course), lines, text));
        } else if begins_with(text, words.others) {
            let text =
                format!("{what}, and what it does to speeds or motions is not in these figures");
            found.push(OtherWord::new("statement", None, lines, text));
        }
    }
    found
}

/// Statements that this looks at.
fn all_statements(read: &RobotRead<'_>, behind: impl Fn(usize) -> usize) -> Vec<Statement> {
    let language = read.program.language;
    let words = Words::of(language);
    let mut found = Vec::new();
    for (line, text) in read.lines_in_capitals() {
        let parts = code(&text, language).split(match language {
            Language::Rapid => ';',
            // There is one on a line.
            _ => '\n',
        });
        for part in parts.map(str::trim) {
            let is_word = [words.others, words.branches]
                .iter()
                .any(|words| begins_with(part, words));
            if is_word || is_end(part, (language, &words)) {
                found.push(Statement {
                    line,
                    text: part.split_whitespace().collect::<Vec<_>>().join(" "),
                    behind: behind(line),
                });
            }
        }
    }
    found
}

/// Whether motions behind a statement may not be made; `IF` has its statement behind itself in RAPID.
fn is_end(text: &str, (language, words): (Language, &Words)) -> bool {
    let ends = words.ends;
    let behind_if = || {
        let last = text.rsplit(char::is_whitespace).next().unwrap_or_default();
        language == Language::Rapid && begins_with(text, &["IF"]) && ends.contains(&last)
    };
    begins_with(text, ends) || behind_if()
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
