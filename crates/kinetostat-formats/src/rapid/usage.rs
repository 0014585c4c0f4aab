//! What statements do to data: which are assigned, which values something rests on.

use std::ops::Range;

use crate::rapid::functions::leaves_arguments;
use crate::rapid::lex::Kind;
use crate::rapid::symbols::{Meaning, Symbols};
use crate::rapid::table::{Ends, motion_row, row};
use crate::rapid::tree::{Change, RoutineKind, Statement, TokenFile};
use crate::table::Treatment;
use crate::text::name::Name;

/// Instructions that are carried and change the numbers that they are given.
const CHANGE_THEIRS: [&str; 3] = ["Clear", "Decr", "Incr"];

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
        notes.statements(&home.routine.handlers);
    }
    // What a declaration's first value rests on.
    for index in 0..symbols.data.len() {
        let node = symbols.data[index].node;
        let file = symbols.data[index].file;
        let Some(initial) = &node.initial else {
            continue;
        };
        for at in initial.clone() {
            let token = files[file].tokens[at];
            if token.kind == Kind::Word
                && let Some(name) = Name::of(files[file].word(at))
            {
                symbols.keep_everywhere(&name);
            }
        }
    }
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
                Statement::Assignment { tokens, assign } => {
                    self.assign(tokens.start, false);
                    let is_tip = (self.file.word(tokens.start + 2)).eq_ignore_ascii_case(b"v_tcp");
                    if let (false, Some(index)) = (is_tip, self.datum(tokens.start)) {
                        self.symbols.data[index].is_assigned_beside_tip = true;
                    }
                    self.keep(tokens.start + 1..*assign);
                    self.functions(tokens.clone());
                    self.keep(*assign..tokens.end);
                }
                Statement::Call { tokens } => self.call(tokens),
                Statement::Branches {
                    conditions, blocks, ..
                } => {
                    for condition in conditions {
                        self.keep(condition.clone());
                        self.functions(condition.clone());
                    }
                    for block in blocks {
                        self.statements(block);
                    }
                }
                Statement::Loop { header, block } => {
                    self.keep(header.clone());
                    self.functions(header.clone());
                    self.statements(block);
                }
                Statement::Leaves { tokens } => {
                    self.keep(tokens.clone());
                    self.functions(tokens.clone());
                }
                Statement::Label { .. } => {}
            }
        }
    }

    fn datum(&self, at: usize) -> Option<usize> {
        let is_word = self.file.tokens.get(at)?.kind == Kind::Word;
        let name = is_word.then(|| Name::of(self.file.word(at)))??;
        match self.symbols.meaning(self.routine, &name)? {
            Meaning::Datum(index) => Some(index),
            Meaning::Parameter => None,
        }
    }

    /// An assignment, or something else by which a datum may change.
    fn assign(&mut self, at: usize, otherwise: bool) {
        if let Some(index) = self.datum(at) {
            let is_trap = self.symbols.routines[self.routine].routine.kind == RoutineKind::Trap;
            let datum = &mut self.symbols.data[index];
            if datum.node.change != Change::Constant {
                let line = self
                    .file
                    .source
                    .line_of(self.file.span(&(at..at + 1)).start);
                let is_first = datum.assigned.is_none();
                datum.assigned.get_or_insert((self.file.index, line));
                datum.is_changed_otherwise |= otherwise || is_trap;
                match is_first {
                    true => datum.assigned_in = Some(self.routine),
                    false => {
                        let routine = self.routine;
                        datum.assigned_in = datum.assigned_in.filter(|known| *known == routine);
                    }
                }
            }
        }
    }

    /// Something rests on the values of the names in these tokens.
    fn keep(&mut self, tokens: Range<usize>) {
        for at in tokens {
            if let Some(index) = self.datum(at) {
                self.symbols.data[index].keeps_value = true;
            }
        }
    }

    /// What functions in an expression may change: own ones with parameters for it, and those that are not known.
    fn functions(&mut self, tokens: Range<usize>) {
        for at in tokens.clone() {
            let opens = self.kind(at + 1) == Some(Kind::Symbol(b'(')) && at + 1 < tokens.end;
            if self.kind(at) != Some(Kind::Word) || !opens {
                continue;
            }
            let name = Name::of(self.file.word(at));
            let changes = name.is_none_or(|name| {
                let own = self.symbols.routine(self.routine, &name);
                own.map_or_else(|| !leaves_arguments(&name), |own| self.has_changing(own))
            });
            if changes {
                self.assign_arguments(at + 2..tokens.end);
            }
        }
    }

    /// Whether a routine has a parameter by which it may change what is given.
    fn has_changing(&self, routine: usize) -> bool {
        let parameters = &self.symbols.routines[routine].routine.parameters;
        parameters.iter().any(|parameter| parameter.changes)
    }

    /// Up to the end, or to the bracket that was open before.
    fn assign_arguments(&mut self, tokens: Range<usize>) {
        let mut open = 0_usize;
        for at in tokens {
            match self.kind(at) {
                Some(Kind::Symbol(b'(' | b'[')) => open += 1,
                Some(Kind::Symbol(b')' | b']')) if open == 0 => return,
                Some(Kind::Symbol(b')' | b']')) => open -= 1,
                // What stands deeper is computed with.
                _ if open == 0 && self.is_whole_argument(at) => self.assign(at, true),
                _ => {}
            }
        }
    }

    fn kind(&self, at: usize) -> Option<Kind> {
        self.file.tokens.get(at).map(|token| token.kind)
    }

    fn call(&mut self, tokens: &Range<usize>) {
        self.functions(tokens.start + 1..tokens.end);
        let Some(name) = Name::of(self.file.word(tokens.start)) else {
            return self.keep(tokens.clone());
        };
        if let Some(motion) = motion_row(&name) {
            let targets = match motion.ends {
                Ends::Circular => 2,
                _ => 1,
            };
            return self.motion(tokens.start + 1..tokens.end, targets);
        }
        self.keep(tokens.start + 1..tokens.end);
        let changes = match self.symbols.routine(self.routine, &name) {
            Some(index) => self.has_changing(index),
            // Of an instruction that is refused nothing else is to be said.
            None => row(&name).is_none_or(|row| {
                row.treatment == Treatment::Understood || CHANGE_THEIRS.contains(&row.name)
            }),
        };
        if changes {
            self.assign_arguments(tokens.start + 1..tokens.end);
        }
    }

    /// A name between commas: what a routine could change.
    fn is_whole_argument(&self, at: usize) -> bool {
        let is_after = |kind| {
            matches!(
                kind,
                Some(Kind::Symbol(b',' | b';' | b')' | b'\\' | b'{' | b'.'))
            )
        };
        let is_before = |kind| {
            matches!(
                kind,
                Some(Kind::Symbol(b',' | b'(' | b'%') | Kind::Word | Kind::Assign)
            )
        };
        let [before, own, after] = [at - 1, at, at + 1].map(|at| self.kind(at));
        own == Some(Kind::Word) && is_after(after) && is_before(before)
    }

    /// The ends of a motion are followed by the writer; what an offset begins at is kept.
    fn motion(&mut self, tokens: Range<usize>, targets: usize) {
        let (mut open, mut argument) = (0_usize, 0);
        // `MoveL\Conc, p1`: what begins with a backslash is no argument in order.
        let mut begins = true;
        let mut ordered = false;
        for at in tokens {
            let kind = self.file.tokens[at].kind;
            if std::mem::take(&mut begins) {
                ordered = kind != Kind::Symbol(b'\\');
            }
            match kind {
                Kind::Symbol(b'(' | b'[' | b'{') => open += 1,
                Kind::Symbol(b')' | b']' | b'}') => open = open.saturating_sub(1),
                Kind::Symbol(b',') if open == 0 => {
                    argument += usize::from(ordered);
                    begins = true;
                }
                Kind::Word if argument >= targets || open > 0 => self.keep(at..at + 1),
                _ => {}
            }
        }
    }
}
