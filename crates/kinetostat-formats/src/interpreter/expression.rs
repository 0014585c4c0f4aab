//! Expressions as trees, for all languages.

use std::ops::Range;

use crate::text::name::Name;

/// Operators with one or two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Or,
    Xor,
    And,
    Not,
    Equal,
    Unequal,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Plus,
    Minus,
    Times,
    Over,
    WholeQuotient,
    Remainder,
    BitAnd,
    BitXor,
    BitOr,
    /// Concatenation of texts.
    Join,
    /// A frame in the axes of another (`:` of KRL).
    Behind,
}

impl Operator {
    /// True for those that compare two values.
    pub(crate) fn compares(self) -> bool {
        use Operator::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, Unequal};
        matches!(
            self,
            Equal | Unequal | Less | LessOrEqual | Greater | GreaterOrEqual
        )
    }
}

/// One node of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Node {
    Number(f64),
    Truth(bool),
    Text,
    /// A word of an enumeration: `#BASE`.
    Choice(Name),
    Word(Name),
    /// `p{2}`, `p{2,3}`.
    Element(Box<Expression>, Vec<Expression>),
    /// `p.trans`.
    Field(Box<Expression>, Name),
    List(Vec<Expression>),
    /// `{X 10,Y 20}`.
    Members(Vec<(Name, Expression)>),
    Call(Name, Vec<Argument>),
    One(Operator, Box<Expression>),
    Two(Operator, Box<[Expression; 2]>),
    /// Text that the language does not have as an expression.
    Unreadable,
}

/// An expression and its tokens.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expression {
    pub node: Node,
    pub tokens: Range<usize>,
}

impl Expression {
    /// Arguments of a function with a name in capitals, if the expression is its call.
    pub(crate) fn given_to(&self, name: &str) -> Option<Vec<&Self>> {
        match &self.node {
            Node::Call(own, arguments) if own.is(name) => {
                let values = arguments.iter().filter_map(|own| own.value.as_ref());
                Some(values.collect())
            }
            _ => None,
        }
    }
}

/// An argument of a call: `value`, `\Option` or `\Option:=value`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Argument {
    pub option: Option<Name>,
    pub value: Option<Expression>,
}
