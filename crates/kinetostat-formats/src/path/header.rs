//! The header of a corrected program: comments in its own language, below the line with which the program begins.

use kinetostat_program::{COMPENSATED_MARK, HEADER_PREFIX};

use crate::heidenhain::numbering;
use crate::ls::write::numbered_again;
use crate::model::language::Language;
use crate::text::source::SourceFile;
use crate::text::source::beginning;

/// Lines in which the mark is looked for.
const LOOKED_AT: usize = 200;

/// How a language begins its comments, and the word of the line below which they may stand (`None`: the first line).
struct Comments {
    opens: &'static str,
    below: Option<&'static str>,
}

fn comments(language: Language) -> Comments {
    match language {
        Language::Rapid => Comments {
            opens: "! ",
            below: Some("MODULE"),
        },
        Language::Apt => Comments {
            opens: "$$ ",
            below: None,
        },
        // A remark has 32 characters: the mark alone is written.
        Language::FanucLs => Comments {
            opens: "   1:  !",
            below: Some("/MN"),
        },
        Language::Krl => Comments {
            opens: "; ",
            below: Some("DEF"),
        },
        Language::Poses => Comments {
            opens: "# ",
            below: None,
        },
        Language::Siemens => Comments {
            opens: "; ",
            below: None,
        },
        Language::Heidenhain => Comments {
            opens: "; ",
            below: Some("BEGIN"),
        },
    }
}

/// Line of the mark of a corrected program, counted from 1.
pub(crate) fn mark_line(file: &SourceFile) -> Option<usize> {
    let mark = HEADER_PREFIX.as_bytes();
    let holds = |line: &[u8]| line.windows(mark.len()).any(|part| part == mark);
    (1..=file.line_count().min(LOOKED_AT)).find(|number| file.line(*number).is_some_and(holds))
}

/// The program with its header, and how many lines that has: the mark, then the texts, in lines of at most so many bytes.
pub(crate) fn with_header(
    language: Language,
    bytes: &[u8],
    texts: &[String],
    max_line_bytes: usize,
) -> (Vec<u8>, usize) {
    let Comments { opens, below } = comments(language);
    let begins = |line: &[u8]| {
        let mut line = line.trim_ascii_start();
        if language == Language::Heidenhain {
            // Behind the number of the block.
            let digits = line.iter().take_while(|byte| byte.is_ascii_digit()).count();
            line = line[digits..].trim_ascii_start();
        }
        let line = line.to_ascii_uppercase();
        below.is_none_or(|word| line.starts_with(word.as_bytes()))
    };
    let mut at = 0;
    let mut found = None;
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        at += line.len();
        if begins(line) && line.ends_with(b"\n") {
            found = Some((at, line.ends_with(b"\r\n")));
            break;
        }
    }
    if language == Language::Poses {
        // Above the names of the columns; inside of YAML a comment could become a part of a text.
        // Behind a byte order mark, which belongs to the first line, a table has it below the names.
        let first = bytes
            .split(|byte| *byte == b'\n')
            .next()
            .unwrap_or_default();
        found = found.filter(|_| beginning(bytes) == 0 || first.contains(&b','));
        if beginning(bytes) == 0 {
            found = found.map(|(_, carriage_return)| (0, carriage_return));
        }
    }
    let Some((mut at, carriage_return)) = found else {
        return (bytes.to_vec(), 0);
    };
    // The control reads a path only right below the name of the program.
    let next = bytes[at..].split_inclusive(|byte| *byte == b'\n').next();
    let is_path = |line: &&[u8]| line.to_ascii_uppercase().starts_with(b";$PATH");
    if let (Language::Siemens, Some(path)) = (language, next.filter(is_path))
        && path.ends_with(b"\n")
    {
        at += path.len();
    }
    let ending: &[u8] = match carriage_return {
        true => b"\r\n",
        false => b"\n",
    };
    // A block of its own, where blocks have numbers.
    let numbered = language == Language::Heidenhain && numbering::is_numbered(bytes);
    let opens = match numbered {
        true => format!("0 {opens}"),
        false => opens.to_owned(),
    };
    let mut header = Vec::new();
    let mut count = 0;
    let closes: &[u8] = match language {
        Language::FanucLs => b" ;",
        _ => b"",
    };
    let mut write = |text: &str| {
        for part in [opens.as_bytes(), text.as_bytes(), closes, ending] {
            header.extend_from_slice(part);
        }
        count += 1;
    };
    write(COMPENSATED_MARK);
    if language == Language::FanucLs {
        let bytes = [&bytes[..at], &header, &bytes[at..]].concat();
        return (numbered_again(&bytes).unwrap_or(bytes), 1);
    }
    let room = max_line_bytes
        .saturating_sub(opens.len() + HEADER_PREFIX.len())
        .max(20);
    for text in texts.iter().flat_map(|text| text.lines()) {
        let plain: String = text.chars().map(plain).collect();
        for part in in_lines(&plain, room) {
            write(&format!("{HEADER_PREFIX}{part}"));
        }
    }
    let bytes = [&bytes[..at], &header, &bytes[at..]].concat();
    match numbered {
        true => (numbering::numbered_again(&bytes).unwrap_or(bytes), count),
        false => (bytes, count),
    }
}

/// A text of ASCII in lines of at most so many bytes, at blanks where there are some.
fn in_lines(text: &str, room: usize) -> Vec<&str> {
    let mut lines = Vec::new();
    let mut rest = text.trim_end();
    while rest.len() > room {
        let at = rest[..=room]
            .rfind(' ')
            .filter(|at| *at > 0)
            .unwrap_or(room);
        lines.push(rest[..at].trim_end());
        rest = rest[at..].trim_start();
    }
    lines.push(rest);
    lines
}

/// ASCII that ends no comment.
fn plain(character: char) -> char {
    match character {
        ' '..='~' => character,
        _ => '?',
    }
}
