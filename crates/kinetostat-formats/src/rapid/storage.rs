//! Data of a run: values of names, and assignments.

use std::rc::Rc;

use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::value::{Datum, Value};
use crate::model::frame::FrameUse;
use crate::rapid::evaluate::{Names, component_of, evaluate, index_of};
use crate::rapid::expression::{arguments_of, expression_of};
use crate::rapid::functions::{Given, computed, leaves_arguments};
use crate::rapid::literals::orient_of;
use crate::rapid::predefined::predefined;
use crate::rapid::run::{Place, Root, Run, Slot};
use crate::rapid::symbols::{Meaning, Scope};
use crate::rapid::tree::Change;
use crate::text::finding::Finding;
use crate::text::name::Name;

/// Deepest nesting of declarations that rest on others.
const DEEPEST: usize = 12;

/// Most elements of an array without a value.
const MOST_ELEMENTS: usize = 1_000_000;

impl Run<'_, '_> {
    /// The value of an expression of the routine that runs.
    pub(super) fn value(&mut self, expression: &Expression) -> Datum {
        let file = self.file();
        evaluate(file, expression, self)
    }

    /// Where the data of a name are stored.
    pub(super) fn root(&self, name: &Name) -> Option<Root> {
        let depth = self.calls.len().checked_sub(1);
        match self.symbols.meaning_in(self.scope, name)? {
            Meaning::Datum(index) => match self.symbols.data[index].scope {
                Scope::Module(_) => Some(Root::Module(index)),
                Scope::Routine(_) => Some(Root::Routine(depth?, *name)),
            },
            Meaning::Parameter => {
                let depth = depth?;
                let routine = &self.symbols.routines[self.calls[depth].routine];
                let is_parameter =
                    || (routine.routine.parameters.iter()).any(|own| own.name == *name);
                if self.calls[depth].slots.contains_key(name) || is_parameter() {
                    return Some(Root::Routine(depth, *name));
                }
                // The variable of a loop hides data of its name in the loop alone.
                match self
                    .symbols
                    .meaning_in(Scope::Module(routine.module), name)?
                {
                    Meaning::Datum(index) => Some(Root::Module(index)),
                    Meaning::Parameter => None,
                }
            }
        }
    }

    /// The value that is stored.
    pub(super) fn stored(&mut self, root: Root) -> Option<Datum> {
        match root {
            Root::Module(index) => {
                if !self.data.contains_key(&index) {
                    let value = self.initial(index);
                    self.data.insert(index, value);
                }
                if self.volatile.contains(&index) {
                    let name = self.shown(index);
                    return Some(Datum::unknown(format!(
                        "`{name}` is changed while the program runs: by an interrupt"
                    )));
                }
                self.data.get(&index).cloned()
            }
            Root::Routine(depth, name) => {
                let called = self.calls.get(depth)?;
                match called.slots.get(&name) {
                    Some(Slot::Own(datum)) => Some(datum.clone()),
                    Some(Slot::Of(place)) => {
                        let place = place.clone();
                        let whole = self.stored(place.root)?;
                        whole.part(&place.path).cloned()
                    }
                    None => {
                        let routine = called.routine;
                        let Meaning::Datum(index) = self.symbols.meaning(routine, &name)? else {
                            return None;
                        };
                        let value = self.initial(index);
                        let called = self.calls.get_mut(depth)?;
                        called.slots.insert(name, Slot::Own(value.clone()));
                        Some(value)
                    }
                }
            }
        }
    }

    /// The first value of a datum.
    pub(super) fn initial(&mut self, index: usize) -> Datum {
        let datum = &self.symbols.data[index];
        if let Some(value) = self.values.get(&datum.node.name) {
            self.used_values.insert(datum.node.name);
            return value.clone();
        }
        let Some(tokens) = datum.node.initial.clone() else {
            return self.without_value(index);
        };
        if self.depth_of_data >= DEEPEST {
            return Datum::unknown("its declaration rests on too many others");
        }
        let node = datum.node;
        if node.change == Change::Persistent && is_kept(&node.type_name) {
            let file = &self.files[datum.file];
            self.findings.push(Finding {
                file: datum.file,
                line: file.source.line_of(file.span(&(node.name_at..node.name_at + 1)).start),
                message: format!(
                    "`{}` is PERS: the controller may hold another value than this file; load the written one",
                    self.shown(index)
                ),
            });
        }
        let outer = std::mem::replace(&mut self.scope, datum.scope);
        self.depth_of_data += 1;
        let expression = expression_of(&self.files[datum.file], tokens);
        let value = self.value(&expression);
        self.depth_of_data -= 1;
        self.scope = outer;
        value
    }

