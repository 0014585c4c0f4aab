//! Control flow of a line (jumps, loops, repeated sections), from its tokens.

use std::ops::Range;

use crate::interpreter::expression::Operator;
use crate::siemens::declarations::type_of;
use crate::siemens::expression::{Cursor, Expression};
use crate::siemens::tokens::{Broken, Kind};
use crate::siemens::values::Type;

/// A jump.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jump {
    pub way: Way,
    /// Label or number.
    pub to: Range<usize>,
    pub number: Option<u64>,
}

/// Search direction of a jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Back,
    Both,
    /// Both directions, without an error if the destination does not exist (GOTOC).
    IfThere,
}

/// Control flow of a line. Other lines are given as indices of the unit.
#[derive(Debug, Clone)]
pub(super) enum Control {
    None,
    Define,
    /// Marker without an action: PROC, EXTERN, LOOP, ENDIF.
    Mark,
    /// IF, WHILE, UNTIL: goes to a line where the condition does not hold.
    Unless {
        condition: Expression,
        to: usize,
    },
    /// ELSE, ENDWHILE, ENDLOOP.
    Goto(usize),
    /// GOTO, IF before it, CASE: the first jump whose condition holds.
    Jump(Vec<(Option<Expression>, Jump)>),
    For {
        variable: Range<usize>,
        indices: Vec<Expression>,
        from: Expression,
        to: Expression,
        end: usize,
    },
    EndFor(usize),
    /// REPEAT and REPEATB of a section.
    Repeat {
        from: Range<usize>,
        to: Option<Range<usize>>,
        one_block: bool,
        count: Option<Expression>,
    },
}

/// A parameter of PROC.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    pub name: Vec<u8>,
    pub kind: Type,
    pub by_reference: bool,
    pub default: Option<Expression>,
}

pub(super) fn jump(cursor: &mut Cursor<'_>) -> Result<Jump, Broken> {
    let way = match () {
        () if cursor.is_next("GOTOF") => Way::Forward,
        () if cursor.is_next("GOTOB") => Way::Back,
        () if cursor.is_next("GOTO") => Way::Both,
        () if cursor.is_next("GOTOC") => Way::IfThere,
        () => return Err(cursor.broken("a jump is missing")),
    };
    cursor.at += 1;
    let numbered = cursor.is_next("N")
        && (cursor.peek_second()).is_some_and(|token| matches!(token.kind, Kind::Number(_)));
    cursor.at += usize::from(numbered);
    let missing = cursor.broken("the destination of a jump is missing");
    let token = cursor.next().ok_or(missing.clone())?;
    match (token.kind, numbered) {
        (Kind::Name, false) => Ok(Jump {
            way,
            to: token.span.clone(),
            number: None,
        }),
        (Kind::Number(number), true) if number.fract() == 0.0 && number >= 0.0 => Ok(Jump {
            way,
            to: token.span.clone(),
            number: Some(number as u64),
        }),
        _ => Err(missing),
    }
}

/// IF of a structure, or one or more with jumps.
pub(super) fn condition(cursor: &mut Cursor<'_>) -> Result<Control, Broken> {
    let mut jumps = Vec::new();
    while cursor.is_next("IF") {
        cursor.at += 1;
        let condition = cursor.expression()?;
        if cursor.peek().is_none() && jumps.is_empty() {
            return Ok(Control::Unless { condition, to: 0 });
        }
        jumps.push((Some(condition), jump(cursor)?));
    }
    Ok(Control::Jump(jumps))
}

pub(super) fn for_loop(cursor: &mut Cursor<'_>) -> Result<Control, Broken> {
    let variable = cursor.place();
    cursor.at += 1;
    let indices = match cursor.takes(b'[') {
        true => cursor.list(b']')?,
        false => Vec::new(),
    };
    if !cursor.takes(b'=') {
        return Err(cursor.broken("the first value of FOR is missing"));
    }
    let from = cursor.expression()?;
    if !cursor.is_next("TO") {
        return Err(cursor.broken("TO is missing"));
    }
    cursor.at += 1;
    let to = cursor.expression()?;
    Ok(Control::For {
        variable,
        indices,
        from,
        to,
        end: 0,
    })
}

pub(super) fn repeat(cursor: &mut Cursor<'_>, one_block: bool) -> Result<Control, Broken> {
    let from = cursor.place();
    cursor.at += 1;
    let second = cursor.peek().filter(|token| {
        token.kind == Kind::Name && !cursor.text(&token.span).eq_ignore_ascii_case(b"P")
    });
    let to = second.map(|token| token.span.clone());
    cursor.at += usize::from(to.is_some());
    let count = match cursor.is_next("P") {
        true => {
            cursor.at += 1;
            cursor.takes(b'=');
            Some(cursor.expression()?)
        }
        false => None,
    };
    Ok(Control::Repeat {
        from,
        to,
        one_block,
        count,
    })
}

pub(super) fn case(cursor: &mut Cursor<'_>) -> Result<Control, Broken> {
    let of = cursor.expression()?;
    if !cursor.is_next("OF") {
        return Err(cursor.broken("OF is missing"));
    }
    cursor.at += 1;
    let mut cases = Vec::new();
    while cursor.peek().is_some() {
        let condition = match cursor.is_next("DEFAULT") {
            true => {
                cursor.at += 1;
                None
            }
            false => {
                let sides = Box::new((of.clone(), cursor.expression()?));
                Some(Expression::Binary(Operator::Equal, sides))
            }
        };
        cases.push((condition, jump(cursor)?));
    }
    Ok(Control::Jump(cases))
}

/// The parameters of PROC, and whether it saves the modes.
pub(super) fn procedure(cursor: &mut Cursor<'_>) -> Result<(Vec<Parameter>, bool), Broken> {
    let (mut parameters, mut saves) = (Vec::new(), false);
    cursor.at += 1;
    if cursor.takes(b'(') && !cursor.takes(b')') {
        loop {
            let by_reference = cursor.is_next("VAR");
            cursor.at += usize::from(by_reference);
            let kind = type_of(cursor)?;
            let name = cursor.place();
            cursor.at += 1;
            if cursor.takes(b'[') {
                // An array of any size has commas alone.
                while cursor.peek().is_some_and(|token| token.is(b',')) {
                    cursor.at += 1;
                }
                cursor.list(b']')?;
            }
            let default = match cursor.takes(b'=') {
                true => Some(cursor.expression()?),
                false => None,
            };
            parameters.push(Parameter {
                name: cursor.text(&name).to_ascii_uppercase(),
                kind,
                by_reference,
                default,
            });
            if cursor.takes(b')') {
                break;
            }
            if !cursor.takes(b',') {
                return Err(cursor.broken("a comma is missing between parameters"));
            }
        }
    }
    while cursor.peek().is_some() {
        saves |= cursor.is_next("SAVE");
        cursor.at += 1;
    }
    Ok((parameters, saves))
}
