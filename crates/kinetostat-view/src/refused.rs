//! Refusals, and their form for the page.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// Largest request, bytes: a state has some hundred numbers.
pub(crate) const MOST_BYTES: usize = 64 << 10;

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

/// An error as the page reads it.
pub(crate) fn problem(status: StatusCode, refused: &Refused) -> Response {
    let body = serde_json::json!({ "error": refused }).to_string();
    (status, [(header::CONTENT_TYPE, "application/json")], body).into_response()
}
