//! YAML as nodes with their bytes.
//!
//! The parser counts characters; it is given one character for each byte ([`Characters`]), so that its places are bytes. All
//! nodes of a file stand in one list, each before what it holds: lists of poses have millions of them.

use std::ops::Range;

use saphyr_parser::{Event, Input, Parser};

use crate::text::source::beginning;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Scalar,
    Map,
    List,
    /// Alias of an anchor.
    Alias,
}

/// A node in the list.
#[derive(Debug)]
struct Flat {
    kind: Kind,
    start: u32,
    end: u32,
    /// Index after the node's last descendant.
    behind: u32,
}

/// The nodes of a file.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    nodes: Vec<Flat>,
}

/// A node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node<'t> {
    tree: &'t Tree,
    at: usize,
}

impl<'t> Node<'t> {
    pub(crate) fn kind(self) -> Kind {
        self.tree.nodes[self.at].kind
    }

    /// From its first byte (of a list with dashes, of the first dash) behind its last one.
    pub(crate) fn span(self) -> Range<usize> {
        let node = &self.tree.nodes[self.at];
        node.start as usize..node.end as usize
    }

    /// Children of the node: the items of a list, keys and values of a map in turn.
    pub(crate) fn held(self) -> Nodes<'t> {
        Nodes {
            tree: self.tree,
            at: self.at + 1,
            end: self.tree.nodes[self.at].behind as usize,
        }
    }

    /// Keys and values of a map; none of other nodes.
    pub(crate) fn pairs(self) -> impl Iterator<Item = (Self, Self)> {
        let mut held = self.held();
        let is_map = self.kind() == Kind::Map;
        std::iter::from_fn(move || Some((held.next()?, held.next()?))).take_while(move |_| is_map)
    }

    /// True if both are the same node.
    pub(crate) fn is_node(self, other: Self) -> bool {
        self.at == other.at
    }
}

/// Nodes one behind the other.
pub(crate) struct Nodes<'t> {
    tree: &'t Tree,
    at: usize,
    end: usize,
}

impl<'t> Iterator for Nodes<'t> {
    type Item = Node<'t>;

    fn next(&mut self) -> Option<Node<'t>> {
        let at = self.at;
        let own = self.tree.nodes[..self.end].get(at)?;
        self.at = own.behind as usize;
        Some(Node {
            tree: self.tree,
            at,
        })
    }
}

/// Error of a text that is no tree: position, reason, remedy.
pub(crate) type TreeFault = (usize, String, &'static str);

/// Lists in lists in lists: poses are at a depth of six.
const DEEPEST: usize = 64;

impl Tree {
    /// The nodes of a file of less than 4 GiB.
    ///
    /// # Errors
    /// Where the file is no YAML.
    pub(crate) fn of(bytes: &[u8]) -> Result<Self, TreeFault> {
        let from = beginning(bytes);
        let mut parser = Parser::new(Characters::of(&bytes[from..]));
        let mut tree = Self::default();
        let mut open: Vec<usize> = Vec::new();
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
            let kind = match event {
                Event::Scalar(..) => Kind::Scalar,
                Event::Alias(_) => Kind::Alias,
                Event::SequenceStart(..) => Kind::List,
                Event::MappingStart(..) => Kind::Map,
                Event::SequenceEnd | Event::MappingEnd => {
                    if let Some(own) = open.pop() {
                        let end = tree.close(own, start, bytes);
                        tree.reach(open.last(), end);
                    }
                    continue;
                }
                _ => continue,
            };
            let holds = matches!(kind, Kind::List | Kind::Map);
            if holds && open.len() >= DEEPEST {
                let reason = format!("lists stand in lists, more than {DEEPEST} deep");
                let remedy = "poses are not that deep: is it another file?";
                return Err((start, reason, remedy));
            }
            let at = tree.nodes.len();
            let (start, end) = match (holds, kind == Kind::Scalar && end <= start) {
                (true, _) => (start, start),
                (false, true) => tree.without_value(start, bytes),
                (false, false) => (start, end.max(start)),
            };
            tree.nodes.push(Flat {
                kind,
                start: small(start),
                end: small(end),
                behind: small(at + 1),
            });
            match holds {
                true => open.push(at),
                false => tree.reach(open.last(), end),
            }
        }
        Ok(tree)
    }

    /// The documents of the file.
    pub(crate) fn documents(&self) -> Nodes<'_> {
        Nodes {
            tree: self,
            at: 0,
            end: self.nodes.len(),
        }
    }

    /// A list or map whose end was read at a place; where it ends.
    fn close(&mut self, own: usize, at: usize, bytes: &[u8]) -> usize {
        let behind = small(self.nodes.len());
        let node = &mut self.nodes[own];
        node.behind = behind;
        let opens = opens(bytes.get(node.start as usize..).unwrap_or_default());
        let closes = matches!(bytes.get(at), Some(b']' | b'}'));
        if closes && opens && at >= node.end as usize {
            node.end = small(at + 1);
        }
        node.end = node.start.max(node.end);
        node.end as usize
    }

    /// Position of an empty value: after the colon of its key, which belongs to the map, or at a place.
    fn without_value(&self, place: usize, bytes: &[u8]) -> (usize, usize) {
        let key = self.nodes.last().map_or(place, |key| key.end as usize);
        let rest = bytes.get(key..).unwrap_or_default();
        let blanks = rest.iter().take_while(|byte| **byte == b' ').count();
        let at = match rest.get(blanks) {
            Some(b':') => key + blanks + 1,
            _ => place,
        };
        (at, at)
    }

    /// Extends a list or map to a place.
    fn reach(&mut self, open: Option<&usize>, end: usize) {
        if let Some(own) = open {
            let own = &mut self.nodes[*own];
            own.end = small(end).max(own.end);
        }
    }
}

