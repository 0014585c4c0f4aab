//! Branches and loops on values that only the controller knows: passed over where they neither move the tool nor change modal state.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::{Dialect, Place, Root, Run, Slot};
use crate::interpreter::symbols::{Meaning, Scope};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Leave, LoopKind, Statement};
use crate::interpreter::value::Datum;
use crate::text::Name;

impl<D: Dialect> Run<'_, '_, D> {
    /// Passes over blocks of which only the controller knows whether they run: what they assign is unknown behind them. A block that moves the
    /// tool, changes modal state or leaves its routine is a fault at the condition.
    pub(crate) fn pass_over(
        &mut self,
        blocks: &[&[Statement]],
        condition: &Range<usize>,
        value: &Datum,
    ) {
        self.counts_passed(blocks);
        let mut all = blocks.iter().copied().flatten();
        if all.any(|statement| self.acts_here(statement, false)) {
            let why = value
                .unknown_reason()
                .map_or("it is no truth", |reason| reason);
            let reason = format!("which way the program goes here is not known: {why}");
            self.fault(condition, (reason, SET_IT));
            return;
        }
        self.lose_assigned(blocks, condition);
    }

    /// Statements that are looked at in loops and calls count as those that run there.
    fn counts_passed(&mut self, blocks: &[&[Statement]]) {
        if self.in_loops > 0 || self.calls.len() > 1 {
            for statement in blocks.iter().copied().flatten() {
                statement.each(&mut |_| self.repeated_statements += 1);
            }
        }
    }

    /// Passes over a loop as [`Run::pass_over`]; its block may leave the loop.
    pub(super) fn pass_over_loop(
        &mut self,
        block: &[Statement],
        condition: &Range<usize>,
        value: &Datum,
    ) {
        self.counts_passed(&[block]);
        match self.only_waits(block) {
            true => self.lose_assigned(&[block], condition),
            false => self.pass_over(&[block], condition, value),
        }
    }

    /// True for the block of a loop that neither moves the tool nor changes modal state.
    pub(super) fn only_waits(&self, block: &[Statement]) -> bool {
        !block
            .iter()
            .any(|statement| self.acts_here(statement, true))
    }

    /// True if a routine that is called moves the tool or changes modal state.
    pub(crate) fn routine_acts(&self, routine: usize) -> bool {
        let mut seen = BTreeSet::from([routine]);
        let body = &self.symbols.routines[routine].routine.body;
        body.iter()
            .any(|statement| self.acts_called(routine, statement, &mut seen))
    }

    fn acts_here(&self, statement: &Statement, in_loop: bool) -> bool {
        match self.scope {
            Scope::Routine(routine) => self.acts(routine, statement, in_loop, &mut BTreeSet::new()),
            Scope::Module(_) => false,
        }
    }

    /// Data that blocks assign are unknown behind them.
    fn lose_assigned(&mut self, blocks: &[&[Statement]], condition: &Range<usize>) {
        let Scope::Routine(routine) = self.scope else {
            return;
        };
        self.passed_over = true;
        for statement in blocks.iter().copied().flatten() {
            for root in self.assigned_in(routine, std::slice::from_ref(statement)) {
                if self.is_constant(root) {
                    continue;
                }
                let name = match root {
                    Root::Module(index) => self.shown(index),
                    Root::Routine(_, name) | Root::Undeclared(name) => {
                        String::from_utf8_lossy(name.letters()).into_owned()
                    }
                };
                let file = self.file();
                let line = file.source.line_of(file.span(condition).start);
                let reason = format!("`{name}` is changed while the program runs (line {line})");
                let value = self.stated_value(root);
                let value = value.unwrap_or_else(|| Datum::unknown(reason));
                // A parameter may stand for data of the caller.
                let slot = match root {
                    Root::Routine(depth, name) => {
                        (self.calls.get(depth)).and_then(|called| called.slots.get(&name))
                    }
                    _ => None,
                };
                let place = match slot {
                    Some(Slot::Of(place)) => place.clone(),
                    _ => Place {
                        root,
                        path: Vec::new(),
                    },
                };
                self.put(&place, value);
            }
        }
    }

