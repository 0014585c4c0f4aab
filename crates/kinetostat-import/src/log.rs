//! Findings in the files that are read: errors stop the import, notices go with its result.

use std::fmt::Display;
use std::ops::Range;

use kinetostat_model::{ModelError, Problem, Severity};

/// A place in one of the files, and the way to it in words.
#[derive(Clone, Debug, Default)]
pub(crate) struct At {
    /// Index of the file in the log.
    pub(crate) file: usize,
    pub(crate) span: Range<usize>,
    /// Path of the element, as in `robot / joint 'a1' / axis`.
    pub(crate) element: String,
}

/// Maximum number of errors that are collected.
const MOST: usize = 100;

/// The files read so far and what was found in them.
#[derive(Debug, Default)]
pub(crate) struct Log {
    files: Vec<(String, String)>,
    errors: Vec<Problem>,
    pub(crate) notices: Vec<Problem>,
}

impl Log {
    /// Adds a file; returns its index.
    pub(crate) fn file(&mut self, name: &str, text: &str) -> usize {
        self.files.push((name.to_owned(), text.to_owned()));
        self.files.len() - 1
    }

    /// The command that expands a xacro file, by its index.
    pub(crate) fn expansion(&self, file: usize) -> String {
        let name = self
            .files
            .get(file)
            .map_or("FILE.urdf.xacro", |(name, _)| name);
        let stem = name.strip_suffix(".xacro").unwrap_or(name);
        let stem = stem.strip_suffix(".urdf").unwrap_or(stem);
        let expanded = match name.ends_with(".xacro") {
            true => format!("{stem}.urdf"),
            false => format!("{stem}_expanded.urdf"),
        };
        format!("expand it first: xacro {name} > {expanded}")
    }

    fn problem(&self, severity: Severity, at: &At, message: String, help: String) -> Problem {
        let (name, text) = &self.files[at.file];
        // The excerpt shows a line; the message says which element that is.
        let message = match at.element.is_empty() {
            true => message,
            false => format!("{}: {message}", at.element),
        };
        Problem::found(
            severity,
            name,
            text,
            at.span.clone(),
            &at.element,
            [message, help],
        )
    }

    pub(crate) fn error(&mut self, at: &At, message: impl Display, help: impl Display) {
        if self.errors.len() < MOST {
            let problem = self.problem(Severity::Error, at, message.to_string(), help.to_string());
            self.errors.push(problem);
        }
    }

    pub(crate) fn notice(&mut self, at: &At, message: impl Display, help: impl Display) {
        if self.notices.len() < MOST {
            let problem =
                self.problem(Severity::Warning, at, message.to_string(), help.to_string());
            self.notices.push(problem);
        }
    }

    pub(crate) fn any_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The errors so far, if there are any.
    pub(crate) fn stop(&mut self) -> Result<(), ModelError> {
        if self.errors.is_empty() {
            return Ok(());
        }
        let mut errors = std::mem::take(&mut self.errors);
        errors.sort_by(|a, b| (&a.file, a.line, a.column).cmp(&(&b.file, b.line, b.column)));
        Err(ModelError::new(errors))
    }
}

/// Creates an error without a place.
pub(crate) fn refusal(file: &str, message: impl Display, help: impl Display) -> ModelError {
    ModelError::new(vec![Problem::without_text(
        file,
        message.to_string(),
        help.to_string(),
    )])
}

/// `; did you mean 'NAME'?` where a known name is near, else the list of what exists.
pub(crate) fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    // Long names are no slips, and the comparison costs the product of the lengths.
    let short = |text: &str| text.chars().take(61).count() <= 60;
    let nearest = known
        .iter()
        .filter(|k| short(name) && short(k))
        .map(|k| (strsim::damerau_levenshtein(name, k), *k))
        .min()
        .filter(|(away, k)| *away <= 2.max(k.chars().count() / 4));
    match nearest {
        Some((_, k)) => format!("did you mean '{k}'?"),
        None if known.is_empty() => "there are none".into(),
        None => {
            let shown: Vec<&str> = known.iter().take(30).copied().collect();
            let more = match known.len() - shown.len() {
                0 => String::new(),
                n => format!(" and {n} more"),
            };
            format!("there are: {}{more}", shown.join(", "))
        }
    }
}

/// Names in a sentence, not more than a few.
pub(crate) fn some_names<S: AsRef<str>>(names: &[S]) -> String {
    let shown: Vec<String> = names
        .iter()
        .take(8)
        .map(|n| format!("'{}'", n.as_ref()))
        .collect();
    match names.len() - shown.len() {
        0 => shown.join(", "),
        n => format!("{} and {n} more", shown.join(", ")),
    }
}