/// True if a list or map is written between brackets, which may stand behind an anchor and a tag (`&a !!map {`).
fn opens(mut rest: &[u8]) -> bool {
    while let Some(b'&' | b'!') = rest.first() {
        let name = rest.split(u8::is_ascii_whitespace).next();
        rest = rest[name.map_or(0, <[u8]>::len)..].trim_ascii_start();
    }
    matches!(rest.first(), Some(b'[' | b'{'))
}

/// Files are shorter than 4 GiB.
fn small(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}

/// A text that is read.
pub(crate) struct Characters<'b> {
    rest: &'b [u8],
    /// Number of characters that the parser has requested.
    asked: usize,
}

impl<'b> Characters<'b> {
    /// All of a text.
    pub(crate) fn of(rest: &'b [u8]) -> Self {
        Self { rest, asked: 0 }
    }

    fn advance(&mut self, count: usize) {
        self.rest = &self.rest[count.min(self.rest.len())..];
    }

    fn taken_while(&mut self, is_taken: impl Fn(&u8) -> bool) -> usize {
        let count = self.rest.iter().take_while(|byte| is_taken(byte)).count();
        self.advance(count);
        count
    }
}

/// Replaces a non-ASCII byte; such bytes never belong to a number or a known name.
fn character(byte: u8) -> char {
    match byte {
        0..=0x7f => char::from(byte),
        _ => 'x',
    }
}

/// True if a byte does not end a line.
fn is_in_line(byte: &u8) -> bool {
    !matches!(byte, b'\0' | b'\n' | b'\r')
}

impl Input for Characters<'_> {
    #[inline]
    fn lookahead(&mut self, count: usize) {
        self.asked = usize::max(self.asked, count);
    }

    #[inline]
    fn buflen(&self) -> usize {
        self.asked
    }

    /// The parser takes memory for so many characters at every scalar: a number of all its digits fits.
    #[inline]
    fn bufmaxlen(&self) -> usize {
        32
    }

    #[inline]
    fn raw_read_ch(&mut self) -> char {
        let next = self.peek();
        self.advance(1);
        next
    }

    #[inline]
    fn raw_read_non_breakz_ch(&mut self) -> Option<char> {
        let next = self.rest.first().filter(|byte| is_in_line(byte))?;
        let next = character(*next);
        self.advance(1);
        Some(next)
    }

    #[inline]
    fn skip(&mut self) {
        self.advance(1);
    }

    #[inline]
    fn skip_n(&mut self, count: usize) {
        self.advance(count);
    }

    #[inline]
    fn peek(&self) -> char {
        self.peek_nth(0)
    }

    #[inline]
    fn peek_nth(&self, n: usize) -> char {
        self.rest.get(n).map_or('\0', |byte| character(*byte))
    }

    #[inline]
    fn peek_opt(&self) -> Option<char> {
        self.rest.first().map(|byte| character(*byte))
    }

    fn skip_while_non_breakz(&mut self) -> usize {
        self.taken_while(is_in_line)
    }

    fn skip_while_blank(&mut self) -> usize {
        self.taken_while(|byte| matches!(byte, b' ' | b'\t'))
    }
}
