//! Values of expressions.

use crate::interpreter::expression::{Argument, Expression, Node, Operator};
use crate::interpreter::operation::{one, two};
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Literal, Step, Value};
use crate::text::Name;

/// Values of names, results of functions, and names of components.
pub(crate) trait Names {
    /// The way to a component of a value.
    fn component(&self, of: &Datum, name: &Name) -> Option<Step>;

    /// The way to an element of a value.
    fn element(&self, _of: &Datum, index: &Datum) -> Option<Step> {
        index_of(index, 1).map(Step::Index)
    }

    /// The result of an operator with two operands.
    fn operation(&self, operator: Operator, left: &Datum, right: &Datum) -> Datum {
        two(operator, left, right)
    }

    /// True for operands of which the quotient is a whole number.
    fn divides_whole(&self, _operands: &[Expression; 2]) -> bool {
        false
    }

    /// The value that the caller states for an element of an array, with its indices.
    fn stated(&mut self, _element: &Expression, _at: &[Datum]) -> Option<Datum> {
        None
    }

    /// Notes that the value of a name, or an element of it, is used.
    fn uses(&mut self, _name: &Name, _element: Option<Step>) {}

    /// The value of a name.
    fn word(&mut self, name: &Name, whole: &Expression) -> Datum;

    /// The result of a function.
    fn call(&mut self, name: &Name, arguments: &[Argument], whole: &Expression) -> Datum;
}

/// Declarations that are read without a run: no name has a value.
pub(crate) struct LiteralsOnly;

impl Names for LiteralsOnly {
    fn component(&self, _: &Datum, _: &Name) -> Option<Step> {
        None
    }

    fn word(&mut self, _: &Name, _: &Expression) -> Datum {
        Datum::unknown("it is a name")
    }

    fn call(&mut self, _: &Name, _: &[Argument], _: &Expression) -> Datum {
        Datum::unknown("it is computed")
    }
}

/// The value of an expression of a file.
pub(crate) fn evaluate(
    file: &TokenFile<'_>,
    expression: &Expression,
    names: &mut dyn Names,
) -> Datum {
    let literal = |value: Value| Datum {
        value,
        literal: Some(Literal::new(file.index, &file.span(&expression.tokens))),
    };
    let shown = |of: &Expression| {
        String::from_utf8_lossy(file.source.part(&file.span(&of.tokens))).into_owned()
    };
    match &expression.node {
        Node::Number(value) => literal(Value::Number(*value)),
        Node::Truth(value) => literal(Value::Truth(*value)),
        Node::Text => {
            let text = file.word(expression.tokens.start);
            let text = String::from_utf8_lossy(text);
            literal(Value::Text(text.trim_matches('"').into()))
        }
        Node::List(parts) => {
            let parts = parts.iter().map(|part| evaluate(file, part, names));
            literal(Value::List(parts.collect::<Vec<_>>().into()))
        }
        Node::Word(name) => {
            names.uses(name, None);
            names.word(name, expression)
        }
        Node::Call(name, arguments) => names.call(name, arguments, expression),
        Node::Choice(name) => {
            let text = format!("#{}", String::from_utf8_lossy(name.letters()));
            literal(Value::Text(text.into()))
        }
        Node::Members(members) => {
            let members = members.iter();
            let all = members.map(|(name, part)| (*name, evaluate(file, part, names)));
            literal(Value::Members(all.collect::<Vec<_>>().into()))
        }
        Node::Field(inner, name) => {
            let of = evaluate(file, inner, names);
            let step = names.component(&of, name);
            let part = step.and_then(|step| of.part(&[step]).cloned());
            part.unwrap_or_else(|| {
                not_a_part(&of, || format!("`{}` has no such component", shown(inner)))
            })
        }
        Node::Element(inner, indices) => {
            let at: Vec<Datum> = indices
                .iter()
                .map(|index| evaluate(file, index, names))
                .collect();
            if let Some(stated) = names.stated(expression, &at) {
                return stated;
            }
            let of = match &inner.node {
                Node::Word(name) => {
                    // An element with an unknown index marks no names as used.
                    let none = Datum::list(Vec::new());
                    let element = at.first().and_then(|index| names.element(&none, index));
                    if element.is_some() {
                        names.uses(name, element);
                    }
                    names.word(name, inner)
                }
                _ => evaluate(file, inner, names),
            };
            if let Some(reason) = at.iter().find_map(Datum::unknown_reason) {
                return Datum::unknown(reason.clone());
            }
            let path = at.iter().map(|index| names.element(&of, index));
            let path: Option<Vec<Step>> = path.collect();
            let part = path.and_then(|path| of.part(&path).cloned());
            part.unwrap_or_else(|| {
                not_a_part(&of, || format!("`{}` has no such element", shown(inner)))
            })
        }
        Node::One(operator, operand) => one(*operator, &evaluate(file, operand, names)),
        Node::Two(operator, operands) => {
            let [left, right] = &**operands;
            let operator = match operator {
                Operator::Over if names.divides_whole(operands) => &Operator::WholeQuotient,
                operator => operator,
            };
            let left = evaluate(file, left, names);
            let right = evaluate(file, right, names);
            names.operation(*operator, &left, &right)
        }
        Node::Unreadable => Datum::unknown("it is no expression that is understood here"),
    }
}

/// An index from 0 for one from another.
pub(crate) fn index_of(datum: &Datum, first: usize) -> Option<usize> {
    let value = datum.as_number()?;
    let is_index = (0.0..1e7).contains(&value) && value.fract() == 0.0;
    (value as usize).checked_sub(first).filter(|_| is_index)
}

fn not_a_part(of: &Datum, reason: impl FnOnce() -> String) -> Datum {
    match &of.value {
        Value::Unknown(reason) => Datum::unknown(reason.clone()),
        _ => Datum::unknown(reason()),
    }
}