    /// The declaration of stored data; none of a parameter or the variable of a loop.
    pub(super) fn datum_of(&self, root: Root) -> Option<usize> {
        match root {
            Root::Module(index) => Some(index),
            Root::Routine(_, name) => match self.symbols.meaning_in(self.scope, &name)? {
                Meaning::Datum(index) => Some(index),
                Meaning::Parameter => None,
            },
        }
    }

    /// The value of a declaration without one.
    fn without_value(&mut self, index: usize) -> Datum {
        let datum = &self.symbols.data[index];
        let value = of_type(&datum.node.type_name)
            .filter(|_| datum.node.change == Change::Variable)
            .unwrap_or_else(|| {
                let name = self.shown(index);
                Datum::unknown(format!("`{name}` is declared without a value"))
            });
        let Some(sizes) = datum.node.dimensions.clone() else {
            return value;
        };
        let outer = std::mem::replace(&mut self.scope, datum.scope);
        let sizes: Vec<Option<usize>> = arguments_of(&self.files[datum.file], sizes)
            .iter()
            .map(|size| index_of(&self.value(size.value.as_ref()?)).map(|last| last + 1))
            .collect();
        self.scope = outer;
        let count = sizes
            .iter()
            .try_fold(1, |all: usize, own| all.checked_mul((*own)?));
        if count.is_none_or(|count| count > MOST_ELEMENTS) {
            return Datum::unknown("its array is too large, or of a size that is not known");
        }
        let sizes = sizes.into_iter().flatten().rev();
        sizes.fold(value, |value, size| Datum::list(vec![value; size]))
    }

    /// The name of a datum as it is declared.
    pub(super) fn shown(&self, index: usize) -> String {
        let datum = &self.symbols.data[index];
        let name = self.files[datum.file].word(datum.node.name_at);
        String::from_utf8_lossy(name).into_owned()
    }

    /// The place that an expression names; none where it is no place, or only the controller knows which.
    pub(super) fn place(&mut self, expression: &Expression) -> Option<Place> {
        match &expression.node {
            Node::Word(name) => {
                let root = self.root(name)?;
                if let Root::Routine(depth, name) = root
                    && let Some(Slot::Of(place)) = self.calls.get(depth)?.slots.get(&name)
                {
                    return Some(place.clone());
                }
                let path = Vec::new();
                Some(Place { root, path })
            }
            Node::Field(of, name) => {
                let mut place = self.place(of)?;
                let whole = self.value(of);
                place.path.push(component_of(&whole, name)?);
                Some(place)
            }
            Node::Element(of, indices) => {
                let mut place = self.place(of)?;
                for index in indices {
                    let index = self.value(index);
                    place.path.push(index_of(&index)?);
                }
                Some(place)
            }
            _ => None,
        }
    }

    /// True for data that the files declare with a value.
    pub(super) fn has_first_value(&mut self, expression: &Expression) -> bool {
        let place = self.place(expression);
        let index = place.and_then(|place| self.datum_of(place.root));
        index.is_some_and(|index| self.symbols.data[index].node.initial.is_some())
    }

    /// Stores a value.
    pub(super) fn put(&mut self, place: &Place, value: Datum) {
        // The parts beside the place stay.
        let whole = match place.path.is_empty() {
            true => value,
            false => {
                let Some(mut whole) = self.stored(place.root) else {
                    return;
                };
                whole.put(&place.path, value);
                whole
            }
        };
        match place.root {
            Root::Module(index) => {
                self.data.insert(index, whole);
            }
            Root::Routine(depth, name) => {
                if let Some(called) = self.calls.get_mut(depth) {
                    called.slots.insert(name, Slot::Own(whole));
                }
            }
        }
    }

