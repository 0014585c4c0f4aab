//! What is wrong in a job file, shown with its line, like the messages about model files.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};

use crate::failure::{Failure, safe};
use crate::orientation::nearest;

/// A text with its name, for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<'t> {
    pub(crate) file: &'t str,
    pub(crate) text: &'t str,
}

/// Longest line shown whole, characters.
const LINE: usize = 160;

impl Source<'_> {
    /// An error at a place of the text.
    pub(crate) fn error(&self, span: Range<usize>, message: &str, help: &str) -> Failure {
        let (title, help) = (safe(message).replace('\n', " "), safe(help));
        let start = floor(self.text, span.start);
        let end = floor(self.text, span.end.max(start));
        let first = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let last = self.text[start..]
            .find('\n')
            .map_or(self.text.len(), |i| start + i);
        let line = self.text[..first].matches('\n').count() + 1;
        // Every character of the line becomes one: places stay what they are.
        let plain: String = self.text[first..last]
            .trim_end_matches('\r')
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .take(LINE)
            .collect();
        let length = plain.chars().count();
        let count = |to: usize| self.text[first..to].chars().count().min(length);
        let (from, to) = (count(start), count(end.min(last)));
        let bytes = |characters: usize| {
            plain
                .char_indices()
                .nth(characters)
                .map_or(plain.len(), |(i, _)| i)
        };
        let file = safe(self.file);
        let mut group = Level::ERROR.primary_title(title.as_str()).element(
            Snippet::source(plain.as_str())
                .path(file.as_str())
                .line_start(line)
                .annotation(AnnotationKind::Primary.span(bytes(from)..bytes(to))),
        );
        if !help.is_empty() {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        let report = [group];
        let text = Renderer::plain().render(&report);
        let styled = Renderer::styled().render(&report);
        Failure::input(text.strip_prefix("error: ").unwrap_or(&text)).with_style(styled)
    }

    /// Reads TOML into a type; every mistake is told with its line and what to do.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<T, Failure> {
        let tree = DeTable::parse(self.text).map_err(|error| self.syntax(&error))?;
        if let Some(span) = not_finite(&DeValue::Table(tree.into_inner()), 0..0) {
            return Err(self.error(
                span,
                "this is no finite number",
                "write a number such as 12.5",
            ));
        }
        toml::from_str(self.text).map_err(|error| self.content(&error))
    }

    fn syntax(&self, error: &toml::de::Error) -> Failure {
        let reason = error.message().lines().collect::<Vec<_>>().join(", ");
        self.error(
            error.span().unwrap_or(0..0),
            &format!("this is not TOML: {reason}"),
            "a value is written as  key = 1.5,  key = \"text\",  key = [1, 2, 3];  a table begins with [name]",
        )
    }

    fn content(&self, error: &toml::de::Error) -> Failure {
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

fn floor(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
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

fn not_finite(value: &DeValue<'_>, span: Range<usize>) -> Option<Range<usize>> {
    match value {
        DeValue::Float(f) => {
            let number: f64 = f.as_str().replace('_', "").parse().unwrap_or(f64::NAN);
            (!number.is_finite()).then_some(span)
        }
        DeValue::Array(list) => list.iter().find_map(|v| not_finite(v.get_ref(), v.span())),
        DeValue::Table(table) => table
            .iter()
            .find_map(|(_, v)| not_finite(v.get_ref(), v.span())),
        _ => None,
    }
}
