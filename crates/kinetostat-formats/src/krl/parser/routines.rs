//! Lines of a file: routines, data lists, declarations, and the values that data lists state.

use std::ops::Range;

use crate::error::ProgramError;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Change, DatumNode, Parameter, Preset, Routine, RoutineKind, Sight};
use crate::krl::expression::literal_index;
use crate::krl::lex::assignment;
use crate::krl::parser::blocks::{Content, Parser};

/// Types that need no DECL.
const TYPES: [&str; 11] = [
    "INT", "REAL", "BOOL", "CHAR", "FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS",
];

/// The content of a file.
pub(crate) fn content_of(file: &TokenFile<'_>, faults: &mut Vec<ProgramError>) -> Content {
    let mut parser = Parser {
        file,
        faults,
        content: Content::default(),
        routine: None,
        blocks: Vec::new(),
        in_list: false,
        lost: false,
        outside: false,
    };
    for line in 0..file.lines.len() {
        parser.line(line);
    }
    parser.end_of_file();
    parser.content
}

impl Parser<'_, '_> {
    fn line(&mut self, line: usize) {
        let tokens = self.file.lines[line].tokens.clone();
        if tokens.is_empty() {
            return;
        }
        let word = |offset: usize| {
            let at = tokens.start + offset;
            (at < tokens.end).then(|| self.file.name(at)).flatten()
        };
        let is = |offset: usize, capitals: &str| word(offset).is_some_and(|name| name.is(capitals));
        let second = usize::from(is(0, "GLOBAL"));
        if is(second, "DEF") || is(second, "DEFFCT") {
            return self.begin_routine(&tokens, tokens.start + second, is(second, "DEFFCT"));
        }
        if is(0, "DEFDAT") {
            self.in_list = true;
            self.content.list = word(1);
            return;
        }
        if is(0, "END") || is(0, "ENDFCT") {
            return self.end_routine(&tokens);
        }
        if is(0, "ENDDAT") {
            self.in_list = false;
            return;
        }
        let declares = is(0, "DECL")
            || is(0, "CONST")
            || (is(0, "GLOBAL") && !is(1, "INTERRUPT"))
            || (word(1).is_some() && TYPES.iter().any(|capitals| is(0, capitals)));
        if declares {
            return self.declaration(&tokens);
        }
        match self.routine.is_some() {
            true => {
                if let Some(routine) = &mut self.routine {
                    let own = &mut routine.statements;
                    let is_first = own.start == own.end;
                    *own = if is_first { tokens.start } else { own.start }..tokens.end;
                }
                self.statement(&tokens);
            }
            false if self.in_list => self.preset(&tokens),
            false if self.outside => {}
            false => {
                // Once for a file: nothing of it is where it must be.
                self.outside = true;
                self.fault(
                    &tokens,
                    "it stands in no routine and no data list",
                    "begin the file with DEF or DEFDAT, as the controller saves it",
                );
            }
        }
    }

    fn begin_routine(&mut self, tokens: &Range<usize>, def: usize, is_function: bool) {
        if let Some(routine) = &self.routine {
            let open = routine.name_at..routine.name_at + 1;
            self.fault(&open, "the routine has no end", "end it with END or ENDFCT");
            self.close();
        }
        // A function has its type before its name, with `[]` where it is an array.
        let mut name_at = def + 1 + usize::from(is_function);
        while self.file.is(name_at, b'[') || self.file.is(name_at, b']') {
            name_at += 1;
        }
        let name = (name_at < tokens.end)
            .then(|| self.file.name(name_at))
            .flatten();
        let Some(name) = name else {
            return self.fault(tokens, "the routine has no name", "write DEF name()");
        };
        let closes = |at: usize| self.file.is(at, b')');
        if !self.file.is(name_at + 1, b'(') || !(name_at + 1..tokens.end).any(closes) {
            let reason = "the name of the routine has no brackets behind it";
            self.fault(tokens, reason, "write DEF name()");
        }
        let mut parameters = Vec::new();
        for at in name_at + 1..tokens.end {
            let separated = self.file.is(at - 1, b'(') || self.file.is(at - 1, b',');
            if let (true, Some(name)) = (separated, self.file.name(at)) {
                let mut rest = at + 1;
                while rest < tokens.end && !self.file.is(rest, b',') && !self.file.is(rest, b':') {
                    rest += 1;
                }
                let is_in = self.file.is(rest, b':')
                    && self.file.word(rest + 1).eq_ignore_ascii_case(b"IN");
                parameters.push(Parameter {
                    name,
                    changes: !is_in,
                    is_optional: false,
                });
            }
        }
        self.lost = false;
        self.routine = Some(Routine {
            kind: match is_function {
                true => RoutineKind::Function,
                false => RoutineKind::Procedure,
            },
            sight: match def > tokens.start {
                true => Sight::Everywhere,
                false => Sight::Module,
            },
            name,
            name_at,
            parameters,
            data: Vec::new(),
            body: Vec::new(),
            handlers: Vec::new(),
            whole: tokens.clone(),
            statements: tokens.end..tokens.end,
        });
    }

