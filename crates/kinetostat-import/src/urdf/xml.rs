//! From bytes to an XML tree with bounded memory: size, kind of text, DTDs and size of tags are
//! looked at before anything is parsed.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use kinetostat_model::ModelError;
use roxmltree::{Document, ParsingOptions};

use crate::log::{At, Log, refusal};

/// Larger files are refused before they are read, bytes. The largest robots lie far below 1 MB.
pub const MOST_URDF_BYTES: u64 = 8 << 20;
/// A longer tag is no element of a URDF, bytes.
const MOST_TAG_BYTES: usize = 4 << 10;
/// Elements, texts and comments in one file.
const MOST_NODES: u32 = 200_000;
/// Elements inside each other.
const MOST_DEPTH: usize = 100;

/// Text of a URDF or of a file beside it: UTF-8, at most [`MOST_URDF_BYTES`], looked at before it is
/// read. `what` names it in messages, as in `URDF file`.
///
/// # Errors
/// [`ModelError`] if it cannot be read, is too large or is no text.
pub fn read_text(what: &str, path: &Path) -> Result<String, ModelError> {
    let name = path.display().to_string();
    let io = |e: std::io::Error| {
        let (message, help) = match e.kind() {
            ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path"),
            ErrorKind::PermissionDenied => (
                "the file may not be read".to_owned(),
                "ask for the right to read it",
            ),
            _ => (format!("the file cannot be read: {e}"), "check the path"),
        };
        refusal(&name, message, help)
    };
    let found = std::fs::metadata(path).map_err(io)?;
    if !found.is_file() {
        return Err(refusal(
            &name,
            format!("this is no file, a {what} is needed"),
            "name a file",
        ));
    }
    let too_large = |bytes: u64| {
        refusal(
            &name,
            format!(
                "the file has {:.1} MB, more than {} MB are not read",
                bytes as f64 / 1e6,
                MOST_URDF_BYTES >> 20
            ),
            format!("name a {what}; meshes and pictures stay in files of their own"),
        )
    };
    if found.len() > MOST_URDF_BYTES {
        return Err(too_large(found.len()));
    }
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|f| f.take(MOST_URDF_BYTES + 1).read_to_end(&mut bytes))
        .map_err(io)?;
    if bytes.len() as u64 > MOST_URDF_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(refusal(
            &name,
            "the file is written in UTF-16",
            "save it as UTF-8",
        ));
    }
    if bytes.contains(&0) {
        return Err(refusal(
            &name,
            format!("this is a binary file, not a {what}"),
            "name a text file",
        ));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let line = e.as_bytes()[..at].iter().filter(|b| **b == b'\n').count() + 1;
        refusal(
            &name,
            format!("line {line} is not UTF-8 text"),
            "save the file as UTF-8",
        )
    })
}

/// Parses `text`, which is file `file` of the log.
pub(crate) fn parse<'a>(
    text: &'a str,
    name: &str,
    file: usize,
    log: &mut Log,
) -> Result<Document<'a>, ModelError> {
    if text.len() as u64 > MOST_URDF_BYTES {
        return Err(refusal(
            name,
            format!("the text is larger than {} MB", MOST_URDF_BYTES >> 20),
            "name a URDF file",
        ));
    }
    if text.trim().is_empty() {
        return Err(refusal(name, "the file is empty", "name a URDF file"));
    }
    let at = |start: usize, length: usize| At {
        file,
        span: start..(start + length).min(text.len()),
        element: String::new(),
    };
    if !text
        .trim_start_matches('\u{feff}')
        .trim_start()
        .starts_with('<')
    {
        log.error(
            &at(0, 1),
            "this is no XML, which begins with '<'",
            "name a URDF file (a xacro file must be expanded first: xacro FILE.urdf.xacro > FILE.urdf)",
        );
        log.stop()?;
    }
    if let Err((start, message, help)) = scan(text) {
        log.error(&at(start, 1), message, help);
        log.stop()?;
    }
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let expansion = log.expansion(file);
    Document::parse_with_options(text, options).map_err(|e| {
        use roxmltree::Error as E;
        let (message, help) = match &e {
            E::DtdDetected => (
                "the file has a document type definition (DTD)".to_owned(),
                "remove <!DOCTYPE ...>: a URDF needs none, and entities can make a small file huge",
            ),
            E::NodesLimitReached => (
                format!("the file has more than {MOST_NODES} elements and texts"),
                "name a URDF file",
            ),
            E::UnexpectedCloseTag(wanted, found, _) => (
                format!("</{found}> appears where </{wanted}> is needed"),
                "close every element in the reverse order of opening",
            ),
            E::UnclosedRootNode | E::UnexpectedEndOfStream => (
                "the file ends before <robot> is closed".to_owned(),
                "is the file complete?",
            ),
            E::DuplicatedAttribute(which, _) => (
                format!("the attribute '{which}' is written twice"),
                "keep one of them",
            ),
            E::UnknownEntityReference(which, _) => (
                format!("&{which}; is not defined"),
                "write the character itself, or &amp; for '&'",
            ),
            E::UnknownNamespace(prefix, _) => (
                format!("the prefix '{prefix}:' is not declared"),
                expansion.as_str(),
            ),
            other => (
                format!("this is not well-formed XML: {other}"),
                "correct it, or export the file again",
            ),
        };
        // The message of a truncated file belongs to its end, where no position is known.
        let place = match e {
            E::UnclosedRootNode | E::UnexpectedEndOfStream => last(text),
            E::DtdDetected => text.find("<!DOCTYPE").unwrap_or(0),
            _ => offset(text, e.pos()),
        };
        log.error(&at(place, 1), message, help);
        match log.stop() {
            Err(refused) => refused,
            Ok(()) => refusal(name, "this is not well-formed XML", "export it again"),
        }
    })
}

