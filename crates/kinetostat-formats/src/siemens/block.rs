//! One line of a program as a block: number, label, words.

use std::ops::Range;

use crate::siemens::expression::{Cursor, Expression};
use crate::siemens::tokens::{Broken, Kind, Sign, Token, tokens_of};
use crate::text::source::beginning;

/// A block: a line of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Block {
    /// The line without its ending.
    pub line: Range<usize>,
    /// From the first to the last byte of its words.
    pub span: Range<usize>,
    /// `/` stands before it.
    pub skip: bool,
    pub number: Option<u64>,
    pub label: Option<Range<usize>>,
    /// First byte of the words, after block number and label.
    pub words_at: usize,
    pub items: Vec<Item>,
}

/// One word of a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Item {
    pub span: Range<usize>,
    /// Name or address.
    pub name: Range<usize>,
    pub what: What,
}

/// Content of a word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum What {
    /// A name alone.
    Name,
    /// A name with arguments in parentheses.
    Call(Vec<Argument>),
    /// An address or a variable with its value: `X10`, `X=AC(5)`, `R1=2`.
    Value {
        /// Indices of an array element: `A[1]=`.
        indices: Vec<Expression>,
        how: How,
        value: Expression,
        /// Bytes of the number or the expression, without what is around it.
        span: Range<usize>,
        /// From behind the name or its `=` to the end.
        whole: Range<usize>,
        /// `=` stands behind the name.
        set: bool,
    },
    /// A statement that is read elsewhere: its tokens begin here.
    Statement,
}

/// Dimension of a coordinate: absolute, incremental or modal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum How {
    /// Follows G90 or G91.
    Modal,
    /// `AC()`.
    Absolute,
    /// `IC()`.
    Step,
    /// `DC()`, `ACP()`, `ACN()`: of a rotary axis.
    Rotary,
}

/// An argument of a call; nothing where it is left out, or where its text is no expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Argument {
    pub span: Range<usize>,
    pub value: Option<Expression>,
}

/// Words whose block is read elsewhere as a whole.
pub(crate) const STATEMENTS: [&str; 33] = [
    "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR", "REPEAT", "REPEATB", "UNTIL",
    "LOOP", "ENDLOOP", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "CASE", "DEF", "PROC", "EXTERN",
    "DEFINE", "ENDLABEL", "SET", "REDEF", "CALL", "WHEN", "WHENEVER", "EVERY", "DO", "ID", "IDS",
    "SETINT",
];

/// Longest line whose words are read, bytes: a block of the control has 512.
const LONGEST_LINE: usize = 8192;

impl Block {
    /// A line whose words are not known.
    pub(crate) fn unread(line: Range<usize>) -> Self {
        Self {
            span: line.clone(),
            words_at: line.start,
            line,
            skip: false,
            number: None,
            label: None,
            items: Vec::new(),
        }
    }

    /// Decodes a line of a file, and returns its tokens.
    ///
    /// # Errors
    /// The part of the line that cannot be read.
    pub(crate) fn of(bytes: &[u8], line: Range<usize>) -> Result<(Self, Vec<Token>), Broken> {
        let mark = match line.start {
            0 => beginning(&bytes[line.clone()]),
            _ => 0,
        };
        let text = line.start + mark..line.end;
        let start = text.start + leading_blanks(&bytes[text]);
        let mut block = Self {
            span: start..start,
            skip: false,
            number: None,
            label: None,
            words_at: start,
            items: Vec::new(),
            line: line.clone(),
        };
        if matches!(bytes.get(start), Some(b'%' | b';') | None) || start >= line.end {
            return Ok((block, Vec::new()));
        }
        if line.len() > LONGEST_LINE {
            return Err(Broken {
                span: start..start + 1,
                reason: "the block has more than 8192 bytes, and a control reads 512",
                remedy: "divide it",
            });
        }
        let mut from = start;
        if bytes[start] == b'/' {
            block.skip = true;
            from += 1 + usize::from(bytes.get(start + 1).is_some_and(u8::is_ascii_digit));
        }
        let (tokens, _) = tokens_of(bytes, from..line.end)?;
        let mut cursor = Cursor::new(bytes, &tokens);
        block.head(&mut cursor);
        if let Some(token) = cursor.peek() {
            block.words_at = token.span.start;
        }
        if let (Some(first), Some(last)) = (tokens.first(), tokens.last()) {
            let begin = match block.skip {
                true => start,
                false => first.span.start,
            };
            block.span = begin..last.span.end;
        }
        block.words(&mut cursor)?;
        Ok((block, tokens))
    }

    /// Number and label.
    fn head(&mut self, cursor: &mut Cursor<'_>) {
        let number = |token: Option<&Token>| match token.map(|token| token.kind) {
            Some(Kind::Number(value)) if (0.0..1e9).contains(&value) => Some(value as u64),
            _ => None,
        };
        let main = cursor.peek().is_some_and(|token| token.is(b':'));
        if (main || cursor.is_next("N"))
            && let Some(found) = number(cursor.peek_second())
        {
            self.number = Some(found);
            cursor.at += 2;
        }
        let named = cursor.peek().filter(|token| token.kind == Kind::Name);
        if let (Some(name), Some(colon)) = (named, cursor.peek_second())
            && colon.is(b':')
        {
            self.label = Some(name.span.clone());
            cursor.at += 2;
        }
    }

