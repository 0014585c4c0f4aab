//! Values of Q parameters and of expressions with them: `+Q1 DIV +3`, `(Q2 + 5) * SIN Q3`. Angles are in degrees.

use std::collections::BTreeMap;

use crate::heidenhain::words::{Word, parameter_at};
use crate::interpreter::operation::function;
use crate::model::stated_value::StatedValue;
use crate::options::ReadOptions;

/// Values of parameters by their names in capitals; none where there is none.
pub(crate) trait Parameters {
    fn value(&self, name: &str) -> Option<f64>;
}

/// Values of parameters; none where the machine alone knows it.
///
/// Q and QR parameters are those of all programs, QL parameters those of one program: HEIDENHAIN, TNC 640, user's manual,
/// Klartext programming, "Q parameters: principle and overview of functions" ("QL: parameters only effective locally within one
/// NC program").
#[derive(Default)]
pub(crate) struct Values {
    shared: BTreeMap<String, f64>,
    local: BTreeMap<String, f64>,
    /// Values of machine parameters, as the caller states them.
    stated: BTreeMap<String, f64>,
}

/// QL parameters of one program.
pub(crate) struct Local(BTreeMap<String, f64>);

/// True if a parameter is local to one program.
fn is_local(name: &str) -> bool {
    name.starts_with("QL")
}

impl Values {
    fn of_kind(&mut self, name: &str) -> &mut BTreeMap<String, f64> {
        match is_local(name) {
            true => &mut self.local,
            false => &mut self.shared,
        }
    }

    /// Parameters begin with the values that the caller states; those that are none, with the reason.
    pub(crate) fn of(options: &ReadOptions) -> Result<Self, (String, &'static str)> {
        let mut values = Self::default();
        for (name, value) in &options.values {
            let key = name.to_ascii_uppercase();
            let is_name = parameter_at(key.as_bytes(), 0, key.len()) == Some(0..key.len());
            match value {
                StatedValue::Number(number) if is_name && number.is_finite() => {
                    values.insert(key.clone(), *number);
                    values.stated.insert(key, *number);
                }
                _ => {
                    return Err((
                        format!(
                            "a value of `{name}` is stated, and it is no Q parameter with a number"
                        ),
                        "state it so: --set Q11=5.5",
                    ));
                }
            }
        }
        Ok(values)
    }

    /// The machine gives a parameter a value: none is known but one that the caller states.
    pub(crate) fn read_from_machine(&mut self, name: &str) {
        match self.stated.get(name) {
            Some(value) => self.insert(name.to_owned(), *value),
            None => self.remove(name),
        }
    }

    pub(crate) fn insert(&mut self, name: String, value: f64) {
        self.of_kind(&name).insert(name, value);
    }

    pub(crate) fn remove(&mut self, name: &str) {
        self.of_kind(name).remove(name);
    }

    /// Another program begins, without QL parameters: those of the program that calls.
    pub(crate) fn called(&mut self) -> Local {
        Local(std::mem::take(&mut self.local))
    }

    /// The program that called goes on with its own.
    pub(crate) fn back(&mut self, local: Local) {
        self.local = local.0;
    }
}

impl Parameters for Values {
    fn value(&self, name: &str) -> Option<f64> {
        let held = match is_local(name) {
            true => &self.local,
            false => &self.shared,
        };
        held.get(name).copied()
    }
}

/// Reason why a parameter has no value; the control has none either.
pub(crate) fn no_value(name: &str) -> String {
    match is_local(name) {
        true => format!(
            "{name} has no value that its program states (QL parameters are those of one program: one that is called has its own)"
        ),
        false => format!("{name} has no value that the program states"),
    }
}

/// Remedy of a parameter without a value.
pub(crate) const STATE_VALUE: &str =
    "state it before (FN 0: Q1 = +5), or give the value that it has on the machine (--set Q1=5)";

/// True if a word is the `=` before a value.
pub(crate) fn begins_value(word: &Word, bytes: &[u8]) -> bool {
    bytes.get(word.span.start) == Some(&b'=')
}

/// Deepest nesting of brackets and functions.
const DEEPEST: usize = 64;

/// Reason why an expression has no value.
pub(crate) type Fault = String;

/// The value of an expression.
///
/// # Errors
/// What has no value, in words.
pub(crate) fn value_of(text: &[u8], parameters: &dyn Parameters) -> Result<f64, Fault> {
    let mut reader = Reader {
        text,
        at: 0,
        parameters,
    };
    let value = reader.sum(0)?;
    reader.blanks();
    match reader.at == text.len() {
        true => finite(value),
        false => Err("the expression is not understood to its end".to_owned()),
    }
}

