//! Text that is not run: files that only define subprograms, and lines behind the closing tape mark `%`.

use std::ops::Range;

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::text::lex::{Spanned, Token, tokens_of};

/// Names of subprograms that are shown.
const NAMES_SHOWN: usize = 3;

/// The one fault of a file that consists of `O.. sub` definitions; `None` if anything else stands in it.
pub(crate) fn only_definitions(bytes: &[u8]) -> Option<ProgramError> {
    let mut names: Vec<String> = Vec::new();
    let mut first: Option<(usize, Range<usize>)> = None;
    let mut open: Option<String> = None;
    let mut start = 0;
    for (index, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        let span = start..start + line.trim_ascii_end().len();
        start += line.len() + 1;
        let bare = bare(line);
        let word = definition(&bare);
        match (&open, word) {
            (None, Some((name, "sub"))) => {
                first.get_or_insert((index + 1, span));
                names.push(shown(name));
                open = Some(name.to_owned());
            }
            (Some(own), Some((name, "endsub"))) if own == name => open = None,
            (Some(_), _) => {}
            (None, _) if matches!(bare.as_str(), "" | "%" | "m2" | "m02" | "m30") => {}
            (None, _) => return None,
        }
    }
    let (line, span) = first?;
    let more = match names.len().saturating_sub(NAMES_SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let call = names.first().cloned().unwrap_or_default();
    names.truncate(NAMES_SHOWN);
    Some(ProgramError {
        kind: ProgramErrorKind::Malformed,
        line,
        found: excerpt(&bytes[span.clone()]),
        span,
        reason: format!(
            "the file defines {}{more}; nothing is run",
            names.join(", ")
        ),
        remedy: format!(
            "call it from a program ({call} call), and run that program with --expand (in a job file: a table [expand])"
        ),
    })
}

/// A line in lower case, without blanks and comments.
fn bare(line: &[u8]) -> String {
    let mut text = String::new();
    let mut depth = false;
    for byte in line {
        match byte {
            b'(' => depth = true,
            b')' => depth = false,
            b';' if !depth => break,
            _ if depth || byte.is_ascii_whitespace() => {}
            0xef | 0xbb | 0xbf => {}
            byte => text.push(char::from(byte.to_ascii_lowercase())),
        }
    }
    text
}

/// `o<name>sub` and `o1endsub`: the name and what stands behind it.
fn definition(bare: &str) -> Option<(&str, &str)> {
    let rest = bare.strip_prefix('o').or_else(|| {
        let numbered = bare.strip_prefix('n')?;
        numbered
            .trim_start_matches(|c: char| c.is_ascii_digit() || c == '.')
            .strip_prefix('o')
    })?;
    let end = match rest.starts_with('<') {
        true => rest.find('>')? + 1,
        false => rest.find(|c: char| !c.is_ascii_digit())?,
    };
    let (name, rest) = rest.split_at(end);
    if name.is_empty() {
        return None;
    }
    match rest.starts_with("endsub") {
        // A value may stand behind it.
        true => Some((name, "endsub")),
        false => Some((name, rest)),
    }
}

fn shown(name: &str) -> String {
    format!("O{name}")
}

/// Letters whose words move an axis, and G.
const ACTING: &[u8] = b"GXYZABCUVWEIJKR";

/// M codes that call other blocks or go back to them.
const CALLS: [f64; 3] = [97.0, 98.0, 99.0];

/// The first word of a line after the end with which a controller that runs on would move or change how
/// it moves; none in a text for people, which does not begin with a word.
///
/// A `%` ends a program for controllers that read to it (LinuxCNC, Fanuc), others pass over it. A block behind it may therefore be
/// run, and then it must be corrected like any other: it is refused.
pub(crate) fn acting_word(line: &[u8], tokens: &mut Vec<Spanned>) -> Option<Range<usize>> {
    tokens.clear();
    tokens_of(line, tokens);
    let mut significant = tokens
        .iter()
        .filter(|spanned| {
            !matches!(
                spanned.token,
                Token::Blank | Token::Semicolon | Token::Parenthesis { .. }
            )
        })
        .skip_while(|spanned| spanned.token == Token::Other(b'/'))
        .peekable();
    if !matches!(significant.peek()?.token, Token::Word { .. }) {
        return None;
    }
    significant
        .find(|spanned| match spanned.token {
            Token::Word { letter, value, .. } => {
                ACTING.contains(&letter) || letter == b'M' && CALLS.contains(&value)
            }
            _ => false,
        })
        .map(|spanned| spanned.span.clone())
}
