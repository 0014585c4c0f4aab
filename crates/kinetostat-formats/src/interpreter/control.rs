//! Order of a run: calls, branches, loops, jumps.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::interpreter::expression::{Argument, Node};
use crate::interpreter::operation::same;
use crate::interpreter::passing::SET_IT;
use crate::interpreter::run::{Called, DEEPEST, Dialect, Place, Root, Run, Slot};
use crate::interpreter::symbols::Scope;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Choice, Flow, Leave, LoopKind, Statement};
use crate::interpreter::value::Datum;
use crate::model::program::ENDLESS;
use crate::text::Name;

/// Limit of repeated statements of a run: in loops, and in routines that others call.
const MOST_REPEATED: usize = 1_000_000;

impl<D: Dialect> Run<'_, '_, D> {
    /// Runs a routine with the slots of its parameters.
    pub(crate) fn call(&mut self, routine: usize, slots: BTreeMap<Name, Slot>) -> Flow {
        let outer = std::mem::replace(&mut self.scope, Scope::Routine(routine));
        self.calls.push(Called { routine, slots });
        self.depth += 1;
        let body = &self.symbols.routines[routine].routine.body;
        let flow = self.block(body);
        if let Flow::To(_, tokens) = &flow {
            let reason = "no label of its routine is where it jumps to".to_owned();
            self.fault(tokens, (reason, "write the label, or take the jump out"));
        }
        self.depth -= 1;
        self.calls.pop();
        self.scope = outer;
        match flow {
            Flow::Returns(value) => Flow::Returns(value),
            Flow::Ends => Flow::Ends,
            Flow::Next | Flow::Breaks | Flow::Continues | Flow::To(..) => Flow::Returns(None),
        }
    }

    /// Calls a routine of the files with the arguments of a statement.
    pub(crate) fn call_with(
        &mut self,
        called: usize,
        arguments: &[Argument],
        tokens: &Range<usize>,
    ) -> Flow {
        if self.depth >= DEEPEST {
            let reason = "calls and blocks are nested deeper than 200".to_owned();
            self.fault(tokens, (reason, "call what is deepest from main"));
            return Flow::Ends;
        }
        let file = self.file();
        let site = (file.index, file.span(tokens).start);
        self.call_sites.entry(called).or_default().insert(site);
        let mut slots = BTreeMap::new();
        let parameters = &self.symbols.routines[called].routine.parameters;
        let mut ordered = parameters.iter().filter(|parameter| !parameter.is_optional);
        for Argument { option, value } in arguments {
            let parameter = match option {
                Some(name) => parameters.iter().find(|parameter| parameter.name == *name),
                None => ordered.next(),
            };
            let Some(parameter) = parameter else {
                // The files know another form of the routine.
                if let Some(value) = value {
                    let reason = self.changed(value);
                    self.lose(value, &reason);
                }
                continue;
            };
            let Some(value) = value else {
                // `\switch`.
                let given = Slot::Own(Datum::truth(true));
                slots.insert(parameter.name, given);
                continue;
            };
            let place = match parameter.changes {
                true => self.place(value),
                false => None,
            };
            let slot = match place {
                Some(place) => Slot::Of(place),
                None => {
                    let value = self.value(value);
                    let types = &self.symbols.routines[called].routine.data;
                    let own = types.iter().find(|node| node.name == parameter.name);
                    Slot::Own(
                        own.map_or(value.clone(), |node| D::converted(&node.type_name, value)),
                    )
                }
            };
            slots.insert(parameter.name, slot);
        }
        self.call(called, slots)
    }

    /// The value of a function of the files.
    pub(crate) fn call_function(
        &mut self,
        called: usize,
        arguments: &[Argument],
        tokens: &Range<usize>,
    ) -> Datum {
        match self.call_with(called, arguments, tokens) {
            Flow::Returns(Some(value)) => value,
            _ => Datum::unknown("the function returns no value"),
        }
    }

