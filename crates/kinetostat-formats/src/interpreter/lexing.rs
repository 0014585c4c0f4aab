//! Tokens and names of a language in which a statement is a line and a variable is declared where it is assigned; blanks and comments have
//! no token.
//!
//! A line that ends outside brackets is a token: it ends the statement.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::{Kind, Token, TokenFile};
use crate::interpreter::tree::{DatumNode, Leave, Module, Routine, RoutineKind};
use crate::text::Name;
use crate::text::source::beginning;

/// Marks of a language.
pub(crate) struct Marks {
    /// Byte before a comment that ends with its line.
    pub comment: u8,
    /// Byte before a line that does not belong to the program.
    pub aside: u8,
}

/// The tokens of a file shorter than 4 GiB.
pub(crate) fn tokens_of(marks: &Marks, bytes: &[u8]) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::with_capacity(bytes.len() / 3);
    let mut at = beginning(bytes);
    let (mut open, mut begins_line) = (0_usize, true);
    while let Some(first) = bytes.get(at) {
        let rest = &bytes[at..];
        let run =
            |is_part: &dyn Fn(u8) -> bool| rest.iter().take_while(|byte| is_part(**byte)).count();
        let line = || run(&|byte| byte != b'\n');
        let (kind, length) = match first {
            b'\n' => ((open == 0).then_some(Kind::Symbol(b'\n')), 1),
            mark if *mark == marks.comment => (None, line()),
            mark if *mark == marks.aside && begins_line => (None, line()),
            byte if byte.is_ascii_whitespace() || *byte == 0x1a => (None, 1),
            b'0'..=b'9' | b'.' => match number(rest) {
                0 => (Some(Kind::Symbol(*first)), 1),
                length => (Some(Kind::Number), length),
            },
            b'"' => match rest[1..line()].iter().position(|byte| *byte == b'"') {
                Some(close) => (Some(Kind::Text), close + 2),
                None => (Some(Kind::OpenText), line()),
            },
            byte if is_part(*byte) => (Some(Kind::Word), run(&is_part)),
            b'=' => (Some(equals(&tokens, at, rest)), 1),
            byte => (Some(Kind::Symbol(*byte)), 1),
        };
        match first {
            b'(' | b'[' | b'{' => open += 1,
            b')' | b']' | b'}' => open = open.saturating_sub(1),
            _ => {}
        }
        begins_line = *first == b'\n' || begins_line && kind.is_none();
        if let Some(kind) = kind {
            tokens.push(Token::new(kind, &(at..at + length)));
        }
        at += length.max(1);
    }
    tokens
}

fn is_part(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 0x80
}

/// The token of `=`: a part of `==`, `<=`, `>=` or `!=`, or an assignment.
pub(crate) fn equals(tokens: &[Token], at: usize, rest: &[u8]) -> Kind {
    let before = tokens.last().filter(|token| token.bytes().end == at);
    let compares =
        before.is_some_and(|token| matches!(token.kind, Kind::Symbol(b'=' | b'<' | b'>' | b'!')));
    match compares || rest.get(1) == Some(&b'=') {
        true => Kind::Symbol(b'='),
        false => Kind::Assign,
    }
}

