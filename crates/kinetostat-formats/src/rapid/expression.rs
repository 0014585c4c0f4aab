//! Expressions of RAPID from tokens.
//!
//! Source of the precedence: ABB, Technical reference manual - RAPID kernel, Priority between operators.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node, Operator};
use crate::rapid::lex::Kind;
use crate::rapid::tree::TokenFile;
use crate::text::name::Name;

/// Deepest nesting of lists, calls and indices.
const DEEPEST: usize = 32;

/// Most operators of one strength in a row: the tree is as deep.
const MOST_OPERATORS: usize = 100;

/// The arguments of a call between two tokens.
pub(crate) fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
    let mut reader = Reader {
        file,
        at: tokens.start,
        end: tokens.end.min(file.tokens.len()),
    };
    reader.arguments(0)
}

/// The expression that tokens are.
pub(crate) fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    let mut reader = Reader {
        file,
        at: tokens.start,
        end: tokens.end.min(file.tokens.len()),
    };
    let found = reader.expression(0);
    match found.tokens.end == tokens.end {
        true => found,
        false => Expression {
            node: Node::Unreadable,
            tokens,
        },
    }
}

struct Reader<'f, 'a> {
    file: &'f TokenFile<'a>,
    at: usize,
    end: usize,
}

impl Reader<'_, '_> {
    fn kind(&self) -> Option<Kind> {
        let inside = (self.at < self.end).then_some(self.at)?;
        self.file.tokens.get(inside).map(|token| token.kind)
    }

