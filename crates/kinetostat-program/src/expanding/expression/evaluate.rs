//! Values of expressions.

use crate::expanding::Dialect;
use crate::expanding::expression::{Expression, Function, Operator, Parameter};

/// Largest difference of two equal numbers (LinuxCNC 2.9, `TOLERANCE_EQUAL`; later ones have 1e-6).
const EQUAL: f64 = 1e-4;

/// Relative difference of two numbers that is rounding.
const ROUNDING: f64 = 1e-12;

/// A whole number may be off by this.
const WHOLE: f64 = 1e-4;

/// Source of the values of parameters.
pub(crate) trait Parameters {
    /// The value of a numbered parameter.
    fn numbered(&self, number: u32) -> Result<f64, String>;
    /// The value of a named one; `None` if it has not been given any.
    fn named(&self, name: &str) -> Result<Option<f64>, String>;
    /// True if a numbered parameter has no value.
    fn is_vacant(&self, number: u32) -> bool;
    /// Whose rules hold.
    fn rules(&self) -> Dialect;
    /// True if a number is that of a parameter.
    fn has_number(&self, number: u32) -> bool;
}

impl Expression {
    /// True if this is a parameter without a value: Fanuc's vacant one.
    pub fn is_vacant(&self, parameters: &dyn Parameters) -> Result<bool, String> {
        let Self::Parameter(of) = self else {
            return Ok(false);
        };
        match &**of {
            Parameter::Number(number) => {
                let number = whole(number.value(parameters)?, "a parameter")?;
                Ok(parameters.is_vacant(number))
            }
            Parameter::Name(_) => Ok(false),
        }
    }

    /// Expression without the signs before it: `X-#1` is left out as `X#1` is, if #1 has no value.
    pub fn unsigned(&self) -> &Self {
        match self {
            Self::Negative(of) => of.unsigned(),
            _ => self,
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
            Self::Function(function, of) => {
                let of = of.value(parameters)?;
                of_controller(parameters.rules(), function.of(of)?, || {
                    function.of_fanuc(of)
                })?
            }
            Self::ArcTangent(y, x) => {
                let angle = y
                    .value(parameters)?
                    .atan2(x.value(parameters)?)
                    .to_degrees();
                of_controller(parameters.rules(), angle, || Ok(full_turn(angle)))?
            }
            Self::Operation(operator @ (Operator::Equal | Operator::NotEqual), left, right) => {
                let same = are_equal(left, right, parameters)?;
                truth(same == (*operator == Operator::Equal))
            }
            Self::Operation(operator, left, right) => {
                let (left, right) = (left.value(parameters)?, right.value(parameters)?);
                let value = operator.of(left, right)?;
                of_controller(parameters.rules(), value, || operator.of_fanuc(left, right))?
            }
            Self::Unbracketed(of) if parameters.rules() == Dialect::Fanuc => {
                let _ = of;
                return Err("AND, OR or XOR beside other operations: in which order they are done depends on the controller; put brackets around each".to_owned());
            }
            Self::Unbracketed(of) => of.value(parameters)?,
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

/// The value of a controller's rules; refused where they are not known and it makes a difference.
fn of_controller(
    rules: Dialect,
    linuxcnc: f64,
    fanuc: impl FnOnce() -> Result<f64, String>,
) -> Result<f64, String> {
    match rules {
        Dialect::LinuxCnc => Ok(linuxcnc),
        Dialect::Fanuc => fanuc(),
        Dialect::Undecided => match fanuc() {
            Ok(fanuc) if fanuc == linuxcnc => Ok(linuxcnc),
            Ok(fanuc) => Err(format!(
                "for LinuxCNC the value is {linuxcnc}, for Fanuc {fanuc}; name the dialect (--dialect)"
            )),
            Err(reason) => Err(format!(
                "for LinuxCNC the value is {linuxcnc}, for Fanuc: {reason}; name the dialect (--dialect)"
            )),
        },
    }
}

/// An angle of Fanuc's ATAN and ASIN as the controller is delivered (parameter 6004, NAT = 0): none is negative.
fn full_turn(angle: f64) -> f64 {
    match angle < 0.0 {
        true => angle + 360.0,
        false => angle,
    }
}

/// True if two values are equal. Fanuc's vacant parameter equals another vacant one and no number, not even 0 (B-63944EN, 16.1).
fn are_equal(
    left: &Expression,
    right: &Expression,
    parameters: &dyn Parameters,
) -> Result<bool, String> {
    let rules = parameters.rules();
    let vacant = match rules {
        Dialect::LinuxCnc => [false; 2],
        Dialect::Fanuc | Dialect::Undecided => {
            [left.is_vacant(parameters)?, right.is_vacant(parameters)?]
        }
    };
    if rules == Dialect::Fanuc && vacant != [false; 2] {
        return Ok(vacant[0] == vacant[1]);
    }
    let (left, right) = (left.value(parameters)?, right.value(parameters)?);
    let apart = (left - right).abs();
    if rules == Dialect::Undecided && vacant[0] != vacant[1] && apart < EQUAL {
        return Err("a parameter without a value: for LinuxCNC it equals 0, for Fanuc it does not; give it a value before, or name the dialect (--dialect)".to_owned());
    }
    if rules != Dialect::LinuxCnc && apart > ROUNDING * left.abs().max(1.0) && apart < EQUAL {
        return Err(format!(
            "{left} and {right} are nearly equal: LinuxCNC takes them for equal, Fanuc does not; round them, or compare with LT or GT"
        ));
    }
    Ok(apart < EQUAL)
}

/// The bits of a whole number, for Fanuc's AND, OR and XOR.
fn bits(value: f64) -> Result<u32, String> {
    whole(
        value,
        "bits (AND, OR and XOR of Fanuc take whole numbers that are not negative)",
    )
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

impl Function {
    /// Fanuc's variant: FIX truncates, FUP rounds away from zero.
    fn of_fanuc(self, x: f64) -> Result<f64, String> {
        match self {
            Self::Floor | Self::Ceiling => Ok(x.signum() * self.of(x.abs())?),
            Self::ArcSine => Ok(full_turn(self.of(x)?)),
            _ => self.of(x),
        }
    }
}

impl Operator {
    /// Fanuc's variant: AND, OR and XOR are bitwise.
    fn of_fanuc(self, left: f64, right: f64) -> Result<f64, String> {
        Ok(match self {
            Self::And => f64::from(bits(left)? & bits(right)?),
            Self::Or => f64::from(bits(left)? | bits(right)?),
            Self::ExclusiveOr => f64::from(bits(left)? ^ bits(right)?),
            Self::Modulo if left < 0.0 || right < 0.0 => {
                return Err(
                    "the sign of MOD with a negative number depends on the controller".to_owned(),
                );
            }
            _ => self.of(left, right)?,
        })
    }

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
