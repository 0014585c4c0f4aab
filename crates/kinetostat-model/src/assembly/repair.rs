//! Mistakes of meaning in a file that has mistakes of form too: the parts of wrong form are taken
//! out, and the rest is looked at as if they were right, so that one run shows all mistakes.

use serde::Deserialize;
use toml::de::{DeTable, DeValue};

use crate::assembly::mechanism::assemble;
use crate::findings::Findings;
use crate::problem::{Finding, KeyPath, PathStep};
use crate::schema::Document;
use crate::text::source::Source;

/// Keys by which other parts of a file are found: without one of them nothing else can be checked.
const BEARING: [&str; 6] = ["schema", "name", "from", "to", "chain", "elements"];

/// Finds mistakes besides `findings`; empty where they could only be guessed.
pub(crate) fn others(source: &Source<'_>, findings: &[Finding]) -> Vec<Finding> {
    search(source, findings).unwrap_or_default()
}

fn search(source: &Source<'_>, findings: &[Finding]) -> Option<Vec<Finding>> {
    let mut tree = DeTable::parse(source.text).ok()?;
    // Tables in which something of wrong form stands: what is missing there may be just that.
    let mut around: Vec<KeyPath> = Vec::new();
    for finding in findings {
        around.push(take_out(tree.get_mut(), finding)?);
    }
    let reader = toml::de::Deserializer::from(tree);
    let document = Document::deserialize(reader).ok()?;
    let mut more = Findings {
        incomplete: true,
        ..Findings::default()
    };
    assemble(&document, &mut more);
    let near = |place: &KeyPath| {
        around
            .iter()
            .any(|a| place.0.starts_with(&a.0) || a.0.starts_with(&place.0))
    };
    more.errors.retain(|finding| !near(&finding.place));
    Some(more.errors)
}

/// Takes what a finding is about out of the tree, or puts in what it misses; the place of the table
/// where that is. `None` where the rest of the file cannot be understood without it.
fn take_out<'t>(tree: &mut DeTable<'t>, finding: &'t Finding) -> Option<KeyPath> {
    let place = &finding.place;
    if let Some(missing) = &finding.remedy.missing {
        if place.0.is_empty() || BEARING.contains(&missing.as_str()) {
            return None;
        }
        let value = DeValue::parse(finding.remedy.stand_in.as_deref()?).ok()?;
        let key = serde_spanned::Spanned::new(0..0, missing.clone().into());
        table_at(tree, &place.0)?.insert(key, value);
        return Some(place.clone());
    }
    // An entry of a list goes with its list, so that no other entry changes its place.
    let last = place
        .0
        .iter()
        .rposition(|s| matches!(s, PathStep::Key(_)))?;
    let (inner, PathStep::Key(key)) = (&place.0[..last], &place.0[last]) else {
        return None;
    };
    if inner.is_empty() || BEARING.contains(&&**key) {
        return None;
    }
    let table = table_at(tree, inner)?;
    let found = table.keys().find(|k| k.get_ref() == &**key).cloned();
    if let Some(found) = found {
        let of_tables = |value: &DeValue<'_>| {
            value.as_array().is_some_and(|list| {
                list.iter()
                    .any(|v| matches!(v.get_ref(), DeValue::Table(_)))
            })
        };
        if table.get(&found).is_some_and(|v| of_tables(v.get_ref())) {
            return None;
        }
        table.remove(&found);
        // A list with a wrong entry is replaced as a whole: the stand-in for the entry is no list.
        if let (true, Some(text)) = (last + 1 == place.0.len(), &finding.remedy.stand_in) {
            table.insert(found, DeValue::parse(text).ok()?);
        }
    }
    Some(KeyPath(inner.to_vec()))
}

/// The table at the end of a path.
fn table_at<'a, 't>(tree: &'a mut DeTable<'t>, path: &[PathStep]) -> Option<&'a mut DeTable<'t>> {
    let mut table = tree;
    let mut steps = path.iter().peekable();
    while let Some(step) = steps.next() {
        let PathStep::Key(key) = step else {
            return None;
        };
        let (_, value) = table.iter_mut().find(|(k, _)| k.get_ref() == &**key)?;
        let mut value = value.get_mut();
        while let Some(PathStep::Index(index)) = steps.peek() {
            let DeValue::Array(list) = value else {
                return None;
            };
            value = list.get_mut(*index)?.get_mut();
            steps.next();
        }
        table = match value {
            DeValue::Table(table) => table,
            _ => return None,
        };
    }
    Some(table)
}
