//! Files of an application: data, parameters and local data as tokens that point into the XML, and where the text of programs stands.
//!
//! Source: Staubli, VAL3 XML format: `Database` and `Programs` since version s7, `dataList` and `programList` before.

use std::collections::BTreeSet;
use std::ops::Range;

use roxmltree::{Attribute, Document, Node};

use crate::error::ProgramError;
use crate::interpreter::token::{Kind, Token, TokenFile};
use crate::interpreter::tree::{Change, DatumNode, Parameter, Sight};
use crate::text::Name;
use crate::text::source::SourceFile;
use crate::val3::expression::{add_tokens, has_values};

/// A program before its statements are read.
pub(super) struct Draft {
    pub name: Name,
    pub name_at: usize,
    pub parameters: Vec<Parameter>,
    pub data: Vec<DatumNode>,
    /// Tokens of the program with its declarations.
    pub whole: Range<usize>,
    /// Tokens of the program text.
    pub code: Range<usize>,
}

/// A file: its tokens, its data and its programs.
pub(super) struct Content<'a> {
    pub file: TokenFile<'a>,
    pub data: Vec<DatumNode>,
    pub drafts: Vec<Draft>,
    /// True for the file of a project with lengths in mm.
    pub says_millimetres: bool,
}

/// Attributes of XML itself.
const XSI: &str = "http://www.w3.org/2001/XMLSchema-instance";

const SAVE_IT: &str = "save the application again with the editor of the controller";

/// The content of a file; `scalars` are the data without an index, to which those of the file are added.
pub(super) fn content_of<'a>(
    index: usize,
    source: &'a SourceFile,
    scalars: &mut BTreeSet<Name>,
    faults: &mut Vec<ProgramError>,
) -> Content<'a> {
    let file = TokenFile {
        index,
        source,
        tokens: Vec::new(),
        lines: Vec::new(),
    };
    let (data, drafts) = (Vec::new(), Vec::new());
    let mut content = Content {
        file,
        data,
        drafts,
        says_millimetres: false,
    };
    let mut refuse = |line: usize, reason: String, remedy: &str| {
        faults.push(ProgramError::at(
            source,
            source.range_of(line),
            reason,
            remedy,
        ));
    };
    let Ok(text) = std::str::from_utf8(source.bytes()) else {
        refuse(1, "the file is not in UTF-8".to_owned(), SAVE_IT);
        return content;
    };
    let document = match Document::parse(text) {
        Ok(document) => document,
        Err(error) => {
            refuse(
                error.pos().row as usize,
                format!("it is no XML: {error}"),
                SAVE_IT,
            );
            return content;
        }
    };
    let root = document.root_element();
    match root.tag_name().name() {
        "Database" | "dataList" => {
            let sections = root.children();
            let all = sections.flat_map(|section| section.children());
            for node in all.filter(Node::is_element) {
                let datum = content.datum(&node);
                let datum = datum.inspect(|own| {
                    if own.is_alone {
                        scalars.insert(own.name);
                    }
                });
                content.data.extend(datum);
            }
        }
        "Programs" | "programList" => {
            for node in root.children().filter(Node::is_element) {
                match content.program(&node, scalars) {
                    Some(draft) => content.drafts.push(draft),
                    None => refuse(
                        source.line_of(node.range().start),
                        "no name and no text of a program are found here".to_owned(),
                        SAVE_IT,
                    ),
                }
            }
        }
        "Project" | "project" => {
            let mut all = root.descendants();
            let unit =
                all.find_map(|node| node.attribute("millimeterUnit").or(node.attribute("unit")));
            content.says_millimetres = matches!(unit, Some("true" | "millimeter" | "mm"));
            if let (false, Some(unit)) = (content.says_millimetres, unit) {
                let reason = format!("the unit of length of the project is stated as `{unit}`");
                refuse(1, reason, "take an application with lengths in mm");
            }
        }
        other => refuse(
            source.line_of(root.range().start),
            format!("`{other}` is no part of an application in VAL3"),
            "give its programs (.pgx) and its data (.dtx)",
        ),
    }
    content
}

