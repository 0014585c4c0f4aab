//! The ways through a program: in which frames, behind which motion and how often each instruction runs.
//!
//! Labels and jumps make the order of lines no order of time. Each instruction gets what is the same on all ways to it;
//! the ways are followed until nothing changes.

use std::collections::BTreeMap;

use crate::ls::program::{Place, Program};
use crate::ls::step::{Number, Step};

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
    /// Which numbers frame and tool have, the run decides: it computes them on one way at least, or they differ from way to way.
    pub is_computed: [bool; 2],
    /// Numbers of frame and tool on one way, where they are not known on another.
    pub on_one_way: [Option<u32>; 2],
    pub last: Last,
}

impl State {
    const OPEN: Self = Self {
        frame: None,
        tool: None,
        is_computed: [false; 2],
        on_one_way: [None; 2],
        last: Last::Unknown,
    };

    /// The numbers of frame and tool, if only on one way.
    fn numbers(&self) -> [Option<u32>; 2] {
        let [frame, tool] = self.on_one_way;
        [self.frame.or(frame), self.tool.or(tool)]
    }

    fn merged(self, other: Self) -> Self {
        let same = |one: Option<u32>, other: Option<u32>| one.filter(|one| Some(*one) == other);
        let both = [same(self.frame, other.frame), same(self.tool, other.tool)];
        let (own, others) = (self.numbers(), other.numbers());
        let differs = |which: usize| {
            let pair = own[which].zip(others[which]);
            pair.is_some_and(|(one, other)| one != other)
        };
        Self {
            frame: both[0],
            tool: both[1],
            is_computed: [0, 1]
                .map(|which| self.is_computed[which] || other.is_computed[which] || differs(which)),
            on_one_way: [0, 1].map(|which| match both[which] {
                Some(_) => None,
                None => own[which].or(others[which]),
            }),
            last: match self.last == other.last {
                true => self.last,
                false => Last::Unknown,
            },
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
                for to in program.leads.get(&at).into_iter().flatten() {
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
                is_computed: [*to == Number::Computed, state.is_computed[1]],
                on_one_way: [None, state.on_one_way[1]],
                ..state
            }),
            Step::Tool(to) => Some(State {
                tool: number(to),
                is_computed: [state.is_computed[0], *to == Number::Computed],
                on_one_way: [state.on_one_way[0], None],
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
