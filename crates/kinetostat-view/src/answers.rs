//! What the page asks.

use crate::refused::Refused;

/// The question whose request holds files: it may be long.
pub const OPEN: &str = "open";

/// What the page asks; requests and answers are JSON.
pub trait Answers: Send + Sync + 'static {
    /// The answer to a question by its name, as in `state`. None: there is no such question.
    ///
    /// # Errors
    /// A question that cannot be asked like this; that a machine cannot do something is an answer.
    fn answer(&self, question: &str, request: &[u8]) -> Option<Result<String, Refused>>;
}
