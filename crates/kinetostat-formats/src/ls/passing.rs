//! Branches and loops on values that only the controller knows: passed over where they neither move the tool nor change modal state.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::value::Datum;
use crate::ls::program::label_of;
use crate::ls::run::{Flow, InForce, Run, RunningCall};
use crate::ls::step::{CallText, Step};
use crate::ls::storage::is_frame;
use crate::model::motion::Runs;
use crate::options::UnknownTargets;

const SET_IT: &str = "state the value of what decides it (--set NAME=VALUE, [values] in a job), or write the motions without the branch";

/// Steps of which only the controller knows whether they run.
pub(super) struct Open<'s> {
    /// Actions behind conditions.
    actions: Vec<&'s Step>,
    /// First step of the range.
    from: usize,
    /// The run goes on here.
    to: usize,
}

impl<'s> Open<'s> {
    /// The steps between the begin of a block and where it leads.
    pub(super) fn block(at: usize, to: usize) -> Self {
        Self {
            actions: Vec::new(),
            from: at + 1,
            // A block that is not whole may lead nowhere.
            to: to.max(at + 1),
        }
    }

    /// Actions of lines up to this one.
    pub(super) fn steps(last: usize, actions: Vec<&'s Step>) -> Self {
        Self {
            actions,
            from: last + 1,
            to: last + 1,
        }
    }
}

/// A step that may run: its program, its place there, and what it does.
type OpenStep<'s> = (usize, usize, &'s Step);

