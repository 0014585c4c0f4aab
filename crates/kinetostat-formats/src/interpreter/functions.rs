//! Functions of one number that have one name and one meaning in all languages; angles are in degrees.

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
