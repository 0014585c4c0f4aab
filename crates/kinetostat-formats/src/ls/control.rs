//! Order of a run: calls, branches, loops, jumps.

use crate::interpreter::expression::Expression;
use crate::interpreter::operation::same;
use crate::interpreter::value::{Datum, Value};
use crate::ls::motion::MotionText;
use crate::ls::passing::Open;
use crate::ls::program::label_of;
use crate::ls::run::{FlatLines, Flow, Pass, Run, RunningCall, index_of_axes};
use crate::ls::step::{CallText, CaseText, ForText, Step};
use crate::model::motion::{Motion, Runs};

/// Deepest nesting of calls.
const DEEPEST: usize = 200;

/// Limit of the statements of a run.
const MOST_STATEMENTS: usize = 5_000_000;

/// Limit of the motions of repeated statements.
const MOST_REPEATED: usize = 200_000;

impl Run<'_, '_> {
    /// Runs a program with its arguments.
    pub(super) fn call(&mut self, program: usize, arguments: Vec<Datum>) -> Flow {
        self.calls.push(RunningCall::of(program, arguments));
        let steps = &self.all.programs[program].steps;
        let mut at = 0;
        let flow = loop {
            let Some(step) = steps.get(at) else {
                break Flow::Returns;
            };
            self.statements += 1;
            if self.flat.as_ref().is_some_and(FlatLines::is_full) {
                self.not_flat(at, "it has more than 5 million lines, or 256 MiB");
                break Flow::Ends;
            }
            if self.statements > MOST_STATEMENTS {
                let reason = "the program runs more than 5 million statements up to here";
                let remedy = "end its loop, or read the part that cuts by itself";
                self.fault(at, reason, remedy);
                break Flow::Ends;
            }
            match self.step(at, step) {
                Flow::Next => at += 1,
                Flow::To(to) if to <= at && self.never_ends(at) => break Flow::Ends,
                Flow::To(to) => at = to,
                flow => break flow,
            }
        };
        self.calls.pop();
        flow
    }

    fn step(&mut self, at: usize, step: &Step) -> Flow {
        let program = &self.all.programs[self.program()];
        let lead = || program.leads.get(&at).copied().unwrap_or(at + 1);
        if matches!(
            step,
            Step::Assign(_)
                | Step::Offset(..)
                | Step::Wait(_)
                | Step::Run
                | Step::Abort
                | Step::Carried
        ) {
            self.log(at);
            self.write_action(at);
        }
        match step {
            Step::Motion(text) => return self.motion(at, text),
            Step::Assign(sides) => self.assign(at, sides),
            Step::Offset(axes, register) => {
                let register = register.as_ref().and_then(|index| self.index(index));
                self.modal.conditions[index_of_axes(*axes)] = register;
            }
            Step::Jump(index) => return self.jump(at, index, step),
            Step::Call(call) => return self.call_by(at, call),
            Step::If(condition) => {
                let value = self.decide(condition);
                return match value.as_truth() {
                    Some(true) => Flow::Next,
                    Some(false) => Flow::To(lead()),
                    None => self.pass_over(at, &value, Open::block(at, program.end_of_if(at))),
                };
            }
            Step::Else => return Flow::To(lead()),
            Step::For(header) => return self.begin_loop(at, header, lead()),
            Step::EndFor => return self.end_loop(at, lead()),
            Step::Perhaps(own) => {
                let value = self.decide(&own.0);
                return match value.as_truth() {
                    Some(true) => self.step(at, &own.1),
                    Some(false) => Flow::Next,
                    None => self.pass_over(at, &value, Open::steps(at, vec![&own.1])),
                };
            }
            // Other lines than the first run with it.
            Step::Case(own) if own.subject.is_some() => return self.select(at, own),
            Step::Wait(condition) => self.wait(condition),
            Step::End => {
                if self.calls.len() == 1 {
                    self.write_action(at);
                }
                return Flow::Returns;
            }
            Step::Abort => return Flow::Ends,
            Step::Run => {
                self.find(at, "another task starts: it is not followed");
                self.forget();
            }
            Step::Refused((reason, remedy)) => {
                self.fault(at, *reason, remedy);
                self.here = None;
            }
            Step::Label(_) | Step::EndIf | Step::Case(_) | Step::Carried => {}
        }
        Flow::Next
    }

