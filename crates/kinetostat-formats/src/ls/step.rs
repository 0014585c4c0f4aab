//! Steps of a program: what an instruction does to the order of the program, to its data and to the tool.

use std::ops::Range;

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::ls::expression::{expression_of, indices_of, list_of};
use crate::ls::lines::{Kind, Word, index_of, words_of};
use crate::ls::motion::{MotionText, Reason, motion_of};
use crate::ls::table::row;
use crate::model::site::OffsetAxes;
use crate::table::Treatment;
use crate::text::Name;

/// A call of a program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CallText {
    /// The name; none where a register holds it.
    pub name: Option<Range<usize>>,
    pub computed: Expression,
    pub arguments: Vec<Expression>,
}

/// `FOR counter=first TO last`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForText {
    pub counter: Expression,
    pub first: Expression,
    pub last: Expression,
    pub is_down: bool,
}

/// A line of a SELECT.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CaseText {
    /// The value that is compared; of the first line alone.
    pub subject: Option<Expression>,
    /// Value of the case; `None` for ELSE.
    pub value: Option<Expression>,
    pub action: Step,
}

/// An instruction as far as it is followed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    Motion(Box<MotionText>),
    /// A register, an output, a frame or the number of a frame gets a value.
    Assign(Box<[Expression; 2]>),
    /// The register by which motions are offset; none where it is not followed.
    Offset(OffsetAxes, Option<Box<Expression>>),
    Label(u32),
    Jump(Box<Expression>),
    Call(Box<CallText>),
    /// `IF (...) THEN`.
    If(Box<Expression>),
    Else,
    EndIf,
    For(Box<ForText>),
    EndFor,
    /// `IF ..., JMP LBL[1]`.
    Perhaps(Box<(Expression, Step)>),
    Case(Box<CaseText>),
    /// Other tasks may change what is waited for.
    Wait(Box<Expression>),
    /// The program returns.
    End,
    /// All programs end.
    Abort,
    /// Another task is started.
    Run,
    Carried,
    Refused(Reason),
}

impl Step {
    /// The step without the condition on which it runs.
    pub(crate) fn action(&self) -> &Self {
        match self {
            Self::Perhaps(own) => own.1.action(),
            Self::Case(own) => own.action.action(),
            own => own,
        }
    }
}

const UNKNOWN: Reason = (
    "the statement is not known, and may move the tool",
    "take it into a program of its own, or ask for it to be carried",
);

/// Decodes an instruction.
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
    let behind = span.start + row.name.len()..span.end;
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
        ("LBL", _) => match first_bracket(bytes, &span).and_then(|of| index_of(bytes, &of)) {
            Some((number, _)) => Step::Label(number),
            None => Step::Refused(("the label has no number", "number it")),
        },
        ("JMP", _) => {
            let indices = first_bracket(bytes, &span).and_then(|of| indices_of(bytes, &of));
            let index = indices.and_then(|indices| indices.into_iter().next());
            Step::Jump(Box::new(
                index.unwrap_or_else(|| expression_of(bytes, span)),
            ))
        }
        ("CALL", _) => Step::Call(Box::new(called(bytes, behind))),
        ("IF", _) if text.ends_with(b"THEN") => {
            let end = (span.end - b"THEN".len()).max(behind.start);
            Step::If(Box::new(expression_of(bytes, behind.start..end)))
        }
        ("IF" | "SELECT", _) => perhaps(bytes, &span, depth),
        ("ELSE", _) if text.contains(&b',') => perhaps(bytes, &span, depth),
        ("ELSE", _) => Step::Else,
        ("ENDIF", _) => Step::EndIf,
        ("FOR", _) => Step::For(Box::new(counted(bytes, behind))),
        ("ENDFOR", _) => Step::EndFor,
        ("END", _) => Step::End,
        ("ABORT", _) => Step::Abort,
        ("RUN", _) => Step::Run,
        ("WAIT", _) => Step::Wait(Box::new(waited(bytes, behind))),
        ("OFFSET CONDITION", _) => offset(OffsetAxes::WorkObject, bytes, behind),
        ("TOOL_OFFSET CONDITION", _) => offset(OffsetAxes::Tool, bytes, behind),
        ("$", _) if sets_frame(text) => Step::Refused(FRAME_OF_SYSTEM),
        ("$" | "!" | "//" | "--", _) => Step::Carried,
        _ => assigned(bytes, &span, row.name),
    }
}

/// Reason and remedy of a frame or tool with an unknown value.
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

/// True if an assignment to a system variable sets a frame: `$GROUP[1].$UFRAME=PR[1]`.
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

/// Conditional action: the text after the first comma outside of brackets.
fn perhaps(bytes: &[u8], span: &Range<usize>, depth: usize) -> Step {
    let Some(comma) = comma_in(bytes, span).filter(|_| depth < DEEPEST) else {
        return Step::Refused((
            "what it does on its condition is not known",
            "write it as the controller prints it",
        ));
    };
    let behind = &bytes[comma + 1..span.end];
    let blanks = behind.len() - behind.trim_ascii_start().len();
    match inner(bytes, comma + 1 + blanks..span.end, depth + 1) {
        step @ Step::Refused(_) => step,
        Step::If(_)
        | Step::Else
        | Step::EndIf
        | Step::For(_)
        | Step::EndFor
        | Step::Case(_)
        | Step::Label(_) => Step::Refused(UNKNOWN),
        step => on_condition(bytes, span.start..comma, step),
    }
}