    /// True if a statement moves the tool, changes modal state, or leaves its block; one of a loop (`in_loop`) may leave the loop.
    fn acts(
        &self,
        routine: usize,
        statement: &Statement,
        in_loop: bool,
        seen: &mut BTreeSet<usize>,
    ) -> bool {
        let file = &self.files[self.symbols.routines[routine].file];
        let calls_what_acts = |tokens: &Range<usize>, seen: &mut BTreeSet<usize>| {
            let names = tokens.clone().filter_map(|at| Name::of(file.word(at)));
            let called: Vec<usize> = names
                .filter_map(|name| self.symbols.routine(routine, &name))
                .collect();
            called.into_iter().any(|called| {
                let body = &self.symbols.routines[called].routine.body;
                seen.insert(called)
                    && (body.iter()).any(|inner| self.acts_called(called, inner, seen))
            })
        };
        match statement {
            Statement::Label { .. } => false,
            // A program that ends here does not cut what follows: it is taken to go on.
            Statement::Leaves { tokens } => match D::leave(file, tokens) {
                Leave::Ends => false,
                Leave::Breaks | Leave::Continues => !in_loop,
                Leave::Jump(_) | Leave::Returns(_) => true,
            },
            Statement::Call { tokens } | Statement::Assignment { tokens, .. } => {
                D::acts(self, file, tokens) || calls_what_acts(tokens, seen)
            }
            Statement::Branches {
                conditions, blocks, ..
            } => {
                conditions.iter().any(|part| calls_what_acts(part, seen))
                    || blocks
                        .iter()
                        .flatten()
                        .any(|inner| self.acts(routine, inner, in_loop, seen))
            }
            Statement::Loop { header, block, .. } => {
                calls_what_acts(header, seen)
                    || (block.iter()).any(|inner| self.acts(routine, inner, true, seen))
            }
        }
    }

    /// True if a statement of a routine that is called acts behind the call: one that returns leaves its routine alone.
    fn acts_called(
        &self,
        routine: usize,
        statement: &Statement,
        seen: &mut BTreeSet<usize>,
    ) -> bool {
        match statement {
            Statement::Leaves { tokens } => {
                let file = &self.files[self.symbols.routines[routine].file];
                !matches!(D::leave(file, tokens), Leave::Returns(_))
            }
            _ => self.acts(routine, statement, false, seen),
        }
    }

    /// Data that statements of a routine, and the routines that they call, assign or give to what may change them.
    pub(crate) fn assigned_in(&self, routine: usize, statements: &[Statement]) -> Vec<Root> {
        let mut found = Vec::new();
        self.collect_assigned(routine, statements, &mut BTreeSet::new(), &mut found);
        found
    }

