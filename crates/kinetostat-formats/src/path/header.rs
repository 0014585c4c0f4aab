//! The header of a corrected program: comments in its own language, below the line with which the program begins.

use kinetostat_program::{COMPENSATED_MARK, HEADER_PREFIX};

use crate::model::Language;
use crate::text::source::SourceFile;

/// Lines in which the mark is looked for.
const LOOKED_AT: usize = 200;

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
    let below = language.header_below();
    let begins = |line: &[u8]| {
        let line = language.behind_number(line.trim_ascii_start());
        let line = line.to_ascii_uppercase();
        below.is_none_or(|word| line.starts_with(word.as_bytes()))
    };
    let mut at = 0;
    let mut lines = bytes.split_inclusive(|byte| *byte == b'\n');
    let found = lines.find(|line| {
        at += line.len();
        begins(line) && line.ends_with(b"\n")
    });
    let place = found.and_then(|line| Some((language.header_place(bytes, at)?, line)));
    let Some((at, line)) = place else {
        return (bytes.to_vec(), 0);
    };
    let ending: &[u8] = match line.ends_with(b"\r\n") {
        true => b"\r\n",
        false => b"\n",
    };
    let opens = language.header_opens(bytes);
    let closes = language.header_closes().as_bytes();
    let mut header = Vec::new();
    let mut count = 0;
    let mut write = |text: &str| {
        for part in [opens.as_bytes(), text.as_bytes(), closes, ending] {
            header.extend_from_slice(part);
        }
        count += 1;
    };
    write(COMPENSATED_MARK);
    let room = max_line_bytes
        .saturating_sub(opens.len() + HEADER_PREFIX.len())
        .max(20);
    let texts = texts.iter().filter(|_| !language.header_is_mark());
    for text in texts.flat_map(|text| text.lines()) {
        let plain: String = text.chars().map(plain).collect();
        for part in in_lines(&plain, room) {
            write(&format!("{HEADER_PREFIX}{part}"));
        }
    }
    let bytes = [&bytes[..at], &header, &bytes[at..]].concat();
    (language.numbered_again(&bytes).unwrap_or(bytes), count)
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
