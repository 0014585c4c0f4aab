//! Statements of a language whose blocks begin and end with words, in which a statement is a line and a variable is declared where it is assigned.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::lexing::{Assigned, Words, refuse_other_capitals, with_data};
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{
    Change, Choice, DatumNode, LoopKind, Module, Parameter, Routine, RoutineKind, Sight, Statement,
};
use crate::text::Name;

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

const MEND_IT: &str = "mend it: the program must run on the controller";

struct Parser<'f, 'a> {
    words: &'static Words,
    file: &'f TokenFile<'a>,
    at: usize,
    faults: &'f mut Vec<ProgramError>,
    /// The first one has the statements that stand in no other.
    routines: Vec<Routine>,
    assigned: Vec<Assigned>,
    /// The routine that is read.
    inside: usize,
}

/// Routines and data of a file. Statements in no routine are the program; without them it is a routine that stands in no other.
pub(crate) fn module_of(
    words: &'static Words,
    file: &TokenFile<'_>,
    faults: &mut Vec<ProgramError>,
) -> Module {
    let mut parser = Parser {
        words,
        file,
        at: 0,
        faults,
        routines: vec![routine(RoutineKind::Procedure, Name::empty(), 0..0)],
        assigned: Vec::new(),
        inside: 0,
    };
    let mut body = Vec::new();
    while parser.kind().is_some() {
        body.extend(parser.block(0));
        if parser.kind().is_some() {
            let at = parser.at..parser.at + 1;
            parser.fault(at, "nothing is open that it ends", MEND_IT);
            parser.at += 1;
        }
    }
    let mut parts = body.iter().map(whole_of);
    let is_program = !body.is_empty();
    if let Some(first) = parts.next() {
        let last = parts.next_back().unwrap_or_else(|| first.clone());
        parser.routines[0].statements = first.start..last.end;
    }
    parser.routines[0].body = body;
    let is_outer = |index: &usize| parser.routines[*index].kind == RoutineKind::Procedure;
    let outer: Vec<usize> = (1..parser.routines.len()).filter(is_outer).collect();
    // If statements call the only routine, its variables are also those of the program.
    let mut programs: BTreeSet<usize> = is_program.then_some(0).into_iter().collect();
    programs.extend(outer.first().filter(|_| outer.len() == 1));
    for (index, routine) in parser.routines.iter_mut().enumerate() {
        if routine.kind == RoutineKind::Procedure && (index > 0) == is_program {
            routine.kind = RoutineKind::Inner;
        }
    }
    let Parser {
        routines, assigned, ..
    } = parser;
    refuse_other_capitals(file, &routines, &assigned, faults);
    with_data(routines, assigned, &programs)
}

fn routine(kind: RoutineKind, name: Name, whole: Range<usize>) -> Routine {
    Routine {
        kind,
        sight: Sight::Everywhere,
        name,
        name_at: whole.start,
        parameters: Vec::new(),
        data: Vec::new(),
        body: Vec::new(),
        handlers: Vec::new(),
        statements: whole.clone(),
        whole,
    }
}

/// All tokens of a statement.
fn whole_of(statement: &Statement) -> Range<usize> {
    match statement {
        Statement::Branches { whole, .. } | Statement::Loop { whole, .. } => whole.clone(),
        Statement::Assignment { tokens, .. }
        | Statement::Call { tokens }
        | Statement::Leaves { tokens } => tokens.clone(),
        Statement::Label { at } => *at..at + 1,
    }
}

impl Parser<'_, '_> {
    fn fault(&mut self, tokens: Range<usize>, reason: &str, remedy: &str) {
        let (source, span) = (self.file.source, self.file.span(&tokens));
        note(self.faults, || {
            ProgramError::at(source, span, reason, remedy)
        });
    }

    fn kind(&self) -> Option<Kind> {
        self.file.tokens.get(self.at).map(|token| token.kind)
    }

    fn is(&self, word: &str) -> bool {
        self.kind() == Some(Kind::Word) && self.file.word(self.at) == word.as_bytes()
    }

    fn is_one(&self, words: &[&str]) -> bool {
        words.iter().any(|word| self.is(word))
    }

