//! Diagnostics: errors with a stable code, a location and a remedy.
//!
//! Depends on no other crate of kinetostat. A program branches on the [`ErrorCode`]; the wording of a message may change
//! at any time.

mod code;
mod toml_fault;

use schemars::JsonSchema;
use serde::Serialize;

pub use code::ErrorCode;
pub use toml_fault::{TomlFault, TomlFaultKind, wrong_length};

/// Severity of a [`Diagnostic`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Severity {
    /// The question has no answer as it was put.
    Error,
    /// An answer exists, and the finding may matter for it.
    Warning,
}

/// Location of a fault: in a file, or in what was given by name. All parts are optional.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Location {
    /// File, as it was named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Column in characters, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
    /// Option, key or part of a model: `--rpm`, `chain.leg.elements[3].length_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// One error or warning, for programs.
///
/// ```
/// use kinetostat_diagnostic::{Diagnostic, ErrorCode, Location};
///
/// let mut fault = Diagnostic::new(ErrorCode::Value, "--rpm is -3; a speed above 0 is needed");
/// fault.location = Location { name: Some("--rpm".into()), ..Location::default() };
/// assert_eq!(fault.code, ErrorCode::Value);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Kind of the fault.
    pub code: ErrorCode,
    /// Error or warning.
    pub severity: Severity,
    /// Location of the fault.
    #[serde(flatten)]
    pub location: Location,
    /// Text or value that was found there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub found: Option<String>,
    /// Values that are allowed there: a range, or a list of words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowed: Option<String>,
    /// The fault in words, on the whole.
    pub message: String,
    /// Remedy, where it is known apart from the message.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<String>,
}

impl Diagnostic {
    /// An error without a location.
    #[must_use]
    pub fn new(code: ErrorCode, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: Severity::Error,
            location: Location::default(),
            found: None,
            allowed: None,
            message: message.into(),
            remedy: None,
        }
    }
}
