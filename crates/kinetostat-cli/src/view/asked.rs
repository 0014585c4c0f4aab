//! The questions of `start` as the page asks and answers them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the page does with the questions of `start`; nothing of it asks for the next one alone.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct StartRequest {
    /// Answer to the question that is asked.
    pub(super) answer: Option<String>,
    /// Back to the question before.
    pub(super) back: bool,
    /// Write the files and compensate.
    pub(super) write: bool,
}

/// Where the questions stand.
#[derive(Default, Serialize, JsonSchema)]
pub(super) struct StartAnswer {
    /// None: all is known, or this page does not ask.
    pub(super) question: Option<AskedQuestion>,
    pub(super) given: Vec<GivenAnswer>,
    /// What was understood of the last answer.
    pub(super) said: Vec<String>,
    /// Reason why the last answer was not taken, or the files were not written.
    pub(super) refused: Option<String>,
    /// Files that were written; the machine stands behind the next question for it.
    pub(super) written: Vec<String>,
}

/// A question in words.
#[derive(Serialize, JsonSchema)]
pub(super) struct AskedQuestion {
    pub(super) words: String,
    pub(super) help: String,
    /// Taken for an empty answer.
    pub(super) usual: Option<String>,
    pub(super) choices: Vec<String>,
}

/// An answer that was taken.
#[derive(Serialize, JsonSchema)]
pub(super) struct GivenAnswer {
    pub(super) words: String,
    pub(super) answer: String,
}