    fn ends_block(&self) -> bool {
        self.is(self.words.end) || self.is_one(&self.words.branch[1..])
    }

    fn takes(&mut self, word: &str) -> bool {
        let found = self.is(word);
        self.at += usize::from(found);
        found
    }

    /// Statements up to a word that ends or divides a block.
    fn block(&mut self, depth: usize) -> Vec<Statement> {
        let mut block = Vec::new();
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'\n' | b';') => self.at += 1,
                _ if self.ends_block() => break,
                _ => block.extend(self.statement(depth)),
            }
        }
        block
    }

    fn statement(&mut self, depth: usize) -> Option<Statement> {
        let start = self.at;
        let words = self.words;
        let [branch, ..] = words.branch;
        let mut routines = words.routines.iter();
        let routine = routines.find(|(word, _)| self.is(word));
        if depth >= DEEPEST && (routine.is_some() || self.is_one(&[branch, words.repeat])) {
            let reason = "blocks are nested deeper than 100";
            self.fault(
                start..start + 1,
                reason,
                "take the inner ones into a routine",
            );
            self.at = self.file.tokens.len();
            return None;
        }
        if let Some((_, kind)) = routine {
            self.routine(*kind, depth);
            return None;
        }
        if self.takes(branch) {
            return Some(self.branches(start, depth));
        }
        if self.takes(words.repeat) {
            let header = self.condition(start);
            let block = self.block(depth + 1);
            self.close(start);
            return Some(Statement::Loop {
                kind: LoopKind::While,
                header,
                block,
                whole: start..self.at,
            });
        }
        if self.takes(words.nothing) {
            return None;
        }
        let is_global = (self.is_one(&words.scopes)).then(|| self.is(words.scopes[0]));
        self.at += usize::from(is_global.is_some());
        self.simple(start, is_global)
    }

    /// An assignment, a call, or what leaves its block.
    fn simple(&mut self, start: usize, is_global: Option<bool>) -> Option<Statement> {
        let begin = self.at;
        let leaves = self.is_one(&self.words.leaves);
        let is_plain = self.is_one(self.words.plain);
        let tokens = begin..self.skip_statement(begin);
        if leaves {
            return Some(Statement::Leaves { tokens });
        }
        let mut places = tokens.clone();
        let assign = places.find(|at| self.file.tokens[*at].kind == Kind::Assign);
        let open = self.file.tokens[tokens.clone()]
            .iter()
            .position(|token| token.kind == Kind::Symbol(b'('));
        let assign = assign.filter(|assign| {
            open.is_none_or(|open| {
                *assign < begin + open || self.file.find(begin + open + 1..*assign, b')').is_some()
            })
        });
        if assign.is_some() || is_global.is_some() {
            let name = self.name(begin)?;
            self.assigned.push(Assigned {
                routine: self.inside,
                is_global,
                node: DatumNode {
                    change: Change::Variable,
                    sight: Sight::Module,
                    type_name: Name::empty(),
                    name,
                    name_at: begin,
                    tokens: start..tokens.end,
                    initial: None,
                    dimensions: None,
                    is_alone: true,
                },
            });
            return assign.map(|assign| Statement::Assignment { tokens, assign });
        }
        let open = tokens.start + open.unwrap_or_default();
        let names_it =
            matches!(open - tokens.start, 1 | 3) && self.file.tokens[begin].kind == Kind::Word;
        if is_plain
            || names_it && self.file.find(open + 1..tokens.end, b')') == Some(tokens.end - 1)
        {
            return Some(Statement::Call { tokens });
        }
        self.fault(tokens, "no statement is written so", MEND_IT);
        None
    }

    /// To the end of the line, or to a word that ends a block.
    fn skip_statement(&mut self, start: usize) -> usize {
        let mut open = 0_i64;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'\n' | b';') => break,
                Kind::Word if self.ends_block() => break,
                Kind::Symbol(b'(' | b'[' | b'{') => open += 1,
                Kind::Symbol(b')' | b']' | b'}') => open -= 1,
                Kind::OpenText => {
                    let reason = "the text is not closed on its line";
                    self.fault(self.at..self.at + 1, reason, "close it with \"");
                }
                _ => {}
            }
            self.at += 1;
        }
        if open != 0 {
            let reason = "a bracket of the statement is not closed, or nothing opens it";
            self.fault(start..self.at, reason, MEND_IT);
        }
        if self.at <= start {
            self.at = self.file.tokens.len().min(start + 1);
        }
        self.at
    }

    /// Returns the identifier, or notes that there is none.
    fn name(&mut self, at: usize) -> Option<Name> {
        let name = self.file.name(at);
        if name.is_none() {
            let reason = "a name of at most 64 characters is missing here";
            self.fault(
                at..at + 1,
                reason,
                "write the name, or shorten it everywhere",
            );
        }
        name
    }

    /// Tokens up to the colon of a header, which is taken.
    fn condition(&mut self, start: usize) -> Range<usize> {
        let begin = self.at;
        let tokens = &self.file.tokens;
        let ends = |at: &usize| tokens[*at].kind == Kind::Symbol(b'\n');
        let line = (begin..tokens.len()).find(ends).unwrap_or(tokens.len());
        let colon = self.file.find(begin..line, self.words.colon);
        if colon.is_none() {
            let remedy = format!("end it with {}", char::from(self.words.colon));
            self.fault(start..line, "nothing ends the header", &remedy);
        }
        self.at = colon.map_or(line, |colon| colon + 1);
        begin..colon.unwrap_or(line)
    }

    fn branches(&mut self, start: usize, depth: usize) -> Statement {
        let mut conditions = vec![self.condition(start)];
        let (mut blocks, mut choice) = (Vec::new(), Choice::AtMostOne);
        loop {
            blocks.push(self.block(depth + 1));
            let at = self.at;
            if choice == Choice::OneOfAll {
                break;
            } else if self.takes(self.words.branch[1]) {
                conditions.push(self.condition(at));
            } else if self.takes(self.words.branch[2]) {
                choice = Choice::OneOfAll;
                self.condition(at);
            } else {
                break;
            }
        }
        self.close(start);
        let whole = start..self.at;
        Statement::Branches {
            conditions,
            choice,
            blocks,
            whole,
        }
    }

    fn close(&mut self, start: usize) {
        let end = self.words.end;
        if !self.takes(end) {
            let reason = format!("no `{end}` ends it");
            self.fault(start..start + 1, &reason, &format!("end it with `{end}`"));
            // The text after it is not read.
            self.at = self.file.tokens.len();
        }
    }

    /// `def name(a,b):`.
    fn routine(&mut self, kind: RoutineKind, depth: usize) {
        let start = self.at;
        self.at += 2;
        let header = self.condition(start);
        let name = self.name(start + 1).unwrap_or_else(Name::empty);
        let commas = header
            .clone()
            .filter(|at| self.file.is(at - 1, b',') || self.file.is(at - 1, b'('));
        let parameters: Vec<Parameter> = (commas.filter_map(|at| self.file.name(at)))
            .map(|name| Parameter {
                name,
                changes: false,
                is_optional: false,
            })
            .collect();
        let is_inner = self.inside > 0 || !parameters.is_empty();
        let kind = match kind {
            RoutineKind::Procedure if is_inner => RoutineKind::Inner,
            kind => kind,
        };
        let own = self.routines.len();
        self.routines.push(routine(kind, name, start..start));
        let outer = std::mem::replace(&mut self.inside, own);
        while self.kind() == Some(Kind::Symbol(b'\n')) {
            self.at += 1;
        }
        let begin = self.at;
        let body = self.block(depth + 1);
        let is_blank = |at: &usize| !self.file.is(at - 1, b'\n');
        let end = (begin..=self.at).rev().find(is_blank).unwrap_or(begin);
        self.close(start);
        self.inside = outer;
        let routine = &mut self.routines[own];
        routine.name_at = start + 1;
        (routine.parameters, routine.body) = (parameters, body);
        (routine.statements, routine.whole) = (begin..end, start..self.at);
    }
}
