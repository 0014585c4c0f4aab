//! The ways through a program: in which frames, behind which motion and how often each instruction runs.
//!
//! Labels and jumps make the order of lines no order of time. Each instruction gets what is the same on all ways to it;
//! the ways are followed until nothing changes.

use std::collections::BTreeMap;

use crate::ls::step::{Number, Step};
use crate::model::motion::Runs;

/// A motion: program and instruction.
pub(crate) type Place = (usize, usize);

/// Where the tool is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Last {
    /// Where it was as the program was called.
    Entry,
    Motion(Place),
    Unknown,
}

/// What is in force before an instruction; none where it differs or is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct State {
    pub frame: Option<u32>,
    pub tool: Option<u32>,
    pub last: Last,
}

impl State {
    const OPEN: Self = Self {
        frame: None,
        tool: None,
        last: Last::Unknown,
    };

    fn merged(self, other: Self) -> Self {
        let same = |one: Option<u32>, other: Option<u32>| one.filter(|one| Some(*one) == other);
        Self {
            frame: same(self.frame, other.frame),
            tool: same(self.tool, other.tool),
            last: match self.last == other.last {
                true => self.last,
                false => Last::Unknown,
            },
        }
    }
}

/// A program's instructions, and where each leads.
pub(crate) struct Program {
    pub steps: Vec<Step>,
    /// The program among these that each CALL calls.
    pub called: BTreeMap<usize, usize>,
    /// Where else than to the next an instruction leads.
    other: BTreeMap<usize, Vec<usize>>,
    labels: BTreeMap<u32, usize>,
    /// How often each runs in one run of the program.
    pub runs: Vec<Runs>,
    /// Instructions that fit nothing: where, why, what to do.
    pub faults: Vec<(usize, &'static str, &'static str)>,
}

impl Program {
    /// Finds the ends of blocks and the targets of jumps.
    pub(crate) fn of(steps: Vec<Step>) -> Self {
        let mut program = Self {
            called: BTreeMap::new(),
            other: BTreeMap::new(),
            labels: BTreeMap::new(),
            runs: vec![Runs::Once; steps.len()],
            faults: Vec::new(),
            steps,
        };
        program.blocks();
        program.jumps();
        program
    }

    fn blocks(&mut self) {
        const ALONE: (&str, &str) = (
            "the block that it belongs to is not whole",
            "close IF with ENDIF and FOR with ENDFOR",
        );
        let mut open: Vec<(usize, bool)> = Vec::new();
        let mut marks = Marks::new(self.steps.len());
        for at in 0..self.steps.len() {
            match &self.steps[at] {
                Step::Label(number) => {
                    let before = self.labels.insert(*number, at);
                    let twice = "there is a label of this number above";
                    let fault = before.map(|_| (at, twice, "number it otherwise"));
                    self.faults.extend(fault);
                }
                Step::If | Step::For => open.push((at, false)),
                Step::Else | Step::EndIf => match open.pop() {
                    Some((from, has_else)) if matches!(self.steps[from], Step::If | Step::Else) => {
                        let is_else = self.steps[at] == Step::Else;
                        if is_else && has_else {
                            self.faults.push((at, ALONE.0, ALONE.1));
                        }
                        // IF leads behind ELSE or to ENDIF; ELSE, reached from above, to ENDIF.
                        self.other
                            .entry(from)
                            .or_default()
                            .push(at + usize::from(is_else));
                        marks.add(from + 1, at, Runs::OnCondition);
                        if is_else {
                            open.push((at, true));
                        }
                    }
                    _ => self.faults.push((at, ALONE.0, ALONE.1)),
                },
                Step::EndFor => match open.pop() {
                    Some((from, _)) if self.steps[from] == Step::For => {
                        self.other.entry(from).or_default().push(at + 1);
                        self.other.entry(at).or_default().push(from);
                        marks.add(from + 1, at, Runs::Repeatedly);
                    }
                    _ => self.faults.push((at, ALONE.0, ALONE.1)),
                },
                Step::End | Step::Abort if !open.is_empty() => {
                    marks.add(at, self.steps.len(), Runs::OnCondition);
                }
                Step::Perhaps(step) if matches!(**step, Step::End | Step::Abort) => {
                    marks.add(at, self.steps.len(), Runs::OnCondition);
                }
                _ => {}
            }
        }
        for (at, _) in open {
            self.faults.push((at, ALONE.0, ALONE.1));
        }
        marks.raise(&mut self.runs);
    }