    /// Runs the statements of a block.
    pub(crate) fn block(&mut self, statements: &[Statement]) -> Flow {
        let mut at = 0;
        while let Some(statement) = statements.get(at) {
            at += 1;
            if !self.counts_statement() {
                if let Some(tokens) = statement.tokens() {
                    let reason =
                        "the loops of the program run more than 1 million statements up to here";
                    let remedy = "end its loop, or read the part that cuts by itself";
                    self.fault(&tokens, (reason.to_owned(), remedy));
                }
                return Flow::Ends;
            }
            self.forget_results();
            match self.statement(statement) {
                Flow::Next => {}
                Flow::To(label, tokens) => {
                    let file = self.file();
                    let is_it = |statement: &Statement| match statement {
                        Statement::Label { at } => Name::of(file.word(*at)) == Some(label),
                        _ => false,
                    };
                    match statements.iter().position(is_it) {
                        Some(label) => {
                            // A jump backward is a loop.
                            self.in_loops += usize::from(label < at);
                            at = label;
                        }
                        None => return Flow::To(label, tokens),
                    }
                }
                flow => return flow,
            }
        }
        Flow::Next
    }

    /// Counts a statement that runs; false where too many ran again.
    fn counts_statement(&mut self) -> bool {
        self.repeated_statements += usize::from(self.in_loops > 0 || self.calls.len() > 1);
        self.repeated_statements <= MOST_REPEATED
    }

    fn statement(&mut self, statement: &Statement) -> Flow {
        match statement {
            Statement::Call { tokens } | Statement::Assignment { tokens, .. } => {
                self.statement = tokens.clone();
            }
            _ => {}
        }
        match statement {
            Statement::Label { .. } => Flow::Next,
            Statement::Call { tokens } => D::instruction(self, tokens, Choice::OneOfAll),
            Statement::Assignment { tokens, assign } => {
                self.assign(tokens, *assign);
                Flow::Next
            }
            Statement::Leaves { tokens } => self.leave(tokens),
            Statement::Branches {
                conditions,
                choice,
                blocks,
                whole,
            } => {
                self.depth += 1;
                let flow = match conditions.len() > blocks.len() {
                    true => self.test(conditions, blocks),
                    false => self.branch(conditions, *choice, blocks),
                };
                self.depth -= 1;
                self.log_passed_over(whole);
                flow
            }
            Statement::Loop {
                kind,
                header,
                block,
                whole,
            } => {
                self.depth += 1;
                self.in_loops += 1;
                let flow = match kind {
                    LoopKind::Counting => self.count(header, block),
                    LoopKind::While => self.repeat(header, block, false),
                    LoopKind::Until => self.repeat(header, block, true),
                    LoopKind::Endless => self.repeat_for_ever(header, block),
                };
                self.in_loops -= 1;
                self.depth -= 1;
                self.log_passed_over(whole);
                flow
            }
        }
    }

    /// `a.b{i} := value;`
    fn assign(&mut self, tokens: &Range<usize>, assign: usize) {
        let file = self.file();
        let to = D::expression_of(file, tokens.start..assign);
        let written = D::expression_of(file, file.value_behind(assign, tokens));
        let value = self.value(&written);
        self.log_assignment(tokens, [&to, &written]);
        D::assigned(self, tokens, assign);
        match self.place(&to) {
            Some(place) => {
                let value = match self.type_of(place.root) {
                    Some(type_name) => D::converted(&type_name, value),
                    None => value,
                };
                self.put(&place, value);
            }
            None => {
                let reason = self.changed(&to);
                self.lose(&to, &reason);
            }
        }
    }

