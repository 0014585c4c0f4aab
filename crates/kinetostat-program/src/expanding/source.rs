//! Lines of a program with macros, as statements.
//!
//! Takes the bytes of a file; gives for each line what it is: a plain block, a block with expressions, an assignment, a
//! statement of control. Knows no values.

use std::ops::Range;

use crate::expanding::expression::parse::{Cursor, Malformed};
use crate::expanding::expression::{Expression, Parameter};
use crate::text::first_line;
use crate::text::lex::comment_length;

/// A line that was read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SourceLine {
    /// Bytes of the file, without the line ending.
    pub span: Range<usize>,
    pub block_delete: bool,
    /// Bytes before the words, where / has a number behind it (Fanuc).
    pub skip_number: Option<usize>,
    /// The N word, where it is a whole number: a label of GOTO.
    pub label: Option<u32>,
    pub statement: Statement,
}

/// Kind of a statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Statement {
    /// Plain words and comments only: run as it stands.
    Plain,
    /// Words with expressions, and assignments, in the order of the line.
    Block(Vec<Piece>),
    /// An O word with a keyword.
    Structure(OLabel, Structure),
    /// `O1000` alone: the beginning of a program or of a subprogram that M98 calls.
    ProgramNumber(u32),
    /// `IF [..] GOTO n`, or `GOTO n` with no condition.
    Goto(Option<Expression>, Expression),
    /// `IF [..] THEN #1 = ..`.
    Then(Expression, Parameter, Expression),
    /// `WHILE [..] DO m`; `DO m` with no condition.
    While(Option<Expression>, u32),
    /// `END m`.
    End(u32),
}

/// A part of a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Piece {
    /// Plain words, comments and blanks, carried as they stand; bytes of the line.
    Text(Range<usize>),
    /// A letter whose number is an expression; bytes of the line.
    Word(u8, Expression, Range<usize>),
    /// `#1 = ...`; takes effect behind the block.
    Assignment(Parameter, Expression),
}

/// Label of an O word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OLabel {
    Name(String),
    /// A number, or an expression that says it.
    Number(Expression),
}

/// The keyword behind an O word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Structure {
    Sub,
    EndSub(Option<Expression>),
    Return(Option<Expression>),
    Call(Vec<Expression>),
    If(Expression),
    ElseIf(Expression),
    Else,
    EndIf,
    While(Expression),
    EndWhile,
    Do,
    Repeat(Expression),
    EndRepeat,
    Break,
    Continue,
}

/// A line that is no statement: what is wrong, at which byte of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub line: usize,
    pub at: usize,
    pub reason: String,
}

/// The lines of a file; wrong ones are listed and left out (they are plain, and refused when they are run).
pub(crate) fn lines(bytes: &[u8]) -> (Vec<SourceLine>, Vec<Fault>) {
    let (mut all, mut faults) = (Vec::new(), Vec::new());
    let mut start = 0;
    while start < bytes.len() {
        let (length, ending) = first_line(&bytes[start..]);
        let span = start..start + length;
        let read = line(&bytes[span.clone()], span.clone()).unwrap_or_else(|fault| {
            faults.push(Fault {
                line: all.len() + 1,
                at: span.start + fault.at,
                reason: fault.reason,
            });
            plain(span, false, None)
        });
        all.push(read);
        start += length + ending.len();
    }
    (all, faults)
}

fn plain(span: Range<usize>, block_delete: bool, label: Option<u32>) -> SourceLine {
    SourceLine {
        span,
        block_delete,
        skip_number: None,
        label,
        statement: Statement::Plain,
    }
}

fn line(text: &[u8], span: Range<usize>) -> Result<SourceLine, Malformed> {
    let mut cursor = Cursor::new(text, 0);
    let block_delete = cursor.take("/");
    let skip_number = skip_number(&mut cursor, text, block_delete);
    let label = label(&mut cursor);
    let statement = match cursor.peek() {
        Some(b'O') => o_word(&mut cursor)?,
        _ => match fanuc(&mut cursor)? {
            Some(statement) => Some(statement),
            None => block(text, skip_number.unwrap_or(0))?,
        },
    };
    Ok(SourceLine {
        statement: statement.unwrap_or(Statement::Plain),
        skip_number,
        ..plain(span, block_delete, label)
    })
}

