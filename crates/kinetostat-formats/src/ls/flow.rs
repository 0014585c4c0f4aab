//! The ways through a program: in which frames, behind which motion and how often each instruction runs.
//!
//! Labels and jumps make the order of lines no order of time. Each instruction gets what is the same on all ways to it;
//! the ways are followed until nothing changes.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::ls::program::{Place, Program};
use crate::ls::registers::{Pool, Registers};
use crate::ls::step::{Number, Step};

/// Where the tool is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Last {
    /// Where it was as the program was called.
    Entry,
    Motion(Place),
    Unknown,
}

/// The number of a frame or tool in force before an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum InForce {
    /// Nothing sets it on any way.
    Unset,
    /// The same on all ways.
    Known(u32),
    /// This on one way; on another nothing sets it.
    OnOneWay(u32),
    /// The run decides: computed on one way at least, or another from way to way.
    Computed,
}

impl InForce {
    /// The number where it is the same on all ways.
    pub(crate) fn known(self) -> Option<u32> {
        match self {
            Self::Known(number) => Some(number),
            _ => None,
        }
    }

    fn merged(self, other: Self) -> Self {
        match (self, other) {
            (one, other) if one == other => one,
            (Self::Computed, _) | (_, Self::Computed) => Self::Computed,
            (Self::Unset, Self::Known(number) | Self::OnOneWay(number))
            | (Self::Known(number) | Self::OnOneWay(number), Self::Unset) => Self::OnOneWay(number),
            (
                Self::Known(one) | Self::OnOneWay(one),
                Self::Known(other) | Self::OnOneWay(other),
            ) if one == other => Self::OnOneWay(one),
            _ => Self::Computed,
        }
    }
}

impl From<&Number> for InForce {
    fn from(number: &Number) -> Self {
        match number {
            Number::Known(number) => Self::Known(*number),
            Number::Computed => Self::Computed,
        }
    }
}

/// What is in force before an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct State {
    pub frame: InForce,
    pub tool: InForce,
    pub last: Last,
    /// What registers hold, an entry of the pool.
    pub registers: usize,
}

impl State {
    /// Before what nothing is known of.
    pub(crate) const OPEN: Self = Self {
        frame: InForce::Unset,
        tool: InForce::Unset,
        last: Last::Unknown,
        registers: 0,
    };

    fn merged(self, other: Self, pool: &mut Pool) -> Self {
        Self {
            registers: pool.merged(self.registers, other.registers),
            frame: self.frame.merged(other.frame),
            tool: self.tool.merged(other.tool),
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
    pool: Pool,
    exits: BTreeMap<(usize, State), Option<State>>,
    entries: Vec<usize>,
    depth: usize,
}

impl<'p> Flow<'p> {
    /// Follows the first program, and then those that it does not reach; with the frames that the caller states.
    pub(crate) fn of(programs: &'p [Program], frames: &BTreeMap<String, Isometry3<f64>>) -> Self {
        let mut flow = Self {
            programs,
            before: programs.iter().map(|p| vec![None; p.steps.len()]).collect(),
            entry: vec![None; programs.len()],
            pool: Pool::of(frames),
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

    /// What registers hold before an instruction.
    pub(crate) fn registers(&self, before: Option<State>) -> &Registers {
        self.pool.get(before.map_or(0, |state| state.registers))
    }

    fn join(&mut self, one: Option<State>, other: State) -> Option<State> {
        Some(one.map_or(other, |one| one.merged(other, &mut self.pool)))
    }

    /// A state with other registers.
    fn with(&mut self, state: State, change: impl FnOnce(&mut Registers)) -> State {
        State {
            registers: self.pool.changed(state.registers, change),
            ..state
        }
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
                    before[at + 1] = self.join(before[at + 1], next);
                }
                let Some(jumped) = jumped else {
                    continue;
                };
                for to in program.leads.get(&at).into_iter().flatten() {
                    let jumped = match pass < MOST_PASSES {
                        true => jumped,
                        false => State::OPEN,
                    };
                    let joined = self.join(before[*to], jumped);
                    again |= joined != before[*to] && *to <= at;
                    before[*to] = joined;
                }
            }
            if !again {
                break;
            }
        }
        for (at, now) in before[..count].iter().enumerate() {
            if let Some(now) = now {
                self.before[index][at] = self.join(self.before[index][at], *now);
            }
        }
        match (before[count], exit) {
            (Some(last), exit) => self.join(exit, last),
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
                    (self.join(done, state), None)
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
        match step {
            Step::Motion(_) => Some(State {
                last: Last::Motion((program, at)),
                ..state
            }),
            Step::Frame(to) => Some(State {
                frame: to.into(),
                ..state
            }),
            Step::Tool(to) => Some(State {
                tool: to.into(),
                ..state
            }),
            Step::Call(name) => match self.programs[program].called.get(&at) {
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
                    let state = self.with(state, Registers::without_conditions);
                    let left = self.program(called, state)?;
                    let left = self.with(left, Registers::without_conditions);
                    Some(State {
                        last: match left.last {
                            Last::Entry => state.last,
                            last => last,
                        },
                        ..left
                    })
                }
                // What is in none of the files is taken not to move the tool; it may compute registers.
                None if name.is_some() => Some(self.with(state, Registers::forget)),
                _ => Some(State::OPEN),
            },
            Step::End => {
                *exit = self.join(*exit, state);
                None
            }
            Step::Abort => None,
            Step::Run => Some(self.with(state, Registers::forget)),
            Step::Give(given) => {
                let positions = &self.programs[program].positions;
                Some(self.with(state, |registers| registers.give(given, positions)))
            }
            _ => Some(state),
        }
    }
}
