//! Variables and what expressions are worth.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::interpreter::expression::Operator;
use crate::interpreter::operation::function;
use crate::model::stated_value::StatedValue;
use crate::options::ReadOptions;
use crate::siemens::expression::Expression;

/// Value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    /// REAL, INT and BOOL.
    Number(f64),
    Text(Vec<u8>),
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    Real,
    /// Assigned values are rounded.
    Int,
    Bool,
    Text,
}

/// A declared variable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Variable {
    pub kind: Type,
    /// Dimensions of an array; empty for a single value.
    pub sizes: Vec<usize>,
    /// Empty for one that was declared with a value that is not known.
    pub values: Vec<Value>,
}

/// Limit of the values of all variables: the arrays of a program have some hundreds.
pub(crate) const MOST_VALUES: usize = 100_000;

impl Variable {
    /// Variable filled with zeros; `None` if it is too large.
    pub(crate) fn new(kind: Type, sizes: Vec<usize>) -> Option<Self> {
        let count = sizes.iter().try_fold(1_usize, |all, size| {
            let all = all.checked_mul(*size)?;
            (all <= MOST_VALUES).then_some(all)
        })?;
        let mut made = Self::zero(kind);
        made.sizes = sizes;
        let value = made.values.first()?.clone();
        made.values.resize(count, value);
        Some(made)
    }

    /// One value: zero, or an empty text.
    pub(crate) fn zero(kind: Type) -> Self {
        let value = match kind {
            Type::Text => Value::Text(Vec::new()),
            _ => Value::Number(0.0),
        };
        Self {
            kind,
            sizes: Vec::new(),
            values: vec![value],
        }
    }

    /// A value as the variable holds it.
    ///
    /// # Errors
    /// It is of another type.
    pub(crate) fn taken(&self, value: Value) -> Result<Value, Why> {
        Ok(match (self.kind, value) {
            (Type::Real, Value::Number(value)) => Value::Number(value),
            (Type::Int, Value::Number(value)) => Value::Number((value + 0.5).floor()),
            (Type::Bool, Value::Number(value)) => truth(value != 0.0),
            (Type::Text, Value::Text(text)) => Value::Text(text),
            _ => return Err("its value is of another type".to_owned()),
        })
    }

    fn place(&self, indices: &[f64]) -> Option<usize> {
        if indices.len() != self.sizes.len() {
            return None;
        }
        let mut place = 0;
        for (index, size) in indices.iter().zip(&self.sizes) {
            let whole = index.round();
            if !(whole >= 0.0 && whole < *size as f64) {
                return None;
            }
            place = place * size + whole as usize;
        }
        Some(place)
    }
}

/// The R parameters, which every program sees, and the variables of one program.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Variables {
    pub parameters: BTreeMap<u32, f64>,
    /// Local variables by name in capitals.
    pub own: BTreeMap<Vec<u8>, Variable>,
    /// Variables of the machine and of the control, of which the caller states the value.
    pub stated: BTreeMap<Vec<u8>, Value>,
}

/// Reason why an expression has no value.
pub(crate) type Why = String;

fn shown(name: &[u8]) -> String {
    String::from_utf8_lossy(name).into_owned()
}

/// The number of an R parameter by its name: `R12`.
pub(crate) fn parameter(name: &[u8]) -> Option<u32> {
    let (first, digits) = name.split_first()?;
    let digits = std::str::from_utf8(digits).ok()?;
    match first.eq_ignore_ascii_case(&b'R') && !digits.is_empty() {
        true => digits.parse().ok(),
        false => None,
    }
}

/// Number of an R parameter from its name or its index: `R[12]`.
fn stated_parameter(name: &[u8], indices: &[f64]) -> Option<u32> {
    match (parameter(name), indices) {
        (Some(number), []) => Some(number),
        (None, [index]) if name.eq_ignore_ascii_case(b"R") => whole(*index),
        _ => None,
    }
}

/// Longest text that is ever joined, bytes.
const LONGEST_TEXT: usize = 1000;

impl Variables {
    /// Variables with the values that the caller states.
    pub(crate) fn of(options: &ReadOptions) -> Self {
        let mut variables = Self::default();
        for (name, value) in &options.values {
            let name = name.to_ascii_uppercase().into_bytes();
            match (parameter(&name), value) {
                (Some(number), StatedValue::Number(value)) => {
                    variables.parameters.insert(number, *value);
                }
                (_, value) => {
                    let value = match value {
                        StatedValue::Number(value) => Value::Number(*value),
                        StatedValue::Truth(value) => truth(*value),
                        StatedValue::Text(text) => Value::Text(text.clone().into_bytes()),
                    };
                    variables.stated.insert(name, value);
                }
            }
        }
        variables
    }