    /// The value of a condition, which may decide the way of the run.
    fn decide(&mut self, condition: &Expression) -> Datum {
        let value = self.value(condition);
        self.decided += usize::from(value.as_truth().is_some());
        value
    }

    fn jump(&mut self, at: usize, index: &Expression, step: &Step) -> Flow {
        let value = self.value(index);
        let Some(label) = self.index(index) else {
            return self.pass_over(at, &value, Open::steps(at, vec![step]));
        };
        match self.all.programs[self.program()].labels.get(&label) {
            Some(to) => Flow::To(*to),
            // A constant label that does not exist is reported without a run.
            None if label_of(&index.node).is_some() => Flow::Next,
            None => {
                let reason = format!("there is no label {label} in the program");
                self.fault(at, reason, "write the label, or take the jump out");
                Flow::Next
            }
        }
    }

    /// CALL of a program of the files, or of what is in none of them: that is taken not to move the tool, and may compute registers.
    fn call_by(&mut self, at: usize, call: &CallText) -> Flow {
        let file = self.file();
        let name = match &call.name {
            Some(name) => Some(file.part(name).to_vec()),
            None => match self.value(&call.computed).value {
                Value::Text(name) => Some(name.as_bytes().to_vec()),
                _ => None,
            },
        };
        let Some(called) = name.as_ref().and_then(|name| self.all.named(name)) else {
            self.log(at);
            self.write_action(at);
            if self.calls.iter().any(|called| !called.counters.is_empty()) {
                self.find(
                    at,
                    "what it calls is taken not to change the counters of the loops around it",
                );
            }
            match call.name {
                Some(_) => self.forget(),
                None => self.forget_all(),
            }
            return Flow::Next;
        };
        if call.name.is_none() {
            let place = (self.program(), self.line(at));
            (self.outside_calls).retain(|call| (call.file, call.line) != place);
        }
        if self.calls.len() >= DEEPEST {
            let reason = "calls are nested deeper than 200".to_owned();
            self.fault(at, reason, "call what is deepest from the first program");
            return Flow::Ends;
        }
        let arguments = call.arguments.iter().map(|of| self.value(of)).collect();
        self.modal.conditions = [None, None];
        let flow = self.call(called, arguments);
        self.modal.conditions = [None, None];
        match flow {
            Flow::Ends => Flow::Ends,
            _ => Flow::Next,
        }
    }

    /// SELECT: the line at a step and the lines of its cases behind it.
    fn select(&mut self, at: usize, first: &CaseText) -> Flow {
        let steps = &self.all.programs[self.program()].steps;
        let behind = steps[at + 1..].iter().map_while(|step| match step {
            Step::Case(own) if own.subject.is_none() => Some(&**own),
            _ => None,
        });
        let cases: Vec<&CaseText> = std::iter::once(first).chain(behind).collect();
        let subject = first.subject.as_ref().map(|subject| self.value(subject));
        let subject = subject.unwrap_or(Datum::truth(true));
        let last = at + cases.len();
        for (number, case) in cases.iter().enumerate() {
            let value = case.value.as_ref().map(|value| self.value(value));
            let is_unknown = |of: &&Datum| of.unknown_reason().is_some();
            let both = value.as_ref().map(|value| [&subject, value]);
            if let Some(why) = both.and_then(|both| both.into_iter().find(is_unknown)) {
                let actions = cases[number..].iter().map(|case| &case.action).collect();
                return self.pass_over(at, &why.clone(), Open::steps(last - 1, actions));
            }
            self.decided += 1;
            if value
                .as_ref()
                .is_none_or(|value| same(&subject.value, &value.value))
            {
                return match self.step(at + number, &case.action) {
                    Flow::Next => Flow::To(last),
                    flow => flow,
                };
            }
        }
        Flow::To(last)
    }

    fn begin_loop(&mut self, at: usize, header: &ForText, behind: usize) -> Flow {
        let ends = [self.value(&header.first), self.value(&header.last)];
        let counter = self.name_of(&header.counter);
        let (Some(counter), [Some(first), Some(last)]) =
            (counter, ends.each_ref().map(Datum::as_number))
        else {
            let mut unknown = ends.into_iter().filter(|end| end.as_number().is_none());
            let why = unknown
                .next()
                .unwrap_or_else(|| self.value(&header.counter));
            return self.pass_over(at, &why, Open::block(at, behind));
        };
        self.decided += 1;
        self.put(&counter, Datum::number(first));
        self.write_counter(at, &counter, first);
        let runs = match header.is_down {
            true => first >= last,
            false => first <= last,
        };
        if !runs {
            return Flow::To(behind);
        }
        if let Some(called) = self.calls.last_mut() {
            called.counters.insert(at, (counter, last));
        }
        Flow::Next
    }