    fn words(&mut self, cursor: &mut Cursor<'_>) -> Result<(), Broken> {
        while let Some(token) = cursor.peek() {
            let start = token.span.start;
            if token.kind != Kind::Name {
                return Err(Broken {
                    span: token.span.clone(),
                    reason: "a word begins with a letter, and here is none",
                    remedy: "mend the block, or make it a comment (;)",
                });
            }
            let name = token.span.clone();
            cursor.at += 1;
            let text = cursor.text(&name);
            let is_statement = STATEMENTS
                .iter()
                .any(|word| text.eq_ignore_ascii_case(word.as_bytes()));
            if is_statement {
                // The rest of the line belongs to the word.
                let end = cursor.tokens.last().map_or(name.end, |last| last.span.end);
                self.items.push(Item {
                    span: start..end,
                    name,
                    what: What::Statement,
                });
                return Ok(());
            }
            let what = what(cursor, &name)?;
            let end = cursor.tokens[cursor.at - 1].span.end;
            self.items.push(Item {
                span: start..end,
                name,
                what,
            });
        }
        Ok(())
    }
}

fn leading_blanks(line: &[u8]) -> usize {
    line.iter()
        .take_while(|byte| byte.is_ascii_whitespace())
        .count()
}

/// Decodes the text after a name.
fn what(cursor: &mut Cursor<'_>, name: &Range<usize>) -> Result<What, Broken> {
    let mut indices = Vec::new();
    let is_number = |token: &Token| matches!(token.kind, Kind::Number(_));
    match cursor.peek().map(|token| token.kind) {
        Some(Kind::Sign(Sign::Byte(b'('))) => {
            cursor.at += 1;
            return Ok(What::Call(arguments(cursor)?));
        }
        Some(Kind::Sign(Sign::Byte(b'['))) => {
            cursor.at += 1;
            indices = cursor.list(b']')?;
        }
        _ => {}
    }
    let from = cursor.at;
    if cursor.takes(b'=') {
        return value(cursor, indices, true);
    }
    let signed = cursor
        .peek()
        .is_some_and(|token| token.is(b'-') || token.is(b'+'))
        && cursor.peek_second().is_some_and(is_number);
    let one_letter = cursor.text(name).len() == 1;
    if one_letter && indices.is_empty() && (signed || cursor.peek().is_some_and(is_number)) {
        let negative = cursor.peek().is_some_and(|token| token.is(b'-'));
        cursor.at += usize::from(signed);
        let first = cursor.tokens[from].span.start;
        let Some(token) = cursor.next() else {
            return Err(cursor.broken("a number is missing"));
        };
        let Kind::Number(number) = token.kind else {
            return Err(cursor.broken("a number is missing"));
        };
        let span = first..token.span.end;
        return Ok(What::Value {
            indices,
            how: How::Modal,
            value: Expression::Number(match negative {
                true => -number,
                false => number,
            }),
            whole: span.clone(),
            span,
            set: false,
        });
    }
    match indices.is_empty() {
        true => Ok(What::Name),
        false => Err(cursor.broken("a value is missing")),
    }
}

/// The value behind `=`.
fn value(cursor: &mut Cursor<'_>, indices: Vec<Expression>, set: bool) -> Result<What, Broken> {
    let start = cursor.place().start;
    let mut how = How::Modal;
    for (word, means) in [
        ("AC", How::Absolute),
        ("IC", How::Step),
        ("DC", How::Rotary),
        ("ACP", How::Rotary),
        ("ACN", How::Rotary),
    ] {
        if cursor.is_next(word) && cursor.peek_second().is_some_and(|token| token.is(b'(')) {
            how = means;
        }
    }
    cursor.at += match how {
        How::Modal => 0,
        _ => 2,
    };
    let inner = cursor.place().start;
    let value = cursor.expression()?;
    let end = cursor.tokens[cursor.at - 1].span.end;
    if how != How::Modal && !cursor.takes(b')') {
        return Err(cursor.broken("a parenthesis is not closed"));
    }
    Ok(What::Value {
        indices,
        how,
        value,
        span: inner..end,
        whole: start..cursor.tokens[cursor.at - 1].span.end,
        set,
    })
}

/// The arguments of a call behind its parenthesis, which may be left out.
fn arguments(cursor: &mut Cursor<'_>) -> Result<Vec<Argument>, Broken> {
    let mut found = Vec::new();
    let mut depth = 0_usize;
    let mut from = cursor.at;
    loop {
        let Some(token) = cursor.peek() else {
            return Err(cursor.broken("a parenthesis is not closed"));
        };
        let closes = depth == 0 && token.is(b')');
        if closes || (depth == 0 && token.is(b',')) {
            let at = token.span.start;
            let part = &cursor.tokens[from..cursor.at];
            let empty = part.is_empty() && closes && found.is_empty();
            if !empty {
                let span = match (part.first(), part.last()) {
                    (Some(first), Some(last)) => first.span.start..last.span.end,
                    _ => at..at,
                };
                let mut inner = Cursor::new(cursor.bytes, part);
                let value = inner.expression().ok();
                let whole = inner.at == part.len();
                found.push(Argument {
                    span,
                    value: value.filter(|_| whole),
                });
            }
            cursor.at += 1;
            from = cursor.at;
            if closes {
                return Ok(found);
            }
            continue;
        }
        if token.is(b'(') || token.is(b'[') {
            depth += 1;
        } else if token.is(b')') || token.is(b']') {
            depth = depth.saturating_sub(1);
        }
        cursor.at += 1;
    }
}
