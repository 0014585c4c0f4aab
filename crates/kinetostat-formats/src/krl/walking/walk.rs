//! Routines, their blocks and statements in their order.

use std::ops::Range;

use crate::calls::Holds;
use crate::krl::role::Role;
use crate::krl::state::{State, Things};
use crate::krl::table::{OPERATORS, motion_row, row};
use crate::krl::tree::{Least, Statement};
use crate::krl::walking::walker::{DEEPEST, Now, Walker};
use crate::model::motion::Runs;

impl<'p> Walker<'_, 'p> {
    /// Walks a routine and what it calls, then all that nothing calls.
    pub(crate) fn walk(&mut self, main: Option<usize>) {
        for routine in main.into_iter().chain(0..self.summaries.len()) {
            if !self.summaries[routine].begun {
                // What no routine here calls may run before what was walked.
                self.settings.given.ends.clear();
                self.routine(routine, 0);
            }
        }
    }

    fn routine(&mut self, index: usize, depth: usize) {
        let home = self.values.symbols.routines[index];
        let runs = match home.routine.jumps {
            true => Runs::Repeatedly,
            false => Runs::Once,
        };
        let now = Now {
            routine: index,
            runs,
            is_certain: depth == 0 || self.is_certain(),
            left: None,
            spline: None,
            along_next: None,
            depth,
        };
        let outer = std::mem::replace(&mut self.now, now);
        self.summaries[index].begun = true;
        let mut state = self.block(&home.routine.body, State::ENTRY);
        if let Some(left) = self.now.left {
            state = state.merged(left);
        }
        self.summaries[index].leaves = Some(state);
        self.finished.push(index);
        self.now = outer;
    }

    /// Whether a statement here runs once, on no condition.
    pub(super) fn is_certain(&self) -> bool {
        self.now.is_certain && self.now.runs == Runs::Once
    }

    fn block(&mut self, statements: &'p [Statement], mut state: State) -> State {
        let runs = self.now.runs;
        for statement in statements {
            state = self.statement(statement, state);
            if self.now.left.is_some() {
                // What is behind a RETURN in a branch runs on a condition.
                self.now.runs = Runs::OnCondition.max(self.now.runs);
            }
        }
        self.now.runs = runs;
        state
    }

    fn statement(&mut self, statement: &'p Statement, state: State) -> State {
        let tokens = |walker: &Self, line: usize| walker.file().lines[line].tokens.clone();
        match statement {
            Statement::Simple(line) => self.simple(*line, state),
            Statement::Label => State::UNKNOWN,
            Statement::Exit => state,
            Statement::Leaves(line) => {
                let state = self.functions(tokens(self, *line), state);
                let at = tokens(self, *line).start;
                // A jump leads to a label of the routine, where nothing is known.
                if self.file().name(at).is_some_and(|name| name.is("GOTO")) {
                    return state;
                }
                let left = self.now.left.map_or(state, |left| left.merged(state));
                self.now.left = Some(left);
                state
            }
            Statement::Branches {
                header,
                complete,
                blocks,
            } => {
                let state = self.functions(tokens(self, *header), state);
                self.now.depth += 1;
                let runs = self.now.runs;
                self.now.runs = runs.max(Runs::OnCondition);
                let mut after = (!complete).then_some(state);
                for block in blocks {
                    let end = self.block(block, state);
                    after = Some(after.map_or(end, |after| after.merged(end)));
                }
                self.now.runs = runs;
                self.now.depth -= 1;
                after.unwrap_or(state)
            }
            Statement::Loop {
                header,
                least,
                block,
            } => {
                let state = self.functions(tokens(self, *header), state);
                let runs = self.now.runs;
                self.now.runs = runs.max(Runs::Repeatedly);
                let things = self.touched.by(self.values, self.now.routine, block);
                self.now.depth += 1;
                let end = self.block(block, state.without(things));
                self.now.depth -= 1;
                self.now.runs = runs;
                match least {
                    Least::Once if !has_exit(block) => end,
                    _ => end.merged(state).without(match has_exit(block) {
                        true => things,
                        false => Things::default(),
                    }),
                }
            }
        }
    }

    fn simple(&mut self, line: usize, state: State) -> State {
        let file = self.file();
        let tokens = file.lines[line].tokens.clone();
        self.stands_at(&tokens);
        let Some(name) = file.name(tokens.start) else {
            self.unknown_statement(&tokens);
            return state;
        };
        if let Some(row) = motion_row(&name) {
            let state = self.functions(tokens.start + 1..tokens.end, state);
            self.stands_at(&tokens);
            return self.moves(row, &tokens, state);
        }
        if name.is("SPLINE") || name.is("ENDSPLINE") {
            return self.spline_word(&tokens, state);
        }
        if name.letters().starts_with(b"EXT") && row(&name).is_some() {
            return state;
        }
        self.notes_what_acts_along(&name, &tokens);
        if name.is("INTERRUPT") || name.is("TRIGGER") || name.is("GLOBAL") {
            let runs = std::mem::replace(&mut self.now.runs, Runs::Repeatedly);
            for called in self.interrupting(&tokens) {
                if !self.summaries[called].begun && self.now.depth < DEEPEST {
                    self.routine(called, self.now.depth + 1);
                }
            }
            self.now.runs = runs;
            return state;
        }
        let mut state = self.functions(tokens.clone(), state);
        // What is called was looked at above.
        self.stands_at(&tokens);
        let is_array = |at| (file.name(at)).is_some_and(|name| Role::of_array(&name).is_some());
        if tokens.clone().any(is_array) {
            let given = &mut self.settings.given;
            given.note_changes(&self.values.symbols.frames_assigned);
        }
        self.gives_frame(&name, &tokens);
        if self.puts_in_force(&name, &tokens, &mut state) || file.is(tokens.start + 1, b'(') {
            return state;
        }
        self.by_table(&name, &tokens, state)
    }

    /// What frames are, they are at this statement.
    fn stands_at(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let line = file.source.line_of(file.span(tokens).start);
        let is_certain = self.is_certain();
        let is_repeated = self.now.runs == Runs::Repeatedly;
        let given = &mut self.settings.given;
        given.at = (self.now.routine, line);
        (given.is_certain, given.is_repeated) = (is_certain, is_repeated);
    }

    /// After what is called in these tokens.
    fn functions(&mut self, tokens: Range<usize>, mut state: State) -> State {
        let file = self.file();
        for at in tokens.clone() {
            let Some(name) = file.name(at).filter(|_| file.is(at + 1, b'(')) else {
                continue;
            };
            if name.is("BAS")
                || motion_row(&name).is_some()
                || OPERATORS.iter().any(|word| name.is(word))
            {
                continue;
            }
            state = match self.values.symbols.routine(self.now.routine, &name) {
                Some(called) => self.enter(called, &tokens, state),
                None => self.calls_outside((at, name), &tokens, state),
            };
        }
        state
    }

    fn enter(&mut self, called: usize, tokens: &Range<usize>, state: State) -> State {
        if !self.notes_call(called, tokens, state) {
            return State::UNKNOWN;
        }
        if !self.summaries[called].begun {
            self.routine(called, self.now.depth + 1);
        }
        self.behind_call(called, state)
    }
}

/// Whether an EXIT leaves a loop from its block.
fn has_exit(block: &[Statement]) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Exit => true,
        Statement::Branches { blocks, .. } => blocks.iter().any(|block| has_exit(block)),
        _ => false,
    })
}