    fn leave(&mut self, tokens: &Range<usize>) -> Flow {
        match D::leave(self.file(), tokens) {
            Leave::Jump(label) => Flow::To(label, tokens.clone()),
            Leave::Returns(value) => {
                let value = value.map(|tokens| D::expression_of(self.file(), tokens));
                Flow::Returns(value.map(|value| self.value(&value)))
            }
            Leave::Breaks => Flow::Breaks,
            Leave::Continues => Flow::Continues,
            Leave::Ends => {
                self.log_instruction(tokens);
                Flow::Ends
            }
        }
    }

    /// IF with its ELSEIF and ELSE.
    fn branch(
        &mut self,
        conditions: &[Range<usize>],
        choice: Choice,
        blocks: &[Vec<Statement>],
    ) -> Flow {
        for (index, tokens) in conditions.iter().enumerate() {
            let condition = D::expression_of(self.file(), tokens.clone());
            let value = self.value(&condition);
            match value.as_truth() {
                Some(true) => return self.arm(choice, &blocks[index]),
                Some(false) => {}
                None => {
                    let open: Vec<&[Statement]> =
                        blocks[index..].iter().map(Vec::as_slice).collect();
                    self.pass_over(&open, tokens, &value);
                    return Flow::Next;
                }
            }
        }
        match blocks.get(conditions.len()) {
            Some(block) => self.block(block),
            None => Flow::Next,
        }
    }

    /// A block that runs; behind `IF condition` without THEN one statement can stand.
    fn arm(&mut self, choice: Choice, block: &[Statement]) -> Flow {
        match (choice, block) {
            (Choice::Compact, [Statement::Call { tokens }]) => D::instruction(self, tokens, choice),
            _ => self.block(block),
        }
    }

    /// TEST with its cases: the first condition is what is compared.
    fn test(&mut self, conditions: &[Range<usize>], blocks: &[Vec<Statement>]) -> Flow {
        let file = self.file();
        let Some((subject, cases)) = conditions.split_first() else {
            return Flow::Next;
        };
        let value = self.value(&D::expression_of(file, subject.clone()));
        for (index, case) in cases.iter().enumerate() {
            let is_default = case.is_empty();
            let mut is_it = Some(is_default);
            for own in file.split(case) {
                let found = self.is_in(&value, &own);
                is_it = match (is_it, found) {
                    (Some(true), _) | (_, Some(true)) => Some(true),
                    (Some(false), Some(false)) => Some(false),
                    _ => None,
                };
            }
            match is_it {
                Some(true) => return self.block(&blocks[index]),
                Some(false) => {}
                None => {
                    let open: Vec<&[Statement]> =
                        blocks[index..].iter().map(Vec::as_slice).collect();
                    self.pass_over(&open, subject, &value);
                    return Flow::Next;
                }
            }
        }
        Flow::Next
    }

    /// True if a value is that of a case, or between two: `1 TO 3`.
    fn is_in(&mut self, value: &Datum, case: &Range<usize>) -> Option<bool> {
        let file = self.file();
        let to = case.clone().find(|at| file.is_word(*at, "TO"));
        let part = |run: &mut Self, tokens| run.value(&D::expression_of(file, tokens));
        let (low, high) = match to {
            Some(to) => (part(self, case.start..to), part(self, to + 1..case.end)),
            None => {
                let own = part(self, case.clone());
                (own.clone(), own)
            }
        };
        if [value, &low, &high]
            .iter()
            .any(|of| of.unknown_reason().is_some())
        {
            return None;
        }
        match (value.as_number(), low.as_number(), high.as_number()) {
            (Some(value), Some(low), Some(high)) => Some((low..=high).contains(&value)),
            _ => Some(same(&value.value, &low.value)),
        }
    }