    fn jumps(&mut self) {
        let mut marks = Marks::new(self.steps.len());
        for at in 0..self.steps.len() {
            let step = match &self.steps[at] {
                Step::Perhaps(step) => step,
                step => step,
            };
            let Step::Jump(to) = step else {
                continue;
            };
            let targets: Vec<usize> = match to {
                Number::Known(number) => self.labels.get(number).copied().into_iter().collect(),
                Number::Computed => self.labels.values().copied().collect(),
            };
            if *to == Number::Computed && targets.len() > MOST_COMPUTED {
                self.faults.push((
                    at,
                    "it jumps to one of more than 64 labels, and a register says to which",
                    "jump to numbers",
                ));
                continue;
            }
            if targets.is_empty() {
                self.faults.push((
                    at,
                    "there is no such label in the program",
                    "write the label, or take the jump out",
                ));
            }
            if targets.len() > 1 {
                marks.add(0, self.steps.len(), Runs::Repeatedly);
            }
            for to in &targets {
                match *to <= at {
                    true => marks.add(*to, at, Runs::Repeatedly),
                    false => marks.add(at + 1, *to, Runs::OnCondition),
                }
            }
            // A computed jump leads to all labels.
            self.other.entry(at).or_default().extend(targets);
        }
        marks.raise(&mut self.runs);
    }
}

/// Most labels of a program with computed jumps.
const MOST_COMPUTED: usize = 64;

/// Ranges of instructions that run on a condition or repeatedly.
struct Marks {
    on_condition: Vec<i64>,
    repeatedly: Vec<i64>,
}

impl Marks {
    fn new(count: usize) -> Self {
        Self {
            on_condition: vec![0; count + 1],
            repeatedly: vec![0; count + 1],
        }
    }

    fn add(&mut self, from: usize, to: usize, runs: Runs) {
        let changes = match runs {
            Runs::Repeatedly => &mut self.repeatedly,
            _ => &mut self.on_condition,
        };
        let end = changes.len() - 1;
        changes[from.min(end)] += 1;
        changes[to.max(from).min(end)] -= 1;
    }

    fn raise(&self, runs: &mut [Runs]) {
        let (mut conditions, mut repeats) = (0, 0);
        for (at, runs) in runs.iter_mut().enumerate() {
            conditions += self.on_condition[at];
            repeats += self.repeatedly[at];
            if conditions > 0 {
                *runs = (*runs).max(Runs::OnCondition);
            }
            if repeats > 0 {
                *runs = (*runs).max(Runs::Repeatedly);
            }
        }
    }
}

/// Deepest nesting of calls; what is called deeper is taken for unknown.
const DEEPEST: usize = 40;
/// Most different states in which one program is followed.
const MOST_ENTRIES: usize = 8;
/// Most passes over a program before all that a jump or loop leads to is open.
const MOST_PASSES: usize = 32;

/// What is in force before each instruction of all programs.
pub(crate) struct Flow<'p> {
    programs: &'p [Program],
    /// None where nothing leads.
    pub before: Vec<Vec<Option<State>>>,
    /// Where the tool is as a program is called.
    pub entry: Vec<Option<Last>>,
    exits: BTreeMap<(usize, State), Option<State>>,
    entries: Vec<usize>,
    depth: usize,
}

impl<'p> Flow<'p> {
    /// Follows the first program, and then those that it does not reach.
    pub(crate) fn of(programs: &'p [Program]) -> Self {
        let mut flow = Self {
            programs,
            before: programs.iter().map(|p| vec![None; p.steps.len()]).collect(),
            entry: vec![None; programs.len()],
            exits: BTreeMap::new(),
            entries: vec![0; programs.len()],
            depth: 0,
        };
        for program in 0..programs.len() {
            if program == 0 || flow.entries[program] == 0 {
                flow.entry[program] = Some(Last::Unknown);
                flow.program(program, State::OPEN);
            }
        }
        flow
    }

