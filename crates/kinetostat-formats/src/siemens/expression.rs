//! Expressions of the control: parsed once, evaluated as often as needed.
//!
//! Order of operations, the strongest first: NOT; `*` `/` DIV MOD; `+` `-`; B_AND; B_XOR; B_OR; AND; XOR; OR; `<<`; comparisons.
//! Comparisons bind least, so those that are joined stand in parentheses. Angles are in degrees.

use std::ops::Range;

use crate::interpreter::expression::Operator;
use crate::siemens::tokens::{Broken, Kind, Sign, Token};

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    Number(f64),
    /// Between quotes.
    Text(Range<usize>),
    /// A variable or an R parameter, with its indices.
    Variable {
        name: Range<usize>,
        indices: Vec<Expression>,
    },
    Negative(Box<Expression>),
    Not(Box<Expression>),
    Binary(Operator, Box<(Expression, Expression)>),
    Call {
        name: Range<usize>,
        arguments: Vec<Expression>,
    },
}

/// The level of comparisons: they bind least.
const COMPARES: u8 = 0;

/// Limit of the parts of an expression; it bounds the depth of the stack.
const MOST_PARTS: usize = 200;

/// Tokens of a block that are taken one after the other.
#[derive(Debug)]
pub(crate) struct Cursor<'t> {
    pub bytes: &'t [u8],
    pub tokens: &'t [Token],
    pub at: usize,
    /// Parts of the expression that is parsed.
    parts: usize,
}

impl<'t> Cursor<'t> {
    pub(crate) fn new(bytes: &'t [u8], tokens: &'t [Token]) -> Self {
        Self {
            bytes,
            tokens,
            at: 0,
            parts: 0,
        }
    }

