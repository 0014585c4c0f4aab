//! Whole runs: the programs of the files one after the other, and what is said at the end: values that were stated, motions that no run came
//! to, statements that ran several times.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::operation::same;
use crate::interpreter::run::{Dialect, Root, Run, Ways};
use crate::interpreter::storage::behind;
use crate::interpreter::token::Kind;
use crate::interpreter::tree::RoutineKind;
use crate::interpreter::value::{Datum, Step, Value};
use crate::model::motion::{Runs, mark_repeated};
use crate::model::parsed::unreached_motions;
use crate::model::site::TargetSite;
use crate::text::Name;

impl<D: Dialect> Run<'_, '_, D> {
    /// Runs `main`, then each procedure that nothing calls as a program of its own.
    pub(crate) fn whole(mut self) -> Self {
        self.note_volatile();
        let main = self.symbols.main;
        let called = self.called_by_name();
        let others = (0..self.symbols.routines.len()).filter(|index| {
            let kind = self.symbols.routines[*index].routine.kind;
            Some(*index) != main && kind == RoutineKind::Procedure && !called.contains(index)
        });
        let roots: Vec<usize> = main.into_iter().chain(others).collect();
        for root in roots {
            self.here = None;
            D::begin(&mut self);
            self.runs = match Some(root) == main {
                true => Runs::Once,
                false => Runs::Elsewhere,
            };
            self.begin_data();
            if self.log.is_none() || Some(root) == main {
                self.call(root, BTreeMap::new());
                self.refuse_kept();
            }
        }
        self.findings.extend(self.values.findings());
        self.say_of_unreached();
        mark_repeated(&mut self.motions);
        self.fix_what_others_call();
        let targets = std::mem::take(&mut self.targets);
        self.targets = targets.with_other_uses(self.files, self.symbols);
        self
    }

    /// Routines that a statement of the files names.
    fn called_by_name(&self) -> BTreeSet<usize> {
        let mut called = BTreeSet::new();
        if self.symbols.routines.len() < 2 {
            return called;
        }
        for (index, home) in self.symbols.routines.iter().enumerate() {
            let file = &self.files[home.file];
            let mut see = |tokens: &Range<usize>| {
                let is_word = |at: &usize| file.tokens[*at].kind == Kind::Word;
                let words = tokens.clone().filter(is_word);
                let names = words.filter_map(|at| Name::of(file.word(at)));
                called.extend(names.filter_map(|name| self.symbols.routine(index, &name)));
            };
            home.routine.each_part(&mut see);
        }
        called
    }

    /// Data that routines of interrupts assign may change between any two statements.
    fn note_volatile(&mut self) {
        for index in D::interrupting(self) {
            let body = &self.symbols.routines[index].routine.body;
            let volatile = self.assigned_in(index, body).into_iter();
            self.volatile.extend(volatile.filter_map(|root| match root {
                Root::Module(datum) => Some(datum),
                Root::Routine(..) | Root::Undeclared(_) => None,
            }));
        }
    }

    /// A target that a routine computes is that of the calls that ran. Where code that did not run calls the routine too (an interrupt, an
    /// error handler, a branch), or a computed name may, it is not written as numbers.
    fn fix_what_others_call(&mut self) {
        let is_computed = self.outside_calls.iter().any(|call| call.name.is_none());
        let mut mentions: BTreeMap<Name, usize> = BTreeMap::new();
        for file in self.files {
            for at in (0..file.tokens.len()).filter(|at| file.tokens[*at].kind == Kind::Word) {
                if let Some(name) = Name::of(file.word(at)) {
                    *mentions.entry(name).or_default() += 1;
                }
            }
        }
        let is_open: Vec<bool> = (self.symbols.routines.iter().enumerate())
            .map(|(index, home)| {
                let sites = self.call_sites.get(&index).map_or(0, BTreeSet::len);
                let named = mentions
                    .get(&home.routine.name)
                    .copied()
                    .unwrap_or_default();
                // One mention is its own declaration.
                sites > 0 && (is_computed || named > sites + 1)
            })
            .collect();
        for (motion, routine) in self.motions.iter_mut().zip(&self.routines) {
            if !is_open.get(*routine).copied().unwrap_or_default() {
                continue;
            }
            let source = self.files[motion.file].source;
            let fixed = |site: &TargetSite| match site {
                TargetSite::Replaced(_) => true,
                TargetSite::Offset { arguments, .. } => arguments.iter().any(|number| {
                    let text = std::str::from_utf8(source.part(&number.span));
                    text.is_ok_and(|text| text.trim().parse::<f64>().is_err())
                }),
                _ => false,
            };
            let reason = "its routine computes it, and is called by code that does not run here (an interrupt, an error handler, a branch)";
            if fixed(&motion.site.target) {
                motion.site.target = TargetSite::Fixed(reason);
            }
            if let Some((_, via)) = &mut motion.site.via
                && fixed(via)
            {
                *via = TargetSite::Fixed(reason);
            }
        }
    }

