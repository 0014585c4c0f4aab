//! Values while a program runs, as a language writes them and as the caller states them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use crate::interpreter::reading::Grammar;
use crate::model::stated_value::StatedValue;
use crate::options::ReadOptions;
use crate::text::Name;
use crate::text::number::NumberText;
use crate::text::source::Finding;

/// The literal in a file that states a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Literal {
    /// An index of the files.
    pub file: usize,
    start: u32,
    end: u32,
}

impl Literal {
    /// Bytes of a file that is shorter than 4 GiB.
    pub(crate) fn new(file: usize, span: &Range<usize>) -> Self {
        Self {
            file,
            start: span.start as u32,
            end: span.end as u32,
        }
    }

    /// Bytes of its file.
    pub(crate) fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// True if it lies in these bytes of a file.
    pub(crate) fn is_within(&self, file: usize, span: &Range<usize>) -> bool {
        let own = self.span();
        self.file == file && span.start <= own.start && own.end <= span.end
    }
}

/// A value, without its place in a text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Truth(bool),
    Text(Rc<str>),
    /// An aggregate or an array.
    List(Rc<Vec<Datum>>),
    /// An aggregate with the names of its members, of which some may be left out.
    Members(Rc<Vec<(Name, Datum)>>),
    /// Known to the controller alone, with the reason.
    Unknown(Rc<str>),
}

/// A way into an aggregate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Step {
    /// An index from 0.
    Index(usize),
    Member(Name),
}

/// A value with the literal that states it, where one does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Datum {
    pub value: Value,
    pub literal: Option<Literal>,
}

impl Datum {
    /// A computed value.
    pub(crate) fn of(value: Value) -> Self {
        Self {
            value,
            literal: None,
        }
    }

    pub(crate) fn number(value: f64) -> Self {
        Self::of(Value::Number(value))
    }

    pub(crate) fn truth(value: bool) -> Self {
        Self::of(Value::Truth(value))
    }

    /// A list of computed numbers.
    pub(crate) fn numbers(values: impl IntoIterator<Item = f64>) -> Self {
        Self::list(values.into_iter().map(Self::number).collect())
    }

    pub(crate) fn list(parts: Vec<Self>) -> Self {
        Self::of(Value::List(Rc::new(parts)))
    }

    /// A value that only the controller knows.
    pub(crate) fn unknown(reason: impl Into<Rc<str>>) -> Self {
        Self::of(Value::Unknown(reason.into()))
    }

    pub(crate) fn as_number(&self) -> Option<f64> {
        match self.value {
            Value::Number(value) => Some(value),
            _ => None,
        }
    }

    pub(crate) fn as_truth(&self) -> Option<bool> {
        match self.value {
            Value::Truth(value) => Some(value),
            _ => None,
        }
    }

    /// Parts of a list; none of another value.
    pub(crate) fn parts(&self) -> &[Self] {
        match &self.value {
            Value::List(parts) => parts,
            _ => &[],
        }
    }