/// The first comma outside of brackets: an action on a condition stands behind it.
pub(super) fn comma_in(bytes: &[u8], span: &Range<usize>) -> Option<usize> {
    let mut open = 0_i32;
    span.clone().find(|at| {
        match bytes[*at] {
            b'[' | b'(' => open += 1,
            b']' | b')' => open -= 1,
            _ => {}
        }
        bytes[*at] == b',' && open == 0
    })
}

fn on_condition(bytes: &[u8], before: Range<usize>, action: Step) -> Step {
    let text = &bytes[before.clone()];
    let behind = |word: &[u8]| expression_of(bytes, before.start + word.len()..before.end);
    let (subject, value) = match text {
        [b'=', ..] => (None, Some(behind(b"="))),
        _ if text.starts_with(b"ELSE") => (None, None),
        _ if text.starts_with(b"SELECT") => {
            let compared = behind(b"SELECT");
            let tokens = compared.tokens.clone();
            let open = Expression {
                node: Node::Unreadable,
                tokens,
            };
            match compared.node {
                Node::Two(Operator::Equal, operands) => {
                    let [subject, value] = *operands;
                    (Some(subject), Some(value))
                }
                _ => (Some(open.clone()), Some(open)),
            }
        }
        _ => return Step::Perhaps(Box::new((behind(b"IF"), action))),
    };
    Step::Case(Box::new(CaseText {
        subject,
        value,
        action,
    }))
}

/// An assignment, or what is carried.
fn assigned(bytes: &[u8], span: &Range<usize>, statement: &str) -> Step {
    let words = words_of(bytes, span);
    let equals = words
        .iter()
        .find(|word| word.kind == Kind::Symbol(b'='))
        .map(|word| word.span.clone());
    match (equals, Name::of(statement.as_bytes())) {
        (None, _) if matches!(statement, "UFRAME" | "UTOOL") => Step::Refused(FRAME_DATA),
        (Some(equals), Some(name)) => {
            let mut to = expression_of(bytes, span.start..equals.start);
            let value = expression_of(bytes, equals.end..span.end);
            // `UFRAME_NUM[GP1]=2` sets that of one group.
            if statement.ends_with("FRAME_NUM") || statement.ends_with("TOOL_NUM") {
                let is_other = to.node != Node::Word(name);
                to.node = Node::Word(name);
                return Step::Assign(Box::new([to.clone(), if is_other { to } else { value }]));
            }
            Step::Assign(Box::new([to, value]))
        }
        _ => Step::Carried,
    }
}

/// Another frame or tool than that in force may stand behind the register: it is not followed.
fn offset(axes: OffsetAxes, bytes: &[u8], behind: Range<usize>) -> Step {
    let register = match expression_of(bytes, behind).node {
        Node::Element(of, indices) => match (&of.node, <[Expression; 1]>::try_from(indices)) {
            (Node::Word(name), Ok([index])) if name.is("PR") => Some(Box::new(index)),
            _ => None,
        },
        _ => None,
    };
    Step::Offset(axes, register)
}

fn counted(bytes: &[u8], behind: Range<usize>) -> ForText {
    let words = words_of(bytes, &behind);
    let find = |is: &dyn Fn(&Word) -> bool| {
        let found = words.iter().find(|word| is(word));
        found.map_or(behind.end..behind.end, |word| word.span.clone())
    };
    let equals = find(&|word| word.kind == Kind::Symbol(b'='));
    let to = find(&|word| matches!(&bytes[word.span.clone()], b"TO" | b"DOWNTO"));
    ForText {
        counter: expression_of(bytes, behind.start..equals.start),
        first: expression_of(bytes, equals.end.min(to.start)..to.start),
        last: expression_of(bytes, to.end..behind.end),
        is_down: bytes[to].starts_with(b"DOWN"),
    }
}

/// The condition of WAIT, without what is done when it lasts too long.
fn waited(bytes: &[u8], behind: Range<usize>) -> Expression {
    let words = words_of(bytes, &behind);
    let timeout = words
        .iter()
        .find(|word| bytes[word.span.clone()] == *b"TIMEOUT");
    let end = timeout.map_or(behind.end, |word| word.span.start);
    expression_of(bytes, behind.start..end)
}

fn first_bracket(bytes: &[u8], span: &Range<usize>) -> Option<Range<usize>> {
    let words = words_of(bytes, span);
    let bracket = words.iter().find(|word| word.kind == Kind::Bracket);
    bracket.map(|word| word.span.clone())
}

/// The program that is called, and its arguments.
fn called(bytes: &[u8], behind: Range<usize>) -> CallText {
    let open = bytes[behind.clone()].iter().position(|byte| *byte == b'(');
    let open = open.map_or(behind.end, |open| behind.start + open);
    let close = bytes[open..behind.end]
        .iter()
        .rposition(|byte| *byte == b')');
    let inside = match close {
        Some(close) => open + 1..open + close,
        None => open..open,
    };
    CallText {
        name: name_from(bytes, behind.clone()),
        computed: expression_of(bytes, behind.start..open),
        arguments: list_of(bytes, inside),
    }
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
