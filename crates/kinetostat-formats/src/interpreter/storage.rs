//! Data of a run: values of names, and assignments.

use std::rc::Rc;

use crate::interpreter::evaluate::{Names, evaluate, index_of};
use crate::interpreter::expression::{Argument, Expression, Node, Operator};
use crate::interpreter::run::{Dialect, Place, Root, Run, Slot, Ways};
use crate::interpreter::symbols::{Meaning, Scope};
use crate::interpreter::tree::Change;
use crate::interpreter::value::{Datum, Step};
use crate::text::Name;
use crate::text::source::Finding;

/// Deepest nesting of declarations that rest on others.
const DEEPEST: usize = 12;

/// Limit of the elements of an array without a value.
const MOST_ELEMENTS: usize = 1_000_000;

impl<D: Dialect> Run<'_, '_, D> {
    /// The value of an expression of the routine that runs.
    pub(crate) fn value(&mut self, expression: &Expression) -> Datum {
        let file = self.file();
        evaluate(file, expression, self)
    }

    /// Storage of the data of a name.
    pub(crate) fn root(&self, name: &Name) -> Option<Root> {
        let depth = self.calls.len().checked_sub(1);
        let Some(meaning) = self.symbols.meaning_in(self.scope, name) else {
            let is_known = self.undeclared.contains_key(name);
            return is_known.then_some(Root::Undeclared(*name));
        };
        match meaning {
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

    /// Notes that data of a module, or an element of them, are used before the run gave them a value.
    pub(crate) fn note_use(&mut self, root: Root, element: Option<Step>) {
        let Root::Module(index) = root else {
            return;
        };
        let none = Ways::new();
        let given = match self.given.get(&index) {
            Some(None) => return,
            Some(Some(given)) => given,
            None => &none,
        };
        let use_of = self.first_uses.entry(index).or_default();
        match element {
            Some(step) if !use_of.parts.contains_key(&step) => {
                let behind = behind(given, step);
                if !behind.contains(&Vec::new()) {
                    use_of.parts.insert(step, behind);
                }
            }
            Some(_) => {}
            None => {
                use_of.whole.get_or_insert_with(|| given.clone());
            }
        }
    }

    /// The value that is stored.
    pub(crate) fn stored(&mut self, root: Root) -> Option<Datum> {
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
            Root::Undeclared(name) => self.undeclared.get(&name).cloned(),
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
    pub(crate) fn initial(&mut self, index: usize) -> Datum {
        let datum = &self.symbols.data[index];
        if datum.node.change != Change::Constant
            && let Some(value) = self.values.ask(&datum.node.name)
        {
            return value;
        }
        if self.left_changed.contains(&index) {
            return Datum::unknown(format!(
                "`{}` is changed by another program of these files",
                self.shown(index)
            ));
        }
        if self.open_data.len() >= DEEPEST || !self.open_data.insert(index) {
            return Datum::unknown("its declaration rests on itself, or on too many others");
        }
        let value = self.declared_value(index);
        self.open_data.remove(&index);
        value
    }

    fn declared_value(&mut self, index: usize) -> Datum {
        let datum = &self.symbols.data[index];
        let Some(tokens) = datum.node.initial.clone() else {
            let whole = self.without_value(index);
            return self.with_elements(index, whole);
        };
        let node = datum.node;
        if let Some(message) = D::kept(self, index) {
            let file = &self.files[datum.file];
            let line = file.line_of(node.name_at);
            if self.noted.insert((datum.file, node.name_at, "kept")) {
                self.findings.push(Finding {
                    file: datum.file,
                    line,
                    message,
                });
            }
        }
        let expression = D::expression_of(&self.files[datum.file], tokens);
        self.within(datum.scope, |run| run.value(&expression))
    }

    /// A declared array with the first values of its elements, which stand in statements of their own.
    fn with_elements(&mut self, index: usize, mut whole: Datum) -> Datum {
        let datum = &self.symbols.data[index];
        for (number, preset) in &datum.elements {
            let expression = D::expression_of(&self.files[datum.file], preset.value.clone());
            let value = self.within(datum.scope, |run| run.value(&expression));
            let Some(element) = number.checked_sub(1) else {
                whole = value;
                continue;
            };
            if element >= MOST_ELEMENTS {
                continue;
            }
            if whole.parts().len() <= element {
                let mut parts = whole.parts().to_vec();
                parts.resize_with(element + 1, || {
                    Datum::unknown("it has no value in these files")
                });
                whole = Datum::list(parts);
            }
            whole.put(&[Step::Index(element)], value);
        }
        whole
    }

    /// The declaration of stored data; none of a parameter or the variable of a loop.
    pub(crate) fn datum_of(&self, root: Root) -> Option<usize> {
        match root {
            Root::Module(index) => Some(index),
            Root::Undeclared(_) => None,
            Root::Routine(_, name) => match self.symbols.meaning_in(self.scope, &name)? {
                Meaning::Datum(index) => Some(index),
                Meaning::Parameter => None,
            },
        }
    }

    /// The value of a declaration without one.
    fn without_value(&mut self, index: usize) -> Datum {
        let datum = &self.symbols.data[index];
        let value = D::of_type(datum.node).unwrap_or_else(|| {
            let name = self.shown(index);
            Datum::unknown(format!("`{name}` is declared without a value"))
        });
        let Some(sizes) = datum.node.dimensions.clone() else {
            return value;
        };
        let arguments = D::arguments_of(&self.files[datum.file], sizes);
        let sizes: Vec<Option<usize>> = self.within(datum.scope, |run| {
            let size = |size: &Argument| Some(index_of(&run.value(size.value.as_ref()?), 1)? + 1);
            arguments.iter().map(size).collect()
        });
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
    pub(crate) fn shown(&self, index: usize) -> String {
        let datum = &self.symbols.data[index];
        let name = self.files[datum.file].word(datum.node.name_at);
        String::from_utf8_lossy(name).into_owned()
    }

    /// The place that an expression names; none where it is no place, or only the controller knows which.
    pub(crate) fn place(&mut self, expression: &Expression) -> Option<Place> {
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
                let whole = self.stored(place.root)?;
                let none = Datum::list(Vec::new());
                let whole = whole.part(&place.path).unwrap_or(&none);
                place.path.push(D::component(whole, name)?);
                Some(place)
            }
            Node::Element(of, indices) => {
                let mut place = self.place(of)?;
                let whole = self.stored(place.root);
                let none = Datum::list(Vec::new());
                let whole = whole.as_ref().and_then(|whole| whole.part(&place.path));
                for index in indices {
                    let index = self.value(index);
                    let step = D::element(whole.unwrap_or(&none), &index)?;
                    place.path.push(step);
                }
                Some(place)
            }
            _ => None,
        }
    }

    /// True for data that the files declare with a value.
    pub(crate) fn has_first_value(&mut self, expression: &Expression) -> bool {
        let place = self.place(expression);
        let index = place.and_then(|place| self.datum_of(place.root));
        index.is_some_and(|index| self.symbols.data[index].node.initial.is_some())
    }

    /// The type of stored data, where they are declared.
    pub(crate) fn type_of(&self, root: Root) -> Option<Name> {
        match root {
            Root::Module(index) => Some(self.symbols.data[index].node.type_name),
            Root::Undeclared(_) => None,
            Root::Routine(depth, name) => {
                let routine = self.symbols.routines[self.calls.get(depth)?.routine].routine;
                let node = routine.data.iter().find(|node| node.name == name);
                node.map(|node| node.type_name)
            }
        }
    }

    /// Stores a value.
    pub(crate) fn put(&mut self, place: &Place, value: Datum) {
        let Place { root, path } = place;
        // The parts beside the place stay: the whole is taken out, so that it is not copied.
        let mut whole = match path.is_empty() {
            true => value.clone(),
            false if self.stored(*root).is_none() => return,
            false => match root {
                Root::Module(index) => self.data.remove(index),
                Root::Undeclared(name) => self.undeclared.remove(name),
                Root::Routine(depth, name) => {
                    let called = self.calls.get_mut(*depth);
                    match called.and_then(|called| called.slots.remove(name)) {
                        Some(Slot::Own(datum)) => Some(datum),
                        _ => None,
                    }
                }
            }
            .unwrap_or_else(|| Datum::unknown("it has no value")),
        };
        if !path.is_empty() {
            whole.put(path, value);
        }
        match *root {
            Root::Module(index) => {
                let given = self.given.entry(index).or_insert_with(|| Some(Ways::new()));
                match (path.as_slice(), given.as_mut()) {
                    ([], _) => *given = None,
                    (path, Some(ways)) if !ways.contains(path) => {
                        ways.insert(path.to_vec());
                    }
                    _ => {}
                }
                self.data.insert(index, whole);
            }
            Root::Undeclared(name) => {
                self.undeclared.insert(name, whole);
            }
            Root::Routine(depth, name) => {
                if let Some(called) = self.calls.get_mut(depth) {
                    called.slots.insert(name, Slot::Own(whole));
                }
            }
        }
    }

    /// A name or a part of it gets a value that only the controller knows.
    pub(crate) fn lose(&mut self, expression: &Expression, reason: &Rc<str>) {
        let mut whole = expression;
        while let Node::Field(of, _) | Node::Element(of, _) = &whole.node {
            whole = of;
        }
        // An unknown index invalidates the whole array.
        let place = self.place(expression).or_else(|| self.place(whole));
        let Some(place) = place.filter(|place| !self.is_constant(place.root)) else {
            if let (Node::Word(name), true) = (&whole.node, D::DECLARES_BY_USE)
                && self.root(name).is_none()
            {
                let unknown = Datum::unknown(reason.clone());
                self.undeclared.insert(*name, unknown);
            }
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
    pub(crate) fn is_constant(&self, root: Root) -> bool {
        let index = self.datum_of(root);
        index.is_some_and(|index| self.symbols.data[index].node.change == Change::Constant)
    }

    /// The value that the caller states for data that only the controller knows.
    pub(crate) fn stated_value(&mut self, root: Root) -> Option<Datum> {
        let name = match root {
            Root::Module(index) => self.symbols.data[index].node.name,
            Root::Routine(_, name) | Root::Undeclared(name) => name,
        };
        self.values.ask(&name)
    }

    /// The reason for a datum that a statement changes.
    pub(crate) fn changed(&self, expression: &Expression) -> Rc<str> {
        let file = self.file();
        let name = file.word(expression.tokens.start);
        let line = file.source.line_of(file.span(&expression.tokens).start);
        let name = String::from_utf8_lossy(name);
        format!("`{name}` is changed while the program runs (line {line})").into()
    }

    /// Arguments that a routine which is not known may change.
    pub(crate) fn lose_arguments(&mut self, arguments: &[Argument]) {
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
    pub(crate) fn forget_results(&mut self) {
        let depth = self.calls.len();
        if !self.results.is_empty() {
            self.results.retain(|(own, ..), _| *own < depth);
        }
    }
}

/// Ways that begin with a step, behind it.
pub(super) fn behind(ways: &Ways, step: Step) -> Ways {
    let from = ways.range(vec![step]..);
    let own = from.take_while(|way| way.first() == Some(&step));
    own.map(|way| way[1..].to_vec()).collect()
}

impl<D: Dialect> Names for Run<'_, '_, D> {
    fn component(&self, of: &Datum, name: &Name) -> Option<Step> {
        D::component(of, name)
    }

    fn element(&self, of: &Datum, index: &Datum) -> Option<Step> {
        D::element(of, index)
    }

    fn operation(&self, operator: Operator, left: &Datum, right: &Datum) -> Datum {
        D::operation(self, operator, left, right)
    }

    fn uses(&mut self, name: &Name, element: Option<Step>) {
        if let Some(root) = self.root(name) {
            self.note_use(root, element);
        }
    }

    fn divides_whole(&self, operands: &[Expression; 2]) -> bool {
        D::divides_whole(self, operands)
    }

    fn stated(&mut self, element: &Expression, at: &[Datum]) -> Option<Datum> {
        if self.values.is_empty() {
            return None;
        }
        let Node::Element(of, _) = &element.node else {
            return None;
        };
        // Key of the element: its indices, if they are known.
        let numbers: Option<Vec<String>> = (at.iter())
            .map(|index| index.as_number().map(|number| number.to_string()))
            .collect();
        let file = self.file();
        let text = match numbers {
            Some(numbers) => {
                let open = file.text(&(of.tokens.end..of.tokens.end + 1));
                let close = file.text(&(element.tokens.end - 1..element.tokens.end));
                format!(
                    "{}{open}{}{close}",
                    file.text(&of.tokens),
                    numbers.join(",")
                )
            }
            None => file.text(&element.tokens),
        };
        let letters: String = text.chars().filter(|own| !own.is_whitespace()).collect();
        self.values.ask(&Name::of(letters.as_bytes())?)
    }

    fn word(&mut self, name: &Name, whole: &Expression) -> Datum {
        let file = self.file();
        let shown = || String::from_utf8_lossy(file.word(whole.tokens.start)).into_owned();
        if D::changes_by_itself(name) {
            let stated = self.values.ask(name);
            return stated.unwrap_or_else(|| {
                Datum::unknown(format!("`{}` is known to the controller alone", shown()))
            });
        }
        let root = self.root(name);
        let stored = root.map(|root| self.stored(root));
        match stored {
            Some(Some(datum)) => datum,
            Some(None) => self.values.ask(name).unwrap_or_else(|| {
                Datum::unknown(format!(
                    "`{}` is an argument of the routine: no call of these files gives it",
                    shown()
                ))
            }),
            None => {
                if let Some(stated) = self.values.ask(name) {
                    return stated;
                }
                if let Some(known) = self.predefined.get(name) {
                    return known.clone();
                }
                match D::predefined(name) {
                    Some(datum) => self.predefined.entry(*name).or_insert(datum).clone(),
                    None if shown().starts_with('$') => {
                        Datum::unknown(format!("`{}` is known to the controller alone", shown()))
                    }
                    None => Datum::unknown(format!("no `{}` is declared in these files", shown())),
                }
            }
        }
    }

    fn call(&mut self, name: &Name, arguments: &[Argument], whole: &Expression) -> Datum {
        let key = self.key_of_call(whole);
        if let Some(known) = self.results.get(&key) {
            return known.clone();
        }
        if let Scope::Routine(from) = self.scope
            && let Some(called) = self.symbols.routine(from, name)
        {
            let lines = |run: &Self| run.log.as_ref().map_or(0, Vec::len);
            let before = lines(self);
            let result = self.call_function(called, arguments, &whole.tokens);
            if lines(self) > before {
                self.calls_that_act.insert(key);
            }
            self.results.insert(key, result.clone());
            return result;
        }
        if let Some(stated) = self.values.ask(name) {
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
        if let Some(found) = D::function(self, name, arguments, whole) {
            return found;
        }
        if !D::leaves_arguments(name) {
            self.lose_arguments(arguments);
        }
        let name = String::from_utf8_lossy(self.file().word(whole.tokens.start)).into_owned();
        Datum::unknown(format!("`{name}` is computed while the program runs"))
    }
}