    /// The numbers of a list of so many.
    pub(crate) fn as_numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let parts: &[Self; N] = self.parts().try_into().ok()?;
        let mut numbers = [0.0; N];
        for (number, part) in numbers.iter_mut().zip(parts) {
            *number = part.as_number()?;
        }
        Some(numbers)
    }

    /// The number that it states in these bytes of a file.
    pub(crate) fn number_in(&self, file: usize, span: &Range<usize>) -> Option<NumberText> {
        let literal = self.literal.filter(|own| own.is_within(file, span))?;
        Some(NumberText {
            span: literal.span(),
            value: self.as_number()?,
        })
    }

    /// Members of an aggregate that names them; none of another value.
    pub(crate) fn members(&self) -> &[(Name, Self)] {
        match &self.value {
            Value::Members(members) => members,
            _ => &[],
        }
    }

    /// A member by its name in capitals.
    pub(crate) fn member(&self, capitals: &str) -> Option<&Self> {
        let mut members = self.members().iter();
        members
            .find(|(name, _)| name.is(capitals))
            .map(|(_, datum)| datum)
    }

    /// The reason of the first part that only the controller knows.
    pub(crate) fn unknown_reason(&self) -> Option<&Rc<str>> {
        match &self.value {
            Value::Unknown(reason) => Some(reason),
            Value::List(parts) => parts.iter().find_map(Self::unknown_reason),
            Value::Members(members) => members.iter().find_map(|(_, of)| of.unknown_reason()),
            _ => None,
        }
    }

    /// The part at the end of a way; none where there is no such part.
    pub(crate) fn part(&self, path: &[Step]) -> Option<&Self> {
        path.iter().try_fold(self, |own, step| match step {
            Step::Index(index) => own.parts().get(*index),
            Step::Member(name) => {
                let mut members = own.members().iter();
                members.find(|(own, _)| own == name).map(|(_, of)| of)
            }
        })
    }

    /// Puts a value at the end of a way; a member that is not there yet is added. A part of what only the controller knows leaves the whole
    /// unknown.
    pub(crate) fn put(&mut self, path: &[Step], value: Self) {
        let Some((step, rest)) = path.split_first() else {
            *self = value;
            return;
        };
        match (&mut self.value, step) {
            (Value::List(parts), Step::Index(index)) => {
                self.literal = None;
                if let Some(part) = Rc::make_mut(parts).get_mut(*index) {
                    part.put(rest, value);
                }
            }
            (Value::Members(members), Step::Member(name)) => {
                self.literal = None;
                let members = Rc::make_mut(members);
                if !members.iter().any(|(own, _)| own == name) {
                    members.push((*name, Self::of(Value::Members(Rc::default()))));
                }
                let mut all = members.iter_mut();
                if let Some((_, member)) = all.find(|(own, _)| own == name) {
                    member.put(rest, value);
                }
            }
            _ => {}
        }
    }
}

/// A value by the grammar of a language; `None` if a part of it is unknown.
pub(crate) fn printed(grammar: &Grammar, datum: &Datum) -> Option<String> {
    let list = |before: &str, parts: &mut dyn Iterator<Item = &Datum>| {
        let [open, close] = grammar.list?.map(char::from);
        let parts: Option<Vec<String>> = parts.map(|part| printed(grammar, part)).collect();
        Some(format!("{before}{open}{}{close}", parts?.join(",")))
    };
    Some(match &datum.value {
        Value::Number(value) => value.to_string(),
        Value::Truth(value) => grammar.truths[usize::from(*value)].to_owned(),
        Value::Text(text) => format!("\"{text}\""),
        Value::List(parts) => list("", &mut parts.iter())?,
        Value::Members(members) => {
            let (word, _) = grammar.aggregate?;
            list(word, &mut members.iter().map(|(_, part)| part))?
        }
        Value::Unknown(_) => return None,
    })
}

/// Stated values, and which of them the run asked for.
pub(crate) struct StatedValues<'o> {
    options: &'o ReadOptions,
    values: BTreeMap<Name, Datum>,
    used: BTreeSet<Name>,
}

impl<'o> StatedValues<'o> {
    /// Values of the caller's options.
    pub(crate) fn of(options: &'o ReadOptions) -> Self {
        let values = options.values.iter().filter_map(|(name, value)| {
            let value = match value {
                StatedValue::Number(number) => Value::Number(*number),
                StatedValue::Truth(truth) => Value::Truth(*truth),
                StatedValue::Text(text) => Value::Text(text.as_str().into()),
            };
            Some((Name::of(name.as_bytes())?, Datum::of(value)))
        });
        Self {
            options,
            values: values.collect(),
            used: BTreeSet::new(),
        }
    }

    /// True where nothing is stated.
    pub(crate) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The value of a name, which the run asks for.
    pub(crate) fn ask(&mut self, name: &Name) -> Option<Datum> {
        let value = self.values.get(name)?;
        self.used.insert(*name);
        Some(value.clone())
    }

    /// Values that decide the way of the program, and those that the run does not ask for.
    pub(crate) fn findings(&self) -> impl Iterator<Item = Finding> {
        self.options.values.iter().map(|(name, value)| {
            let is_used = Name::of(name.as_bytes()).is_some_and(|own| self.used.contains(&own));
            let message = match (is_used, value) {
                (false, _) => {
                    format!("a value of `{name}` is stated, and the run does not ask for it")
                }
                (true, StatedValue::Number(number)) => {
                    format!("`{name}` is {number}, as is stated")
                }
                (true, StatedValue::Truth(truth)) => format!("`{name}` is {truth}, as is stated"),
                (true, StatedValue::Text(text)) => format!("`{name}` is \"{text}\", as is stated"),
            };
            Finding {
                file: 0,
                line: 1,
                message,
            }
        })
    }
}