    /// Evaluates an expression.
    ///
    /// # Errors
    /// Reason why its value is unknown.
    pub(crate) fn value(&self, bytes: &[u8], expression: &Expression) -> Result<Value, Why> {
        let text = |span: &Range<usize>| bytes.get(span.clone()).unwrap_or_default();
        Ok(match expression {
            Expression::Number(value) => Value::Number(*value),
            Expression::Text(span) => {
                let all = text(span);
                let inner = all.get(1..all.len().saturating_sub(1)).unwrap_or_default();
                Value::Text(inner.to_vec())
            }
            Expression::Variable { name, indices } => {
                let indices: Result<Vec<f64>, Why> = indices
                    .iter()
                    .map(|index| self.number(bytes, index))
                    .collect();
                self.variable(text(name), &indices?)?
            }
            Expression::Negative(inner) => Value::Number(-self.number(bytes, inner)?),
            Expression::Not(inner) => truth(self.number(bytes, inner)? == 0.0),
            Expression::Binary(operation, sides) => {
                let left = self.value(bytes, &sides.0)?;
                let right = self.value(bytes, &sides.1)?;
                binary(*operation, left, right)?
            }
            Expression::Call { name, arguments } => {
                let numbers: Result<Vec<f64>, Why> = arguments
                    .iter()
                    .map(|argument| self.number(bytes, argument))
                    .collect();
                Value::Number(computed(text(name), &numbers?)?)
            }
        })
    }

    /// The number that an expression is worth.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn number(&self, bytes: &[u8], expression: &Expression) -> Result<f64, Why> {
        match self.value(bytes, expression)? {
            Value::Number(value) if value.is_finite() => Ok(value),
            Value::Number(_) => Err("its value is no number".to_owned()),
            Value::Text(_) => Err("a text stands where a number is needed".to_owned()),
        }
    }

    fn variable(&self, name: &[u8], indices: &[f64]) -> Result<Value, Why> {
        let unknown = || format!("`{}` has no value that this program gives it", shown(name));
        if let Some(number) = stated_parameter(name, indices) {
            let value = self.parameters.get(&number).ok_or_else(unknown)?;
            return Ok(Value::Number(*value));
        }
        match name.to_ascii_uppercase().as_slice() {
            b"TRUE" => Ok(truth(true)),
            b"FALSE" => Ok(truth(false)),
            b"$PI" => Ok(Value::Number(std::f64::consts::PI)),
            capitals => {
                let stated = (self.stated.get(capitals))
                    .filter(|_| indices.is_empty() && !self.own.contains_key(capitals));
                if let Some(value) = stated {
                    return Ok(value.clone());
                }
                if capitals.starts_with(b"$") {
                    return Err(format!(
                        "`{}` is known at the machine alone",
                        shown(capitals)
                    ));
                }
                let found = self.own.get(capitals).ok_or_else(unknown)?;
                let place = found.place(indices);
                let place = place.ok_or_else(|| "its index is outside the array".to_owned())?;
                found.values.get(place).cloned().ok_or_else(unknown)
            }
        }
    }

    /// Gives a variable or an R parameter a value.
    ///
    /// # Errors
    /// Why it cannot have it.
    pub(crate) fn set(&mut self, name: &[u8], indices: &[f64], value: Value) -> Result<(), Why> {
        if let Some(number) = stated_parameter(name, indices) {
            let Value::Number(value) = value else {
                return Err("an R parameter takes a number".to_owned());
            };
            if self.parameters.len() >= MOST_VALUES {
                return Err("it has too many R parameters".to_owned());
            }
            self.parameters.insert(number, value);
            return Ok(());
        }
        let capitals = name.to_ascii_uppercase();
        if let (Some(stated), true) = (self.stated.get_mut(&capitals), indices.is_empty())
            && !self.own.contains_key(&capitals)
        {
            *stated = value;
            return Ok(());
        }
        let Some(variable) = self.own.get_mut(&capitals) else {
            return Err(format!("`{}` is not declared", shown(name)));
        };
        let value = variable.taken(value)?;
        let place = variable.place(indices);
        let place = place.ok_or_else(|| "its index is outside the array".to_owned())?;
        match variable.values.get_mut(place) {
            Some(held) => *held = value,
            None => variable.values = vec![value],
        }
        Ok(())
    }

    /// True if a name is that of a variable or an R parameter.
    pub(crate) fn knows(&self, name: &[u8]) -> bool {
        parameter(name).is_some()
            || name.eq_ignore_ascii_case(b"R")
            || self.own.contains_key(&name.to_ascii_uppercase())
            || self.stated.contains_key(&name.to_ascii_uppercase())
    }
}