    /// A name or a part of it gets a value that only the controller knows.
    pub(super) fn lose(&mut self, expression: &Expression, reason: &Rc<str>) {
        let mut whole = expression;
        while let Node::Field(of, _) | Node::Element(of, _) = &whole.node {
            whole = of;
        }
        // Of an element that only the controller knows, the whole array.
        let place = self.place(expression).or_else(|| self.place(whole));
        let Some(place) = place.filter(|place| !self.is_constant(place.root)) else {
            return;
        };
        let stated = match place.path.is_empty() {
            true => self.stated_value(place.root),
            false => None,
        };
        self.put(
            &place,
            stated.unwrap_or_else(|| Datum::unknown(reason.clone())),
        );
    }

    /// True for constants, which nothing changes.
    pub(super) fn is_constant(&self, root: Root) -> bool {
        let index = self.datum_of(root);
        index.is_some_and(|index| self.symbols.data[index].node.change == Change::Constant)
    }

    /// The value that the caller states for data that only the controller knows.
    pub(super) fn stated_value(&mut self, root: Root) -> Option<Datum> {
        let name = match root {
            Root::Module(index) => self.symbols.data[index].node.name,
            Root::Routine(_, name) => name,
        };
        let value = self.values.get(&name).cloned()?;
        self.used_values.insert(name);
        Some(value)
    }

    /// The reason for a datum that a statement changes.
    pub(super) fn changed(&self, expression: &Expression) -> Rc<str> {
        let file = self.file();
        let name = file.word(expression.tokens.start);
        let line = file.source.line_of(file.span(&expression.tokens).start);
        let name = String::from_utf8_lossy(name);
        format!("`{name}` is changed while the program runs (line {line})").into()
    }

    /// Arguments that a routine which is not known may change.
    pub(super) fn lose_arguments(&mut self, arguments: &[Argument]) {
        for value in arguments
            .iter()
            .filter_map(|argument| argument.value.as_ref())
        {
            if let Node::Word(_) | Node::Field(..) | Node::Element(..) = value.node {
                let reason = self.changed(value);
                self.lose(value, &reason);
            }
        }
    }

    /// Results of functions are those of one statement.
    pub(super) fn forget_results(&mut self) {
        let depth = self.calls.len();
        if !self.results.is_empty() {
            self.results.retain(|(own, ..), _| *own < depth);
        }
    }

    /// `DInput(di1)` and its kin, with the value that the caller states for the signal.
    fn stated_signal(&mut self, name: &Name, arguments: &[Argument]) -> Option<Datum> {
        let reads = [
            "DINPUT", "DOUTPUT", "GINPUT", "GOUTPUT", "AINPUT", "AOUTPUT", "TESTDI",
        ];
        let [
            Argument {
                value: Some(signal),
                ..
            },
        ] = arguments
        else {
            return None;
        };
        let (true, Node::Word(signal)) = (reads.iter().any(|read| name.is(read)), &signal.node)
        else {
            return None;
        };
        let value = self.values.get(signal).cloned()?;
        self.used_values.insert(*signal);
        Some(match (name.is("TESTDI"), value.as_number()) {
            (true, Some(number)) => Datum::truth(number != 0.0),
            _ => value,
        })
    }

    /// `CRobT`: the end of the last motion, with the same tool and work object.
    fn current_target(&self, arguments: &[Argument]) -> Option<Datum> {
        let last = self.motions.get(self.here?)?;
        let pose = last.target.pose()?;
        let is_that_of = |name: &str, frame: &FrameUse| {
            let option = |argument: &&Argument| argument.option.is_some_and(|own| own.is(name));
            let given = arguments.iter().find(option)?;
            let text = self.text(given.value.as_ref()?);
            Some(text.eq_ignore_ascii_case(&frame.name))
        };
        let is_same = is_that_of("TOOL", &last.tool).unwrap_or(true)
            && is_that_of("WOBJ", &last.work_object).unwrap_or(true);
        let external = (0..6).map(|axis| pose.external.get(axis).copied().flatten().unwrap_or(9e9));
        is_same.then(|| {
            Datum::list(vec![
                Datum::numbers(pose.position_mm.iter().copied()),
                orient_of(&pose.orientation),
                Datum::numbers(pose.configuration.numbers.iter().copied()),
                Datum::numbers(external),
            ])
        })
    }

