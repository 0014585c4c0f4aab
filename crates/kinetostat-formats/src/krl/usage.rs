//! What statements do to data: which are assigned, which values something rests on.

use std::ops::Range;

use crate::krl::aggregate::literal_index;
use crate::krl::assigned_frames::{Assignment, MOST};
use crate::krl::lex::{Kind, TokenFile};
use crate::krl::role::Role;
use crate::krl::symbols::{Meaning, Symbols};
use crate::krl::table::{Ends, motion_row, only_reads};
use crate::krl::tree::Statement;
use crate::text::name::Name;

/// Notes it in the symbols, for all statements of all routines.
pub(crate) fn note_usage(files: &[TokenFile<'_>], symbols: &mut Symbols<'_>) {
    for routine in 0..symbols.routines.len() {
        let home = symbols.routines[routine];
        let mut notes = Notes {
            file: &files[home.file],
            symbols: &mut *symbols,
            routine,
        };
        notes.statements(&home.routine.body);
    }
}

/// A name, or an element of an array, and the tokens it is written with. An index that is no literal number is none.
pub(crate) fn place_of(file: &TokenFile<'_>, at: usize, end: usize) -> (Range<usize>, Option<u32>) {
    if !file.is(at + 1, b'[') || at + 1 >= end {
        return (at..at + 1, Some(0));
    }
    let close = file.find(at + 2..end, b']').map_or(end, |close| close + 1);
    (at..close, literal_index(file, at + 1..close))
}

/// The places of the ends of a motion, by tokens, with what is added to them (`:{...}`).
pub(crate) fn ends_of(
    file: &TokenFile<'_>,
    tokens: &Range<usize>,
    ends: Ends,
) -> Vec<Range<usize>> {
    let count = match ends {
        Ends::Circular => 2,
        Ends::Joint | Ends::Linear | Ends::Step | Ends::JointStep => 1,
    };
    let mut found = Vec::with_capacity(count);
    let mut start = tokens.start + 1;
    for _ in 0..count {
        let mut at = start;
        let mut open = 0_usize;
        while at < tokens.end {
            match file.tokens[at].kind {
                Kind::Symbol(b'{' | b'[' | b'(') => open += 1,
                Kind::Symbol(b'}' | b']' | b')') => open = open.saturating_sub(1),
                Kind::Symbol(b',') if open == 0 => break,
                // In whose axes a step is: #BASE, #TOOL.
                Kind::Symbol(b'#') if open == 0 && at > start => break,
                // A word behind a whole value begins what is behind the end: C_DIS, WITH.
                Kind::Word
                    if open == 0
                        && at > start
                        && !file.is(at - 1, b':')
                        && !file.is(at - 1, b'.') =>
                {
                    break;
                }
                _ => {}
            }
            at += 1;
        }
        found.push(start..at);
        start = at + usize::from(file.is(at, b','));
    }
    found
}

struct Notes<'n, 's, 'p, 'f> {
    file: &'n TokenFile<'f>,
    symbols: &'s mut Symbols<'p>,
    routine: usize,
}

impl Notes<'_, '_, '_, '_> {
    fn statements(&mut self, block: &[Statement]) {
        for statement in block {
            match statement {
                Statement::Simple(line) | Statement::Leaves(line) => self.line(*line),
                Statement::Branches { header, blocks, .. } => {
                    self.line(*header);
                    for block in blocks {
                        self.statements(block);
                    }
                }
                Statement::Loop { header, block, .. } => {
                    self.line(*header);
                    self.statements(block);
                }
                Statement::Label | Statement::Exit => {}
            }
        }
    }

    fn line(&mut self, line: usize) {
        let tokens = self.file.lines[line].tokens.clone();
        let first = self.file.name(tokens.start);
        if let Some(row) = first.as_ref().and_then(motion_row) {
            let mut rest = tokens.end;
            for end in ends_of(self.file, &tokens, row.ends) {
                rest = end.end;
                // The end itself is followed by the writer, unless something is added to it.
                let (place, _) = place_of(self.file, end.start, end.end);
                if place != end {
                    self.keep(end);
                }
            }
            return self.keep(rest..tokens.end);
        }
        let is_for = first.is_some_and(|name| name.is("FOR"));
        let assigned = tokens.start + usize::from(is_for);
        match self.file.assign(&(assigned..tokens.end)) {
            Some(equals)
                if is_for
                    || first.is_none_or(|name| {
                        !["IF", "WHILE", "UNTIL", "SWITCH", "WAIT"]
                            .iter()
                            .any(|word| name.is(word))
                    }) =>
            {
                self.assign(assigned, equals, is_for);
                self.frame(assigned, equals, Some(equals + 1..tokens.end));
                let (place, _) = place_of(self.file, assigned, equals);
                self.keep(place.start + 1..equals);
                self.keep(equals..tokens.end);
                self.calls(equals..tokens.end);
            }
            _ => {
                self.keep(tokens.start + 1..tokens.end);
                self.calls(tokens);
            }
        }
    }

    fn datum(&self, at: usize) -> Option<usize> {
        match self.symbols.meaning(self.routine, &self.file.name(at)?)? {
            Meaning::Datum(index) => Some(index),
            Meaning::Parameter => None,
        }
    }

    fn assign(&mut self, at: usize, end: usize, by_call: bool) {
        let Some(index) = self.datum(at) else {
            return;
        };
        let here = (
            self.file.index,
            self.file
                .source
                .line_of(self.file.span(&(at..at + 1)).start),
        );
        let (place, element) = place_of(self.file, at, end);
        let datum = &mut self.symbols.data[index];
        datum.assignments += 1;
        let first = *datum.assigned_in.get_or_insert(self.routine);
        datum.is_changed_by_calls |= by_call || first != self.routine;
        if self.file.is(at + 1, b'.') && end == at + 3 {
            datum.parts_assigned.extend(self.file.name(at + 2));
        }
        match element {
            Some(element) if place.len() > 1 => {
                match datum.stated.get_mut(&element) {
                    Some(stated) => stated.assigned.get_or_insert(here),
                    None => datum.elements_assigned.entry(element).or_insert(here),
                };
            }
            _ => {
                datum.assigned.get_or_insert(here);
            }
        }
    }

    /// Notes what changes an element of TOOL_DATA or BASE_DATA, declared or not.
    fn frame(&mut self, at: usize, end: usize, value: Option<Range<usize>>) {
        let Some(role) = (self.file.name(at)).and_then(|name| Role::of_array(&name)) else {
            return;
        };
        let (place, element) = place_of(self.file, at, end);
        let is_whole = place == (at..end);
        let span = self.file.span(&(at..at + 1));
        let number = element.filter(|_| place.len() > 1);
        let all = self.symbols.frames_assigned.entry((role, number));
        let all = all.or_default();
        let is_last = all.len() + 1 == MOST;
        if all.len() < MOST {
            all.push(Assignment {
                routine: self.routine,
                line: self.file.source.line_of(span.start),
                value: value.filter(|_| is_whole && !is_last && number.is_some()),
            });
        }
    }

    /// Something rests on the values of the names in these tokens.
    fn keep(&mut self, tokens: Range<usize>) {
        for at in tokens.clone() {
            if let Some(index) = self.datum(at) {
                let (_, element) = place_of(self.file, at, tokens.end);
                for (of, stated) in &mut self.symbols.data[index].stated {
                    stated.keeps_value |= element.is_none_or(|element| element == *of);
                }
            }
        }
    }

    /// What routines that are called may change.
    fn calls(&mut self, tokens: Range<usize>) {
        for at in tokens.clone() {
            let called = match self.file.name(at) {
                Some(name) if self.file.is(at + 1, b'(') && !name.is("BAS") => name,
                _ => continue,
            };
            let close = self
                .file
                .find(at + 2..tokens.end, b')')
                .unwrap_or(tokens.end);
            let mut start = at + 2;
            let mut number = 0;
            while start < close {
                let end = self.file.find(start..close, b',').unwrap_or(close);
                let (place, _) = place_of(self.file, start, end);
                if place == (start..end) && self.changes(&called, number) {
                    self.assign(start, end, true);
                    self.frame(start, end, None);
                }
                number += 1;
                start = end + 1;
            }
        }
    }

    /// Whether a routine may change one of its arguments.
    fn changes(&self, called: &Name, argument: usize) -> bool {
        match self.symbols.routine(self.routine, called) {
            Some(index) => {
                let parameters = &self.symbols.routines[index].routine.parameters;
                parameters
                    .get(argument)
                    .is_none_or(|parameter| parameter.changes)
            }
            None => !only_reads(called),
        }
    }
}
