//! Reads values, parameters and expressions out of a line.

use crate::expanding::expression::{Expression, Function, Operator, Parameter};

/// Brackets and signs within each other, more than any program has.
const DEEPEST: usize = 64;

/// A syntax error and its byte in the line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Malformed {
    pub at: usize,
    pub reason: String,
}

type Read<T> = Result<T, Malformed>;

/// A line that is read from left to right; blanks stand anywhere.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'l> {
    line: &'l [u8],
    at: usize,
    depth: usize,
}

impl<'l> Cursor<'l> {
    pub fn new(line: &'l [u8], at: usize) -> Self {
        Self { line, at, depth: 0 }
    }

    /// The byte that is read next, blanks left out.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Goes on at a byte of the line.
    pub fn go_to(&mut self, at: usize) {
        self.at = at;
    }

    /// The next byte, in capitals; none at the end.
    pub fn peek(&mut self) -> Option<u8> {
        while matches!(self.line.get(self.at), Some(b' ' | b'\t')) {
            self.at += 1;
        }
        self.line.get(self.at).map(u8::to_ascii_uppercase)
    }

    pub fn next(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.at += 1;
        Some(byte)
    }

    /// Goes on behind a text of capitals, if it stands here.
    pub fn take(&mut self, text: &str) -> bool {
        let before = self.at;
        let all = text.bytes().all(|byte| self.next() == Some(byte));
        if !all {
            self.at = before;
        }
        all
    }

    fn expect(&mut self, byte: u8, where_: &str) -> Read<()> {
        match self.peek() == Some(byte) {
            true => {
                self.at += 1;
                Ok(())
            }
            false => Err(self.malformed(&format!("{} is missing {where_}", char::from(byte)))),
        }
    }

    pub fn malformed(&self, reason: &str) -> Malformed {
        Malformed {
            at: self.at.min(self.line.len()),
            reason: reason.to_owned(),
        }
    }

    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        if self.depth == DEEPEST {
            return Err(self.malformed("the expression has too many brackets within each other"));
        }
        self.depth += 1;
        let found = read(self);
        self.depth -= 1;
        found
    }

    /// Value after a letter: a number, a parameter, a function, an expression in brackets.
    pub fn value(&mut self) -> Read<Expression> {
        self.deeper(|cursor| match cursor.peek() {
            Some(b'[') => cursor.bracketed(),
            Some(b'#') => Ok(Expression::Parameter(Box::new(cursor.parameter()?))),
            Some(sign @ (b'+' | b'-')) if !cursor.is_number_behind_sign() => {
                cursor.at += 1;
                let of = cursor.value()?;
                Ok(match sign {
                    b'-' => Expression::Negative(Box::new(of)),
                    _ => of,
                })
            }
            Some(byte) if byte.is_ascii_alphabetic() => cursor.function(),
            _ => cursor.number().map(Expression::Number),
        })
    }

    /// Right side of an assignment: Fanuc's controllers take operations without brackets there, and nothing else could be meant
    /// elsewhere.
    pub fn assigned(&mut self) -> Read<Expression> {
        self.deeper(|cursor| Ok(cursor.operations(0)?.0))
    }

    /// `[ ... ]`.
    pub fn bracketed(&mut self) -> Read<Expression> {
        self.expect(b'[', "before an expression")?;
        let (found, _) = self.deeper(|cursor| cursor.operations(0))?;
        self.expect(b']', "behind an expression")?;
        Ok(found)
    }

    /// `#5`, `#<name>`, `#[...]`.
    pub fn parameter(&mut self) -> Read<Parameter> {
        self.expect(b'#', "before a parameter")?;
        match self.peek() {
            Some(b'<') => self.name().map(Parameter::Name),
            _ => self.value().map(Parameter::Number),
        }
    }

    /// `<name>`, in small letters without blanks.
    pub fn name(&mut self) -> Read<String> {
        self.expect(b'<', "before a name")?;
        let mut name = String::new();
        loop {
            match self.next() {
                Some(b'>') if !name.is_empty() => return Ok(name),
                Some(byte)
                    if byte.is_ascii_graphic() && !matches!(byte, b'<' | b'(' | b')' | b'>') =>
                {
                    name.push(char::from(byte.to_ascii_lowercase()));
                }
                _ => return Err(self.malformed("a name in < > is not closed or has no letters")),
            }
        }
    }

    /// Operations whose operators bind more than `above`, and the last one that was done, where there is one.
    fn operations(&mut self, above: u8) -> Read<(Expression, Option<Operator>)> {
        let (mut left, mut last) = (self.value()?, None);
        while let Some((operator, behind)) = self.operator() {
            if operator.precedence() <= above {
                break;
            }
            self.at = behind;
            let (right, of_right) =
                self.deeper(|cursor| cursor.operations(operator.precedence()))?;
            left = Expression::Operation(operator, Box::new(left), Box::new(right));
            let others = [last, of_right].into_iter().flatten();
            if operator.is_logical() && others.into_iter().any(|other| other != operator) {
                left = Expression::Unbracketed(Box::new(left));
            }
            last = Some(operator);
        }
        Ok((left, last))
    }

    /// The operator that stands here, and where it ends.
    fn operator(&self) -> Option<(Operator, usize)> {
        let mut all = Operator::ALL.into_iter();
        all.find_map(|(text, operator)| {
            let mut ahead = self.clone();
            ahead.take(text).then_some((operator, ahead.at))
        })
    }

    fn function(&mut self) -> Read<Expression> {
        let start = self.at;
        if self.take("ATAN") {
            let y = self.bracketed()?;
            self.expect(b'/', "between the two values of ATAN[y]/[x]")?;
            return Ok(Expression::ArcTangent(
                Box::new(y),
                Box::new(self.bracketed()?),
            ));
        }
        if self.take("EXISTS") {
            self.expect(b'[', "behind EXISTS")?;
            let of = self.parameter()?;
            self.expect(b']', "behind the parameter of EXISTS")?;
            return Ok(Expression::Exists(Box::new(of)));
        }
        let mut known = Function::ALL.into_iter();
        let found = known.find_map(|(name, function)| self.take(name).then_some(function));
        let Some(function) = found else {
            self.at = start;
            return Err(self.malformed("a number, a parameter or a function is expected"));
        };
        Ok(Expression::Function(function, Box::new(self.bracketed()?)))
    }

    fn is_number_behind_sign(&self) -> bool {
        let behind = self.line.get(self.at + 1);
        behind.is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
    }

    /// Sign, digits, point; no exponent.
    fn number(&mut self) -> Read<f64> {
        self.peek();
        let rest = &self.line[self.at.min(self.line.len())..];
        let sign = usize::from(matches!(rest.first(), Some(b'+' | b'-')));
        let is_digit = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
        let length = sign + rest[sign..].iter().take_while(is_digit).count();
        let text = std::str::from_utf8(&rest[..length]).unwrap_or_default();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += length;
                Ok(value)
            }
            _ => Err(self.malformed("a number, a parameter or an expression is expected")),
        }
    }
}