/// The number behind `/`, 1 to 9.
fn skip_number(cursor: &mut Cursor<'_>, text: &[u8], block_delete: bool) -> Option<usize> {
    let at = cursor.at();
    let is_number = matches!(text.get(at), Some(b'1'..=b'9'))
        && !matches!(text.get(at + 1), Some(b'0'..=b'9' | b'.'));
    if !block_delete || !is_number {
        return None;
    }
    let blanks = text[at + 1..]
        .iter()
        .take_while(|byte| matches!(byte, b' ' | b'\t'));
    let first = at + 1 + blanks.count();
    cursor.go_to(first);
    Some(first)
}

/// The N word in front, where it is a whole number.
fn label(cursor: &mut Cursor<'_>) -> Option<u32> {
    let mut ahead = cursor.clone();
    if !ahead.take("N") || !ahead.peek()?.is_ascii_digit() {
        return None;
    }
    let Ok(Expression::Number(value)) = ahead.value() else {
        return None;
    };
    *cursor = ahead;
    (value.fract() == 0.0 && (0.0..1e9).contains(&value)).then_some(value as u32)
}

/// `O100 sub`, `O<name> call [1] [2]`; a bare `O100` is the number of a program.
fn o_word(cursor: &mut Cursor<'_>) -> Result<Option<Statement>, Malformed> {
    cursor.take("O");
    let label = match cursor.peek() {
        Some(b'<') => OLabel::Name(cursor.name()?),
        _ => OLabel::Number(cursor.value()?),
    };
    if is_at_end(cursor) {
        return match label {
            OLabel::Number(Expression::Number(number)) if number >= 0.0 => {
                Ok(Some(Statement::ProgramNumber(number as u32)))
            }
            _ => Err(cursor.malformed("an O word without a keyword (sub, call, if, while ...)")),
        };
    }
    let structure = structure(cursor)?;
    match is_at_end(cursor) {
        true => Ok(Some(Statement::Structure(label, structure))),
        false => Err(cursor.malformed("something stands behind the keyword of an O word")),
    }
}

fn structure(cursor: &mut Cursor<'_>) -> Result<Structure, Malformed> {
    let optional = |cursor: &mut Cursor<'_>| match cursor.peek() {
        Some(b'[') => cursor.bracketed().map(Some),
        _ => Ok(None),
    };
    // A longer keyword stands before its own prefix.
    for (name, made) in [
        ("SUB", Structure::Sub),
        ("ELSE", Structure::Else),
        ("ENDIF", Structure::EndIf),
        ("ENDWHILE", Structure::EndWhile),
        ("DO", Structure::Do),
        ("ENDREPEAT", Structure::EndRepeat),
        ("BREAK", Structure::Break),
        ("CONTINUE", Structure::Continue),
    ] {
        let is_else_if = name == "ELSE" && cursor.clone().take("ELSEIF");
        if !is_else_if && cursor.take(name) {
            return Ok(made);
        }
    }
    if cursor.take("ENDSUB") {
        return optional(cursor).map(Structure::EndSub);
    }
    if cursor.take("RETURN") {
        return optional(cursor).map(Structure::Return);
    }
    if cursor.take("CALL") {
        let mut values = Vec::new();
        while cursor.peek() == Some(b'[') {
            values.push(cursor.bracketed()?);
        }
        return Ok(Structure::Call(values));
    }
    if cursor.take("ELSEIF") {
        return cursor.bracketed().map(Structure::ElseIf);
    }
    if cursor.take("IF") {
        return cursor.bracketed().map(Structure::If);
    }
    if cursor.take("WHILE") {
        return cursor.bracketed().map(Structure::While);
    }
    if cursor.take("REPEAT") {
        return cursor.bracketed().map(Structure::Repeat);
    }
    Err(cursor.malformed("an O word has no keyword that is known (sub, call, if, while ...)"))
}