    /// What is in force behind a program that is entered in a state.
    fn program(&mut self, program: usize, entered: State) -> Option<State> {
        let mut entered = State {
            last: Last::Entry,
            ..entered
        };
        self.entries[program] += 1;
        if self.entries[program] > MOST_ENTRIES {
            entered = State {
                last: Last::Entry,
                ..State::OPEN
            };
        }
        if let Some(exit) = self.exits.get(&(program, entered)) {
            return *exit;
        }
        // Who calls itself comes back with anything.
        self.exits.insert((program, entered), Some(State::OPEN));
        self.depth += 1;
        let exit = self.follow(program, entered);
        self.depth -= 1;
        self.exits.insert((program, entered), exit);
        exit
    }

    fn follow(&mut self, index: usize, entered: State) -> Option<State> {
        let programs = self.programs;
        let program = &programs[index];
        let count = program.steps.len();
        let mut before: Vec<Option<State>> = vec![None; count + 1];
        before[0] = Some(entered);
        let mut exit = None;
        for pass in 0.. {
            let mut again = false;
            for at in 0..count {
                let Some(state) = before[at] else {
                    continue;
                };
                let (next, jumped) = self.step(index, at, state, &mut exit);
                if let Some(next) = next {
                    before[at + 1] = join(before[at + 1], next);
                }
                let Some(jumped) = jumped else {
                    continue;
                };
                for to in program.other.get(&at).into_iter().flatten() {
                    let jumped = match pass < MOST_PASSES {
                        true => jumped,
                        false => State::OPEN,
                    };
                    let joined = join(before[*to], jumped);
                    again |= joined != before[*to] && *to <= at;
                    before[*to] = joined;
                }
            }
            if !again {
                break;
            }
        }
        for (all, now) in self.before[index].iter_mut().zip(&before) {
            if let Some(now) = now {
                *all = join(*all, *now);
            }
        }
        match (before[count], exit) {
            (Some(last), exit) => join(exit, last),
            (None, exit) => exit,
        }
    }

    /// What an instruction leaves to the next, and to where else it leads.
    fn step(
        &mut self,
        program: usize,
        at: usize,
        state: State,
        exit: &mut Option<State>,
    ) -> (Option<State>, Option<State>) {
        match &self.programs[program].steps[at] {
            Step::Jump(_) => (None, Some(state)),
            Step::Else => (None, Some(state)),
            Step::If | Step::For | Step::EndFor => (Some(state), Some(state)),
            Step::Perhaps(step) => match &**step {
                Step::Jump(_) => (Some(state), Some(state)),
                step => {
                    let done = self.effect(program, at, step, state, exit);
                    (join(done, state), None)
                }
            },
            step => (self.effect(program, at, step, state, exit), None),
        }
    }

    fn effect(
        &mut self,
        program: usize,
        at: usize,
        step: &Step,
        state: State,
        exit: &mut Option<State>,
    ) -> Option<State> {
        let number = |number: &Number| match number {
            Number::Known(number) => Some(*number),
            Number::Computed => None,
        };
        match step {
            Step::Motion(_) => Some(State {
                last: Last::Motion((program, at)),
                ..state
            }),
            Step::Frame(to) => Some(State {
                frame: number(to),
                ..state
            }),
            Step::Tool(to) => Some(State {
                tool: number(to),
                ..state
            }),
            Step::Call(_) => match self.programs[program].called.get(&at) {
                Some(called) if self.depth < DEEPEST => {
                    let called = *called;
                    // What a caller does not know itself is not known.
                    let last = match state.last {
                        Last::Entry => Last::Unknown,
                        last => last,
                    };
                    self.entry[called] = match self.entry[called] {
                        Some(before) if before != last => Some(Last::Unknown),
                        _ => Some(last),
                    };
                    let left = self.program(called, state)?;
                    Some(State {
                        last: match left.last {
                            Last::Entry => state.last,
                            last => last,
                        },
                        ..left
                    })
                }
                _ => Some(State::OPEN),
            },
            Step::End => {
                *exit = join(*exit, state);
                None
            }
            Step::Abort => None,
            _ => Some(state),
        }
    }
}

fn join(one: Option<State>, other: State) -> Option<State> {
    Some(one.map_or(other, |one| one.merged(other)))
}
