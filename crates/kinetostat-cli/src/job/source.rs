//! Faults of a job file, shown with their line, like the messages about model files.

use std::ops::Range;

use kinetostat_model::{Problem, Severity, exact_toml};
use serde::de::DeserializeOwned;
use serde_spanned::Spanned;
use toml::de::DeTable;

use crate::job::toml_tree::not_finite;
use crate::place::orientation::CONVENTIONS;
use crate::ui::failure::Failure;
use crate::ui::safe_text::safe;
use crate::ui::spelling::nearest;

/// Default remedy for a fault in a job file.
const HELP: &str = "correct this value; `kinetostat help compensate` shows a whole job file";

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
        let problem = self.problem(span.clone(), [message, help]);
        Failure::located(&problem, span)
    }

    /// The line that a place begins in, from 1.
    pub(crate) fn line(&self, span: Range<usize>) -> usize {
        let found = self.problem(span, [String::new(), String::new()]);
        found.line.unwrap_or(1)
    }

    fn problem(&self, span: Range<usize>, [message, help]: [String; 2]) -> Problem {
        Problem::found(
            Severity::Error,
            self.file,
            self.text,
            span,
            "",
            [message, help],
        )
    }

    /// Reads a job file's TOML into a type; every mistake is reported with its line and what to do.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<T, Failure> {
        self.read_as(HELP)
    }

    /// Reads TOML into a type; `help` is what is said of a mistake that is not of the usual kinds.
    pub(crate) fn read_as<T: DeserializeOwned>(&self, help: &str) -> Result<T, Failure> {
        let tree = DeTable::parse(self.text).map_err(|error| self.syntax(&error))?;
        if let Some(span) = self.not_finite(&tree).into_iter().next() {
            return Err(self.not_finite_number(span));
        }
        exact_toml(self.text).map_err(|error| self.wrong(&error, help))
    }

    /// Places of all numbers that are nan or infinite.
    pub(crate) fn not_finite(&self, tree: &Spanned<DeTable<'_>>) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        for value in tree.get_ref().values() {
            not_finite(value, &mut found);
        }
        found
    }

    /// Fault of a number that is not finite.
    pub(crate) fn not_finite_number(&self, span: Range<usize>) -> Failure {
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

    pub(crate) fn syntax(&self, error: &toml::de::Error) -> Failure {
        let reason = error.message().lines().collect::<Vec<_>>().join(", ");
        self.error(
            error.span().unwrap_or(0..0),
            &format!("this is not TOML: {reason}"),
            "a value is written as  key = 1.5,  key = \"text\",  key = [1, 2, 3];  a table begins with [name]",
        )
    }

    pub(crate) fn content(&self, error: &toml::de::Error) -> Failure {
        self.wrong(error, HELP)
    }

    pub(crate) fn wrong(&self, error: &toml::de::Error, help: &str) -> Failure {
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
                &words_known(&found, &known),
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
        if let Some(help) = help_on_length(message) {
            return self.error(span, message, &help);
        }
        let words = message
            .replace("invalid type: ", "found ")
            .replace("invalid value: ", "found ")
            .replace("found string ", "found the text ")
            .replace("found integer ", "found the number ")
            .replace("found floating point ", "found the number ")
            .replace("expected f64", "a number is needed")
            .replace("expected finite f32", "a number is needed")
            .replace("expected f32", "a number is needed")
            .replace("expected usize", "a whole number is needed")
            .replace("expected u64", "a whole number is needed")
            .replace("expected u32", "a whole number is needed")
            .replace("expected u16", "a whole number is needed")
            .replace("expected u8", "a small whole number is needed")
            .replace("expected an array", "a list is needed")
            .replace("expected a string", "text in quotes is needed")
            .replace("expected a boolean", "true or false is needed");
        let words = match words.split_once("expected struct ") {
            Some((before, _)) => format!("{before}a table {{ key = value, ... }} is needed"),
            None => words,
        };
        self.error(span, &words, help)
    }
}

/// Remedy for a list of the wrong length, if the message reports one.
fn help_on_length(message: &str) -> Option<String> {
    let (needed, rest) = message.split_once(" values are needed, ")?;
    let given = rest.strip_suffix(" are given")?;
    let [needed, given] = [needed, given].map(|n| n.parse::<usize>().ok());
    let needed = needed?;
    let form = match needed {
        3 => "write them as [x, y, z]".to_owned(),
        _ => format!("write {needed} values in the brackets"),
    };
    Some(match given? > needed {
        true => format!("{form}; numbers take a decimal point, not a comma: 1.5, not 1,5"),
        false => form,
    })
}

/// Lists the known words in place of an unknown one; orientations have keys of their own.
fn words_known(found: &str, known: &[String]) -> String {
    let known = known.join(", ");
    match CONVENTIONS.contains(&found) {
        true => format!(
            "write one of: {known}; an orientation itself is written as  part_orientation = {{ {found} = [...] }}  or  tool_orientation = {{ {found} = [...] }}"
        ),
        false => format!("write one of: {known}"),
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
