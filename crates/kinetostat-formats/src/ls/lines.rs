//! The sections of a program, the lines of its instructions, and their words.

use std::ops::Range;

use crate::text::number::NumberText;
use crate::text::source::{beginning, next_line};

/// Error of a line: position, reason, remedy.
pub(crate) type Fault = (Range<usize>, &'static str, &'static str);

/// An instruction with its number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    /// The digits of its number; empty where it has none.
    pub number: Range<usize>,
    /// Text between colon and semicolon; with line ends if it spans several lines.
    pub text: Range<usize>,
    /// Text from the number to the semicolon.
    pub whole: Range<usize>,
}

/// Positions of the parts of a program.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    /// Name after `/PROG`.
    pub name: Range<usize>,
    /// Number after `LINE_COUNT =`.
    pub line_count: Option<NumberText>,
    pub lines: Vec<Line>,
    /// Text from the line after `/POS` to the next section.
    pub positions: Option<Range<usize>>,
    pub has_instructions: bool,
    pub has_end: bool,
    pub faults: Vec<Fault>,
}

#[derive(Clone, Copy, PartialEq)]
enum Section {
    Before,
    Attributes,
    Instructions,
    Positions,
    Other,
}

impl Layout {
    /// Layout of the bytes of a file.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        let mut layout = Self::default();
        let mut section = Section::Before;
        let mut open: Option<Line> = None;
        let mut at = beginning(bytes);
        while at < bytes.len() {
            let next = next_line(bytes, at);
            let line = bytes[at..next].trim_ascii_end();
            let is_header = line.first() == Some(&b'/')
                && line.get(1).is_some_and(u8::is_ascii_uppercase)
                && (section != Section::Before || line.starts_with(b"/PROG"));
            if is_header {
                layout.close(&mut open, bytes);
                section = layout.header(line, at, next);
            } else {
                match section {
                    Section::Attributes => layout.attribute(bytes, at..at + line.len()),
                    Section::Instructions => {
                        layout.instruction(bytes, at..at + line.len(), &mut open);
                    }
                    Section::Positions => {
                        if let Some(positions) = &mut layout.positions {
                            positions.end = next;
                        }
                    }
                    Section::Before | Section::Other => {}
                }
            }
            at = next;
        }
        layout.close(&mut open, bytes);
        layout
    }

    fn header(&mut self, line: &[u8], at: usize, next: usize) -> Section {
        let name = line
            .split(|byte| byte.is_ascii_whitespace())
            .next()
            .unwrap_or_default();
        match name {
            b"/PROG" => {
                let rest = &line[name.len()..];
                let blanks = rest.len() - rest.trim_ascii_start().len();
                let from = at + name.len() + blanks;
                let word = rest
                    .trim_ascii_start()
                    .split(|byte| byte.is_ascii_whitespace());
                self.name = from..from + word.map(<[u8]>::len).next().unwrap_or(0);
                Section::Other
            }
            b"/ATTR" => Section::Attributes,
            b"/MN" => {
                self.has_instructions = true;
                Section::Instructions
            }
            b"/POS" => {
                self.positions = Some(next..next);
                Section::Positions
            }
            // Some printers end it with a point.
            b"/END" | b"/END." => {
                self.has_end = true;
                Section::Other
            }
            _ => Section::Other,
        }
    }

    fn attribute(&mut self, bytes: &[u8], span: Range<usize>) {
        let line = &bytes[span.clone()];
        if !line.trim_ascii_start().starts_with(b"LINE_COUNT") {
            return;
        }
        let digit = |at: &usize| line[*at].is_ascii_digit();
        let Some(from) = (0..line.len()).find(digit) else {
            return;
        };
        let to = (from..line.len())
            .find(|at| !digit(at))
            .unwrap_or(line.len());
        if let Some(value) = number_of(&line[from..to]) {
            let span = span.start + from..span.start + to;
            self.line_count = Some(NumberText { span, value });
        }
    }

    fn instruction(&mut self, bytes: &[u8], span: Range<usize>, open: &mut Option<Line>) {
        let line = &bytes[span.clone()];
        let Some((digits, text)) = prefix(line) else {
            if !line.trim_ascii().is_empty() {
                self.close(open, bytes);
                self.faults.push((
                    span,
                    "the line begins with neither a number nor a colon",
                    "give the program as the controller prints it",
                ));
            }
            return;
        };
        let number = span.start + digits.start..span.start + digits.end;
        let text = span.start + text..span.end;
        let continued = number.is_empty() && open.is_some();
        if !continued {
            self.close(open, bytes);
        }
        let start = match number.is_empty() {
            true => text.start - 1,
            false => number.start,
        };
        let mut line = match open.take() {
            Some(before) => Line {
                text: before.text.start..text.end,
                whole: before.whole.start..text.end,
                ..before
            },
            None => Line {
                number,
                whole: start..text.end,
                text,
            },
        };
        if bytes[line.text.clone()].ends_with(b";") {
            line.text.end -= 1;
            self.lines.push(line);
        } else {
            *open = Some(line);
        }
    }

    /// Ends an instruction that no semicolon ends: only an empty one may.
    fn close(&mut self, open: &mut Option<Line>, bytes: &[u8]) {
        let Some(line) = open.take() else {
            return;
        };
        if !bytes[line.text.clone()].trim_ascii().is_empty() {
            self.faults.push((
                line.whole.clone(),
                "no `;` ends the instruction",
                "give the program as the controller prints it",
            ));
        }
        self.lines.push(line);
    }
}