    /// Motions that the run does not come to: of arms that are not taken, behind the end of the program, of error handlers and interrupts.
    fn say_of_unreached(&mut self) {
        let mut unreached: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for home in &self.symbols.routines {
            let file = &self.files[home.file];
            home.routine.each_part(&mut |tokens| {
                let start = file.span(tokens).start;
                let is_motion = || {
                    let name = Name::of(file.word(tokens.start));
                    name.is_some_and(|name| D::is_motion(&name))
                };
                if !self.ran.contains(&(file.index, start)) && is_motion() {
                    let lines = unreached.entry(file.index).or_default();
                    lines.push(file.source.line_of(start));
                }
            });
        }
        let all = unreached.into_iter();
        (self.findings).extend(all.filter_map(|(file, lines)| unreached_motions(file, lines)));
    }

    /// Refuses data that decide where the tool goes, that began with the values of the files, and end with others: the next run begins with
    /// those.
    fn refuse_kept(&mut self) {
        for (index, uses) in std::mem::take(&mut self.first_uses) {
            let node = self.symbols.data[index].node;
            let Some(now) = self.data.get(&index).cloned() else {
                continue;
            };
            if !D::decides_places(node) {
                continue;
            }
            let first = self.initial(index);
            let is_other =
                |(step, given): (&Step, &Ways)| match (first.part(&[*step]), now.part(&[*step])) {
                    (Some(first), Some(now)) => differs(first, now, given),
                    _ => false,
                };
            let whole = uses.whole.as_ref();
            if whole.is_some_and(|given| differs(&first, &now, given))
                || uses.parts.iter().any(is_other)
            {
                let datum = &self.symbols.data[index];
                let file = &self.files[datum.file];
                let span = file.span(&(node.name_at..node.name_at + 1));
                let reason =
                    "the run changes it after it was used: the next run begins with another value";
                let remedy =
                    "give it its value in the program before it is used, or declare a further one";
                note(&mut self.faults, || {
                    ProgramError::at(file.source, span, reason, remedy)
                });
            }
        }
    }

    /// Begins a program of the files: what another one changed is not known.
    fn begin_data(&mut self) {
        self.left_changed.extend(self.given.keys());
        self.data.clear();
        self.undeclared.clear();
        self.first_uses.clear();
        self.given.clear();
    }
}

/// True if a part of a value with which the files begin became another, but for those that were given a value before (`given`).
fn differs(first: &Datum, now: &Datum, given: &Ways) -> bool {
    let is_other = |step: Step, value: &Datum| {
        let given = behind(given, step);
        let is_given = given.contains(&Vec::new());
        let now = now.part(&[step]);
        !is_given && now.is_none_or(|now| differs(value, now, &given))
    };
    if !first.members().is_empty() {
        let mut members = first.members().iter();
        return members.any(|(name, value)| is_other(Step::Member(*name), value));
    }
    if !first.parts().is_empty() {
        let mut parts = first.parts().iter().enumerate();
        return parts.any(|(at, value)| is_other(Step::Index(at), value));
    }
    let is_known = first.unknown_reason().is_none() && !matches!(first.value, Value::Members(_));
    is_known && !same(&first.value, &now.value)
}
