//! Values of expressions.

use crate::expanding::expression::tree::{Expression, Function, Operator, Parameter};

/// Two numbers that differ by less are equal (LinuxCNC 2.9, `TOLERANCE_EQUAL`; later ones have 1e-6).
const EQUAL: f64 = 1e-4;

/// A whole number may be off by this.
const WHOLE: f64 = 1e-4;

/// Where the values of parameters come from.
pub(crate) trait Parameters {
    /// The value of a numbered parameter.
    fn numbered(&self, number: u32) -> Result<f64, String>;
    /// The value of a named one; none where it has not been given any.
    fn named(&self, name: &str) -> Result<Option<f64>, String>;
    /// Whether a numbered parameter has not been given a value; none where that makes no difference (LinuxCNC).
    fn is_vacant(&self, number: u32) -> Option<bool>;
    /// Whether a number is that of a parameter.
    fn has_number(&self, number: u32) -> bool;
}

impl Expression {
    /// `#0`, which never has a value.
    pub fn is_number_zero(&self) -> bool {
        matches!(self, Self::Parameter(of) if **of == Parameter::Number(Self::Number(0.0)))
    }

    /// Whether this is a parameter that has not been given a value (Fanuc).
    pub fn is_vacant(&self, parameters: &dyn Parameters) -> Result<bool, String> {
        let Self::Parameter(of) = self else {
            return Ok(false);
        };
        match &**of {
            Parameter::Number(number) => {
                let number = whole(number.value(parameters)?, "a parameter")?;
                match parameters.is_vacant(number) {
                    Some(vacant) => Ok(vacant),
                    None if number == 0 => Err("#0 is no parameter".to_owned()),
                    None => Ok(false),
                }
            }
            Parameter::Name(_) => Ok(false),
        }
    }

    /// The value, or why there is none.
    pub fn value(&self, parameters: &dyn Parameters) -> Result<f64, String> {
        let value = match self {
            Self::Number(value) => *value,
            Self::Parameter(of) => match &**of {
                Parameter::Number(number) => {
                    parameters.numbered(whole(number.value(parameters)?, "a parameter")?)?
                }
                Parameter::Name(name) => parameters
                    .named(name)?
                    .ok_or_else(|| format!("the parameter #<{name}> has no value"))?,
            },
            Self::Exists(of) => truth(match &**of {
                Parameter::Number(number) => {
                    parameters.has_number(whole(number.value(parameters)?, "a parameter")?)
                }
                Parameter::Name(name) => parameters.named(name)?.is_some(),
            }),
            Self::Negative(of) => -of.value(parameters)?,
            Self::Function(function @ (Function::Floor | Function::Ceiling), of)
                if parameters.is_vacant(0).is_some() =>
            {
                // Fanuc's FIX drops the digits behind the point, its FUP goes away from zero.
                let value = of.value(parameters)?;
                value.signum() * function.of(value.abs())?
            }
            Self::Function(function, of) => function.of(of.value(parameters)?)?,
            Self::ArcTangent(y, x) => {
                let (y, x) = (y.value(parameters)?, x.value(parameters)?);
                y.atan2(x).to_degrees()
            }
            Self::Operation(operator @ (Operator::Equal | Operator::NotEqual), left, right)
                if left.is_number_zero() || right.is_number_zero() =>
            {
                let [left, right] = [left, right].map(|side| side.is_vacant(parameters));
                let same = left? == right?;
                truth(same == (*operator == Operator::Equal))
            }
            Self::Operation(operator, left, right) => {
                operator.of(left.value(parameters)?, right.value(parameters)?)?
            }
        };
        match value.is_finite() {
            true => Ok(value),
            false => Err("the result is no number".to_owned()),
        }
    }
}

/// A number that counts.
pub(crate) fn whole(value: f64, what: &str) -> Result<u32, String> {
    let nearest = value.round();
    match (value - nearest).abs() <= WHOLE && (0.0..=f64::from(u32::MAX)).contains(&nearest) {
        true => Ok(nearest as u32),
        false => Err(format!("{value} is no number of {what}")),
    }
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

impl Function {
    fn of(self, x: f64) -> Result<f64, String> {
        let outside = |name: &str| Err(format!("{name} of {x} does not exist"));
        Ok(match self {
            Self::Absolute => x.abs(),
            Self::ArcCosine if x.abs() > 1.0 => return outside("ACOS"),
            Self::ArcCosine => x.acos().to_degrees(),
            Self::ArcSine if x.abs() > 1.0 => return outside("ASIN"),
            Self::ArcSine => x.asin().to_degrees(),
            Self::Cosine => x.to_radians().cos(),
            Self::Exponential => x.exp(),
            Self::Floor => x.floor(),
            Self::Ceiling => x.ceil(),
            Self::Logarithm if x <= 0.0 => return outside("LN"),
            Self::Logarithm => x.ln(),
            Self::Round => x.round(),
            Self::Sine => x.to_radians().sin(),
            Self::SquareRoot if x < 0.0 => return outside("SQRT"),
            Self::SquareRoot => x.sqrt(),
            Self::Tangent => x.to_radians().tan(),
        })
    }
}

impl Operator {
    fn of(self, left: f64, right: f64) -> Result<f64, String> {
        let equal = (left - right).abs() < EQUAL;
        Ok(match self {
            Self::Power if left < 0.0 && right.floor() != right => {
                return Err(format!("{left} to the power of {right} does not exist"));
            }
            Self::Power => left.powf(right),
            Self::Times => left * right,
            Self::Divided if right == 0.0 => return Err("a division by zero".to_owned()),
            Self::Divided => left / right,
            Self::Modulo if right == 0.0 => return Err("a division by zero (MOD)".to_owned()),
            // Never negative.
            Self::Modulo => left.rem_euclid(right),
            Self::Plus => left + right,
            Self::Minus => left - right,
            Self::Equal => truth(equal),
            Self::NotEqual => truth(!equal),
            Self::Greater => truth(left > right),
            Self::GreaterOrEqual => truth(left >= right),
            Self::Less => truth(left < right),
            Self::LessOrEqual => truth(left <= right),
            Self::And => truth(left != 0.0 && right != 0.0),
            Self::Or => truth(left != 0.0 || right != 0.0),
            Self::ExclusiveOr => truth((left != 0.0) != (right != 0.0)),
        })
    }
}