    /// A loop with its condition before its block, or behind it, where it runs until that holds.
    fn repeat(&mut self, header: &Range<usize>, block: &[Statement], until: bool) -> Flow {
        let condition = D::expression_of(self.file(), header.clone());
        if condition.node == Node::Truth(!until) {
            return self.repeat_for_ever(header, block);
        }
        // A loop that tests at its end runs at least once.
        let mut tests = !until;
        loop {
            if tests {
                self.forget_results();
                let value = self.value(&condition);
                match value.as_truth() {
                    Some(truth) if truth == until => return Flow::Next,
                    Some(_) => {}
                    None => {
                        self.pass_over_loop(block, header, &value);
                        return Flow::Next;
                    }
                }
            }
            tests = true;
            if let Some(flow) = self.pass(block) {
                return flow;
            }
        }
    }

    /// A pass of a loop; how the run goes on where it leaves the loop.
    fn pass(&mut self, block: &[Statement]) -> Option<Flow> {
        if !self.counts_statement() {
            return Some(self.block(block));
        }
        match self.block(block) {
            Flow::Next | Flow::Continues => None,
            Flow::Breaks => Some(Flow::Next),
            flow => Some(flow),
        }
    }

    /// A loop that only a statement in it leaves. Where none does, its first pass is read; where it waits, it is passed over.
    fn repeat_for_ever(&mut self, header: &Range<usize>, block: &[Statement]) -> Flow {
        if !has_way_out::<D>(self.file(), block, true) {
            self.find(
                header,
                "the loop never ends: its first pass is read, and its corrections are those of all"
                    .to_owned(),
            );
            self.say_beside(header, ENDLESS.to_owned());
            return match self.one_pass(header, block) {
                Flow::Next | Flow::Continues => Flow::Ends,
                flow => flow,
            };
        }
        if self.only_waits(block) {
            let value = Datum::unknown("the loop waits");
            self.pass_over_loop(block, header, &value);
            return Flow::Next;
        }
        let before = self.faults.len();
        loop {
            if let Some(flow) = self.pass(block) {
                return flow;
            }
            // What leaves it may be what is refused.
            if self.faults.len() > before {
                return Flow::Next;
            }
        }
    }

    /// The first pass of a loop that never ends. A second pass shows whether all passes go to the same places.
    fn one_pass(&mut self, header: &Range<usize>, block: &[Statement]) -> Flow {
        let begin = self.motions.len();
        let flow = self.block(block);
        if !matches!(flow, Flow::Next | Flow::Continues) || self.motions.len() == begin {
            return flow;
        }
        let (end, here, beside) = (self.motions.len(), self.here, self.ran_beside.len());
        let logged = self.log.as_ref().map(Vec::len);
        self.block(block);
        let [first, second] = [&self.motions[begin..end], &self.motions[end..]];
        let is_same = first.len() == second.len()
            && first.iter().zip(second).all(|(first, second)| {
                let places = [first, second].map(|of| (&of.kind, &of.target, &of.zone));
                let frames = [first, second].map(|of| (&of.tool, &of.work_object, &of.speed));
                places[0] == places[1] && frames[0] == frames[1]
            });
        // The way to the first place of a pass is another than that of the next pass.
        let starts = [begin, end].map(|of| of.checked_sub(1).map(|of| &self.motions[of]));
        let starts = starts.map(|start| start.map(|of| (&of.target, &of.tool, &of.work_object)));
        let begins_elsewhere = starts[0] != starts[1];
        self.repeated_motions -= (self.motions.len() - end).min(self.repeated_motions);
        self.motions.truncate(end);
        self.routines.truncate(end);
        self.ran_beside.truncate(beside);
        self.here = here;
        if let (Some(log), Some(length)) = (&mut self.log, logged) {
            log.truncate(length);
        }
        if begins_elsewhere {
            let site = &mut self.motions[begin].site;
            site.indivisible = (site.indivisible).or(Some(
                "the next pass of its loop comes to it from another place",
            ));
        }
        if !is_same {
            let reason = "the loop never ends, and its second pass is another than its first: places, frames, speeds or zones";
            self.fault(
                header,
                (
                    reason.to_owned(),
                    "write a loop that ends, or state at the begin of each pass what it goes by",
                ),
            );
        }
        flow
    }

