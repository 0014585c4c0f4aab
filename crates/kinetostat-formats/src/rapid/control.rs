//! Order of a run: calls, branches, loops, jumps.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::operation::same;
use crate::interpreter::value::Datum;
use crate::rapid::arguments::Arguments;
use crate::rapid::expression::{arguments_of, expression_of};
use crate::rapid::lex::Kind;
use crate::rapid::passing::SET_IT;
use crate::rapid::run::{Called, DEEPEST, Run, Slot};
use crate::rapid::symbols::Scope;
use crate::rapid::table::motion_row;
use crate::rapid::tree::{Choice, Statement};
use crate::text::name::Name;

/// Most statements of a run.
const MOST_STATEMENTS: usize = 5_000_000;

/// Where a run goes on behind a statement.
pub(super) enum Flow {
    Next,
    /// Behind the call of the routine, with the value of a function.
    Returns(Option<Datum>),
    /// At a label of a block around it.
    To(Name, Range<usize>),
    /// Nowhere: the program ends.
    Ends,
}

impl Run<'_, '_> {
    /// Runs a routine with the slots of its parameters.
    pub(super) fn call(&mut self, routine: usize, slots: BTreeMap<Name, Slot>) -> Flow {
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
            Flow::Next | Flow::To(..) => Flow::Returns(None),
        }
    }

    /// Calls a routine of the files with the arguments of a statement.
    pub(super) fn call_with(
        &mut self,
        called: usize,
        arguments: &[Argument],
        tokens: &Range<usize>,
    ) -> Flow {
        if self.depth >= DEEPEST {
            let reason = "calls and blocks are nested deeper than 200".to_owned();
            self.fault(tokens, (reason, "call what is deepest from main"));
            return Flow::Next;
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
            let Some(parameter) = parameter else { continue };
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
                None => Slot::Own(self.value(value)),
            };
            slots.insert(parameter.name, slot);
        }
        self.call(called, slots)
    }

    /// The value of a function of the files.
    pub(super) fn call_function(
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
    pub(super) fn block(&mut self, statements: &[Statement]) -> Flow {
        let mut at = 0;
        while let Some(statement) = statements.get(at) {
            at += 1;
            self.statements += 1;
            if self.statements > MOST_STATEMENTS {
                if let Some(tokens) = statement.tokens() {
                    let reason =
                        "the program runs more than 5 million statements up to here".to_owned();
                    self.fault(
                        &tokens,
                        (reason, "end its loop, or read the part that cuts by itself"),
                    );
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
                        Some(label) => at = label,
                        None => return Flow::To(label, tokens),
                    }
                }
                flow => return flow,
            }
        }
        Flow::Next
    }

    fn statement(&mut self, statement: &Statement) -> Flow {
        match statement {
            Statement::Label { .. } => Flow::Next,
            Statement::Call { tokens } => self.instruction(tokens, Choice::OneOfAll),
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
                header,
                block,
                whole,
            } => {
                self.depth += 1;
                let flow = self.repeat(header, block);
                self.depth -= 1;
                self.log_passed_over(whole);
                flow
            }
        }
    }

    /// `a.b{i} := value;`
    fn assign(&mut self, tokens: &Range<usize>, assign: usize) {
        let file = self.file();
        let to = expression_of(file, tokens.start..assign);
        let value = expression_of(
            file,
            assign + 1..tokens.end.saturating_sub(1).max(assign + 1),
        );
        let value = self.value(&value);
        self.log_assignment(tokens, assign);
        match self.place(&to) {
            Some(place) => self.put(&place, value),
            None => {
                let reason = self.changed(&to);
                self.lose(&to, &reason);
            }
        }
    }

    fn leave(&mut self, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let word = file.word(tokens.start).to_ascii_uppercase();
        match word.as_slice() {
            b"GOTO" => match Name::of(file.word(tokens.start + 1)) {
                Some(label) => Flow::To(label, tokens.clone()),
                None => Flow::Next,
            },
            b"RETURN" => {
                let end = tokens.end.saturating_sub(1);
                let value = (end > tokens.start + 1)
                    .then(|| expression_of(file, tokens.start + 1..end))
                    .map(|value| self.value(&value));
                Flow::Returns(value)
            }
            _ => {
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
            let condition = expression_of(self.file(), tokens.clone());
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
            (Choice::Compact, [Statement::Call { tokens }]) => self.instruction(tokens, choice),
            _ => self.block(block),
        }
    }

    /// TEST with its cases: the first condition is what is compared.
    fn test(&mut self, conditions: &[Range<usize>], blocks: &[Vec<Statement>]) -> Flow {
        let file = self.file();
        let Some((subject, cases)) = conditions.split_first() else {
            return Flow::Next;
        };
        let value = self.value(&expression_of(file, subject.clone()));
        for (index, case) in cases.iter().enumerate() {
            let is_default = case.is_empty();
            let mut is_it = Some(is_default);
            for own in ranges(file.tokens.as_slice(), case) {
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
        let to = case
            .clone()
            .find(|at| file.word(*at).eq_ignore_ascii_case(b"TO"));
        let part = |run: &mut Self, tokens| run.value(&expression_of(file, tokens));
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

    /// FOR and WHILE.
    fn repeat(&mut self, header: &Range<usize>, block: &[Statement]) -> Flow {
        let file = self.file();
        let is_word = |at: usize, word: &str| file.word(at).eq_ignore_ascii_case(word.as_bytes());
        if header.len() > 1 && is_word(header.start + 1, "FROM") {
            return self.count(header, block);
        }
        let condition = expression_of(file, header.clone());
        if condition.node == Node::Truth(true) {
            self.find(
                header,
                "the loop never ends: its first pass is read, and its corrections are those of all"
                    .to_owned(),
            );
            return match self.block(block) {
                Flow::Next => Flow::Ends,
                flow => flow,
            };
        }
        loop {
            self.forget_results();
            let value = self.value(&condition);
            match value.as_truth() {
                Some(true) => {}
                Some(false) => return Flow::Next,
                None => {
                    self.pass_over(&[block], header, &value);
                    return Flow::Next;
                }
            }
            self.statements += 1;
            match self.block(block) {
                Flow::Next if self.statements <= MOST_STATEMENTS => {}
                flow => return flow,
            }
        }
    }

    /// `i FROM a TO b STEP c`.
    fn count(&mut self, header: &Range<usize>, block: &[Statement]) -> Flow {
        let file = self.file();
        let find = |word: &str| {
            let mut all = header.clone();
            all.find(|at| file.word(*at).eq_ignore_ascii_case(word.as_bytes()))
        };
        let (to, step) = (find("TO"), find("STEP"));
        let Some((name, to)) = Name::of(file.word(header.start)).zip(to) else {
            let reason = "the loop does not say from where to where it counts".to_owned();
            self.fault(header, (reason, "write FOR i FROM a TO b DO"));
            return Flow::Next;
        };
        let last = step.unwrap_or(header.end);
        let mut number = |tokens: Range<usize>| self.value(&expression_of(file, tokens));
        let (from, end) = (number(header.start + 2..to), number(to + 1..last));
        let step = step.map(|at| number(at + 1..header.end));
        let (Some(first), Some(end_at)) = (from.as_number(), end.as_number()) else {
            let unknown = [from, end].into_iter().find(|of| of.as_number().is_none());
            let unknown = unknown.unwrap_or_else(|| Datum::truth(false));
            self.pass_over(&[block], header, &unknown);
            return Flow::Next;
        };
        let usual = if end_at < first { -1.0 } else { 1.0 };
        let step = match step.as_ref().map(Datum::as_number) {
            None => usual,
            Some(Some(step)) if step != 0.0 => step,
            Some(_) => {
                let reason = "the step of the loop is 0, or not known".to_owned();
                self.fault(header, (reason, SET_IT));
                return Flow::Next;
            }
        };
        let depth = self.calls.len() - 1;
        let hidden = self.calls[depth].slots.get(&name).cloned();
        let mut value = first;
        let mut flow = Flow::Next;
        while (step > 0.0 && value <= end_at) || (step < 0.0 && value >= end_at) {
            self.calls[depth]
                .slots
                .insert(name, Slot::Own(Datum::number(value)));
            self.statements += 1;
            flow = self.block(block);
            if !matches!(flow, Flow::Next) || self.statements > MOST_STATEMENTS {
                break;
            }
            // Numbers of RAPID have single precision.
            value = f64::from(value as f32 + step as f32);
        }
        match hidden {
            Some(slot) => self.calls[depth].slots.insert(name, slot),
            None => self.calls[depth].slots.remove(&name),
        };
        flow
    }

    /// An instruction, or the call of a procedure.
    pub(super) fn instruction(&mut self, tokens: &Range<usize>, choice: Choice) -> Flow {
        let file = self.file();
        let name = Name::of(file.word(tokens.start));
        if let Some(row) = name.as_ref().and_then(motion_row) {
            self.motion_by(row, tokens, choice);
            self.log_motion(row, tokens);
            return Flow::Next;
        }
        if let (Some(name), Scope::Routine(from)) = (&name, self.scope)
            && let Some(called) = self.symbols.routine(from, name)
        {
            let arguments = arguments_of(file, tokens.start + 1..tokens.end);
            return match self.call_with(called, &arguments, tokens) {
                Flow::Ends => Flow::Ends,
                _ => Flow::Next,
            };
        }
        self.log_instruction(tokens);
        self.carried(name, tokens)
    }

    /// The arguments of an instruction; functions of these files in them run.
    pub(super) fn arguments(&mut self, tokens: &Range<usize>) -> Arguments {
        let file = self.file();
        let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        let has_function = |expression: &&Expression| matches!(expression.node, Node::Call(..));
        let options = arguments
            .options
            .iter()
            .filter_map(|(_, value)| value.as_ref());
        for expression in arguments.ordered.iter().chain(options).filter(has_function) {
            self.value(expression);
        }
        arguments
    }
}

/// Tokens between the commas of a case.
fn ranges(tokens: &[crate::rapid::lex::Token], case: &Range<usize>) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = case.start;
    for at in case.clone() {
        if tokens
            .get(at)
            .is_some_and(|token| token.kind == Kind::Symbol(b','))
        {
            found.push(start..at);
            start = at + 1;
        }
    }
    if start < case.end {
        found.push(start..case.end);
    }
    found
}
