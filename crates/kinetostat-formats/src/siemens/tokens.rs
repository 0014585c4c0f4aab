//! The tokens of a block: names, numbers, texts and signs.
//!
//! Blanks separate nothing that a letter or a sign separates: `G0X-170M8` is three words. A letter with digits is a name where
//! `=` follows (`A3=`, `M1=`), a number of R or L (`R12`, `L140`), and else an address with its number (`X10`).

use std::ops::Range;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// A word of letters, digits and underscores.
    Name,
    Number(f64),
    /// Between quotes.
    Text,
    Sign(Sign),
}

/// A sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    /// One byte that is none of the others.
    Byte(u8),
    Equal,
    NotEqual,
    LessOrEqual,
    GreaterOrEqual,
    /// `<<`.
    Joined,
}

/// A token and its bytes in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Token {
    pub kind: Kind,
    pub span: Range<usize>,
}

impl Token {
    /// True if the token is this single byte.
    pub(crate) fn is(&self, byte: u8) -> bool {
        self.kind == Kind::Sign(Sign::Byte(byte))
    }
}

/// Syntax error of a block, with its position.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Broken {
    pub span: Range<usize>,
    pub reason: &'static str,
    pub remedy: &'static str,
}

/// The tokens of a part of a file, up to its comment; and where the comment begins.
///
/// # Errors
/// A text without its second quote, or a byte of no word.
pub(crate) fn tokens_of(bytes: &[u8], part: Range<usize>) -> Result<(Vec<Token>, usize), Broken> {
    let mut tokens = Vec::new();
    let mut at = part.start;
    while at < part.end {
        let byte = bytes[at];
        let rest = &bytes[at..part.end];
        match byte {
            b';' => return Ok((tokens, at)),
            _ if byte.is_ascii_whitespace() => at += 1,
            b'"' => {
                let end = rest[1..].iter().position(|byte| *byte == b'"');
                let end = end.ok_or(Broken {
                    span: at..part.end,
                    reason: "a text has no second quote",
                    remedy: "write the quote",
                })?;
                tokens.push(Token {
                    kind: Kind::Text,
                    span: at..at + end + 2,
                });
                at += end + 2;
            }
            b'0'..=b'9' | b'.' => at = number(bytes, at, part.end, &mut tokens)?,
            b'\'' => at = in_other_base(bytes, at, part.end, &mut tokens)?,
            b'A'..=b'Z' | b'a'..=b'z' | b'_' | b'$' => {
                at = name(bytes, at, part.end, &mut tokens);
            }
            b'=' | b'<' | b'>' | b'(' | b')' | b'[' | b']' | b',' | b'+' | b'-' | b'*' | b'/'
            | b':' | b'%' | b'@' | b'&' | b'#' | b'!' => {
                let (sign, length) = match rest {
                    [b'=', b'=', ..] => (Sign::Equal, 2),
                    [b'<', b'>', ..] => (Sign::NotEqual, 2),
                    [b'<', b'=', ..] => (Sign::LessOrEqual, 2),
                    [b'>', b'=', ..] => (Sign::GreaterOrEqual, 2),
                    [b'<', b'<', ..] => (Sign::Joined, 2),
                    _ => (Sign::Byte(byte), 1),
                };
                tokens.push(Token {
                    kind: Kind::Sign(sign),
                    span: at..at + length,
                });
                at += length;
            }
            _ => {
                return Err(Broken {
                    span: at..at + 1,
                    reason: "the character belongs to no word of the language",
                    remedy: "take it out, or write it in a comment (;)",
                });
            }
        }
    }
    Ok((tokens, part.end))
}

fn is_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// A name, or the address of a number that follows.
fn name(bytes: &[u8], at: usize, end: usize, tokens: &mut Vec<Token>) -> usize {
    let rest = &bytes[at..end];
    let length = 1 + rest[1..].iter().take_while(|byte| is_name(**byte)).count();
    let digits = rest[1..length]
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    let is_address = rest[0].is_ascii_alphabetic() && digits > 0;
    let whole = match is_address {
        false => length,
        true if matches!(rest[0].to_ascii_uppercase(), b'R' | b'L') => 1 + digits,
        true if 1 + digits == length && is_set(&rest[length..]) => length,
        true => 1,
    };
    tokens.push(Token {
        kind: Kind::Name,
        span: at..at + whole,
    });
    at + whole
}

/// True if `=` or an index follows.
fn is_set(behind: &[u8]) -> bool {
    let behind = behind.trim_ascii_start();
    match behind {
        [b'=', b'=', ..] => false,
        [b'=' | b'[', ..] => true,
        _ => false,
    }
}

const NO_NUMBER: &str = "a number cannot be read";
const WRITE_NUMBER: &str = "write it with digits, one point and no blank between them";

fn number(bytes: &[u8], at: usize, end: usize, tokens: &mut Vec<Token>) -> Result<usize, Broken> {
    let rest = &bytes[at..end];
    let part = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
    let length = rest.iter().take_while(part).count();
    let mut text = String::from_utf8_lossy(&rest[..length]).into_owned();
    let mut whole = length;
    if let [b'E' | b'e', b'X' | b'x', exponent @ ..] = &rest[length..] {
        let sign = usize::from(matches!(exponent.first(), Some(b'+' | b'-')));
        let digits = exponent[sign..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        if digits > 0 {
            whole = length + 2 + sign + digits;
            text = format!(
                "{text}e{}",
                String::from_utf8_lossy(&exponent[..sign + digits])
            );
        }
    }
    let value: Option<f64> = text.parse().ok();
    let value = value.filter(|value| value.is_finite()).ok_or(Broken {
        span: at..at + whole,
        reason: NO_NUMBER,
        remedy: WRITE_NUMBER,
    })?;
    tokens.push(Token {
        kind: Kind::Number(value),
        span: at..at + whole,
    });
    Ok(at + whole)
}

/// `'H1F'`, `'B0101'`.
fn in_other_base(
    bytes: &[u8],
    at: usize,
    end: usize,
    tokens: &mut Vec<Token>,
) -> Result<usize, Broken> {
    let rest = &bytes[at + 1..end];
    let length = rest.iter().position(|byte| *byte == b'\'');
    let value = length.and_then(|length| {
        let (base, digits) = rest[..length].split_first()?;
        let radix = match base.to_ascii_uppercase() {
            b'H' => 16,
            b'B' => 2,
            _ => return None,
        };
        let digits = std::str::from_utf8(digits).ok()?;
        Some((u32::from_str_radix(digits, radix).ok()?, length))
    });
    let (value, length) = value.ok_or(Broken {
        span: at..end,
        reason: NO_NUMBER,
        remedy: "write it as 'H1F' or 'B101'",
    })?;
    tokens.push(Token {
        kind: Kind::Number(f64::from(value)),
        span: at..at + length + 2,
    });
    Ok(at + length + 2)
}