    fn takes(&mut self, symbol: u8) -> bool {
        let found = self.kind() == Some(Kind::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    fn arguments(&mut self, depth: usize) -> Vec<Argument> {
        let mut found = Vec::new();
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b')' | b';') => break,
                Kind::Symbol(b',') => self.at += 1,
                Kind::Symbol(b'\\') => {
                    self.at += 1;
                    let option = self.name();
                    let valued = self.kind() == Some(Kind::Assign)
                        || self.kind() == Some(Kind::Symbol(b'?'));
                    self.at += usize::from(valued);
                    let value = valued.then(|| self.expression(depth));
                    found.push(Argument { option, value });
                }
                _ => {
                    let start = self.at;
                    let value = Some(self.expression(depth));
                    found.push(Argument {
                        option: None,
                        value,
                    });
                    // A bracket that nothing opened.
                    if self.at == start {
                        self.at += 1;
                    }
                }
            }
        }
        found
    }

    fn name(&mut self) -> Option<Name> {
        let word = self.file.word(self.at);
        let is_word = self.kind() == Some(Kind::Word);
        self.at += usize::from(is_word);
        is_word.then(|| Name::of(word))?
    }

    /// Up to a comma, a backslash, a closing bracket or the end.
    fn expression(&mut self, depth: usize) -> Expression {
        let start = self.at;
        let found = (depth < DEEPEST)
            .then(|| self.operation(depth, 0))
            .flatten();
        let over = match self.kind() {
            None => true,
            Some(Kind::Symbol(symbol)) => b",\\)]};".contains(&symbol),
            Some(_) => false,
        };
        match found {
            Some(found) if over => found,
            _ => {
                self.skip();
                Expression {
                    node: Node::Unreadable,
                    tokens: start..self.at,
                }
            }
        }
    }

    /// Operands and the operators between them that bind at least so strongly.
    fn operation(&mut self, depth: usize, least: u8) -> Option<Expression> {
        if depth >= DEEPEST {
            return None;
        }
        let start = self.at;
        let mut left = match self.is_word("NOT") {
            true => {
                self.at += 1;
                let operand = self.operation(depth + 1, 1)?;
                self.over(start, Node::One(Operator::Not, Box::new(operand)))
            }
            false => self.signed(depth)?,
        };
        let mut count_of_operators = 0;
        while let Some((operator, strength, count)) = self.operator() {
            if strength < least {
                break;
            }
            count_of_operators += 1;
            if count_of_operators > MOST_OPERATORS {
                return None;
            }
            self.at += count;
            let right = self.operation(depth + 1, strength + 1)?;
            left = self.over(start, Node::Two(operator, Box::new([left, right])));
        }
        Some(left)
    }

    /// An expression from a token to here.
    fn over(&self, start: usize, node: Node) -> Expression {
        Expression {
            node,
            tokens: start..self.at,
        }
    }

    fn is_word(&self, capitals: &str) -> bool {
        let is_word = self.kind() == Some(Kind::Word);
        is_word && (self.file.word(self.at)).eq_ignore_ascii_case(capitals.as_bytes())
    }

    /// The operator that stands here, how strongly it binds, and its tokens.
    fn operator(&self) -> Option<(Operator, u8, usize)> {
        let is_next = |symbol| {
            let next = (self.at + 1 < self.end).then(|| self.file.tokens.get(self.at + 1));
            next.flatten()
                .is_some_and(|token| token.kind == Kind::Symbol(symbol))
        };
        Some(match self.kind()? {
            Kind::Word if self.is_word("OR") => (Operator::Or, 0, 1),
            Kind::Word if self.is_word("XOR") => (Operator::Xor, 0, 1),
            Kind::Word if self.is_word("AND") => (Operator::And, 1, 1),
            Kind::Word if self.is_word("DIV") => (Operator::WholeQuotient, 4, 1),
            Kind::Word if self.is_word("MOD") => (Operator::Remainder, 4, 1),
            Kind::Symbol(b'<') if is_next(b'>') => (Operator::Unequal, 2, 2),
            Kind::Symbol(b'<') if is_next(b'=') => (Operator::LessOrEqual, 2, 2),
            Kind::Symbol(b'>') if is_next(b'=') => (Operator::GreaterOrEqual, 2, 2),
            Kind::Symbol(b'<') => (Operator::Less, 2, 1),
            Kind::Symbol(b'>') => (Operator::Greater, 2, 1),
            Kind::Symbol(b'=') => (Operator::Equal, 2, 1),
            Kind::Symbol(b'+') => (Operator::Plus, 3, 1),
            Kind::Symbol(b'-') => (Operator::Minus, 3, 1),
            Kind::Symbol(b'*') => (Operator::Times, 4, 1),
            Kind::Symbol(b'/') => (Operator::Over, 4, 1),
            _ => return None,
        })
    }

    /// A primary with its sign; a sign before a number belongs to the number.
    fn signed(&mut self, depth: usize) -> Option<Expression> {
        let start = self.at;
        let Kind::Symbol(sign @ (b'-' | b'+')) = self.kind()? else {
            return self.primary(depth);
        };
        self.at += 1;
        if let Some(number) = self.number() {
            let value = match sign {
                b'-' => -number,
                _ => number,
            };
            return Some(self.over(start, Node::Number(value)));
        }
        let operator = match sign {
            b'-' => Operator::Minus,
            _ => Operator::Plus,
        };
        let operand = self.operation(depth + 1, 5)?;
        Some(self.over(start, Node::One(operator, Box::new(operand))))
    }

    /// To the end of what is computed.
    fn skip(&mut self) {
        let mut open = 0_usize;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'(' | b'[' | b'{') => open += 1,
                Kind::Symbol(b')' | b']' | b'}') if open == 0 => return,
                Kind::Symbol(b')' | b']' | b'}') => open -= 1,
                Kind::Symbol(b',' | b'\\') if open == 0 => return,
                Kind::Symbol(b';') => return,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// An operand with its indices and components.
    fn primary(&mut self, depth: usize) -> Option<Expression> {
        let start = self.at;
        let node = match self.kind()? {
            Kind::Number => Node::Number(self.number()?),
            Kind::Text => {
                self.at += 1;
                Node::Text
            }
            Kind::Symbol(b'[') => {
                self.at += 1;
                Node::List(self.list(depth, b']')?)
            }
            Kind::Symbol(b'(') => {
                self.at += 1;
                let inner = self.operation(depth + 1, 0)?;
                self.takes(b')').then_some(inner)?.node
            }
            Kind::Word => self.named(depth)?,
            _ => return None,
        };
        let mut found = self.over(start, node);
        loop {
            let node = if self.takes(b'{') {
                let indices = self.list(depth, b'}')?;
                Node::Element(Box::new(found), indices)
            } else if self.takes(b'.') {
                Node::Field(Box::new(found), self.name()?)
            } else {
                return Some(found);
            };
            found = self.over(start, node);
        }
    }

    fn number(&mut self) -> Option<f64> {
        let is_number = self.kind() == Some(Kind::Number);
        let text = self.file.word(self.at);
        self.at += usize::from(is_number);
        let value: f64 = is_number.then(|| std::str::from_utf8(text).ok()?.parse().ok())??;
        value.is_finite().then_some(value)
    }

    fn list(&mut self, depth: usize, closing: u8) -> Option<Vec<Expression>> {
        let mut list = Vec::new();
        loop {
            if self.takes(closing) {
                return Some(list);
            }
            if !list.is_empty() && !self.takes(b',') {
                return None;
            }
            let start = self.at;
            list.push(self.expression(depth + 1));
            if self.at == start {
                return None;
            }
        }
    }

    fn named(&mut self, depth: usize) -> Option<Node> {
        let name = self.name()?;
        if name.is("TRUE") || name.is("FALSE") {
            return Some(Node::Truth(name.is("TRUE")));
        }
        if self.takes(b'(') {
            let arguments = self.arguments(depth + 1);
            return self.takes(b')').then_some(Node::Call(name, arguments));
        }
        Some(Node::Word(name))
    }
}
