//! What the statements do in their order: routines followed from the first one, branches and loops noted.
//!
//! Each routine is walked once; what depends on where it is called from stays open until all its calls are known.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::{ProgramError, excerpt, note};
use crate::krl::calls::{Call, Summary};
use crate::krl::lex::TokenFile;
use crate::krl::motion::{Followed, Statement as MotionStatement, follow, with};
use crate::krl::settings::Setter;
use crate::krl::state::{Settings, Slot, State, Thing, Things};
use crate::krl::table::{MotionRow, OPERATORS, motion_row, row};
use crate::krl::targets::Targets;
use crate::krl::touched::Touched;
use crate::krl::tree::{Least, Statement};
use crate::krl::values::{Reason, Values};
use crate::model::motion::{Runs, Zone};
use crate::model::program::Finding;
use crate::options::UnknownTargets;
use crate::table::Treatment;
use crate::text::name::Name;

/// Deepest nesting of calls and blocks together.
const DEEPEST: usize = 200;

/// The routine that is walked.
#[derive(Debug, Clone, Copy)]
struct Now {
    routine: usize,
    /// Of the statement in its routine.
    runs: Runs,
    /// Where a RETURN left it.
    left: Option<State>,
    /// What was in force before the spline block that is open.
    spline: Option<State>,
    depth: usize,
}

pub(crate) struct Walker<'w, 'p> {
    pub values: &'w Values<'p>,
    pub targets: &'w mut Targets,
    pub settings: Settings,
    pub unknown: UnknownTargets,
    pub faults: &'w mut Vec<ProgramError>,
    pub touched: Touched,
    pub motions: Vec<Followed>,
    pub findings: Vec<Finding>,
    pub summaries: Vec<Summary>,
    /// Callers behind what they call.
    pub finished: Vec<usize>,
    /// Routines that were named in a finding.
    named: BTreeSet<Name>,
    now: Now,
}

impl<'w, 'p> Walker<'w, 'p> {
    pub(crate) fn new(
        values: &'w Values<'p>,
        targets: &'w mut Targets,
        unknown: UnknownTargets,
        faults: &'w mut Vec<ProgramError>,
    ) -> Self {
        Self {
            touched: Touched::of(values),
            summaries: vec![Summary::default(); values.symbols.routines.len()],
            values,
            targets,
            settings: Settings::default(),
            unknown,
            faults,
            motions: Vec::new(),
            findings: Vec::new(),
            finished: Vec::new(),
            named: BTreeSet::new(),
            now: Now {
                routine: 0,
                runs: Runs::Once,
                left: None,
                spline: None,
                depth: 0,
            },
        }
    }

    /// Walks a routine and what it calls, then all that nothing calls.
    pub(crate) fn walk(&mut self, main: Option<usize>) {
        for routine in main.into_iter().chain(0..self.summaries.len()) {
            if !self.summaries[routine].begun {
                self.routine(routine, 0);
            }
        }
    }

