//! Numbers of a model file changed in its text, so that comments, order and everything else stay as they are.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::schema::{Document, Element};

/// Names of the components of vectors and matrices in paths.
const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// A number by its path, its new value, and the words about its source.
#[derive(Clone, Debug)]
pub struct NumberEdit {
    /// Path, as in [`crate::Parameter::path`].
    pub path: String,
    /// Value in the unit of its key.
    pub value: f64,
    /// Words for the key `source` of the element, section or stiffness that has the number; left as they are without any.
    pub source: Option<String>,
}

/// The text with the numbers; none where one of them does not stand in the text as its path says: it is shared out to a limb, a
/// deviation that the file does not have, or a factor.
pub(crate) fn edited(text: &str, document: &Document, edits: &[NumberEdit]) -> Option<String> {
    let tree = DeTable::parse(text).ok()?;
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    for edit in edits {
        let found = place(tree.get_ref(), document, &edit.path)?;
        for span in &found.numbers {
            changes.push((span.clone(), written(edit.value)));
        }
        let Some(words) = &edit.source else { continue };
        let quoted = toml::Value::String(words.clone()).to_string();
        let change = match found.owner.get("source") {
            Some(own) => (own.span(), quoted),
            None => match behind_last(text, found.owner) {
                Some((at, before)) => (at..at, format!("{before}source = {quoted}")),
                None => continue,
            },
        };
        // Several numbers of one element have one source.
        if !changes.iter().any(|(span, _)| *span == change.0) {
            changes.push(change);
        }
    }
    changes.sort_by_key(|(span, _)| (span.start, span.end));
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for (span, words) in &changes {
        out.push_str(text.get(at..span.start)?);
        out.push_str(words);
        at = span.end;
    }
    out.push_str(text.get(at..)?);
    Some(out)
}

/// Nine digits: more than any measurement has.
fn written(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if (1e-3..1e7).contains(&size) || size == 0.0 => format!("{rounded:?}"),
        _ => format!("{rounded:e}"),
    }
}

/// Where a key can be added to a table behind its last value, and what has to stand before it.
fn behind_last(text: &str, table: &DeTable<'_>) -> Option<(usize, &'static str)> {
    let values = table
        .values()
        .filter(|v| !matches!(v.get_ref(), DeValue::Table(_)));
    let end = values.map(|v| v.span().end).max()?;
    let rest = text.get(end..)?;
    let next = rest.trim_start().chars().next();
    match next {
        // In braces.
        Some('}' | ',') => Some((end, ", ")),
        // In a table of several lines, behind a comment on the line of the value.
        _ => Some((end + rest.find('\n').unwrap_or(rest.len()), "\n")),
    }
}

/// Where a number stands.
struct Place<'a, 't> {
    /// Spans of the number: two of a matrix beside its diagonal.
    numbers: Vec<Range<usize>>,
    /// The element, section or stiffness that has it.
    owner: &'a DeTable<'t>,
}

fn place<'a, 't>(tree: &'a DeTable<'t>, document: &Document, path: &str) -> Option<Place<'a, 't>> {
    let (kind, rest) = path.split_once('.')?;
    let table = tree.get(kind)?.get_ref().as_table()?;
    let named = |name: &str| {
        rest.strip_prefix(name)
            .and_then(|after| after.strip_prefix('.'))
    };
    let (owner, rest) = match kind {
        "chain" => {
            let (name, chain) = document
                .chain
                .iter()
                .find(|(name, _)| named(name).is_some())?;
            let rest = named(name)?;
            let label = |(i, element): (usize, &Element)| element.name_or_number(i + 1);
            let mut labels = chain.elements.iter().enumerate().map(label);
            let behind = |label: &String| rest.strip_prefix(label.as_str())?.strip_prefix('.');
            let index = labels.position(|label| behind(&label).is_some())?;
            let rest = behind(&chain.elements[index].name_or_number(index + 1))?;
            let elements = table
                .get(name.as_str())?
                .get_ref()
                .as_table()?
                .get("elements")?;
            let own = elements.get_ref().as_array()?.get(index)?;
            (own.get_ref().as_table()?, rest)
        }
        "section" | "stiffness" => {
            let names = table.keys().map(|k| k.get_ref().to_string());
            let name = names.into_iter().find(|name| named(name).is_some())?;
            (
                table.get(name.as_str())?.get_ref().as_table()?,
                named(&name)?,
            )
        }
        _ => return None,
    };
    let mut steps: Vec<&str> = rest.split('.').collect();
    let component = |word: &str| COMPONENTS.iter().position(|c| *c == word);
    let mut indices = Vec::new();
    while let Some(index) = steps.last().and_then(|word| component(word)) {
        indices.insert(0, index);
        steps.pop();
    }
    let mut value = owner.get(*steps.first()?)?;
    for step in &steps[1..] {
        value = value.get_ref().as_table()?.get(*step)?;
    }
    let at = |indices: &[usize]| {
        let mut own = value;
        for index in indices {
            own = own.get_ref().as_array()?.get(*index)?;
        }
        matches!(own.get_ref(), DeValue::Float(_) | DeValue::Integer(_)).then(|| own.span())
    };
    let mut numbers = vec![at(&indices)?];
    if let [row, column] = indices[..]
        && row != column
    {
        numbers.push(at(&[column, row])?);
    }
    Some(Place { numbers, owner })
}
