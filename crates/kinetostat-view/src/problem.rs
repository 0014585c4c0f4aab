//! A refusal as an answer to the page.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::refused::Refused;

/// Largest request, bytes: a state has some hundred numbers.
pub(crate) const MOST_BYTES: usize = 64 << 10;

/// Largest request that holds files, bytes.
pub(crate) const MOST_FILE_BYTES: usize = 64 << 20;

/// An error as the page reads it.
pub(crate) fn problem(status: StatusCode, refused: &Refused) -> Response {
    let body = serde_json::json!({ "error": refused }).to_string();
    (status, [(header::CONTENT_TYPE, "application/json")], body).into_response()
}