    fn collect_assigned(
        &self,
        routine: usize,
        statements: &[Statement],
        seen: &mut BTreeSet<usize>,
        found: &mut Vec<Root>,
    ) {
        let file = &self.files[self.symbols.routines[routine].file];
        let is_inner = !seen.is_empty();
        let (mut names, mut called) = (Vec::new(), Vec::new());
        let is_own = |name: &Name| self.symbols.routine(routine, name).is_some();
        let mut see = |tokens: &Range<usize>, assign: Option<usize>| {
            changed_in::<D>(file, tokens, assign, &is_own, &mut names);
            let words = tokens.clone().filter_map(|at| Name::of(file.word(at)));
            called.extend(words.filter_map(|name| self.symbols.routine(routine, &name)));
        };
        let mut counted = Vec::new();
        for statement in statements {
            statement.each(&mut |inner| match inner {
                Statement::Assignment { tokens, assign } => see(tokens, Some(*assign)),
                Statement::Call { tokens } | Statement::Leaves { tokens } => see(tokens, None),
                Statement::Branches { conditions, .. } => {
                    conditions.iter().for_each(|tokens| see(tokens, None));
                }
                Statement::Loop { kind, header, .. } => {
                    see(header, None);
                    let variable = Name::of(file.word(header.start));
                    counted.extend(variable.filter(|_| *kind == LoopKind::Counting));
                }
                Statement::Label { .. } => {}
            });
        }
        if !D::OWN_COUNTER {
            names.extend(counted);
        }
        for name in names {
            match self.symbols.meaning(routine, &name) {
                Some(Meaning::Datum(index))
                    if matches!(self.symbols.data[index].scope, Scope::Module(_)) =>
                {
                    found.push(Root::Module(index));
                }
                // Data of a routine that is called are gone behind the call.
                Some(_) if !self.calls.is_empty() && !is_inner => {
                    found.push(Root::Routine(self.calls.len() - 1, name));
                }
                None if D::DECLARES_BY_USE => {
                    found.push(Root::Undeclared(name));
                }
                _ => {}
            }
        }
        seen.insert(routine);
        for called in called {
            if seen.insert(called) {
                let body = &self.symbols.routines[called].routine.body;
                self.collect_assigned(called, body, seen, found);
            }
        }
    }
}

pub(crate) const SET_IT: &str = "state the value of what decides it (--set NAME=VALUE, [values] in a job), or write the motions without the branch";

/// Names that a statement assigns, and those that it gives to a routine or an instruction that may change them.
fn changed_in<D: Dialect>(
    file: &TokenFile<'_>,
    tokens: &Range<usize>,
    assign: Option<usize>,
    is_own: &dyn Fn(&Name) -> bool,
    names: &mut Vec<Name>,
) {
    let Some(first) = Name::of(file.word(tokens.start)) else {
        return;
    };
    if let Some(at) = assign {
        names.push(first);
        let value = D::expression_of(file, file.value_behind(at, tokens));
        given_away::<D>(&value, is_own, names);
        return;
    }
    let changes = is_own(&first) || D::changes_arguments(&first);
    for argument in D::arguments_of(file, tokens.start + 1..tokens.end) {
        if let Some(value) = argument.value {
            match (changes, root_name(&value)) {
                (true, Some(name)) => names.push(name),
                _ => given_away::<D>(&value, is_own, names),
            }
        }
    }
}

/// Names that an expression gives to functions which may change them.
fn given_away<D: Dialect>(
    expression: &Expression,
    is_own: &dyn Fn(&Name) -> bool,
    names: &mut Vec<Name>,
) {
    match &expression.node {
        Node::Call(name, arguments) => {
            let changes = is_own(name) || !D::leaves_arguments(name);
            for Argument { value, .. } in arguments {
                let Some(value) = value else { continue };
                match (changes, root_name(value)) {
                    (true, Some(name)) => names.push(name),
                    _ => given_away::<D>(value, is_own, names),
                }
            }
        }
        Node::List(parts) => parts
            .iter()
            .for_each(|part| given_away::<D>(part, is_own, names)),
        Node::One(_, operand) => given_away::<D>(operand, is_own, names),
        Node::Two(_, operands) => operands
            .iter()
            .for_each(|part| given_away::<D>(part, is_own, names)),
        Node::Field(of, _) => given_away::<D>(of, is_own, names),
        Node::Element(of, indices) => {
            given_away::<D>(of, is_own, names);
            indices
                .iter()
                .for_each(|part| given_away::<D>(part, is_own, names));
        }
        Node::Members(members) => members
            .iter()
            .for_each(|(_, part)| given_away::<D>(part, is_own, names)),
        Node::Number(_)
        | Node::Truth(_)
        | Node::Text
        | Node::Choice(_)
        | Node::Word(_)
        | Node::Unreadable => {}
    }
}

/// The name with which a place begins.
fn root_name(expression: &Expression) -> Option<Name> {
    match &expression.node {
        Node::Word(name) => Some(*name),
        Node::Field(of, _) | Node::Element(of, _) => root_name(of),
        _ => None,
    }
}
