//! Compares a file with the JSON Schema before anything is read from it, so that a mistake is
//! named in words, with its line and the nearest known key. The schema comes from the types in
//! [`crate::schema`]; nothing is listed twice.

use std::ops::Range;
use std::sync::OnceLock;

use serde_json::Value;
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::problem::{Finding, KeyPath, PathStep};
use crate::schema::Document;
use crate::text::hints;

/// The schema without `null`: TOML has no such value.
pub(crate) fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| {
        let mut value = schemars::schema_for!(Document).to_value();
        without_null(&mut value);
        value
    })
}

fn without_null(value: &mut Value) {
    match value {
        Value::Object(map) => {
            if let Some(Value::Array(types)) = map.get_mut("type") {
                types.retain(|t| t != "null");
                if let [only] = types.as_slice() {
                    let only = only.clone();
                    map.insert("type".into(), only);
                }
            }
            if map.get("default") == Some(&Value::Null) {
                map.remove("default");
            }
            if let Some(Value::Array(variants)) = map.get_mut("anyOf") {
                variants.retain(|v| v.get("type") != Some(&Value::from("null")));
                if let [Value::Object(only)] = variants.as_slice() {
                    let only = only.clone();
                    map.remove("anyOf");
                    map.extend(only);
                }
            }
            map.values_mut().for_each(without_null);
        }
        Value::Array(list) => list.iter_mut().for_each(without_null),
        _ => {}
    }
}

/// Every structural mistake of a file.
pub(crate) fn check(tree: &DeTable<'_>) -> Vec<Finding> {
    let mut checker = Checker {
        root: schema(),
        findings: Vec::new(),
    };
    checker.table(checker.root, tree, 0..0, &KeyPath::root());
    checker.findings
}

/// A file with this many mistakes is not a model file; the rest is not looked at.
const ENOUGH: usize = 100;

struct Checker {
    root: &'static Value,
    findings: Vec<Finding>,
}

impl Checker {
    fn report(&mut self, place: &KeyPath, span: Range<usize>, message: String, help: String) {
        // Descriptions of several lines become one.
        let help = help.replace('\n', " ");
        self.findings
            .push(Finding::new(place, message, help).at(span));
    }

    /// Sets the stand-in for the value of the last finding, for reading on.
    fn stand_in(&mut self, value: Option<String>) {
        if let Some(finding) = self.findings.last_mut() {
            finding.remedy.stand_in = value;
        }
    }

