//! What an instruction does to the order of the program, to its frames and to the tool.

use std::ops::Range;

use crate::ls::motion::{MotionText, Reason, motion_of};
use crate::ls::registers::{Given, given_by};
use crate::ls::table::row;
use crate::ls::words::{Kind, index_of, words_of};
use crate::table::Treatment;

/// A frame's number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    Known(u32),
    /// A register says it.
    Computed,
}

/// An instruction as far as it is followed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    Motion(Box<MotionText>),
    Frame(Number),
    Tool(Number),
    Label(u32),
    Jump(Number),
    /// A program by its name; none where a register says it.
    Call(Option<Range<usize>>),
    /// `IF (...) THEN`.
    If,
    Else,
    EndIf,
    For,
    EndFor,
    /// What runs on a condition: `IF ..., JMP LBL[1]`, and the lines of a SELECT.
    Perhaps(Box<Step>),
    /// The program returns.
    End,
    /// All programs end.
    Abort,
    /// Another task is started.
    Run,
    /// A register, frame or tool gets a value.
    Give(Given),
    Carried,
    Refused(Reason),
}

const UNKNOWN: Reason = (
    "the statement is not known, and may move the tool",
    "take it into a program of its own, or ask for it to be carried",
);

/// What an instruction is.
pub(crate) fn step_of(bytes: &[u8], text: &Range<usize>) -> Step {
    let from = bytes[text.clone()]
        .iter()
        .position(|byte| !byte.is_ascii_whitespace());
    let Some(from) = from.map(|from| text.start + from) else {
        return Step::Carried;
    };
    let end = text.end - trailing_blanks(&bytes[from..text.end]);
    inner(bytes, from..end, 0)
}

fn trailing_blanks(text: &[u8]) -> usize {
    text.len() - text.trim_ascii_end().len()
}

fn inner(bytes: &[u8], span: Range<usize>, depth: usize) -> Step {
    let text = &bytes[span.clone()];
    if text.first() == Some(&b'=') {
        // A further line of SELECT.
        return perhaps(bytes, &span, depth);
    }
    let Some(row) = row(text) else {
        return Step::Refused(UNKNOWN);
    };
    match (row.name, row.treatment) {
        (_, Treatment::Refused { reason, remedy }) => Step::Refused((reason, remedy)),
        ("J" | "L" | "C", _) => match motion_of(bytes, &span) {
            Ok(motion) if depth == 0 => Step::Motion(Box::new(motion)),
            Ok(_) => Step::Refused((
                "a motion stands behind a condition",
                "write it between IF ... THEN and ENDIF",
            )),
            Err(reason) => Step::Refused(reason),
        },
        ("UFRAME_NUM", _) => Step::Frame(assigned(bytes, &span)),
        ("UTOOL_NUM", _) => Step::Tool(assigned(bytes, &span)),
        ("LBL", _) => match bracketed(bytes, &span) {
            Number::Known(number) => Step::Label(number),
            Number::Computed => Step::Refused(("the label has no number", "number it")),
        },
        ("JMP", _) => Step::Jump(bracketed(bytes, &span)),
        ("CALL", _) => Step::Call(called(bytes, &span)),
        ("IF", _) if text.ends_with(b"THEN") => Step::If,
        ("IF" | "SELECT", _) => perhaps(bytes, &span, depth),
        ("ELSE", _) if text.contains(&b',') => perhaps(bytes, &span, depth),
        ("ELSE", _) => Step::Else,
        ("ENDIF", _) => Step::EndIf,
        ("FOR", _) => Step::For,
        ("ENDFOR", _) => Step::EndFor,
        ("END", _) => Step::End,
        ("ABORT", _) => Step::Abort,
        ("RUN", _) => Step::Run,
        ("PR" | "OFFSET CONDITION" | "TOOL_OFFSET CONDITION", _) => {
            Step::Give(given_by(bytes, &span).unwrap_or(Given::AnyRegister))
        }
        ("UFRAME" | "UTOOL", _) => {
            given_by(bytes, &span).map_or(Step::Refused(FRAME_DATA), Step::Give)
        }
        ("$", _) if sets_frame(text) => Step::Refused(FRAME_OF_SYSTEM),
        _ => Step::Carried,
    }
}

/// Of a frame or tool whose value is not known.
pub(crate) const FRAME_DATA: Reason = (
    "it says which frame a number means while the program runs, and its value is not in the text",
    "give the register all six numbers before (PR[9,1]=0 to PR[9,6]=0, PR[9]=P[2]), state the frame under [robot.frames], or set it on the controller and take this statement into a program of its own",
);