    /// The arguments of a function of the controller.
    fn given(&mut self, arguments: &[Argument]) -> Given {
        let mut given = Given {
            ordered: Vec::with_capacity(4),
            options: Vec::new(),
        };
        for Argument { option, value } in arguments {
            let value = value.as_ref().map(|value| self.value(value));
            match (option, value) {
                (Some(name), value) => {
                    given
                        .options
                        .push((*name, value.unwrap_or(Datum::truth(true))));
                }
                (None, Some(value)) => given.ordered.push(value),
                (None, None) => {}
            }
        }
        given
    }
}

/// True for the types of data whose values decide where the tool goes, or which way the program takes. Frames, loads and speeds that
/// controllers keep are stated again as they are set up.
fn is_kept(type_name: &Name) -> bool {
    let kinds = ["NUM", "DNUM", "BOOL", "POS", "ORIENT", "POSE", "ROBTARGET"];
    kinds.iter().any(|kind| type_name.is(kind))
}

/// The value of a type without one: numbers are 0, truths FALSE, texts empty, and aggregates of those.
///
/// Source: ABB, Technical reference manual - RAPID kernel, Data declarations.
fn of_type(type_name: &Name) -> Option<Datum> {
    let zeros = |count: usize| Datum::numbers(std::iter::repeat_n(0.0, count));
    Some(match type_name.letters() {
        b"NUM" | b"DNUM" | b"INTNUM" | b"ERRNUM" => Datum::number(0.0),
        b"BOOL" => Datum::truth(false),
        b"STRING" => Datum::of(Value::Text("".into())),
        b"POS" => zeros(3),
        b"ORIENT" | b"CONFDATA" | b"SPEEDDATA" => zeros(4),
        b"EXTJOINT" | b"ROBJOINT" => zeros(6),
        b"POSE" => Datum::list(vec![zeros(3), zeros(4)]),
        b"JOINTTARGET" => Datum::list(vec![zeros(6), zeros(6)]),
        b"ROBTARGET" => Datum::list(vec![zeros(3), zeros(4), zeros(4), zeros(6)]),
        _ => return None,
    })
}

impl Names for Run<'_, '_> {
    fn word(&mut self, name: &Name, whole: &Expression) -> Datum {
        let file = self.file();
        let shown = || String::from_utf8_lossy(file.word(whole.tokens.start)).into_owned();
        let stored = self.root(name).map(|root| self.stored(root));
        match stored {
            Some(Some(datum)) => datum,
            Some(None) => Datum::unknown(format!(
                "`{}` is an argument of the routine: no call of these files gives it",
                shown()
            )),
            None => {
                if let Some(stated) = self.values.get(name) {
                    self.used_values.insert(*name);
                    return stated.clone();
                }
                if let Some(known) = self.predefined.get(name) {
                    return known.clone();
                }
                match predefined(name) {
                    Some(datum) => self.predefined.entry(*name).or_insert(datum).clone(),
                    None => Datum::unknown(format!("no `{}` is declared in these files", shown())),
                }
            }
        }
    }

    fn call(&mut self, name: &Name, arguments: &[Argument], whole: &Expression) -> Datum {
        let key = (self.calls.len(), self.file().index, whole.tokens.start);
        if let Some(known) = self.results.get(&key) {
            return known.clone();
        }
        if let Scope::Routine(from) = self.scope
            && let Some(called) = self.symbols.routine(from, name)
        {
            let result = self.call_function(called, arguments, &whole.tokens);
            self.results.insert(key, result.clone());
            return result;
        }
        if let Some(stated) = self.stated_signal(name, arguments) {
            return stated;
        }
        if name.is("PRESENT")
            && let Some(Node::Word(parameter)) = arguments
                .first()
                .and_then(|of| Some(&of.value.as_ref()?.node))
        {
            let called = self.calls.last();
            return Datum::truth(called.is_some_and(|called| called.slots.contains_key(parameter)));
        }
        if name.is("CROBT")
            && let Some(here) = self.current_target(arguments)
        {
            self.results.insert(key, here.clone());
            return here;
        }
        let given = self.given(arguments);
        if let Some(found) = computed(name, &given) {
            return found;
        }
        if !leaves_arguments(name) {
            self.lose_arguments(arguments);
        }
        let name = String::from_utf8_lossy(self.file().word(whole.tokens.start)).into_owned();
        Datum::unknown(format!("`{name}` is computed while the program runs"))
    }
}
