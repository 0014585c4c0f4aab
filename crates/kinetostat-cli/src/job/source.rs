//! Faults of a job file, shown with their line, like the messages about model files.

use std::ops::Range;

use kinetostat_diagnostic::{TomlFault, TomlFaultKind, wrong_length};
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
        exact_toml(self.text).map_err(|error| self.wrong(TomlFault::of(&error), help))
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

    pub(crate) fn syntax(&self, error: &toml::de::Error) -> Failure {
        let fault = TomlFault::of(error);
        self.error(
            fault.span,
            &format!("this is not TOML: {}", fault.message),
            "a value is written as  key = 1.5,  key = \"text\",  key = [1, 2, 3];  a table begins with [name]",
        )
    }

    /// A mistake in what a job file says, shown with its line.
    pub(crate) fn content(&self, fault: TomlFault) -> Failure {
        self.wrong(fault, HELP)
    }

    fn wrong(&self, fault: TomlFault, help: &str) -> Failure {
        let (message, help) = match fault.kind {
            TomlFaultKind::UnknownKey { given, known } => {
                (format!("unknown key '{given}'"), advice(&given, &known))
            }
            TomlFaultKind::UnknownWord { given, known } => (
                format!("'{given}' is not known here"),
                words_known(&given, &known),
            ),
            TomlFaultKind::MissingKey(key) => {
                let example = match key.as_str() {
                    "schema" => "1",
                    _ => "...",
                };
                let help = format!("add  {key} = {example}");
                (format!("the key '{key}' is missing"), help)
            }
            TomlFaultKind::Length { needed, given } => {
                (wrong_length(needed, given), help_on_length(needed, given))
            }
            TomlFaultKind::Mismatch { found, expected } => {
                let message = format!("found {found}, {expected} is needed");
                (message, help.to_owned())
            }
            _ => (fault.message, help.to_owned()),
        };
        self.error(fault.span, &message, &help)
    }
}

/// Remedy for a list of the wrong length.
fn help_on_length(needed: usize, given: usize) -> String {
    let form = match needed {
        3 => "write them as [x, y, z]".to_owned(),
        _ => format!("write {needed} values in the brackets"),
    };
    match given > needed {
        true => format!("{form}; numbers take a decimal point, not a comma: 1.5, not 1,5"),
        false => form,
    }
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

fn advice(found: &str, known: &[String]) -> String {
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
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
    match nearest(found, &known) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("known here: {}", known.join(", ")),
    }
}
