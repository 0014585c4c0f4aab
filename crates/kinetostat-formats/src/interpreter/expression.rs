//! Expressions as trees, for all languages.

use std::ops::Range;

use crate::text::Name;

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
    /// Arguments of a function, if the expression is its call with no others than these parameters, in their order; names in capitals.
    pub(crate) fn given_to(&self, name: &str, parameters: &[&str]) -> Option<Vec<&Self>> {
        let Node::Call(own, arguments) = &self.node else {
            return None;
        };
        if !own.is(name) || arguments.len() > parameters.len() {
            return None;
        }
        let given = arguments.iter().zip(parameters);
        let given = given.map(|(own, parameter)| {
            let is_it = own.option.is_none_or(|name| name.is(parameter));
            own.value.as_ref().filter(|_| is_it)
        });
        given.collect()
    }
}

/// An argument of a call: `value`, `\Option` or `\Option:=value`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Argument {
    pub option: Option<Name>,
    pub value: Option<Expression>,
}