    /// A loop with a variable that counts.
    fn count(&mut self, header: &Range<usize>, block: &[Statement]) -> Flow {
        let file = self.file();
        let Some(counting) = D::counting(file, header) else {
            let reason = "the loop does not say from where to where it counts".to_owned();
            self.fault(
                header,
                (reason, "write its variable, from where, and to where"),
            );
            return Flow::Next;
        };
        let mut number = |tokens: Range<usize>| self.value(&D::expression_of(file, tokens));
        let (from, end) = (number(counting.from), number(counting.to));
        let step = counting.step.map(number);
        let (Some(first), Some(end_at)) = (from.as_number(), end.as_number()) else {
            let unknown = [from, end].into_iter().find(|of| of.as_number().is_none());
            let unknown = unknown.unwrap_or_else(|| Datum::truth(false));
            self.pass_over_loop(block, header, &unknown);
            return Flow::Next;
        };
        let usual = if D::OWN_COUNTER && end_at < first {
            -1.0
        } else {
            1.0
        };
        let step = match step.as_ref().map(Datum::as_number) {
            None => usual,
            Some(Some(step)) if step != 0.0 => step,
            Some(_) => {
                let reason = "the step of the loop is 0, or not known".to_owned();
                self.fault(header, (reason, SET_IT));
                return Flow::Next;
            }
        };
        let variable = D::expression_of(file, counting.variable.clone());
        let own = Name::of(file.word(counting.variable.start)).filter(|_| D::OWN_COUNTER);
        let depth = self.calls.len() - 1;
        let hidden = own.and_then(|own| self.calls[depth].slots.get(&own).cloned());
        let place = match own {
            Some(name) => {
                let slot = Slot::Own(Datum::number(first));
                self.calls[depth].slots.insert(name, slot);
                Some(Place {
                    root: Root::Routine(depth, name),
                    path: Vec::new(),
                })
            }
            None => self.place(&variable),
        };
        let mut value = first;
        let mut flow = Flow::Next;
        while (step > 0.0 && value <= end_at) || (step < 0.0 && value >= end_at) {
            if let Some(place) = &place {
                self.put(place, Datum::number(value));
            }
            if own.is_none() {
                self.log_counter(&variable, value);
            }
            flow = self.block(block);
            if !matches!(flow, Flow::Next | Flow::Continues) || !self.counts_statement() {
                break;
            }
            if own.is_none() {
                // The block may change the variable.
                let now = self.value(&variable);
                let Some(number) = now.as_number() else {
                    self.pass_over_loop(block, header, &now);
                    break;
                };
                value = number;
            }
            // Numbers of robots have single precision.
            value = f64::from(value as f32 + step as f32);
        }
        match (own, hidden) {
            (Some(name), Some(slot)) => {
                self.calls[depth].slots.insert(name, slot);
            }
            (Some(name), None) => {
                self.calls[depth].slots.remove(&name);
            }
            (None, _) if matches!(flow, Flow::Next | Flow::Continues) => {
                self.lose(&variable, &"it counted a loop that has ended".into());
            }
            (None, _) => {}
        }
        match flow {
            Flow::Breaks | Flow::Continues => Flow::Next,
            flow => flow,
        }
    }
}

/// True if a statement of a block that runs for ever leaves it on a condition that decides where the program goes on.
fn has_way_out<D: Dialect>(file: &TokenFile<'_>, block: &[Statement], is_innermost: bool) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Leaves { tokens } => match D::leave(file, tokens) {
            Leave::Jump(_) | Leave::Returns(_) => true,
            Leave::Breaks => is_innermost,
            Leave::Ends | Leave::Continues => false,
        },
        Statement::Branches { blocks, .. } => {
            (blocks.iter()).any(|block| has_way_out::<D>(file, block, is_innermost))
        }
        Statement::Loop { block, .. } => has_way_out::<D>(file, block, false),
        _ => false,
    })
}