    /// ENDFOR: the counter is the last value behind the loop.
    fn end_loop(&mut self, at: usize, header: usize) -> Flow {
        let program = &self.all.programs[self.program()];
        let Some(Step::For(text)) = program.steps.get(header) else {
            return Flow::Next;
        };
        let running = self
            .calls
            .last()
            .and_then(|called| called.counters.get(&header));
        let (count, last) = match running.cloned() {
            Some((counter, last)) => (self.values.get(&counter).cloned(), last),
            None => (Some(Datum::unknown("a jump leads into the loop")), 0.0),
        };
        let count = count.unwrap_or_else(|| self.value(&text.counter));
        let Some(number) = count.as_number() else {
            return self.pass_over(at, &count, Open::block(header, at + 1));
        };
        self.decided += 1;
        let (is_over, step) = match text.is_down {
            true => (number <= last, -1.0),
            false => (number >= last, 1.0),
        };
        if is_over {
            if let Some(called) = self.calls.last_mut() {
                called.counters.remove(&header);
            }
            return Flow::Next;
        }
        if let Some(counter) = self.name_of(&text.counter) {
            self.write_counter(at, &counter, number + step);
        }
        self.store(&text.counter, Datum::number(number + step));
        Flow::To(header + 1)
    }

    /// True where a jump back leads to the state in which it was before, or no condition on the way is known: its first pass is read.
    fn never_ends(&mut self, at: usize) -> bool {
        let now = Pass {
            decided: self.decided,
            values: self.values.clone(),
            modal: self.modal,
            motions: self.motions.len(),
            beside: self.ran_beside.len(),
            flat: self.flat.as_ref().map_or([0; 2], FlatLines::extent),
        };
        let Some(called) = self.calls.last_mut() else {
            return false;
        };
        let motions = now.motions;
        let is_same = |before: &Pass| {
            before.decided == now.decided
                || (before.values == now.values && before.modal == now.modal)
        };
        let (before, beside, flat) = match called.passes.get(&at) {
            Some(before) if is_same(before) => (before.motions, before.beside, before.flat),
            _ => {
                called.passes.insert(at, now);
                return false;
            }
        };
        let count = motions - before;
        let (first, again) =
            self.motions[before.saturating_sub(count)..].split_at(count.min(before));
        let is_again = |(one, other): (&Motion, &Motion)| {
            one.span == other.span && one.kind == other.kind && one.target == other.target
        };
        if first.len() == again.len() && first.iter().zip(again).all(is_again) {
            self.motions.truncate(before);
            if let Some(lines) = &mut self.flat {
                lines.cut(flat);
            }
            for motion in &mut self.motions[before - count..] {
                if motion.runs < Runs::Repeatedly {
                    motion.runs = Runs::Repeatedly;
                }
            }
        }
        self.log_endless(at, before.saturating_sub(count), beside);
        self.find(
            at,
            "the loop never ends: its first pass is read, and its corrections are those of all",
        );
        true
    }

    fn motion(&mut self, at: usize, text: &MotionText) -> Flow {
        let program = self.program();
        if std::mem::replace(&mut self.ran[program][at], true) {
            self.repeated_motions += 1;
            if self.repeated_motions > MOST_REPEATED {
                let reason = "the loops of the program run more than 200000 motions".to_owned();
                self.fault(at, reason, "read the part that cuts by itself");
                return Flow::Ends;
            }
        }
        self.write_action(at);
        match self.motion_of(at, text, None) {
            Ok(mut motion) => {
                motion.runs = self.runs;
                motion.follows = self.here;
                self.here = Some(self.motions.len());
                self.motions.push(motion);
                if let Some(label) = &text.skips_to {
                    let jump = Step::Jump(Box::new(label.clone()));
                    let why = Datum::unknown("a signal decides it");
                    return self.pass_over(at, &why, Open::steps(at, vec![&jump]));
                }
            }
            Err((reason, remedy)) => {
                self.fault(at, reason, remedy);
                self.here = None;
            }
        }
        Flow::Next
    }
}
