//! Findings while a document becomes a machine: every mistake with its place, so that one run reports them all.

use crate::problem::{Finding, KeyPath};

/// Errors and warnings found in a document.
#[derive(Default)]
pub(crate) struct Findings {
    pub(crate) errors: Vec<Finding>,
    pub(crate) warnings: Vec<Finding>,
    /// The document is a file without its faulty parts: it is searched for more mistakes, but no
    /// machine is made of it.
    pub(crate) incomplete: bool,
}

impl Findings {
    pub(crate) fn error(
        &mut self,
        place: &KeyPath,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.errors.push(Finding::new(place, message, help));
    }

    /// True if the number of errors shows that the file is no model; the rest is not examined.
    pub(crate) fn enough(&self) -> bool {
        self.errors.len() >= 100
    }

    /// The value, or `None` with the reason kept.
    pub(crate) fn keep<T>(&mut self, result: Result<T, Finding>) -> Option<T> {
        result.map_err(|f| self.errors.push(f)).ok()
    }
}

pub(crate) fn name(place: &KeyPath, text: &str, findings: &mut Findings) {
    let reason = if text.trim().is_empty() {
        "the name is empty"
    } else if text.trim() != text {
        "the name begins or ends with a space"
    } else if text.chars().any(char::is_control) {
        "the name holds a control character"
    } else if text.chars().count() > 100 {
        "the name is longer than 100 characters"
    } else {
        return;
    };
    findings.error(place, reason, "write a short name in plain text");
}
