//! Expressions as far as they are followed: literals, names, elements of arrays, calls of functions.

use std::ops::Range;

use crate::rapid::lex::Kind;
use crate::rapid::tree::TokenFile;
use crate::text::name::Name;

/// Deepest nesting of lists, calls and indices.
const DEEPEST: usize = 32;

/// What an expression is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Truth(bool),
    Text,
    /// A name without index or component.
    Word(Name),
    /// A name with an index: `p{2}`, `p{2,3}`.
    Element(Name, Vec<Expression>),
    List(Vec<Expression>),
    Call(Name, Vec<Argument>),
    /// Anything that is computed.
    Other,
}

/// An expression and its tokens.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expression {
    pub value: Value,
    pub tokens: Range<usize>,
}

/// An argument of a call: `value`, `\Option` or `\Option:=value`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Argument {
    pub option: Option<Name>,
    pub value: Option<Expression>,
}

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
            value: Value::Other,
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
        let found = (depth < DEEPEST).then(|| self.primary(depth)).flatten();
        let over = match self.kind() {
            None => true,
            Some(Kind::Symbol(symbol)) => b",\\)]};".contains(&symbol),
            Some(_) => false,
        };
        let value = match found {
            Some(value) if over => value,
            _ => {
                self.skip();
                Value::Other
            }
        };
        Expression {
            value,
            tokens: start..self.at,
        }
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

    fn primary(&mut self, depth: usize) -> Option<Value> {
        match self.kind()? {
            Kind::Symbol(sign @ (b'-' | b'+')) => {
                self.at += 1;
                let number = self.number()?;
                Some(Value::Number(match sign {
                    b'-' => -number,
                    _ => number,
                }))
            }
            Kind::Number => self.number().map(Value::Number),
            Kind::Text => {
                self.at += 1;
                Some(Value::Text)
            }
            Kind::Symbol(b'[') => {
                self.at += 1;
                let list = self.list(depth, b']')?;
                Some(Value::List(list))
            }
            Kind::Word => self.named(depth),
            _ => None,
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

    fn named(&mut self, depth: usize) -> Option<Value> {
        let name = self.name()?;
        if name.is("TRUE") || name.is("FALSE") {
            return Some(Value::Truth(name.is("TRUE")));
        }
        if self.takes(b'{') {
            let indices = self.list(depth, b'}')?;
            return Some(Value::Element(name, indices));
        }
        if self.takes(b'(') {
            let arguments = self.arguments(depth + 1);
            return self.takes(b')').then_some(Value::Call(name, arguments));
        }
        Some(Value::Word(name))
    }
}