    pub(crate) fn peek(&self) -> Option<&'t Token> {
        self.tokens.get(self.at)
    }

    pub(crate) fn peek_second(&self) -> Option<&'t Token> {
        self.tokens.get(self.at + 1)
    }

    pub(crate) fn next(&mut self) -> Option<&'t Token> {
        let token = self.tokens.get(self.at)?;
        self.at += 1;
        Some(token)
    }

    /// Takes a sign of one byte if it is next.
    pub(crate) fn takes(&mut self, byte: u8) -> bool {
        let is = self.peek().is_some_and(|token| token.is(byte));
        self.at += usize::from(is);
        is
    }

    pub(crate) fn text(&self, span: &Range<usize>) -> &'t [u8] {
        self.bytes.get(span.clone()).unwrap_or_default()
    }

    /// True if the next token is this name (in capitals).
    pub(crate) fn is_next(&self, name: &str) -> bool {
        self.peek().is_some_and(|token| {
            token.kind == Kind::Name && self.text(&token.span).eq_ignore_ascii_case(name.as_bytes())
        })
    }

    /// Bytes of what is next, or of the end of the last token.
    pub(crate) fn place(&self) -> Range<usize> {
        let last = self.tokens.last().map_or(0..0, |last| last.span.clone());
        self.peek().map_or(last, |token| token.span.clone())
    }

    pub(crate) fn broken(&self, reason: &'static str) -> Broken {
        Broken {
            span: self.place(),
            reason,
            remedy: "mend the expression",
        }
    }

    /// The expression that is next.
    ///
    /// # Errors
    /// Where it is none.
    pub(crate) fn expression(&mut self) -> Result<Expression, Broken> {
        self.parts = 0;
        self.level(COMPARES)
    }

    /// The operator that is next, and how tightly it binds.
    fn operator(&self) -> Option<(Operator, u8)> {
        let token = self.peek()?;
        Some(match token.kind {
            Kind::Sign(Sign::Equal) => (Operator::Equal, COMPARES),
            Kind::Sign(Sign::NotEqual) => (Operator::Unequal, COMPARES),
            Kind::Sign(Sign::LessOrEqual) => (Operator::LessOrEqual, COMPARES),
            Kind::Sign(Sign::GreaterOrEqual) => (Operator::GreaterOrEqual, COMPARES),
            Kind::Sign(Sign::Joined) => (Operator::Join, 1),
            Kind::Sign(Sign::Byte(byte)) => match byte {
                b'<' => (Operator::Less, COMPARES),
                b'>' => (Operator::Greater, COMPARES),
                b'+' => (Operator::Plus, 8),
                b'-' => (Operator::Minus, 8),
                b'*' => (Operator::Times, 9),
                b'/' => (Operator::Over, 9),
                _ => return None,
            },
            Kind::Name => match self.text(&token.span).to_ascii_uppercase().as_slice() {
                b"OR" => (Operator::Or, 2),
                b"XOR" => (Operator::Xor, 3),
                b"AND" => (Operator::And, 4),
                b"B_OR" => (Operator::BitOr, 5),
                b"B_XOR" => (Operator::BitXor, 6),
                b"B_AND" => (Operator::BitAnd, 7),
                b"DIV" => (Operator::WholeQuotient, 9),
                b"MOD" => (Operator::Remainder, 9),
                _ => return None,
            },
            _ => return None,
        })
    }

    /// Operators that bind at least so tightly, with their operands.
    fn level(&mut self, least: u8) -> Result<Expression, Broken> {
        let mut left = self.operand()?;
        let mut compared = false;
        while let Some((operator, level)) = self.operator().filter(|(_, level)| *level >= least) {
            if level == COMPARES && std::mem::replace(&mut compared, true) {
                return Err(Broken {
                    span: self.place(),
                    reason: "comparisons bind less than AND and OR",
                    remedy: "put each comparison in parentheses: (R1==1) AND (R2>0)",
                });
            }
            self.part()?;
            self.at += 1;
            let right = self.level(level + 1)?;
            left = Expression::Binary(operator, Box::new((left, right)));
        }
        Ok(left)
    }

    fn part(&mut self) -> Result<(), Broken> {
        self.parts += 1;
        match self.parts > MOST_PARTS {
            true => Err(Broken {
                span: self.place(),
                reason: "the expression has more than 200 parts",
                remedy: "divide it",
            }),
            false => Ok(()),
        }
    }

    fn operand(&mut self) -> Result<Expression, Broken> {
        self.part()?;
        let nothing = self.broken("a value is missing");
        let token = self.next().ok_or(nothing.clone())?;
        match token.kind {
            Kind::Number(value) => Ok(Expression::Number(value)),
            Kind::Text => Ok(Expression::Text(token.span.clone())),
            Kind::Sign(Sign::Byte(b'-')) => Ok(Expression::Negative(Box::new(self.operand()?))),
            Kind::Sign(Sign::Byte(b'+')) => self.operand(),
            Kind::Sign(Sign::Byte(b'(')) => {
                let inner = self.level(COMPARES)?;
                match self.takes(b')') {
                    true => Ok(inner),
                    false => Err(self.broken("a parenthesis is not closed")),
                }
            }
            Kind::Name => self.named(token),
            Kind::Sign(_) => {
                self.at -= 1;
                Err(nothing)
            }
        }
    }

    fn named(&mut self, token: &Token) -> Result<Expression, Broken> {
        let name = token.span.clone();
        let text = self.text(&name);
        if text.eq_ignore_ascii_case(b"NOT") || text.eq_ignore_ascii_case(b"B_NOT") {
            let inner = Box::new(self.operand()?);
            return match text.len() == 3 {
                true => Ok(Expression::Not(inner)),
                false => Ok(Expression::Call {
                    name,
                    arguments: vec![*inner],
                }),
            };
        }
        if self.takes(b'(') {
            let arguments = self.list(b')')?;
            return Ok(Expression::Call { name, arguments });
        }
        let indices = match self.takes(b'[') {
            true => self.list(b']')?,
            false => Vec::new(),
        };
        Ok(Expression::Variable { name, indices })
    }

    /// Expressions between commas up to a closing sign, which is taken.
    pub(crate) fn list(&mut self, closes: u8) -> Result<Vec<Expression>, Broken> {
        let mut found = Vec::new();
        if self.takes(closes) {
            return Ok(found);
        }
        loop {
            self.part()?;
            found.push(self.level(COMPARES)?);
            if self.takes(closes) {
                return Ok(found);
            }
            if !self.takes(b',') {
                return Err(self.broken("a comma or a closing sign is missing"));
            }
        }
    }
}