    /// The file of the routine that is walked.
    fn file(&self) -> &'p TokenFile<'p> {
        self.values.file(self.now.routine)
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
            left: None,
            spline: None,
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

    fn refuse(&mut self, tokens: &Range<usize>, (reason, remedy): Reason) {
        let file = self.file();
        let span = file.span(tokens);
        note(self.faults, || {
            ProgramError::at(file.source, span, reason, remedy)
        });
    }

    fn simple(&mut self, line: usize, state: State) -> State {
        let file = self.file();
        let tokens = file.lines[line].tokens.clone();
        let Some(name) = file.name(tokens.start) else {
            self.refuse(&tokens, no_statement());
            return state;
        };
        if let Some(row) = motion_row(&name) {
            return self.motion(row, &tokens, state);
        }
        if name.is("SPLINE") || name.is("ENDSPLINE") {
            return self.spline(&tokens, state);
        }
        if name.letters().starts_with(b"EXT") && row(&name).is_some() {
            return state;
        }
        let is_interrupt = name.is("INTERRUPT") || name.is("TRIGGER") || name.is("GLOBAL");
        let mut state = match is_interrupt {
            true => self.interrupt(&tokens, state),
            false => self.functions(tokens.clone(), state),
        };
        if is_interrupt {
            return state;
        }
        let routine = self.now.routine;
        if let Some(equals) = file.assign(&tokens) {
            let mut setter = Setter {
                values: self.values,
                settings: &mut self.settings,
                routine,
            };
            if let Err(reason) = setter.assign(&tokens, equals, &mut state) {
                self.refuse(&tokens, reason);
            }
            return state;
        }
        if name.is("BAS") {
            let mut setter = Setter {
                values: self.values,
                settings: &mut self.settings,
                routine,
            };
            if let Err(reason) = setter.bas(&tokens, &mut state) {
                self.refuse(&tokens, reason);
            }
            return state;
        }
        // What is called was looked at above.
        if file.is(tokens.start + 1, b'(') {
            return state;
        }
        match row(&name).map(|row| row.treatment) {
            Some(Treatment::Refused { reason, remedy }) => {
                self.refuse(&tokens, (reason.to_owned(), remedy));
                State::UNKNOWN
            }
            Some(Treatment::Carried) => state,
            _ => {
                self.refuse(&tokens, no_statement());
                State::UNKNOWN
            }
        }
    }

    /// `SPLINE WITH $VEL.CP=0.2` and `ENDSPLINE C_SPL`: what the first puts in force, the second takes back.
    fn spline(&mut self, tokens: &Range<usize>, mut state: State) -> State {
        let file = self.file();
        let begins = file
            .name(tokens.start)
            .is_some_and(|name| name.is("SPLINE"));
        match (begins, self.now.spline.take()) {
            (true, None) => {
                self.now.spline = Some(state);
                let is_with = file
                    .name(tokens.start + 1)
                    .is_some_and(|name| name.is("WITH"));
                if is_with && tokens.len() > 1 {
                    let routine = self.now.routine;
                    let to = (self.values, &mut self.settings, routine);
                    if let Err(reason) = with(to, &(tokens.start + 2..tokens.end), &mut state) {
                        self.refuse(tokens, reason);
                    }
                }
                state
            }
            (false, Some(mut before)) => {
                before.set(Thing::Place, state.get(Thing::Place));
                before
            }
            (_, open) => {
                self.now.spline = open;
                let reason = "a spline block begins in another one, or ends without a beginning";
                self.refuse(
                    tokens,
                    (
                        reason.to_owned(),
                        "write SPLINE, its segments, and ENDSPLINE",
                    ),
                );
                state
            }
        }
    }

    fn motion(&mut self, row: &'static MotionRow, tokens: &Range<usize>, state: State) -> State {
        let mut state = self.functions(tokens.start + 1..tokens.end, state);
        let in_spline = self.now.spline.is_some();
        if in_spline && !matches!(row.name, "SLIN" | "SCIRC") {
            self.refuse(
                tokens,
                (
                    "it is no segment of a spline block".to_owned(),
                    "write SLIN or SCIRC, or write it behind ENDSPLINE",
                ),
            );
            state.set(Thing::Place, Slot::Unknown);
            return state;
        }
        let statement = MotionStatement {
            row,
            routine: self.now.routine,
            tokens,
        };
        let followed = follow(
            &statement,
            self.values,
            self.targets,
            &mut self.settings,
            state,
            self.unknown,
        );
        match followed {
            Ok(mut followed) => {
                followed.motion.runs = self.now.runs;
                if in_spline {
                    // Segments pass their ends, and only their own WITH states a speed.
                    followed.own_speed = true;
                    if followed.motion.zone == Zone::Exact {
                        followed.motion.zone = Zone::Unstated;
                    }
                }
                self.motions.push(followed);
                state.set(Thing::Place, Slot::Is(self.motions.len() - 1));
            }
            Err(reason) => {
                self.refuse(tokens, reason);
                state.set(Thing::Place, Slot::Unknown);
            }
        }
        state
    }

    /// `INTERRUPT DECL 3 WHEN condition DO routine()`, `TRIGGER WHEN PATH=0 DELAY=0 DO routine() PRIO=-1`.
    fn interrupt(&mut self, tokens: &Range<usize>, state: State) -> State {
        let file = self.file();
        for at in tokens.clone() {
            let Some(name) = file.name(at).filter(|_| file.is(at + 1, b'(')) else {
                continue;
            };
            let Some(called) = self.values.symbols.routine(self.now.routine, &name) else {
                continue;
            };
            if self.touched.routines[called].has(Thing::Place) {
                self.refuse(
                    tokens,
                    (
                        format!("`{}` moves the tool at any time", excerpt(file.word(at))),
                        "take the interrupt into a program of its own",
                    ),
                );
            }
            let runs = Runs::Repeatedly;
            self.summaries[called].calls.push(Call {
                from: self.now.routine,
                at: State::UNKNOWN,
                runs,
            });
            if !self.summaries[called].begun && self.now.depth < DEEPEST {
                self.routine(called, self.now.depth + 1);
            }
        }
        state
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
            if let Some(called) = self.values.symbols.routine(self.now.routine, &name) {
                state = self.enter(called, &tokens, state);
                continue;
            }
            match row(&name).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => {
                    self.refuse(&tokens, (reason.to_owned(), remedy));
                    state = State::UNKNOWN;
                }
                Some(_) => {}
                None => {
                    state = State::UNKNOWN;
                    if self.named.insert(name) {
                        let called = excerpt(file.word(at));
                        self.findings.push(Finding {
                            file: file.index,
                            line: file.source.line_of(file.span(&tokens).start),
                            message: format!(
                                "`{called}` is in none of these files: it is carried, and if it moves the tool, that is not seen"
                            ),
                        });
                    }
                }
            }
        }
        state
    }

    fn enter(&mut self, called: usize, tokens: &Range<usize>, state: State) -> State {
        let now = self.now;
        self.summaries[called].calls.push(Call {
            from: now.routine,
            at: state,
            runs: now.runs,
        });
        if now.depth >= DEEPEST {
            let reason = "calls and blocks are nested deeper than 200".to_owned();
            self.refuse(
                tokens,
                (reason, "call what is deepest from the first routine"),
            );
            return State::UNKNOWN;
        }
        if !self.summaries[called].begun {
            self.routine(called, now.depth + 1);
        }
        let summary = &mut self.summaries[called];
        match summary.leaves {
            Some(leaves) => leaves.in_call(state),
            None => {
                summary.recursive = true;
                State::UNKNOWN
            }
        }
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

fn no_statement() -> Reason {
    (
        "it is no statement of KRL that is known here".to_owned(),
        "remove it, or take it into a program of its own",
    )
}
