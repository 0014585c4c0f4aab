//! YAML as nodes with their bytes.
//!
//! The parser counts characters; it is given one character for each byte ([`crate::poses::characters`]), so that its places are bytes.

use std::ops::Range;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::poses::characters::Characters;
use crate::text::source::beginning;

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Node {
    pub kind: Kind,
    /// From its first byte (of a list with dashes, of the first dash) behind its last one.
    pub span: Range<usize>,
}

/// What a node is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    Scalar {
        /// It has neither quotes nor a sign of a block.
        plain: bool,
    },
    Map(Vec<(Node, Node)>),
    List(Vec<Node>),
    /// What an anchor stands for.
    Alias,
}

/// Why a text is no tree: the place and what to do.
pub(crate) type TreeFault = (usize, String, &'static str);

/// Lists in lists in lists: poses are at a depth of six.
const DEEPEST: usize = 64;

/// A node whose end is not read yet.
struct Open {
    start: usize,
    end: usize,
    is_map: bool,
    nodes: Vec<Node>,
}

/// The documents of a file.
///
/// # Errors
/// Where the file is no YAML.
pub(crate) fn documents_of(bytes: &[u8]) -> Result<Vec<Node>, TreeFault> {
    let from = beginning(bytes);
    let mut parser = Parser::new(Characters::of(&bytes[from..]));
    let mut open: Vec<Open> = Vec::new();
    let mut documents = Vec::new();
    while let Some(next) = parser.next_event() {
        let (event, span) = next.map_err(|error| {
            let at = from + error.marker().index();
            let reason = format!("it is no YAML: {}", error.info());
            (at.min(bytes.len()), reason, "mend it there or before")
        })?;
        let (start, end) = (
            (from + span.start.index()).min(bytes.len()),
            (from + span.end.index()).min(bytes.len()),
        );
        let done = match event {
            Event::Scalar(_, style, _, _) => Node {
                kind: Kind::Scalar {
                    plain: style == ScalarStyle::Plain,
                },
                span: start..end.max(start),
            },
            Event::Alias(_) => Node {
                kind: Kind::Alias,
                span: start..end.max(start),
            },
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                if open.len() >= DEEPEST {
                    let reason = format!("lists stand in lists, more than {DEEPEST} deep");
                    return Err((
                        start,
                        reason,
                        "poses are not that deep: is it another file?",
                    ));
                }
                open.push(Open {
                    start,
                    end: start,
                    is_map: matches!(event, Event::MappingStart(..)),
                    nodes: Vec::new(),
                });
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => {
                let Some(own) = open.pop() else {
                    continue;
                };
                closed(own, start, bytes)
            }
            _ => continue,
        };
        match open.last_mut() {
            Some(own) => {
                own.end = done.span.end.max(own.end);
                own.nodes.push(done);
            }
            None => documents.push(done),
        }
    }
    Ok(documents)
}

/// A list or map whose end was read.
fn closed(own: Open, at: usize, bytes: &[u8]) -> Node {
    let end = match bytes.get(at) {
        Some(b']' | b'}') if at >= own.end && opens(bytes, own.start) => at + 1,
        _ => own.end,
    };
    let kind = match own.is_map {
        true => {
            let mut pairs = Vec::with_capacity(own.nodes.len() / 2);
            let mut nodes = own.nodes.into_iter();
            while let (Some(key), Some(value)) = (nodes.next(), nodes.next()) {
                pairs.push((key, value));
            }
            Kind::Map(pairs)
        }
        false => Kind::List(own.nodes),
    };
    Node {
        kind,
        span: own.start..end.max(own.start),
    }
}

fn opens(bytes: &[u8], at: usize) -> bool {
    matches!(bytes.get(at), Some(b'[' | b'{'))
}
