//! Definitions of variables: `DEF REAL A, B=1, C[3]`.

use crate::siemens::expression::Cursor;
use crate::siemens::tokens::{Broken, Kind, Token};
use crate::siemens::values::{Type, Value, Variable, Variables};

/// Types whose variables say which axis moves, or where.
const OTHER_TYPES: [&str; 2] = ["AXIS", "FRAME"];

fn fault(cursor: &Cursor<'_>, reason: &'static str, remedy: &'static str) -> Broken {
    Broken {
        span: cursor.place(),
        reason,
        remedy,
    }
}

/// The type that is next.
///
/// # Errors
/// Where none is known.
pub(crate) fn type_of(cursor: &mut Cursor<'_>) -> Result<Type, Broken> {
    for (word, kind) in [
        ("REAL", Type::Real),
        ("INT", Type::Int),
        ("BOOL", Type::Bool),
        ("CHAR", Type::Int),
        ("STRING", Type::Text),
    ] {
        if cursor.is_next(word) {
            cursor.at += 1;
            if kind == Type::Text && cursor.takes(b'[') {
                cursor.list(b']')?;
            }
            return Ok(kind);
        }
    }
    match OTHER_TYPES.iter().any(|word| cursor.is_next(word)) {
        true => Err(fault(
            cursor,
            "variables of axes and frames are not followed",
            "write the axes by their names, and frames by TRANS and ROT",
        )),
        false => Err(fault(
            cursor,
            "the type of the variable is not known",
            "write REAL, INT, BOOL, CHAR or STRING",
        )),
    }
}

/// Declares the variables of a DEF.
///
/// # Errors
/// What cannot be declared.
pub(crate) fn define(
    bytes: &[u8],
    tokens: &[Token],
    variables: &mut Variables,
) -> Result<(), Broken> {
    let mut cursor = Cursor::new(bytes, tokens);
    // Attributes of where it is seen and held.
    while ["DEF", "NCK", "CHAN", "SYNR", "SYNW", "SYNRW"]
        .iter()
        .any(|word| cursor.is_next(word))
    {
        cursor.at += 1;
    }
    let kind = type_of(&mut cursor)?;
    loop {
        let place = cursor.place();
        let named = cursor.next().filter(|token| token.kind == Kind::Name);
        let name = named.ok_or(Broken {
            span: place.clone(),
            reason: "the name of a variable is missing",
            remedy: "write DEF REAL NAME",
        })?;
        let name = cursor.text(&name.span).to_ascii_uppercase();
        let mut sizes = Vec::new();
        if cursor.takes(b'[') {
            for size in cursor.list(b']')? {
                let size = variables.number(bytes, &size).ok();
                let size = size.filter(|size| *size >= 1.0 && *size < 1e6);
                sizes.push(size.ok_or(Broken {
                    span: place.clone(),
                    reason: "the size of an array is no number from 1",
                    remedy: "write it as a number",
                })? as usize);
            }
        }
        let held: usize = variables.own.values().map(|own| own.values.len()).sum();
        let made = Variable::new(kind, sizes);
        let made = made.filter(|made| held + made.values.len() <= super::values::MOST_VALUES);
        let mut made = made.ok_or(Broken {
            span: place.clone(),
            reason: "the variables hold more than 100 000 values",
            remedy: "make the arrays smaller",
        })?;
        if cursor.takes(b'=') {
            let value = cursor.expression()?;
            if let Ok(value) = variables.value(bytes, &value) {
                let value = match (kind, value) {
                    (Type::Int, Value::Number(value)) => Value::Number((value + 0.5).floor()),
                    (_, value) => value,
                };
                made.values.fill(value);
            }
        }
        variables.own.insert(name, made);
        if cursor.peek().is_none() {
            return Ok(());
        }
        if !cursor.takes(b',') {
            return Err(fault(
                &cursor,
                "a comma is missing between variables",
                "write DEF REAL A, B",
            ));
        }
    }
}