/// Bytes of the number that begins here; 0 where none does.
pub(crate) fn number(text: &[u8]) -> usize {
    let digits = |from: usize| {
        text[from..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    };
    let whole = digits(0);
    let fraction = match text.get(whole) {
        Some(b'.') => 1 + digits(whole + 1),
        _ => 0,
    };
    if whole + fraction < 2 && whole == 0 {
        return 0;
    }
    let mantissa = whole + fraction;
    let sign = usize::from(matches!(text.get(mantissa + 1), Some(b'+' | b'-')));
    match (text.get(mantissa), text.get(mantissa + 1 + sign)) {
        (Some(b'e' | b'E'), Some(b'0'..=b'9')) => mantissa + 1 + sign + digits(mantissa + 1 + sign),
        _ => mantissa,
    }
}

/// The words of a language.
pub(crate) struct Words {
    pub marks: Marks,
    /// Word before a routine, and its kind if it is not nested and has no parameters.
    pub routines: &'static [(&'static str, RoutineKind)],
    /// Words before the first condition of a branch, a further one, and the alternative.
    pub branch: [&'static str; 3],
    /// Word before a loop with its condition.
    pub repeat: &'static str,
    /// Word after each block.
    pub end: &'static str,
    /// Byte after a header.
    pub colon: u8,
    /// Words before a global name, and before one of its routine.
    pub scopes: [&'static str; 2],
    /// Words of return, loop exit, next pass, and program end.
    pub leaves: [&'static str; 4],
    /// Words before a statement that is neither a call nor an assignment.
    pub plain: &'static [&'static str],
    /// A statement that does nothing.
    pub nothing: &'static str,
}

impl Words {
    /// Effect of a statement that leaves its block.
    pub(crate) fn leave(&self, file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        let word = file.word(tokens.start);
        let value = tokens.start + 1..tokens.end;
        match self.leaves.iter().position(|own| word == own.as_bytes()) {
            Some(1) => Leave::Breaks,
            Some(2) => Leave::Continues,
            Some(3) => Leave::Ends,
            _ => Leave::Returns((!value.is_empty()).then_some(value)),
        }
    }
}

/// A name that a statement of a routine assigns.
pub(crate) struct Assigned {
    /// An index of the routines.
    pub routine: usize,
    /// Said before it: all routines see it, or its own alone.
    pub is_global: Option<bool>,
    pub node: DatumNode,
}

/// Letters of either case are one name to the run: names that differ in their case alone are refused.
pub(crate) fn refuse_other_capitals(
    file: &TokenFile<'_>,
    routines: &[Routine],
    assigned: &[Assigned],
    faults: &mut Vec<ProgramError>,
) {
    let assigned = assigned.iter().map(|own| own.node.name_at);
    // The first routine is that of the statements that stand in no other.
    let headers = routines.iter().skip(1);
    let headers = headers.flat_map(|own| own.name_at..own.statements.start);
    let declared = assigned.chain(headers);
    let mut known: BTreeMap<Name, usize> = BTreeMap::new();
    for at in declared {
        if let Some(name) = file.name(at) {
            known.entry(name).or_insert(at);
        }
    }
    for at in 0..file.tokens.len() {
        let Some(name) = file.name(at) else { continue };
        if (known.get(&name)).is_some_and(|first| file.word(*first) != file.word(at)) {
            known.remove(&name);
            let span = file.span(&(at..at + 1));
            let reason = "another name has the same letters, in capitals or not: the two are not told apart here";
            note(faults, || {
                ProgramError::at(file.source, span, reason, "rename one of them")
            });
        }
    }
}

/// Routines with their own data, and the data that all of them see: those of the program, and those of which it is said. A name of which
/// nothing is said is that of the program, where it has one.
pub(crate) fn with_data(
    mut routines: Vec<Routine>,
    assigned: Vec<Assigned>,
    programs: &BTreeSet<usize>,
) -> Module {
    let is_seen = |own: &&Assigned| own.is_global.unwrap_or(programs.contains(&own.routine));
    let seen: BTreeSet<Name> = (assigned.iter().filter(is_seen))
        .map(|own| own.node.name)
        .collect();
    let mut known = BTreeSet::new();
    let mut data = Vec::new();
    for own in assigned {
        let name = own.node.name;
        let routine = &mut routines[own.routine];
        if routine.parameters.iter().any(|own| own.name == name) {
            continue;
        }
        let is_local = own.is_global == Some(false) || !seen.contains(&name);
        let (home, list) = match is_local {
            true => (Some(own.routine), &mut routine.data),
            false => (None, &mut data),
        };
        if known.insert((home, name)) {
            list.push(own.node);
        }
    }
    Module { data, routines }
}

/// The names of the modules of files, and which routine is the program: the only one that may be one and that no other names.
pub(crate) fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    modules: &'p [Module],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    let mut mentions: BTreeMap<Name, usize> = BTreeMap::new();
    for (file, content) in files.iter().zip(modules) {
        let module = all.add_module(file.index, None);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        // The parser has noted faults of names; the first routine has the statements outside all others.
        let is_named =
            |(index, own): &(usize, &'p Routine)| *index == 0 || own.name != Name::empty();
        let routines = content.routines.iter().enumerate().filter(is_named);
        for (_, routine) in routines {
            all.add_routine(file, module, routine, faults);
        }
        for name in (0..file.tokens.len()).filter_map(|at| file.name(at)) {
            *mentions.entry(name).or_default() += 1;
        }
    }
    let is_program = |index: &usize| {
        let routine = all.routines[*index].routine;
        // The count includes the routine's own header.
        let is_called = mentions.get(&routine.name).is_some_and(|count| *count > 1);
        routine.kind == RoutineKind::Procedure && !is_called
    };
    let mut programs = (0..all.routines.len()).filter(is_program);
    all.main = match (programs.next(), programs.next()) {
        (Some(index), None) => Some(index),
        _ => None,
    };
    all
}