impl Content<'_> {
    fn push(&mut self, kind: Kind, bytes: &Range<usize>) -> usize {
        self.file.tokens.push(Token::new(kind, bytes));
        self.file.tokens.len() - 1
    }

    /// The name of an attribute and its value.
    fn pair(&mut self, attribute: &Attribute<'_, '_>) -> usize {
        let is_number = attribute.value().parse().is_ok_and(f64::is_finite);
        self.push(Kind::Word, &attribute.range_qname());
        self.push(
            if is_number { Kind::Number } else { Kind::Text },
            &attribute.range_value(),
        )
    }

    /// A datum with the tokens of its values: a bracket, the attributes of each value behind a bracket of its own, a bracket.
    fn datum(&mut self, node: &Node<'_, '_>) -> Option<DatumNode> {
        let start = self.file.tokens.len();
        let range = node.range();
        self.push(Kind::Symbol(b'<'), &(range.start..range.start + 1));
        let mut own = self.declaration(node)?;
        let named = |node: &Node<'_, '_>| node.tag_name().name().to_ascii_lowercase();
        let father = node
            .children()
            .find(|child| named(child).ends_with("father"));
        let mut count = 0;
        for value in node
            .children()
            .filter(|child| named(child).starts_with("value"))
        {
            count += 1;
            let begin = value.range().start;
            self.push(Kind::Symbol(b'<'), &(begin..begin + 1));
            let inner = value.descendants().filter(|inner| named(inner) != "io");
            for of in father.into_iter().chain(inner) {
                of.attributes().for_each(|attribute| {
                    self.pair(&attribute);
                });
            }
        }
        self.push(Kind::Symbol(b'>'), &(range.end - 1..range.end));
        own.is_alone &= count < 2;
        own.tokens = start..self.file.tokens.len();
        own.initial = Some(own.tokens.clone()).filter(|_| has_values(&own.type_name));
        Some(own)
    }

    /// A name with its type and its size.
    fn declaration(&mut self, node: &Node<'_, '_>) -> Option<DatumNode> {
        let start = self.file.tokens.len();
        let attribute = node.attribute_node("name")?;
        let name = Name::of(attribute.value().as_bytes())?;
        let name_at = self.push(Kind::Word, &attribute.range_value());
        let tag = node.tag_name().name();
        let begin = node.range().start + 1;
        // Not `xsi:type`, which says whether it is an array.
        let mut all = node.attributes();
        let own_type = all.find(|own| own.name() == "type" && own.namespace().is_none());
        let (type_text, place) = match own_type {
            Some(own) => (own.value(), own.range_value()),
            None => (tag, begin..begin + tag.len()),
        };
        self.push(Kind::Word, &place);
        let is_alone = node.attribute("size").is_none_or(|size| size == "1");
        let size = node.attribute_node("size").map(|size| self.pair(&size));
        Some(DatumNode {
            change: Change::Variable,
            sight: Sight::Everywhere,
            type_name: Name::of(type_text.as_bytes())?,
            name,
            name_at,
            tokens: start..self.file.tokens.len(),
            initial: None,
            dimensions: size.map(|at| at..at + 1).filter(|_| !is_alone),
            is_alone,
        })
    }

    /// A program with its parameters, its data and the tokens of its text.
    fn program(&mut self, node: &Node<'_, '_>, scalars: &BTreeSet<Name>) -> Option<Draft> {
        let start = self.file.tokens.len();
        let DatumNode { name, name_at, .. } = self.declaration(node)?;
        let (mut parameters, mut data) = (Vec::new(), Vec::new());
        let mut code = None;
        for inner in node.descendants() {
            match inner.tag_name().name() {
                "Parameter" | "param" => {
                    let mut own = self.declaration(&inner)?;
                    own.is_alone &= inner.attribute((XSI, "type")) != Some("array");
                    let is_value = inner.attribute("use") == Some("value")
                        || inner.attribute("byVal") == Some("true");
                    parameters.push(Parameter {
                        name: own.name,
                        changes: !is_value,
                        is_optional: false,
                    });
                    data.push(own);
                }
                "Local" | "local" => data.push(self.declaration(&inner)?),
                "Code" | "code" => code = Some(inner.range()),
                _ => {}
            }
        }
        let (code, is_escaped) = text_in(self.file.source, code?)?;
        let begin = self.file.tokens.len();
        add_tokens(
            self.file.source.bytes(),
            &code,
            is_escaped,
            &mut self.file.tokens,
        );
        let is_scalar = |name: Name| match data.iter().find(|own| own.name == name) {
            Some(own) => own.is_alone,
            None => scalars.contains(&name),
        };
        self.without_zeros(begin, is_scalar);
        Some(Draft {
            name,
            name_at,
            parameters,
            data,
            whole: start..self.file.tokens.len(),
            code: begin..self.file.tokens.len(),
        })
    }

    /// Takes out the index 0 behind names of data that have no other: `nA[0]` is `nA`.
    fn without_zeros(&mut self, begin: usize, is_scalar: impl Fn(Name) -> bool) {
        let mut kept = Vec::new();
        let mut at = begin;
        while let Some(token) = self.file.tokens.get(at) {
            kept.push(*token);
            let (open, close) = (self.file.is(at + 1, b'['), self.file.is(at + 3, b']'));
            let is_first = open && close && self.file.word(at + 2) == b"0";
            let is_part = at > begin && self.file.is(at - 1, b'.');
            let name = self.file.name(at).filter(|_| is_first && !is_part);
            at += if name.is_some_and(&is_scalar) { 4 } else { 1 };
        }
        self.file.tokens.truncate(begin);
        self.file.tokens.extend(kept);
    }
}

/// Bytes of the text in an element, and true where it is not in CDATA; none where other elements stand in it.
fn text_in(source: &SourceFile, element: Range<usize>) -> Option<(Range<usize>, bool)> {
    let text = std::str::from_utf8(source.part(&element)).ok()?;
    let inner = text.find('>')? + 1..text.rfind("</")?;
    let own = text.get(inner.clone())?;
    let place = |from: usize, to: usize| element.start + from..element.start + to;
    match own.trim_start().strip_prefix("<![CDATA[") {
        Some(rest) => {
            let begin = inner.end - rest.len();
            let end = rest.find("]]>")?;
            let is_alone = rest[end + 3..].trim().is_empty();
            is_alone.then(|| (place(begin, begin + end), false))
        }
        None => (!own.contains('<')).then(|| (place(inner.start, inner.end), true)),
    }
}
