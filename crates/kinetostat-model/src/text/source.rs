//! The text of a model file, read from disk, with the place of every value in it.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use kinetostat_diagnostic::{TomlFault, TomlFaultKind};
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::problem::{Finding, KeyPath, ModelError, PathStep, Problem, Severity};

/// A text and the tree of its values.
pub(crate) struct Source<'t> {
    pub(crate) file: &'t str,
    pub(crate) text: &'t str,
    pub(crate) tree: DeTable<'t>,
}

impl<'t> Source<'t> {
    /// Reads TOML; a mistake in the syntax is an error with its line.
    pub(crate) fn parse(file: &'t str, text: &'t str) -> Result<Self, ModelError> {
        match DeTable::parse(text) {
            Ok(tree) => Ok(Self {
                file,
                text,
                tree: tree.into_inner(),
            }),
            Err(error) => {
                let finding = Self::syntax(&error);
                let span = finding.span.clone().unwrap_or(0..0);
                let problem = Problem::in_text(Severity::Error, file, text, span, &finding);
                Err(ModelError::new(vec![problem]))
            }
        }
    }

    /// A message of the TOML reader as a finding.
    pub(crate) fn syntax(error: &toml::de::Error) -> Finding {
        let fault = TomlFault::of(error);
        let help = match fault.kind {
            TomlFaultKind::DuplicateKey => {
                "each key is written once in a table; keep one of them (a list of tables begins with [[name]])"
            }
            TomlFaultKind::LineGoesOn => {
                "one key and its value are on a line of their own; decimals are written with a point"
            }
            _ => {
                "a value is written as  key = 1.5,  key = \"text\",  key = [1, 2, 3];  a table begins with [name], a list of tables with [[name]]"
            }
        };
        let message = format!("this is not TOML: {}", fault.message);
        Finding::new(&KeyPath::root(), message, help).at(fault.span)
    }

    /// Byte range of a value; for a missing one, the table that should contain it.
    pub(crate) fn span(&self, place: &KeyPath) -> Range<usize> {
        let mut span = 0..0;
        let mut steps = place.0.iter();
        let Some(PathStep::Key(first)) = steps.next() else {
            return span;
        };
        let Some((key, mut value)) = entry(&self.tree, first) else {
            return span;
        };
        // A whole table is shown by its name rather than by all of its lines.
        span = shown(key.span(), value);
        for step in steps {
            let next = match (step, value.get_ref()) {
                (PathStep::Key(k), DeValue::Table(table)) => {
                    entry(table, k).map(|(key, v)| (shown(key.span(), v), v))
                }
                (PathStep::Index(i), DeValue::Array(list)) => list.get(*i).map(|v| (v.span(), v)),
                _ => None,
            };
            let Some((found, inner)) = next else {
                return span;
            };
            if !found.is_empty() {
                span = found;
            }
            value = inner;
        }
        span
    }

    pub(crate) fn problem(&self, severity: Severity, finding: &Finding) -> Problem {
        let span = finding
            .span
            .clone()
            .unwrap_or_else(|| self.span(&finding.place));
        Problem::in_text(severity, self.file, self.text, span, finding)
    }

    pub(crate) fn error(&self, findings: &[Finding]) -> ModelError {
        let mut problems: Vec<Problem> = findings
            .iter()
            .map(|f| self.problem(Severity::Error, f))
            .collect();
        problems.sort_by_key(|p| (p.line, p.column));
        ModelError::new(problems)
    }
}

fn shown(key: Range<usize>, value: &Spanned<DeValue<'_>>) -> Range<usize> {
    match value.get_ref() {
        DeValue::Table(_) | DeValue::Array(_) => key,
        _ => value.span(),
    }
}

fn entry<'a, 't>(
    table: &'a DeTable<'t>,
    key: &str,
) -> Option<(
    &'a Spanned<toml::de::DeString<'t>>,
    &'a Spanned<DeValue<'t>>,
)> {
    table.iter().find(|(k, _)| k.get_ref() == key)
}

/// Longer texts are refused, bytes.
pub(crate) const MOST_BYTES: usize = 16 * 1024 * 1024;

/// The text of a file that may be a model; `file` names it in messages.
pub(crate) fn read_text(path: &Path, file: &str) -> Result<String, ModelError> {
    let refuse = |message: String, help: &str| {
        ModelError::new(vec![Problem::without_text(file, message, help.into())])
    };
    if path.is_dir() {
        return Err(refuse(
            "this is a directory, not a model file".into(),
            "name the .toml file in it",
        ));
    }
    let bytes = read(path).map_err(|e| {
        let (message, help) = match e.kind() {
            std::io::ErrorKind::NotFound => (
                "there is no such file".to_owned(),
                "check the path; the presets are listed by: kinetostat model list",
            ),
            std::io::ErrorKind::PermissionDenied => (
                "the file may not be read".to_owned(),
                "ask for the right to read it",
            ),
            _ => (format!("the file cannot be read: {e}"), "check the path"),
        };
        refuse(message, help)
    })?;
    let Some(bytes) = bytes else {
        return Err(refuse(
            "the file is larger than 16 MB, which no model file is".into(),
            "name a model file in TOML",
        ));
    };
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(refuse(
            "the file is written in UTF-16".into(),
            "save it as UTF-8",
        ));
    }
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let before = &e.as_bytes()[..at];
        if before.contains(&0) || e.as_bytes().contains(&0) {
            return refuse(
                "this is a binary file, not a model file".into(),
                "name a model file in TOML",
            );
        }
        let line = before.iter().filter(|b| **b == b'\n').count() + 1;
        refuse(
            format!(
                "the file is not UTF-8 text: line {line} holds the byte {:#04x}",
                e.as_bytes()[at]
            ),
            "save it as UTF-8; umlauts and accents of older encodings look like this",
        )
    })?;
    if text.contains('\0') {
        return Err(refuse(
            "this is a binary file, not a model file".into(),
            "name a model file in TOML",
        ));
    }
    Ok(text)
}

/// The bytes of a file, or nothing where there are more than a model has. The size that the system
/// tells is checked first: nothing of a huge file is read.
fn read(path: &Path) -> std::io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    if file.metadata()?.len() > MOST_BYTES as u64 {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() <= MOST_BYTES).then_some(bytes))
}