    fn end_routine(&mut self, tokens: &Range<usize>) {
        match self.routine.is_some() {
            true => {
                if let Some(routine) = &mut self.routine {
                    routine.whole.end = tokens.end;
                }
                self.close();
            }
            false => self.fault(
                tokens,
                "no routine is open here",
                "remove it, or begin the routine with DEF",
            ),
        }
    }

    fn end_of_file(&mut self) {
        if let Some(routine) = &self.routine {
            let open = routine.name_at..routine.name_at + 1;
            self.fault(&open, "the routine has no end", "end it with END or ENDFCT");
            self.close();
        }
    }

    /// `[GLOBAL] [DECL] [CONST] type name[3]=value, name`.
    pub(super) fn declaration(&mut self, tokens: &Range<usize>) {
        let mut at = tokens.start;
        let (mut is_global, mut is_constant, mut is_other) = (false, false, false);
        while let Some(name) = (at < tokens.end).then(|| self.file.name(at)).flatten() {
            is_global |= name.is("GLOBAL");
            is_constant |= name.is("CONST");
            is_other |= ["STRUC", "ENUM", "SIGNAL", "EXT", "EXTFCT"]
                .iter()
                .any(|word| name.is(word));
            if !["GLOBAL", "DECL", "CONST"].iter().any(|word| name.is(word)) {
                break;
            }
            at += 1;
        }
        if is_other {
            return;
        }
        let Some(type_name) = (at < tokens.end).then(|| self.file.name(at)).flatten() else {
            return self.fault(tokens, "nothing is declared here", "write DECL type name");
        };
        let mut found = Vec::new();
        let mut start = at + 1;
        while start < tokens.end {
            let end = self
                .file
                .find(start..tokens.end, b',')
                .unwrap_or(tokens.end);
            let Some(name) = self.file.name(start) else {
                return self.fault(
                    tokens,
                    "a declared name is missing or longer than 24 characters",
                    "write DECL type name",
                );
            };
            let assign = assignment(self.file, &(start..end));
            let close = self.file.is(start + 1, b'[').then(|| {
                let close = self.file.find(start + 2..end, b']');
                start + 2..close.unwrap_or(end)
            });
            found.push(DatumNode {
                change: match is_constant {
                    true => Change::Constant,
                    false => Change::Variable,
                },
                sight: match is_global {
                    true => Sight::Everywhere,
                    false => Sight::Module,
                },
                type_name,
                name,
                name_at: start,
                tokens: tokens.clone(),
                initial: assign.map(|assign| assign + 1..end),
                dimensions: close.filter(|sizes| !sizes.is_empty()),
                is_alone: start == at + 1 && end == tokens.end,
            });
            start = end + 1;
        }
        if found.is_empty() {
            return self.fault(tokens, "nothing is declared here", "write DECL type name");
        }
        match &mut self.routine {
            Some(routine) => routine.data.extend(found),
            None => self.content.data.extend(found),
        }
    }

    /// `name[3]=value` in a data list.
    pub(super) fn preset(&mut self, tokens: &Range<usize>) {
        let Some(name) = self.file.name(tokens.start) else {
            return;
        };
        let Some(assign) = assignment(self.file, tokens) else {
            return;
        };
        if let Some(index) = literal_index(self.file, tokens.start + 1..assign) {
            self.content.presets.push(Preset {
                name,
                name_at: tokens.start,
                index: index as usize,
                tokens: tokens.clone(),
                value: assign + 1..tokens.end,
            });
        }
    }
}