impl<'p> Run<'_, 'p> {
    /// Passes over steps of which only the controller knows whether they run: what they assign is unknown behind them. Steps that move the
    /// tool or change modal state are refused at the condition, or their motions stay as they are written.
    pub(super) fn pass_over<'s>(&mut self, at: usize, why: &Datum, open: Open<'s>) -> Flow
    where
        'p: 's,
    {
        let open = self.with_jumps(open);
        let steps = self.open_steps(at, &open);
        let acts = steps.iter().any(|(.., step)| self.acts(step));
        let own = steps.iter().filter(|(own, ..)| *own == self.program());
        let passed: BTreeSet<usize> = own.map(|(_, at, _)| *at).chain([at]).collect();
        self.pass(at, &open, passed);
        self.lose(&steps);
        if acts {
            let why = why.unknown_reason();
            let why = why.map_or("it is no truth", |reason| reason);
            let reason = format!("which way the program goes here is not known: {why}");
            match self.reader.options.unknown_targets {
                UnknownTargets::Refused => self.fault(at, reason, SET_IT),
                UnknownTargets::LeftAsWritten => self.leave(&steps, open.from..=at, &reason),
            }
        }
        Flow::To(open.to)
    }

    /// Notes the steps that are passed over; of a flat program they are lines, with what ends them.
    fn pass(&mut self, at: usize, open: &Open<'_>, passed: BTreeSet<usize>) {
        let steps = &self.all.programs[self.program()].steps;
        let is_still =
            |of: usize| matches!(steps[of], Step::Label(_) | Step::Carried | Step::Wait(_));
        if (open.from..at).any(|of| !is_still(of)) {
            self.not_flat(at, "the controller decides how often a loop runs");
        }
        for of in passed {
            self.log(of);
            self.write_whole(of);
        }
        if open.to > at + 1 && matches!(steps.get(open.to), Some(Step::EndIf | Step::Label(_))) {
            self.write_whole(open.to);
        }
    }

    /// Actions of the open steps, and of the programs that they call.
    fn open_steps<'s>(&self, at: usize, open: &Open<'s>) -> Vec<OpenStep<'s>>
    where
        'p: 's,
    {
        let program = self.program();
        let actions = open.actions.iter().map(|step| (program, at, step.action()));
        let mut found: Vec<OpenStep<'s>> = actions.collect();
        let all = |program: usize, from: usize, to: usize| {
            let steps = &self.all.programs[program].steps[from..to];
            let steps = (from..).zip(steps);
            steps.map(move |(at, step)| (program, at, step.action()))
        };
        found.extend(all(program, open.from, open.to));
        let mut seen = BTreeSet::new();
        let mut next = 0;
        while let Some((program, _, step)) = found.get(next).copied() {
            next += 1;
            if let Step::Call(call) = step
                && let Called::Program(called) = self.called(program, call)
                && seen.insert(called)
            {
                found.extend(all(called, 0, self.all.programs[called].steps.len()));
            }
        }
        found
    }

    /// With all that jumps of the open steps lead over. A jump behind which the program ends without a motion is taken not to be made: a
    /// program that ends does not cut what follows.
    fn with_jumps<'s>(&self, mut open: Open<'s>) -> Open<'s> {
        let steps = &self.all.programs[self.program()].steps;
        loop {
            let inside = open
                .actions
                .iter()
                .copied()
                .chain(&steps[open.from..open.to]);
            let targets: Vec<usize> = inside.flat_map(|step| self.targets(step)).collect();
            let before = (open.from, open.to);
            for target in targets
                .into_iter()
                .filter(|target| !self.ends_behind(*target))
            {
                if target < open.from {
                    open.from = target;
                } else if target > open.to {
                    open.to = target;
                }
            }
            if before == (open.from, open.to) {
                return open;
            }
        }
    }

    /// The steps to which a step jumps; that behind the last where a program returns to another one.
    fn targets(&self, step: &Step) -> Vec<usize> {
        let program = &self.all.programs[self.program()];
        match step.action() {
            Step::Jump(index) => match label_of(&index.node) {
                Some(label) => program.labels.get(&label).copied().into_iter().collect(),
                None => program.labels.values().copied().collect(),
            },
            Step::End if self.calls.len() > 1 => vec![program.steps.len()],
            _ => Vec::new(),
        }
    }

    /// True if all ways from a step lead to the end of all programs without a motion.
    fn ends_behind(&self, from: usize) -> bool {
        let program = &self.all.programs[self.program()];
        let mut seen = BTreeSet::new();
        let mut open = vec![from];
        while let Some(at) = open.pop() {
            if !seen.insert(at) {
                continue;
            }
            let Some(step) = program.steps.get(at) else {
                if self.calls.len() > 1 {
                    return false;
                }
                continue;
            };
            let open_here = Open::steps(at, vec![step]);
            let inside = self.open_steps(at, &open_here);
            if inside.iter().any(|(.., step)| self.acts(step)) {
                return false;
            }
            open.extend(self.targets(step));
            open.extend(program.leads.get(&at));
            if !matches!(step, Step::Jump(_) | Step::Else | Step::End | Step::Abort) {
                open.push(at + 1);
            }
        }
        true
    }

    /// True if a step moves the tool or changes modal state.
    fn acts(&self, step: &Step) -> bool {
        match step {
            Step::Motion(_) | Step::Refused(_) => true,
            Step::Assign(sides) => self.changes_modal_state(sides),
            _ => false,
        }
    }

    fn called(&self, program: usize, call: &CallText) -> Called {
        let name = call.name.as_ref();
        let name = name.map(|name| self.all.named(self.all.files[program].part(name)));
        match name {
            Some(Some(called)) => Called::Program(called),
            Some(None) => Called::Outside,
            None => Called::Computed,
        }
    }

    /// True if a frame or a tool may become another one than that in force.
    fn changes_modal_state(&self, [to, value]: &[Expression; 2]) -> bool {
        let number = label_of(&value.node);
        let is_other = |now: InForce| number.is_none() || now.known() != number;
        match &to.node {
            Node::Word(name) if name.is("UFRAME_NUM") => is_other(self.modal.frame),
            Node::Word(name) if name.is("UTOOL_NUM") => is_other(self.modal.tool),
            Node::Element(of, indices) => match (&of.node, indices.first()) {
                (Node::Word(kind), Some(index)) if is_frame(kind) => {
                    let number = label_of(&index.node);
                    number.is_none_or(|number| self.stated_frame(kind, number).is_none())
                }
                _ => false,
            },
            _ => false,
        }
    }

    /// Forgets the values that possibly executed steps assign.
    fn lose(&mut self, steps: &[OpenStep<'_>]) {
        for (program, _, step) in steps {
            match step {
                Step::Assign(sides) => self.lose_place(&sides[0]),
                Step::For(header) => self.lose_place(&header.counter),
                Step::Offset(..) => self.modal.conditions = [None, None],
                Step::Run => self.forget(),
                Step::Call(call) => match self.called(*program, call) {
                    Called::Program(_) => {}
                    Called::Outside => self.forget(),
                    Called::Computed => self.forget_all(),
                },
                _ => {}
            }
        }
    }

    fn lose_place(&mut self, to: &Expression) {
        let mut to = to.clone();
        let Node::Element(of, indices) = &mut to.node else {
            return;
        };
        if matches!(&of.node, Node::Word(kind) if is_frame(kind)) {
            return;
        }
        // A computed index may be another one there.
        if indices.iter().any(|index| label_of(&index.node).is_none()) {
            indices
                .iter_mut()
                .for_each(|index| index.node = Node::Unreadable);
        }
        self.store(&to, Datum::unknown("it may have changed"));
    }

    /// Leaves the motions of steps as they are written, and what the steps set is not known. Motions between the lines of a jump back may run again.
    fn leave(&mut self, steps: &[OpenStep<'_>], between: RangeInclusive<usize>, reason: &str) {
        let lines = &self.all.layouts[self.program()].lines;
        let file = self.program();
        let between = lines.get(between).unwrap_or_default();
        if let (Some(first), Some(last)) = (between.first(), between.last()) {
            let between = first.whole.start..last.whole.start;
            for motion in &mut self.motions {
                let is_between = motion.file == file && between.contains(&motion.span.start);
                if is_between && motion.runs < Runs::Repeatedly {
                    motion.runs = Runs::Repeatedly;
                    motion.follows = None;
                }
            }
        }
        self.here = None;
        for (program, at, step) in steps {
            match step {
                Step::Motion(text) if !std::mem::replace(&mut self.ran[*program][*at], true) => {
                    self.calls.push(RunningCall::of(*program, Vec::new()));
                    match self.motion_of(*at, text, Some(reason)) {
                        Ok(mut motion) => {
                            motion.runs = Runs::OnCondition;
                            self.motions.push(motion);
                        }
                        Err((reason, remedy)) => self.fault(*at, reason, remedy),
                    }
                    self.calls.pop();
                }
                Step::Refused((reason, remedy)) => {
                    self.calls.push(RunningCall::of(*program, Vec::new()));
                    self.fault(*at, *reason, remedy);
                    self.calls.pop();
                }
                Step::Assign(sides) if self.changes_modal_state(sides) => match &sides[0].node {
                    Node::Word(name) if name.is("UFRAME_NUM") => {
                        self.modal.frame = InForce::Computed;
                    }
                    Node::Word(_) => self.modal.tool = InForce::Computed,
                    _ => {
                        let name = self.name_of(&sides[0]);
                        self.values.retain(|own, _| Some(*own) != name);
                        self.given.extend(name);
                    }
                },
                _ => {}
            }
        }
    }
}

/// The program that a call names.
enum Called {
    Program(usize),
    /// Program that is in none of the files.
    Outside,
    /// A register names it.
    Computed,
}