/// The digits before the colon with which an instruction begins, and where its text begins.
fn prefix(line: &[u8]) -> Option<(Range<usize>, usize)> {
    let from = line.iter().position(|byte| !matches!(byte, b' ' | b'\t'))?;
    let digits = line[from..]
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    (line.get(from + digits) == Some(&b':')).then_some((from..from + digits, from + digits + 1))
}

/// The value of digits.
pub(crate) fn number_of(text: &[u8]) -> Option<f64> {
    let value: f64 = std::str::from_utf8(text).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// Letters and `_`; digits behind them are a number of their own (`CNT100`).
    Letters,
    Number(f64),
    /// `[...]`, as a whole.
    Bracket,
    /// Any other byte.
    Symbol(u8),
}

/// A word and its bytes in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Word {
    pub kind: Kind,
    pub span: Range<usize>,
}

/// The words of a part of a file.
pub(crate) fn words_of(bytes: &[u8], part: &Range<usize>) -> Vec<Word> {
    let mut words = Vec::with_capacity(12);
    let mut at = part.start;
    let mut begins_line = false;
    while at < part.end {
        let byte = bytes[at];
        let run = |from: usize, is: fn(&u8) -> bool| {
            let end = bytes[from..part.end].iter().position(|byte| !is(byte));
            end.map_or(part.end, |end| from + end)
        };
        let (kind, end) = match byte {
            b'\n' => {
                begins_line = true;
                at += 1;
                continue;
            }
            b' ' | b'\t' | b'\r' => {
                at += 1;
                continue;
            }
            // The colon with which a further line of an instruction begins.
            b':' if begins_line => {
                begins_line = false;
                at += 1;
                continue;
            }
            b'0'..=b'9' | b'.' => {
                let end = run(at, |byte| byte.is_ascii_digit() || *byte == b'.');
                match number_of(&bytes[at..end]) {
                    Some(value) => (Kind::Number(value), end),
                    None => (Kind::Symbol(byte), at + 1),
                }
            }
            b'[' => (Kind::Bracket, bracket_end(bytes, at, part.end)),
            byte if is_letter(&byte) => (Kind::Letters, run(at, is_letter)),
            _ => (Kind::Symbol(byte), at + 1),
        };
        begins_line = false;
        words.push(Word {
            kind,
            span: at..end,
        });
        at = end;
    }
    words
}

fn is_letter(byte: &u8) -> bool {
    byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$') || *byte >= 0x80
}

/// Position after the closing bracket that matches the one at a place.
fn bracket_end(bytes: &[u8], at: usize, end: usize) -> usize {
    let mut open = 0_usize;
    for (index, byte) in bytes[at..end].iter().enumerate() {
        match byte {
            b'[' => open += 1,
            b']' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return at + index + 1;
        }
    }
    end
}

/// The number in `[12]` or `[12:name]`, and its bytes.
pub(crate) fn index_of(bytes: &[u8], bracket: &Range<usize>) -> Option<(u32, Range<usize>)> {
    let inside = bytes.get(bracket.start + 1..bracket.end.checked_sub(1)?)?;
    let blanks = inside.len() - inside.trim_ascii_start().len();
    let rest = &inside[blanks..];
    let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let behind = rest[digits..].trim_ascii_start();
    if !matches!(behind.first(), None | Some(b':')) {
        return None;
    }
    let number: u32 = std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()?;
    let start = bracket.start + 1 + blanks;
    Some((number, start..start + digits))
}
