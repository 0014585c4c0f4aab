//! Refusals.

use serde::Serialize;

/// Reason why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// Code, as those of `kinetostat explain`.
    pub code: String,
    /// A sentence.
    pub message: String,
}

impl Refused {
    /// A refusal with its code.
    pub fn new(code: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            message: message.into(),
        }
    }
}