/// Byte of the last character that is no white space.
fn last(text: &str) -> usize {
    let end = text.trim_end();
    end.char_indices().next_back().map_or(0, |(i, _)| i)
}

/// Byte of a row and a column (characters, from 1).
fn offset(text: &str, pos: roxmltree::TextPos) -> usize {
    let row = pos.row.saturating_sub(1) as usize;
    let start: usize = text.split_inclusive('\n').take(row).map(str::len).sum();
    let line = text[start..].lines().next().unwrap_or("");
    let column = pos.col.saturating_sub(1) as usize;
    start
        + line
            .char_indices()
            .nth(column)
            .map_or(line.len(), |(i, _)| i)
}

/// Finds constructs that could make the parser use much time or memory, in one pass over the bytes.
fn scan(text: &str) -> Result<(), (usize, String, String)> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut i = 0;
    while let Some(found) = text[i..].find('<') {
        let start = i + found;
        let rest = &text[start..];
        let end = if rest.starts_with("<!--") {
            rest.find("-->").map(|e| e + 3)
        } else if rest.starts_with("<![CDATA[") {
            rest.find("]]>").map(|e| e + 3)
        } else if rest.starts_with("<?") {
            rest.find("?>").map(|e| e + 2)
        } else if rest.starts_with("<!") {
            return Err((
                start,
                "the file has a document type definition (DTD)".into(),
                "remove <!DOCTYPE ...>: a URDF needs none, and entities can make a small file huge"
                    .into(),
            ));
        } else {
            let end = tag_end(&bytes[start..]);
            if end.is_some_and(|e| e > MOST_TAG_BYTES)
                || (end.is_none() && rest.len() > MOST_TAG_BYTES)
            {
                return Err((
                    start,
                    format!("this tag is longer than {} kB", MOST_TAG_BYTES >> 10),
                    "no element of a URDF is; export the file again".into(),
                ));
            }
            if rest.starts_with("</") {
                depth = depth.saturating_sub(1);
            } else if let Some(e) = end
                && bytes[start + e - 2] != b'/'
            {
                depth += 1;
                if depth > MOST_DEPTH {
                    return Err((
                        start,
                        format!("elements lie more than {MOST_DEPTH} deep in each other"),
                        "no URDF does; export the file again".into(),
                    ));
                }
            }
            end
        };
        match end {
            Some(e) => i = start + e,
            // The parser says what is not closed.
            None => break,
        }
    }
    Ok(())
}

/// Bytes of a tag up to and with its `>`; quoted values may hold one.
fn tag_end(bytes: &[u8]) -> Option<usize> {
    let mut quote = None;
    for (i, b) in bytes.iter().take(MOST_TAG_BYTES + 2).enumerate() {
        match (quote, b) {
            (None, b'>') => return Some(i + 1),
            (None, b'"' | b'\'') => quote = Some(*b),
            (Some(q), b) if q == *b => quote = None,
            _ => {}
        }
    }
    None
}
