//! Statements of robots' and APT programs beside their motions.

use kinetostat_formats::Language;

use crate::job::robot::read_program::RobotRead;
use crate::verify::words::{Kind, Word};

/// Statements of a language that this looks at.
struct Words {
    /// Those behind which the motions that follow may not be made.
    ends: &'static [&'static str],
    /// Those that make motions behind them under a condition, or again.
    branches: &'static [&'static str],
    /// Those that say how fast all motions run.
    overrides: &'static [&'static str],
    /// Beginnings of those that are compared otherwise or say nothing to the machine; none where only the kinds above are looked at.
    compared: Option<&'static [&'static str]>,
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
                overrides: &["VELSET", "SPEEDREFRESH"],
                compared: Some(&[
                    "MODULE", "PROC", "FUNC", "TRAP", "RECORD", "CONST", "PERS", "VAR", "LOCAL",
                    "TASK", "END", "VERSION", "LANGUAGE",
                ]),
            },
            Language::Krl => Self {
                ends: &["EXIT", "RETURN", "HALT", "GOTO"],
                branches: &[
                    "IF", "ELSE", "SWITCH", "CASE", "FOR", "WHILE", "LOOP", "REPEAT",
                ],
                overrides: &["$OV_PRO", "$OV_ROB"],
                compared: Some(&[
                    "&", "DEF", "GLOBAL", "DECL", "INT ", "REAL ", "BOOL ", "CHAR ", "E6", "POS ",
                    "FRAME ", "AXIS ", "EXT", "IMPORT", "END", "BAS", "PDAT_ACT", "FDAT_ACT",
                    "LDAT_ACT", "$VEL", "$BASE", "$TOOL", "$LOAD",
                ]),
            },
            Language::FanucLs => Self {
                ends: &["END", "ABORT", "JMP", "PAUSE"],
                branches: &["IF", "ELSE", "SELECT", "FOR"],
                overrides: &["OVERRIDE"],
                compared: Some(&["LBL", "UFRAME_NUM", "UTOOL_NUM", "PR[", "END"]),
            },
            Language::Apt => Self {
                ends: &["FINI", "END", "JUMPTO", "STOP"],
                branches: &["IF", "LOOPST"],
                overrides: &[],
                compared: Some(&[
                    "PARTNO", "UNITS", "GO", "FROM", "RAPID", "FEDRAT", "SPINDL", "LOADTL",
                    "TURRET", "CUTTER", "MULTAX", "INTOL", "OUTTOL", "INDIRV", "CIRCLE", "MOVARC",
                    "PPRINT", "REMARK",
                ]),
            },
            Language::Siemens => Self {
                ends: &["RET", "GOTO", "GOTOF", "GOTOB", "GOTOS"],
                branches: &["IF", "ELSE", "CASE", "FOR", "WHILE", "LOOP", "REPEAT"],
                overrides: &["OVR", "OVRRAP"],
                compared: None,
            },
            _ => Self {
                ends: &[],
                branches: &[],
                overrides: &[],
                compared: None,
            },
        }
    }
}

/// Statements of a program beside its motions, in the order of their lines.
pub(crate) fn statements(read: &RobotRead<'_>) -> Vec<Word> {
    let language = read.program.language;
    let words = Words::of(language);
    let mut found = Vec::new();
    let text = besides_motions(read);
    // Positions of FANUC's programs stand behind their statements, and what describes the file before them.
    let mut is_head = language == Language::FanucLs;
    for (line, text) in (1..).zip(text.lines()) {
        match text.trim() {
            "/MN" => is_head = false,
            "/POS" => break,
            _ if is_head => {}
            text => {
                let parts = code(text, language).split(match language {
                    Language::Rapid => ';',
                    // There is one on a line.
                    _ => '\n',
                });
                let parts = parts.map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
                found.extend(parts.filter_map(|text| {
                    let kind = words.kind(&text, language)?;
                    Some(Word { line, kind, text })
                }));
            }
        }
    }
    found
}

/// The file with the motions in capitals, with blanks for these.
fn besides_motions(read: &RobotRead<'_>) -> String {
    let mut bytes = read.program.files[read.path.file].bytes().to_vec();
    for motion in &read.program.motions {
        if motion.file == read.path.file
            && let Some(part) = bytes.get_mut(motion.span.clone())
        {
            part.iter_mut()
                .filter(|byte| **byte != b'\n')
                .for_each(|byte| *byte = b' ');
        }
    }
    String::from_utf8_lossy(&bytes).to_ascii_uppercase()
}

impl Words {
    /// The kind of a statement; none of what is not looked at.
    fn kind(&self, text: &str, language: Language) -> Option<Kind> {
        let is_frame = language == Language::Krl && text.replace(' ', "").contains("={");
        let begins = |with: &&str| text.starts_with(with);
        if is_end(text, (language, self)) {
            Some(Kind::End)
        } else if begins_with(text, self.branches) {
            Some(Kind::Branch)
        } else if begins_with(text, self.overrides) {
            Some(Kind::Override)
        } else if text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '$' | '%'))
            && !is_frame
            && self.compared.is_some_and(|all| !all.iter().any(begins))
        {
            match text.contains("SPIND") {
                true => Some(Kind::Spindle),
                false => Some(Kind::Other),
            }
        } else {
            None
        }
    }
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
