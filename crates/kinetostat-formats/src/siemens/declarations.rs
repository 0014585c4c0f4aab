//! Definitions of variables: `DEF REAL A, B=1, C[3]`.

use crate::siemens::expression::{Cursor, Expression};
use crate::siemens::tokens::{Broken, Kind, Token};
use crate::siemens::values::{Type, Variable, Variables, whole};

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
            let span = cursor.place();
            let value = cursor.expression()?;
            begin_with(&mut made, &value, bytes, variables).map_err(|(reason, remedy)| Broken {
                span,
                reason,
                remedy,
            })?;
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

/// Gives a variable the values of its declaration: one, or those of an array by SET and REP; what they do not name is zero.
/// [SINUMERIK, job planning: Definition and initialization of array variables (DEF, SET, REP)]
///
/// A single value that only the machine knows is none: the variable is refused where it is used.
fn begin_with(
    made: &mut Variable,
    value: &Expression,
    bytes: &[u8],
    variables: &Variables,
) -> Result<(), (&'static str, &'static str)> {
    let is = |name: &std::ops::Range<usize>, word: &str| {
        bytes
            .get(name.clone())
            .is_some_and(|text| text.eq_ignore_ascii_case(word.as_bytes()))
    };
    let known = |made: &Variable, value: &Expression| {
        let value = variables.value(bytes, value).ok();
        let value = value.ok_or((
            "a value of the array is not known here",
            "write it as a number",
        ))?;
        made.taken(value).map_err(|_| {
            (
                "its value is of another type",
                "write one of the variable's type",
            )
        })
    };
    let more = (
        "it has more values than the array has elements",
        "take those behind out",
    );
    match value {
        Expression::Call { name, arguments } if is(name, "SET") && !made.sizes.is_empty() => {
            if arguments.len() > made.values.len() {
                return Err(more);
            }
            for (index, value) in arguments.iter().enumerate() {
                made.values[index] = known(made, value)?;
            }
        }
        Expression::Call { name, arguments } if is(name, "REP") && !made.sizes.is_empty() => {
            let (value, count) = match arguments.as_slice() {
                [value] => (value, made.values.len()),
                [value, count] => {
                    let count = variables.number(bytes, count).ok().and_then(whole);
                    let count = count.ok_or((
                        "how many elements REP fills, is no whole number",
                        "write it as one",
                    ))?;
                    (value, count as usize)
                }
                _ => {
                    return Err((
                        "REP has a value, and how many elements it fills",
                        "write REP(value) or REP(value, count)",
                    ));
                }
            };
            if count > made.values.len() {
                return Err(more);
            }
            let value = known(made, value)?;
            made.values[..count].fill(value);
        }
        Expression::Call { name, .. } if is(name, "SET") || is(name, "REP") => {
            return Err((
                "SET and REP are for arrays, and this is a single variable",
                "write its value",
            ));
        }
        _ if !made.sizes.is_empty() => {
            return Err((
                "an array begins with one value, and which elements have it is not sure",
                "write SET(values), or REP(value) for all elements",
            ));
        }
        _ => match variables.value(bytes, value) {
            Ok(value) => {
                let value = made.taken(value);
                let value = value.map_err(|_| {
                    (
                        "its value is of another type",
                        "write one of the variable's type",
                    )
                })?;
                made.values.fill(value);
            }
            Err(_) => made.values.clear(),
        },
    }
    Ok(())
}