const FRAME_OF_SYSTEM: Reason = (
    "a system variable moves a frame or a tool, and all points with it",
    "set the frame on the controller and take this statement into a program of its own",
);

/// Members of system variables that hold frames and tools, and their numbers.
const FRAMES_OF_SYSTEM: [&[u8]; 7] = [
    b"UFRAME",
    b"UTOOL",
    b"UFRAMENUM",
    b"UTOOLNUM",
    b"MNUFRAME",
    b"MNUTOOL",
    b"TCPFRAME",
];

/// Whether an assignment to a system variable sets a frame: `$GROUP[1].$UFRAME=PR[1]`.
fn sets_frame(text: &[u8]) -> bool {
    let set = text.split(|byte| *byte == b'=').next().unwrap_or_default();
    let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let names = set.split(|byte| !is_part(byte));
    names.into_iter().any(|name| {
        let known = FRAMES_OF_SYSTEM.iter();
        known.into_iter().any(|one| name.eq_ignore_ascii_case(one))
    })
}

/// Deepest nesting of conditions in one instruction.
const DEEPEST: usize = 4;

/// What stands behind the first comma that no bracket holds.
fn perhaps(bytes: &[u8], span: &Range<usize>, depth: usize) -> Step {
    let mut open = 0_i32;
    for at in span.clone() {
        match bytes[at] {
            b'[' | b'(' => open += 1,
            b']' | b')' => open -= 1,
            b',' if open == 0 && depth < DEEPEST => {
                let blanks = bytes[at + 1..span.end]
                    .iter()
                    .take_while(|byte| byte.is_ascii_whitespace())
                    .count();
                let step = inner(bytes, at + 1 + blanks..span.end, depth + 1);
                return match step {
                    Step::Refused(_) | Step::Carried | Step::Perhaps(_) | Step::Run => step,
                    Step::If
                    | Step::Else
                    | Step::EndIf
                    | Step::For
                    | Step::EndFor
                    | Step::Label(_) => Step::Refused(UNKNOWN),
                    step => Step::Perhaps(Box::new(step)),
                };
            }
            _ => {}
        }
    }
    Step::Refused((
        "what it does on its condition is not known",
        "write it as the controller prints it",
    ))
}

/// The number behind the equals sign.
fn assigned(bytes: &[u8], span: &Range<usize>) -> Number {
    let words = words_of(bytes, span);
    let kinds: Vec<Kind> = words.iter().map(|word| word.kind).collect();
    match kinds.as_slice() {
        [Kind::Letters, Kind::Symbol(b'='), Kind::Number(value)]
            if value.fract() == 0.0 && *value < 1e6 =>
        {
            Number::Known(*value as u32)
        }
        _ => Number::Computed,
    }
}

/// The number in the first bracket.
fn bracketed(bytes: &[u8], span: &Range<usize>) -> Number {
    let words = words_of(bytes, span);
    let bracket = words.iter().find(|word| word.kind == Kind::Bracket);
    let index = bracket.and_then(|word| index_of(bytes, &word.span));
    index.map_or(Number::Computed, |(number, _)| Number::Known(number))
}

/// The name of the program that is called.
fn called(bytes: &[u8], span: &Range<usize>) -> Option<Range<usize>> {
    name_from(bytes, span.start + b"CALL".len()..span.end)
}

/// The name of a program with which a part begins; none where a register says it.
pub(crate) fn name_from(bytes: &[u8], part: Range<usize>) -> Option<Range<usize>> {
    let (from, span) = (part.start, part);
    let rest = bytes.get(from..span.end)?;
    let blanks = rest.len() - rest.trim_ascii_start().len();
    let is_part = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_' || **byte == b'-';
    let length = rest[blanks..].iter().take_while(is_part).count();
    let behind = rest.get(blanks + length);
    (length > 0 && behind != Some(&b'[')).then_some(from + blanks..from + blanks + length)
}

/// The positions that a statement reads besides its motion: their values must stay. None where a register says which.
pub(crate) fn positions_read(bytes: &[u8], text: &Range<usize>) -> Option<Vec<u32>> {
    let part = &bytes[text.clone()];
    if !part.windows(2).any(|pair| pair == b"P[") || part.trim_ascii_start().starts_with(b"!") {
        return Some(Vec::new());
    }
    let words = words_of(bytes, text);
    let mut found = Vec::new();
    for pair in words.windows(2) {
        if bytes[pair[0].span.clone()] == *b"P" && pair[1].kind == Kind::Bracket {
            found.push(index_of(bytes, &pair[1].span)?.0);
        }
    }
    Some(found)
}