fn finite(value: f64) -> Result<f64, Fault> {
    match value.is_finite() {
        true => Ok(value),
        false => Err("the expression has no finite value".to_owned()),
    }
}

struct Reader<'t> {
    text: &'t [u8],
    at: usize,
    parameters: &'t dyn Parameters,
}

impl Reader<'_> {
    fn blanks(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn sign(&mut self, signs: &[u8]) -> Option<u8> {
        self.blanks();
        let sign = *self.text.get(self.at)?;
        signs.contains(&sign).then(|| {
            self.at += 1;
            sign
        })
    }

    /// A word of letters, looked at.
    fn word(&mut self) -> String {
        self.blanks();
        let letters = self.text[self.at..]
            .iter()
            .take_while(|byte| byte.is_ascii_alphabetic());
        let letters: Vec<u8> = letters.map(u8::to_ascii_uppercase).collect();
        String::from_utf8(letters).unwrap_or_default()
    }

    fn sum(&mut self, depth: usize) -> Result<f64, Fault> {
        if depth > DEEPEST {
            return Err("the expression is nested more than 64 deep".to_owned());
        }
        let mut value = self.product(depth)?;
        while let Some(sign) = self.sign(b"+-") {
            let next = self.product(depth)?;
            value += match sign {
                b'+' => next,
                _ => -next,
            };
        }
        Ok(value)
    }

    fn product(&mut self, depth: usize) -> Result<f64, Fault> {
        let mut value = self.power(depth)?;
        loop {
            if let Some(sign) = self.sign(b"*/%") {
                let next = self.power(depth)?;
                if sign != b'*' && next == 0.0 {
                    return Err("the expression divides by zero".to_owned());
                }
                value = match sign {
                    b'*' => value * next,
                    b'/' => value / next,
                    _ => value % next,
                };
                continue;
            }
            let word = self.word();
            if !matches!(word.as_str(), "DIV" | "LEN" | "ANG") {
                return Ok(value);
            }
            self.at += word.len();
            let next = self.power(depth)?;
            value = match word.as_str() {
                "DIV" if next == 0.0 => return Err("the expression divides by zero".to_owned()),
                "DIV" => value / next,
                "LEN" => value.hypot(next),
                // The angle whose sine and cosine are as these.
                _ => value.atan2(next).to_degrees().rem_euclid(360.0),
            };
        }
    }

    fn power(&mut self, depth: usize) -> Result<f64, Fault> {
        let mut value = self.one(depth)?;
        while self.sign(b"^").is_some() {
            let next = self.one(depth)?;
            value = value.powf(next);
        }
        Ok(value)
    }

    fn one(&mut self, depth: usize) -> Result<f64, Fault> {
        if depth > DEEPEST {
            return Err("the expression is nested more than 64 deep".to_owned());
        }
        match self.sign(b"+-(") {
            Some(b'+') => return self.one(depth + 1),
            Some(b'-') => return Ok(-self.one(depth + 1)?),
            Some(_) => {
                let value = self.sum(depth + 1)?;
                return match self.sign(b")") {
                    Some(_) => Ok(value),
                    None => Err("a bracket is not closed".to_owned()),
                };
            }
            None => {}
        }
        if let Some(name) = parameter_at(self.text, self.at, self.text.len()) {
            self.at = name.end;
            let name = String::from_utf8_lossy(&self.text[name]).to_ascii_uppercase();
            return self.parameters.value(&name).ok_or_else(|| no_value(&name));
        }
        let number = self.text[self.at..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b','))
            .count();
        if number > 0 {
            let text = String::from_utf8_lossy(&self.text[self.at..self.at + number]);
            self.at += number;
            let value = text.replace(',', ".").parse::<f64>();
            return value.map_err(|_| format!("`{text}` is no number"));
        }
        let word = self.word();
        self.at += word.len();
        if word == "PI" {
            return Ok(std::f64::consts::PI);
        }
        if word.is_empty() {
            return Err("the expression is not understood".to_owned());
        }
        let function: fn(f64) -> f64 = match word.as_str() {
            "ATAN" => |of| of.atan().to_degrees(),
            "SQ" => |of| of * of,
            "LOG" => f64::log10,
            "NEG" => |of| -of,
            "INT" => f64::trunc,
            "FRAC" => f64::fract,
            "SGN" => |of| if of == 0.0 { 0.0 } else { of.signum() },
            name => function(name).ok_or_else(|| format!("the function {word} is not known"))?,
        };
        finite(function(self.one(depth + 1)?))
    }
}
