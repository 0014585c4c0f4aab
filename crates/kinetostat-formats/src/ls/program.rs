//! The instructions of a program: its blocks, where its jumps lead, how often each instruction runs.

use std::collections::BTreeMap;

use crate::ls::registers::Value;
use crate::ls::step::{Number, Step};
use crate::model::motion::Runs;

/// A motion: program and instruction.
pub(crate) type Place = (usize, usize);

/// A program's instructions, and where each leads.
pub(crate) struct Program {
    pub steps: Vec<Step>,
    /// The program among these that each CALL calls.
    pub called: BTreeMap<usize, usize>,
    /// Where else than to the next an instruction leads.
    pub leads: BTreeMap<usize, Vec<usize>>,
    labels: BTreeMap<u32, usize>,
    /// How often each runs in one run of the program.
    pub runs: Vec<Runs>,
    /// Its positions that are poses, by number.
    pub positions: BTreeMap<u32, Value>,
    /// Instructions that fit nothing: where, why, what to do.
    pub faults: Vec<(usize, &'static str, &'static str)>,
}

impl Program {
    /// Finds the ends of blocks and the targets of jumps.
    pub(crate) fn of(steps: Vec<Step>) -> Self {
        let mut program = Self {
            called: BTreeMap::new(),
            leads: BTreeMap::new(),
            labels: BTreeMap::new(),
            runs: vec![Runs::Once; steps.len()],
            positions: BTreeMap::new(),
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
                        self.leads
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
                        self.leads.entry(from).or_default().push(at + 1);
                        self.leads.entry(at).or_default().push(from);
                        marks.add(from + 1, at, Runs::Repeatedly);
                    }
                    _ => self.faults.push((at, ALONE.0, ALONE.1)),
                },
                // What is behind the end runs where a jump leads there, if at all.
                Step::End | Step::Abort => {
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
            self.leads.entry(at).or_default().extend(targets);
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
