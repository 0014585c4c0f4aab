//! Lines of a flat program in answers: beside each the line that it came from, in the JSON and under the text.

use std::borrow::Cow;

use kinetostat_machining::{FlatProgram, Warning, merged};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

use crate::ui::layout::{columns, wrapped};

/// An answer whose lines get their `source_line` and `source_file`, where the program was written flat.
pub(crate) struct WithSources<'a, T>(pub(crate) &'a T, pub(crate) Option<&'a FlatProgram>);

impl<T: Serialize> Serialize for WithSources<'_, T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Some(flat) = self.1 else {
            return self.0.serialize(to);
        };
        let mut value = serde_json::to_value(self.0).map_err(serde::ser::Error::custom)?;
        add(&mut value, flat);
        value.serialize(to)
    }
}

/// The schema of the answer; the lines that are added are further properties.
impl<T: JsonSchema> JsonSchema for WithSources<'_, T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

fn add(value: &mut Value, flat: &FlatProgram) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|value| add(value, flat)),
        Value::Object(object) => {
            object.values_mut().for_each(|value| add(value, flat));
            add_here(object, flat);
        }
        _ => {}
    }
}

fn add_here(object: &mut Map<String, Value>, flat: &FlatProgram) {
    // An object with a file already refers to a line of that file.
    if object.get("file").is_some_and(|file| !file.is_null()) {
        return;
    }
    let line = object.get("line").and_then(Value::as_u64);
    let line = line.and_then(|line| usize::try_from(line).ok());
    if let Some((file, line)) = line.and_then(|line| flat.source_of(line)) {
        object.insert("source_line".to_owned(), line.into());
        object.insert("source_file".to_owned(), file.into());
    }
}

/// Lines listed under a text.
const MOST_LISTED: usize = 20;

/// List below a text for people: the origin of the lines that it names.
pub(crate) fn listed_under(text: &str, flat: Option<&FlatProgram>) -> String {
    let Some(flat) = flat else {
        return String::new();
    };
    let mut out = format!("\n{}", wrapped(&format!("{}.", flat.description()), 0));
    let lines = flat.lines_in(text);
    let rows = lines.iter().take(MOST_LISTED).filter_map(|line| {
        let (file, from) = flat.source_of(*line)?;
        Some(vec![
            format!("line {line}"),
            format!("line {from} of {file}"),
        ])
    });
    out.push_str(&columns(&rows.collect::<Vec<_>>(), 2));
    if lines.len() > MOST_LISTED {
        out.push_str(&format!("  and {} more\n", lines.len() - MOST_LISTED));
    }
    out
}

/// Warnings, one of each kind, with the lines that theirs came from.
pub(crate) fn of_warnings(warnings: Vec<Warning>, flat: Option<&FlatProgram>) -> Vec<Warning> {
    let warnings = merged(warnings);
    match flat {
        Some(flat) => {
            let with = |warning: Warning| warning.with_sources(flat);
            warnings.into_iter().map(with).collect()
        }
        None => warnings,
    }
}

/// Two cells of a table of points: the line and its file; none where the program was not written flat.
pub(crate) fn cells(line: usize, flat: Option<&FlatProgram>) -> Option<[String; 2]> {
    let source = flat?.source_of(line);
    Some(match source {
        Some((file, line)) => [line.to_string(), crate::ui::csv_cell::text(file)],
        None => [String::new(), String::new()],
    })
}

/// Their names.
pub(crate) const COLUMNS: [&str; 2] = ["source_line", "source_file"];