    fn resolve(&self, schema: &'static Value) -> &'static Value {
        let name = schema.get("$ref").and_then(Value::as_str);
        name.and_then(|n| n.strip_prefix("#/$defs/"))
            .and_then(|n| self.root.get("$defs")?.get(n))
            .unwrap_or(schema)
    }

    fn value(
        &mut self,
        schema: &'static Value,
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
        about: &str,
    ) {
        if self.findings.len() >= ENOUGH {
            return;
        }
        let schema = self.resolve(schema);
        let variants = schema.get("anyOf").or_else(|| schema.get("oneOf"));
        if let Some(variants) = variants.and_then(Value::as_array) {
            return self.variant(variants, value, place, about);
        }
        let kind = schema.get("type").and_then(Value::as_str).unwrap_or("");
        match (kind, value.get_ref()) {
            ("object", DeValue::Table(table)) => self.table(schema, table, value.span(), place),
            ("array", DeValue::Array(_)) => self.array(schema, value, place, about),
            ("number" | "integer", DeValue::Integer(_) | DeValue::Float(_)) => {
                self.number(kind, value, place);
            }
            ("boolean", DeValue::Boolean(_)) => {}
            ("string", DeValue::String(text)) => self.string(schema, text, value, place),
            _ => self.wrong_kind(&[kind], value, place, about),
        }
    }

    fn wrong_kind(
        &mut self,
        kinds: &[&str],
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
        about: &str,
    ) {
        let mut wanted: Vec<&str> = kinds.iter().map(|k| kind_description(k)).collect();
        wanted.dedup();
        let help = match (kinds, value.get_ref()) {
            (["array"], DeValue::Table(_)) => format!(
                "write [[{}]] with two brackets: there can be several. {about}",
                place
            ),
            (["number"], DeValue::String(_)) => {
                format!("write the number without quotes. {about}")
            }
            _ => about.to_owned(),
        };
        self.report(
            place,
            value.span(),
            format!(
                "'{place}' needs {}, but {} was found",
                wanted.join(" or "),
                kind_description(value.get_ref().type_str())
            ),
            help,
        );
        self.stand_in(kinds.first().and_then(|kind| stand_in(kind)));
    }

    fn variant(
        &mut self,
        variants: &'static [Value],
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
        about: &str,
    ) {
        let resolved: Vec<&'static Value> = variants.iter().map(|v| self.resolve(v)).collect();
        let words: Vec<&'static str> = resolved
            .iter()
            .filter_map(|v| v.get("x-word").and_then(Value::as_str))
            .collect();
        if let (false, DeValue::Table(table)) = (words.is_empty(), value.get_ref()) {
            return self.worded(&resolved, &words, table, value.span(), place);
        }
        let constants: Vec<&str> = resolved
            .iter()
            .filter_map(|v| v.get("const").and_then(Value::as_str))
            .collect();
        if constants.len() == resolved.len() {
            return match value.get_ref() {
                DeValue::String(text) => self.one_of(&constants, text, value, place),
                _ => self.wrong_kind(&["string"], value, place, about),
            };
        }
        let found = match value.get_ref() {
            DeValue::Table(_) => "object",
            other => other.type_str(),
        };
        let fitting = resolved.iter().find(|v| {
            let kind = v.get("type").and_then(Value::as_str).unwrap_or("string");
            kind == found || (kind == "number" && matches!(found, "integer" | "float"))
        });
        match fitting {
            Some(schema) => self.value(schema, value, place, about),
            None => {
                let kinds: Vec<&str> = resolved
                    .iter()
                    .map(|v| v.get("type").and_then(Value::as_str).unwrap_or("string"))
                    .collect();
                self.wrong_kind(&kinds, value, place, about);
            }
        }
    }

    /// A table whose kind is decided by the one key that is a word.
    fn worded(
        &mut self,
        variants: &[&'static Value],
        words: &[&'static str],
        table: &DeTable<'_>,
        span: Range<usize>,
        place: &KeyPath,
    ) {
        let (noun, a_noun) = match place.0.iter().rev().find_map(|step| match step {
            PathStep::Key(key) => Some(&**key),
            PathStep::Index(_) => None,
        }) {
            Some("load") => ("load", "A load"),
            _ => ("element", "An element"),
        };
        let present: Vec<(&str, Range<usize>)> = table
            .keys()
            .filter(|k| words.contains(&k.get_ref().as_ref()))
            .map(|k| (k.get_ref().as_ref(), k.span()))
            .collect();
        match present.as_slice() {
            [(word, _)] => {
                let schema = variants
                    .iter()
                    .find(|v| v.get("x-word").and_then(Value::as_str) == Some(word));
                if let Some(schema) = schema {
                    self.table(schema, table, span, place);
                }
            }
            [] => {
                let close = table.keys().find_map(|k| {
                    hints::nearest(k.get_ref(), words).map(|w| (k.get_ref().clone(), w, k.span()))
                });
                let list = words.join(", ");
                match close {
                    Some((key, word, span)) => self.report(
                        place,
                        span,
                        format!("unknown key '{key}'"),
                        format!("did you mean '{word}'? {a_noun} is one of: {list}"),
                    ),
                    None => self.report(
                        place,
                        span,
                        format!("this {noun} does not say what it is"),
                        format!("write one of these words as a key: {list}"),
                    ),
                }
            }
            [(first, _), (second, span), ..] => self.report(
                place,
                span.clone(),
                format!("this {noun} is said to be '{first}' and '{second}'"),
                match noun {
                    "load" => "a load is one thing: write two of them, each under [[limb.load]] or [[load]]",
                    _ => "an element is one thing: write two elements in the order of the chain",
                }
                .into(),
            ),
        }
    }

    fn table(
        &mut self,
        schema: &'static Value,
        table: &DeTable<'_>,
        span: Range<usize>,
        place: &KeyPath,
    ) {
        let Some(properties) = schema.get("properties").and_then(Value::as_object) else {
            return self.map(schema, table, place);
        };
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            match properties.get(name) {
                Some(inner) => {
                    let about = description(self.resolve(inner))
                        .filter(|_| inner.get("description").is_none())
                        .or_else(|| description(inner))
                        .unwrap_or_default();
                    self.value(inner, value, &place.key(name), about);
                }
                None => {
                    let known: Vec<&str> = properties.keys().map(String::as_str).collect();
                    let (message, help) = hints::unknown_key(name, &known);
                    self.report(&place.key(name), key.span(), message, help);
                }
            }
        }
        let required = schema.get("required").and_then(Value::as_array);
        for key in required.into_iter().flatten().filter_map(Value::as_str) {
            if !table.keys().any(|k| k.get_ref() == key) {
                let about = properties
                    .get(key)
                    .and_then(|p| description(p).or_else(|| description(self.resolve(p))))
                    .unwrap_or_default();
                let owner = match place.0.is_empty() {
                    true => "the file".to_owned(),
                    false => format!("'{place}'"),
                };
                self.report(
                    place,
                    span.clone(),
                    format!("{owner} has no '{key}'"),
                    match key {
                        "schema" => "write schema = 1 in the first line".into(),
                        _ => format!("write '{key}': {about}"),
                    },
                );
                let kind = properties
                    .get(key)
                    .and_then(|p| p.get("type"))
                    .and_then(Value::as_str);
                self.stand_in(kind.and_then(stand_in));
                if let Some(finding) = self.findings.last_mut() {
                    finding.remedy.missing = Some(key.to_owned());
                }
            }
        }
    }

    fn map(&mut self, schema: &'static Value, table: &DeTable<'_>, place: &KeyPath) {
        let most = schema.get("maxProperties").and_then(Value::as_u64);
        if let Some(most) = most.filter(|&m| table.len() as u64 > m) {
            let span = table.keys().next().map_or(0..0, |k| k.span());
            return self.report(
                place,
                span,
                format!(
                    "'{place}' has {} entries, at most {most} are read",
                    table.len()
                ),
                "split the model".into(),
            );
        }
        if let Some(inner) = schema.get("additionalProperties") {
            let about = description(self.resolve(inner)).unwrap_or_default();
            for (key, value) in table {
                self.value(inner, value, &place.key(key.get_ref()), about);
            }
        }
    }

    fn array(
        &mut self,
        schema: &'static Value,
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
        about: &str,
    ) {
        let DeValue::Array(list) = value.get_ref() else {
            return;
        };
        let limit = |key| schema.get(key).and_then(Value::as_u64);
        let (least, most) = (limit("minItems"), limit("maxItems"));
        let count = list.len() as u64;
        if least.is_some_and(|l| count < l) || most.is_some_and(|m| count > m) {
            let wanted = match (least, most) {
                (Some(l), Some(m)) if l == m => format!("{l}"),
                (Some(l), Some(m)) => format!("{l} to {m}"),
                (Some(l), None) => format!("at least {l}"),
                (None, most) => format!("at most {}", most.unwrap_or_default()),
            };
            self.report(
                place,
                value.span(),
                format!("'{place}' needs {wanted} entries, {count} were found"),
                about.to_owned(),
            );
            let zeros = |count: u64| format!("[{}]", vec!["0"; count as usize].join(", "));
            return self.stand_in(least.map(zeros));
        }
        if let Some(inner) = schema.get("items") {
            for (i, item) in list.iter().enumerate() {
                self.value(inner, item, &place.index(i), about);
            }
        }
    }

    fn number(&mut self, kind: &str, value: &Spanned<DeValue<'_>>, place: &KeyPath) {
        let (fits, text) = match value.get_ref() {
            DeValue::Integer(i) => {
                let number = i64::from_str_radix(i.as_str(), i.radix()).ok();
                let fits = match kind {
                    "integer" => number.is_some_and(|n| (0..=i64::from(u32::MAX)).contains(&n)),
                    _ => number.is_some(),
                };
                (fits, i.to_string())
            }
            DeValue::Float(f) => {
                let finite = f.as_str().parse::<f64>().is_ok_and(f64::is_finite);
                (finite && kind == "number", f.to_string())
            }
            _ => return,
        };
        if !fits {
            let (wanted, help) = match kind {
                "integer" => ("a whole number", "write a whole number, not below zero"),
                _ => (
                    "a finite number",
                    "nan, inf and numbers beyond 1.8e308 (whole numbers beyond 9.2e18) cannot be measured; write the figure itself",
                ),
            };
            self.report(
                place,
                value.span(),
                format!("'{place}' is {text}, {wanted} is needed"),
                help.into(),
            );
            self.stand_in(stand_in(kind));
        }
    }

    fn string(
        &mut self,
        schema: &'static Value,
        text: &str,
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
    ) {
        let Some(list) = schema.get("enum").and_then(Value::as_array) else {
            return;
        };
        let words: Vec<&str> = list.iter().filter_map(Value::as_str).collect();
        self.one_of(&words, text, value, place);
    }

    fn one_of(
        &mut self,
        words: &[&str],
        text: &str,
        value: &Spanned<DeValue<'_>>,
        place: &KeyPath,
    ) {
        if words.contains(&text) {
            return;
        }
        let list = words.join("', '");
        let help = match hints::nearest(text, words) {
            Some(word) => format!("did you mean '{word}'? Possible are: '{list}'"),
            None => format!("possible are: '{list}'"),
        };
        self.report(
            place,
            value.span(),
            format!("'{place}' cannot be '{text}'"),
            help,
        );
        self.stand_in(words.first().map(|word| format!("'{word}'")));
    }
}

fn description(schema: &'static Value) -> Option<&'static str> {
    schema.get("description").and_then(Value::as_str)
}

/// A value of a kind, as TOML.
fn stand_in(kind: &str) -> Option<String> {
    let value = match kind {
        "number" | "integer" => "0",
        "string" => "''",
        "boolean" => "false",
        _ => return None,
    };
    Some(value.to_owned())
}

fn kind_description(kind: &str) -> &'static str {
    match kind {
        "object" | "table" => "a table",
        "array" => "a list",
        "number" | "float" => "a number",
        "integer" => "a whole number",
        "boolean" => "true or false",
        "string" => "text in quotes",
        "datetime" => "a date",
        _ => "something else",
    }
}
