//! What is wrong in a job file, shown with its line, like the messages about model files.

use std::ops::Range;

use kinetostat_model::{Problem, Severity};
use serde::de::DeserializeOwned;
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::failure::{Failure, safe};
use crate::orientation::nearest;

/// A text with its name, for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<'t> {
    pub(crate) file: &'t str,
    pub(crate) text: &'t str,
}

impl Source<'_> {
    /// An error at a place of the text.
    pub(crate) fn error(&self, span: Range<usize>, message: &str, help: &str) -> Failure {
        let [message, help] = [message, help].map(|t| safe(t).replace('\n', " "));
        let problem = Problem::found(
            Severity::Error,
            self.file,
            self.text,
            span.clone(),
            "",
            [message, help],
        );
        let plain = problem.rendered(false);
        let plain = plain.strip_prefix("error: ").unwrap_or(plain).to_owned();
        Failure::located(plain, problem.rendered(true).to_owned(), span)
    }

    /// Reads TOML into a type; every mistake is told with its line and what to do.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<T, Failure> {
        let tree = DeTable::parse(self.text).map_err(|error| self.syntax(&error))?;
        if let Some(span) = self.not_finite(&tree).into_iter().next() {
            return Err(self.endless(span));
        }
        toml::from_str(self.text).map_err(|error| self.content(&error))
    }

    /// Places of all numbers that are nan or infinite.
    pub(crate) fn not_finite(&self, tree: &Spanned<DeTable<'_>>) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        for value in tree.get_ref().values() {
            not_finite(value, &mut found);
        }
        found
    }

    /// What is said of such a number.
    pub(crate) fn endless(&self, span: Range<usize>) -> Failure {
        self.error(
            span,
            "this is no finite number",
            "write a number such as 12.5",
        )
    }

    /// The key that the reader misses, if that is its complaint.
    pub(crate) fn missing(error: &toml::de::Error) -> Option<String> {
        quoted(error.message(), "missing field ")
    }

    fn syntax(&self, error: &toml::de::Error) -> Failure {
        let reason = error.message().lines().collect::<Vec<_>>().join(", ");
        self.error(
            error.span().unwrap_or(0..0),
            &format!("this is not TOML: {reason}"),
            "a value is written as  key = 1.5,  key = \"text\",  key = [1, 2, 3];  a table begins with [name]",
        )
    }

    pub(crate) fn content(&self, error: &toml::de::Error) -> Failure {
        let message = error.message();
        let span = error.span().unwrap_or(0..0);
        if let Some(found) = quoted(message, "unknown field ") {
            let known = expected(message);
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            return self.error(
                span,
                &format!("unknown key '{found}'"),
                &advice(&found, &known),
            );
        }
        if let Some(found) = quoted(message, "unknown variant ") {
            let known = expected(message);
            return self.error(
                span,
                &format!("'{found}' is not known here"),
                &format!("write one of: {}", known.join(", ")),
            );
        }
        if let Some(missing) = quoted(message, "missing field ") {
            let example = match missing.as_str() {
                "schema" => "1",
                _ => "...",
            };
            return self.error(
                span,
                &format!("the key '{missing}' is missing"),
                &format!("add  {missing} = {example}"),
            );
        }
        if let Some((given, needed)) = message
            .strip_prefix("invalid length ")
            .and_then(|rest| rest.split_once(", expected an array of length "))
        {
            return self.error(
                span,
                &format!("{needed} values are needed, {given} are given"),
                "write them as [x, y, z]",
            );
        }
        let words = message
            .replace("invalid type: ", "found ")
            .replace("invalid value: ", "found ")
            .replace("found string ", "found the text ")
            .replace("found integer ", "found the number ")
            .replace("found floating point ", "found the number ")
            .replace("expected f64", "a number is needed")
            .replace("expected u32", "a whole number is needed")
            .replace("expected u8", "a small whole number is needed")
            .replace("expected an array", "a list is needed")
            .replace("expected a string", "text in quotes is needed")
            .replace("expected a boolean", "true or false is needed");
        let words = match words.split_once("expected struct ") {
            Some((before, _)) => format!("{before}a table {{ key = value, ... }} is needed"),
            None => words,
        };
        self.error(
            span,
            &words,
            "correct this value; `kinetostat help compensate` shows a whole job file",
        )
    }
}

/// The word in backticks after `prefix`.
fn quoted(message: &str, prefix: &str) -> Option<String> {
    let rest = message.strip_prefix(prefix)?.strip_prefix('`')?;
    Some(rest.split('`').next()?.to_owned())
}

/// All words in backticks after `expected`.
fn expected(message: &str) -> Vec<String> {
    message
        .split_once("expected")
        .map_or("", |(_, rest)| rest)
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

fn advice(found: &str, known: &[&str]) -> String {
    let with_unit: Vec<&str> = known
        .iter()
        .copied()
        .filter(|k| {
            k.strip_prefix(found)
                .is_some_and(|rest| rest.starts_with('_'))
        })
        .collect();
    if !with_unit.is_empty() {
        return format!("write the unit in the key: {}", with_unit.join(" or "));
    }
    match nearest(found, known) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("known here: {}", known.join(", ")),
    }
}

fn not_finite(value: &Spanned<DeValue<'_>>, found: &mut Vec<Range<usize>>) {
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
