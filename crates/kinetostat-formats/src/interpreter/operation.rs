//! Operators on values, and functions of one number that have one name and one meaning in all languages; angles are in degrees.

use nalgebra::{Quaternion, Vector3};

use crate::interpreter::expression::Operator;
use crate::interpreter::value::{Datum, Value};

/// The result of an operator with one operand.
pub(crate) fn one(operator: Operator, operand: &Datum) -> Datum {
    match (operator, &operand.value) {
        (Operator::Not, Value::Truth(value)) => Datum::truth(!value),
        (Operator::Plus, Value::Number(_) | Value::List(_)) => Datum::of(operand.value.clone()),
        (Operator::Minus, Value::Number(value)) => Datum::number(-value),
        (Operator::Minus, Value::List(_)) => match operand.as_numbers::<3>() {
            Some(own) => Datum::numbers(own.map(|part| -part)),
            None => not_computed(&[operand]),
        },
        _ => not_computed(&[operand]),
    }
}

/// The result of an operator with two operands. A truth that one operand decides is known although the other is not.
pub(crate) fn two(operator: Operator, left: &Datum, right: &Datum) -> Datum {
    use Operator::{And, Equal, Or, Unequal, Xor};
    match (operator, left.as_truth(), right.as_truth()) {
        (And, Some(false), _) | (And, _, Some(false)) => return Datum::truth(false),
        (Or, Some(true), _) | (Or, _, Some(true)) => return Datum::truth(true),
        (And, Some(left), Some(right)) => return Datum::truth(left && right),
        (Or, Some(left), Some(right)) => return Datum::truth(left || right),
        (Xor, Some(left), Some(right)) => return Datum::truth(left != right),
        _ => {}
    }
    if left.unknown_reason().is_some() || right.unknown_reason().is_some() {
        return not_computed(&[left, right]);
    }
    match (operator, &left.value, &right.value) {
        (Equal | Unequal, left_value, right_value)
            if std::mem::discriminant(left_value) != std::mem::discriminant(right_value) =>
        {
            not_computed(&[left, right])
        }
        (Equal, left, right) => Datum::truth(same(left, right)),
        (Unequal, left, right) => Datum::truth(!same(left, right)),
        (_, Value::Number(left), Value::Number(right)) => of_numbers(operator, *left, *right),
        (_, Value::List(_), _) | (_, _, Value::List(_)) => {
            of_lists(operator, left, right).unwrap_or_else(|| not_computed(&[left, right]))
        }
        _ => not_computed(&[left, right]),
    }
}

/// True if two values are equal, whatever literals state them.
pub(crate) fn same(left: &Value, right: &Value) -> bool {
    match (left, right) {
        (Value::List(left), Value::List(right)) => {
            let mut pairs = left.iter().zip(right.iter());
            left.len() == right.len() && pairs.all(|(left, right)| same(&left.value, &right.value))
        }
        (Value::Members(left), Value::Members(right)) => {
            left.len() == right.len()
                && (left.iter().zip(right.iter()))
                    .all(|(left, right)| left.0 == right.0 && same(&left.1.value, &right.1.value))
        }
        // Numbers of robots have single precision.
        (Value::Number(left), Value::Number(right))
            if left.abs() < EXACT && right.abs() < EXACT =>
        {
            *left as f32 == *right as f32
        }
        (left, right) => left == right,
    }
}

/// Whole numbers below this are exact in single precision.
const EXACT: f64 = 8_388_608.0;

fn of_numbers(operator: Operator, left: f64, right: f64) -> Datum {
    let number = match operator {
        Operator::Less => return Datum::truth(left < right),
        Operator::LessOrEqual => return Datum::truth(left <= right),
        Operator::Greater => return Datum::truth(left > right),
        Operator::GreaterOrEqual => return Datum::truth(left >= right),
        Operator::Plus => left + right,
        Operator::Minus => left - right,
        Operator::Times => left * right,
        Operator::Over => left / right,
        Operator::WholeQuotient => (left / right).trunc(),
        Operator::Remainder => left % right,
        _ => f64::NAN,
    };
    match number.is_finite() {
        true => Datum::number(number),
        false => Datum::unknown("it divides by zero, or is larger than a number can be"),
    }
}

/// Sums, differences and products of places, and products of quaternions.
fn of_lists(operator: Operator, left: &Datum, right: &Datum) -> Option<Datum> {
    if let (Operator::Times, Some([w, i, j, k]), Some(by)) =
        (operator, left.as_numbers::<4>(), right.as_numbers::<4>())
    {
        let product = Quaternion::new(w, i, j, k) * Quaternion::new(by[0], by[1], by[2], by[3]);
        return Some(Datum::numbers([product.w, product.i, product.j, product.k]));
    }
    let place = |of: &Datum| of.as_numbers::<3>().map(Vector3::from);
    let found = match (operator, place(left), place(right)) {
        (Operator::Plus, Some(left), Some(right)) => left + right,
        (Operator::Minus, Some(left), Some(right)) => left - right,
        (Operator::Times, Some(left), Some(right)) => left.cross(&right),
        (Operator::Times, Some(place), None) => place * right.as_number()?,
        (Operator::Times, None, Some(place)) => place * left.as_number()?,
        (Operator::Over, Some(place), None) => place / right.as_number()?,
        _ => return None,
    };
    Some(Datum::numbers(found.iter().copied()))
}

fn not_computed(operands: &[&Datum]) -> Datum {
    let reason = operands.iter().find_map(|operand| operand.unknown_reason());
    match reason {
        Some(reason) => Datum::unknown(reason.clone()),
        None => Datum::unknown("its operands are of kinds that do not go together"),
    }
}

/// Function of a language whose angles are in radians.
pub(crate) fn in_radians(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "SIN" => f64::sin,
        "COS" => f64::cos,
        "TAN" => f64::tan,
        "ASIN" => f64::asin,
        "ACOS" => f64::acos,
        "ATAN" => f64::atan,
        _ => return function(name),
    })
}

/// The function of a name in capitals.
pub(crate) fn function(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "SIN" => |angle| angle.to_radians().sin(),
        "COS" => |angle| angle.to_radians().cos(),
        "TAN" => |angle| angle.to_radians().tan(),
        "ASIN" => |value| value.asin().to_degrees(),
        "ACOS" => |value| value.acos().to_degrees(),
        "SQRT" => f64::sqrt,
        "ABS" => f64::abs,
        "LN" => f64::ln,
        "EXP" => f64::exp,
        _ => return None,
    })
}
