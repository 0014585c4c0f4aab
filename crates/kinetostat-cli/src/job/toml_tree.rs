//! Parsed TOML with the places of its values: what lies at a place, and taking it out.

use std::ops::Range;

use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

pub(crate) fn not_finite(value: &Spanned<DeValue<'_>>, found: &mut Vec<Range<usize>>) {
    match value.get_ref() {
        DeValue::Float(f) => {
            let number: f64 = f.as_str().replace('_', "").parse().unwrap_or(f64::NAN);
            if !number.is_finite() {
                found.push(value.span());
            }
        }
        DeValue::Array(list) => list.iter().for_each(|v| not_finite(v, found)),
        DeValue::Table(table) => table.values().for_each(|v| not_finite(v, found)),
        _ => {}
    }
}

/// Takes out what stands at a place and notes it, and the table without it; false where nothing is there.
pub(crate) fn take(
    table: &mut DeTable<'_>,
    span: Range<usize>,
    taken: &mut Vec<(String, Range<usize>)>,
) -> bool {
    let around = around(table, &span);
    let Some(key) = take_out(table, &span) else {
        return false;
    };
    // The place of a table under a header is the header: what is taken from it lies elsewhere.
    taken.extend(around.map(|table| (String::new(), table)));
    taken.push((key, span));
    true
}

/// The place of the innermost table with an entry that a place lies in; none for the whole file.
fn around(table: &DeTable<'_>, span: &Range<usize>) -> Option<Range<usize>> {
    let tables = table.values().flat_map(|value| match value.get_ref() {
        DeValue::Array(list) => list.iter().collect(),
        _ => vec![value],
    });
    for value in tables {
        let DeValue::Table(inner) = value.get_ref() else {
            continue;
        };
        if let Some(found) = around(inner, span) {
            return Some(found);
        }
        let mut entries = inner.iter();
        if entries.any(|(key, value)| holds(&key.span(), span) || holds(&value.span(), span)) {
            return Some(value.span());
        }
    }
    None
}

pub(crate) fn holds(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end && !outer.is_empty()
}

/// Takes out the innermost entry that a place lies in, and tells its key; none if there is no such entry.
fn take_out(table: &mut DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let mut own = None;
    for (key, value) in table.iter_mut() {
        let mine = holds(&key.span(), span) || holds(&value.span(), span);
        if mine {
            own = Some(key.clone());
        }
        match value.get_mut() {
            DeValue::Table(inner) => {
                let taken = take_out(inner, span);
                if taken.is_some() {
                    return taken;
                }
            }
            DeValue::Array(list) => {
                let mut whole = None;
                for (i, entry) in list.iter_mut().enumerate() {
                    let place = entry.span();
                    if let DeValue::Table(inner) = entry.get_mut() {
                        let taken = take_out(inner, span);
                        if taken.is_some() {
                            return taken;
                        }
                        if holds(&place, span) {
                            whole = Some(i);
                        }
                    }
                }
                if let Some(i) = whole {
                    let others = list.iter().enumerate().filter(|(other, _)| *other != i);
                    *list = others.map(|(_, entry)| entry.clone()).collect();
                    // An entry of a list has no key.
                    return Some(String::new());
                }
            }
            _ => {}
        }
    }
    let key = own?;
    table.remove(&key).map(|_| key.get_ref().to_string())
}

/// The table that is written at a place.
pub(crate) fn table_of<'a, 't>(
    table: &'a mut DeTable<'t>,
    span: &Range<usize>,
) -> Option<&'a mut DeTable<'t>> {
    for (_, value) in table.iter_mut() {
        let place = value.span();
        if let DeValue::Table(inner) = value.get_mut() {
            if place == *span {
                return Some(inner);
            }
            if let Some(found) = table_of(inner, span) {
                return Some(found);
            }
        }
    }
    None
}