fn truth(value: bool) -> Value {
    Value::Number(f64::from(u8::from(value)))
}

/// A whole number without sign.
pub(crate) fn whole(value: f64) -> Option<u32> {
    let rounded = value.round();
    let is = (rounded - value).abs() < 1e-9 && (0.0..1e9).contains(&rounded);
    is.then_some(rounded as u32)
}

/// Comparisons of the control count as equal what differs by less, relative.
const SAME: f64 = 1e-12;

fn binary(operation: Operator, left: Value, right: Value) -> Result<Value, Why> {
    use Operator as O;
    let (a, b) = match (left, right) {
        (Value::Number(a), Value::Number(b)) if operation != O::Join => (a, b),
        (Value::Text(a), Value::Text(b)) if operation == O::Equal => return Ok(truth(a == b)),
        (Value::Text(a), Value::Text(b)) if operation == O::Unequal => return Ok(truth(a != b)),
        (a, b) if operation == O::Join => {
            let text = |value| match value {
                Value::Number(number) => format!("{number}").into_bytes(),
                Value::Text(text) => text,
            };
            let mut joined = text(a);
            joined.extend(text(b));
            joined.truncate(LONGEST_TEXT);
            return Ok(Value::Text(joined));
        }
        _ => return Err("a text stands where a number is needed".to_owned()),
    };
    let near = (a - b).abs() <= SAME * a.abs().max(b.abs());
    let bits = |operation: fn(i64, i64) -> i64| operation(a as i64, b as i64) as f64;
    let zero = || Err("it is divided by zero".to_owned());
    Ok(match operation {
        O::Plus => Value::Number(a + b),
        O::Minus => Value::Number(a - b),
        O::Times => Value::Number(a * b),
        O::Over | O::WholeQuotient | O::Remainder if b == 0.0 => return zero(),
        O::Over => Value::Number(a / b),
        O::WholeQuotient => Value::Number((a / b).trunc()),
        O::Remainder => Value::Number(a % b),
        O::BitAnd => Value::Number(bits(|a, b| a & b)),
        O::BitOr => Value::Number(bits(|a, b| a | b)),
        O::BitXor => Value::Number(bits(|a, b| a ^ b)),
        O::And => truth(a != 0.0 && b != 0.0),
        O::Or => truth(a != 0.0 || b != 0.0),
        O::Xor => truth((a != 0.0) != (b != 0.0)),
        O::Equal => truth(near),
        O::Unequal => truth(!near),
        O::Less => truth(a < b && !near),
        O::LessOrEqual => truth(a < b || near),
        O::Greater => truth(a > b && !near),
        O::GreaterOrEqual => truth(a > b || near),
        O::Join | O::Not | O::Behind => return Err("texts are not joined here".to_owned()),
    })
}

fn computed(name: &[u8], arguments: &[f64]) -> Result<f64, Why> {
    let capitals = name.to_ascii_uppercase();
    let value = match (capitals.as_slice(), arguments) {
        (b"ATAN2", [y, x]) => y.atan2(*x).to_degrees(),
        (b"POT", [x]) => x * x,
        (b"TRUNC", [x]) => x.trunc(),
        (b"ROUND", [x]) => (x + 0.5).floor(),
        (b"ROUNDUP", [x]) => x.ceil(),
        (b"MINVAL", [x, y]) if x < y => *x,
        (b"MINVAL", [_, y]) => *y,
        (b"MAXVAL", [x, y]) if x > y => *x,
        (b"MAXVAL", [_, y]) => *y,
        (b"B_NOT", [x]) => !(*x as i64) as f64,
        (capitals, arguments) => {
            let of_one = std::str::from_utf8(capitals).ok().and_then(function);
            let (Some(of_one), [x]) = (of_one, arguments) else {
                let unknown = format!("what `{}` is worth, is not known here", shown(name));
                return Err(unknown);
            };
            of_one(*x)
        }
    };
    match value.is_finite() {
        true => Ok(value),
        false => Err(format!("`{}` has no value there", shown(name))),
    }
}
