//! Expressions of TP programs from the words of an instruction.
//!
//! Source of the precedence: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4, mixed logic instructions.

use std::ops::Range;

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::ls::lines::{Kind, Word, words_of};
use crate::text::Name;

/// Deepest nesting of brackets and signs.
const DEEPEST: usize = 16;

/// Limit of consecutive operators of one precedence: it bounds the depth of the tree.
const MOST_OPERATORS: usize = 100;

/// The expression that a part of a file is; its tokens are bytes.
pub(crate) fn expression_of(bytes: &[u8], part: Range<usize>) -> Expression {
    let mut reader = Reader::of(bytes, &part);
    let found = reader.operation(0, 0);
    let is_whole = reader.at == reader.words.len();
    found.filter(|_| is_whole).unwrap_or(Expression {
        node: Node::Unreadable,
        tokens: part,
    })
}

/// The expressions between the commas of a part of a file that no bracket holds.
pub(crate) fn list_of(bytes: &[u8], part: Range<usize>) -> Vec<Expression> {
    let (mut open, mut is_text, mut start) = (0_i32, false, part.start);
    let mut found = Vec::new();
    for at in part.clone() {
        match bytes[at] {
            b'\'' => is_text = !is_text,
            b'[' | b'(' => open += 1,
            b']' | b')' => open -= 1,
            b',' if open == 0 && !is_text => {
                found.push(expression_of(bytes, start..at));
                start = at + 1;
            }
            _ => {}
        }
    }
    if !bytes[start..part.end].trim_ascii().is_empty() {
        found.push(expression_of(bytes, start..part.end));
    }
    found
}

/// The indices in `[12]`, `[12:name]`, `[R[1]]` and `[9,3]`.
pub(crate) fn indices_of(bytes: &[u8], bracket: &Range<usize>) -> Option<Vec<Expression>> {
    indices(bytes, bracket, 0)
}

fn indices(bytes: &[u8], bracket: &Range<usize>, depth: usize) -> Option<Vec<Expression>> {
    let inside = bracket.start + 1..bracket.end.checked_sub(1)?;
    if depth > DEEPEST || inside.start > inside.end {
        return None;
    }
    let mut reader = Reader::of(bytes, &inside);
    let mut found = vec![reader.operand(depth + 1)?];
    if reader.takes(b',') {
        found.push(reader.operand(depth + 1)?);
    }
    // A name that people give it.
    (reader.at == reader.words.len() || reader.takes(b':')).then_some(found)
}

struct Reader<'b> {
    bytes: &'b [u8],
    words: Vec<Word>,
    at: usize,
}

impl<'b> Reader<'b> {
    fn of(bytes: &'b [u8], part: &Range<usize>) -> Self {
        Self {
            bytes,
            words: words_of(bytes, part),
            at: 0,
        }
    }

    fn kind(&self, ahead: usize) -> Option<Kind> {
        self.words.get(self.at + ahead).map(|word| word.kind)
    }

    fn takes(&mut self, symbol: u8) -> bool {
        let found = self.kind(0) == Some(Kind::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    fn text(&self) -> &'b [u8] {
        let word = self.words.get(self.at);
        word.map_or(&[], |word| &self.bytes[word.span.clone()])
    }

    /// An expression from a word to here.
    fn over(&self, start: usize, node: Node) -> Expression {
        let from = self.words.get(start).map_or(0, |word| word.span.start);
        let last = self.at.checked_sub(1).and_then(|last| self.words.get(last));
        Expression {
            node,
            tokens: from..last.map_or(from, |word| word.span.end),
        }
    }

    /// Operands and the operators between them that bind at least so strongly.
    fn operation(&mut self, depth: usize, least: u8) -> Option<Expression> {
        let start = self.at;
        let mut left = self.operand(depth)?;
        let mut operators = 0;
        while let Some((operator, strength, count)) = self.operator() {
            if strength < least {
                break;
            }
            operators += 1;
            if operators > MOST_OPERATORS {
                return None;
            }
            self.at += count;
            let right = self.operation(depth + 1, strength + 1)?;
            left = self.over(start, Node::Two(operator, Box::new([left, right])));
        }
        Some(left)
    }

    /// The operator that stands here, how strongly it binds, and its words.
    fn operator(&self) -> Option<(Operator, u8, usize)> {
        let next = |symbol| self.kind(1) == Some(Kind::Symbol(symbol));
        Some(match self.kind(0)? {
            Kind::Letters => match self.text() {
                b"OR" => (Operator::Or, 0, 1),
                b"AND" => (Operator::And, 1, 1),
                b"DIV" => (Operator::WholeQuotient, 5, 1),
                b"MOD" => (Operator::Remainder, 5, 1),
                _ => return None,
            },
            Kind::Symbol(b'<') if next(b'>') => (Operator::Unequal, 2, 2),
            Kind::Symbol(b'<') if next(b'=') => (Operator::LessOrEqual, 3, 2),
            Kind::Symbol(b'>') if next(b'=') => (Operator::GreaterOrEqual, 3, 2),
            Kind::Symbol(b'<') => (Operator::Less, 3, 1),
            Kind::Symbol(b'>') => (Operator::Greater, 3, 1),
            Kind::Symbol(b'=') => (Operator::Equal, 2, 1),
            Kind::Symbol(b'+') => (Operator::Plus, 4, 1),
            Kind::Symbol(b'-') => (Operator::Minus, 4, 1),
            Kind::Symbol(b'*') => (Operator::Times, 5, 1),
            Kind::Symbol(b'/') => (Operator::Over, 5, 1),
            _ => return None,
        })
    }

    /// A value with its sign.
    fn operand(&mut self, depth: usize) -> Option<Expression> {
        let start = self.at;
        if depth > DEEPEST {
            return None;
        }
        let kind = self.kind(0)?;
        let name = Name::of(self.text());
        self.at += 1;
        let node = match kind {
            Kind::Number(value) => Node::Number(value),
            Kind::Symbol(b'-') => Node::One(Operator::Minus, Box::new(self.operand(depth + 1)?)),
            Kind::Symbol(b'!') => Node::One(Operator::Not, Box::new(self.operand(depth + 1)?)),
            Kind::Symbol(b'(') => {
                let inner = self.operation(depth + 1, 0)?;
                self.takes(b')').then_some(inner)?.node
            }
            Kind::Symbol(b'\'') => {
                while !self.takes(b'\'') {
                    self.kind(0)?;
                    self.at += 1;
                }
                Node::Text
            }
            Kind::Letters => match (self.kind(0), name?) {
                (Some(Kind::Bracket), name) => {
                    let bracket = self.words[self.at].span.clone();
                    self.at += 1;
                    let indices = indices(self.bytes, &bracket, depth + 1)?;
                    let of = self.over(start, Node::Word(name));
                    Node::Element(Box::new(of), indices)
                }
                (_, name) if name.is("ON") || name.is("TRUE") => Node::Truth(true),
                (_, name) if name.is("OFF") || name.is("FALSE") => Node::Truth(false),
                (_, name) => Node::Word(name),
            },
            Kind::Symbol(_) | Kind::Bracket => return None,
        };
        Some(self.over(start, node))
    }
}