/// `IF`, `GOTO`, `WHILE`, `DO`, `END`.
fn fanuc(cursor: &mut Cursor<'_>) -> Result<Option<Statement>, Malformed> {
    let number = |cursor: &mut Cursor<'_>| match cursor.value()? {
        Expression::Number(n) if n.fract() == 0.0 && (1.0..=1e4).contains(&n) => Ok(n as u32),
        _ => Err(cursor.malformed("DO and END have a whole number, as in DO1")),
    };
    if cursor.take("GOTO") {
        return cursor.value().map(|to| Some(Statement::Goto(None, to)));
    }
    if cursor.take("WHILE") {
        let condition = cursor.bracketed()?;
        if !cursor.take("DO") {
            return Err(cursor.malformed("WHILE [...] needs DO and a number"));
        }
        let number = number(cursor)?;
        return Ok(Some(Statement::While(Some(condition), number)));
    }
    if cursor.take("IF") {
        let condition = cursor.bracketed()?;
        if cursor.take("GOTO") {
            let to = cursor.value()?;
            return Ok(Some(Statement::Goto(Some(condition), to)));
        }
        if cursor.take("THEN") {
            let parameter = cursor.parameter()?;
            if !cursor.take("=") {
                return Err(cursor.malformed("THEN needs an assignment, as in #1 = 2"));
            }
            let value = cursor.assigned()?;
            return Ok(Some(Statement::Then(condition, parameter, value)));
        }
        return Err(cursor.malformed("IF [...] needs GOTO or THEN"));
    }
    if cursor.take("END") {
        return number(cursor).map(|n| Some(Statement::End(n)));
    }
    if cursor.take("DO") {
        return number(cursor).map(|n| Some(Statement::While(None, n)));
    }
    Ok(None)
}

/// Words with expressions and assignments, from a byte of the line on; `None` if all words are plain.
fn block(text: &[u8], first: usize) -> Result<Option<Statement>, Malformed> {
    let mut pieces = Vec::new();
    let mut cursor = Cursor::new(text, 0);
    cursor.go_to(first);
    let mut kept = first;
    let keep = |pieces: &mut Vec<Piece>, from: usize, to: usize| {
        if from < to {
            pieces.push(Piece::Text(from..to));
        }
    };
    while let Some(byte) = cursor.peek() {
        let start = cursor.at();
        match byte {
            b'(' => skip_comment(&mut cursor, text),
            b';' => break,
            b'@' | b'^' => {
                keep(&mut pieces, kept, start);
                cursor.next();
                let value = cursor.value()?;
                pieces.push(Piece::Word(byte, value, start..cursor.at()));
                kept = cursor.at();
            }
            b'#' => {
                keep(&mut pieces, kept, start);
                let parameter = cursor.parameter()?;
                if !cursor.take("=") {
                    return Err(cursor.malformed("a parameter without a letter needs ="));
                }
                pieces.push(Piece::Assignment(parameter, cursor.assigned()?));
                kept = cursor.at();
            }
            b'O' if !pieces.is_empty() => {
                return Err(cursor.malformed("an O word stands behind other words"));
            }
            letter if letter.is_ascii_alphabetic() => {
                cursor.next();
                if is_expression(&mut cursor) {
                    keep(&mut pieces, kept, start);
                    let value = cursor.value()?;
                    pieces.push(Piece::Word(letter, value, start..cursor.at()));
                    kept = cursor.at();
                }
            }
            _ => {
                cursor.next();
            }
        }
    }
    if pieces.is_empty() {
        return Ok(None);
    }
    keep(&mut pieces, kept, text.len());
    Ok(Some(Statement::Block(pieces)))
}

/// True if the text after a letter is more than a number.
fn is_expression(cursor: &mut Cursor<'_>) -> bool {
    let mut ahead = cursor.clone();
    while ahead.take("-") || ahead.take("+") {}
    match ahead.peek() {
        Some(b'#' | b'[') => true,
        // `XSIN[30]`; two letters that nothing follows are no function.
        Some(byte) if byte.is_ascii_alphabetic() => {
            matches!(
                ahead.value(),
                Ok(Expression::Function(..) | Expression::ArcTangent(..) | Expression::Exists(_))
            )
        }
        _ => false,
    }
}

fn skip_comment(cursor: &mut Cursor<'_>, text: &[u8]) {
    cursor.go_to(cursor.at() + comment_length(&text[cursor.at()..]));
}

/// True if only blanks and comments are left.
fn is_at_end(cursor: &mut Cursor<'_>) -> bool {
    matches!(cursor.peek(), None | Some(b';' | b'('))
}
