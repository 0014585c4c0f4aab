//! A machine in three dimensions, for another program that shows the page.

use kinetostat_model::Model;
use kinetostat_view::{Answers, Refused};

use crate::shown::session::{Session, read};

/// A machine whose states a page shows; requests and answers are the JSON of `kinetostat schema view`.
pub struct Viewed(Session);

impl Viewed {
    /// The machine of a model, by the name that commands on the page give it.
    #[must_use]
    pub fn of(model: Model, named: &str) -> Self {
        Self(Session {
            named: named.to_owned(),
            path: None,
            model,
            program: None,
        })
    }

    /// The page with a state in it, HTML. A live one asks the page around it for further states.
    ///
    /// # Errors
    /// A state that cannot be asked for, or whose place is out of reach.
    pub fn page(&self, request: &str, is_live: bool) -> Result<String, Refused> {
        Ok(self.0.page(&read(request.as_bytes())?, is_live)?)
    }

    /// The answer to a question of the page by its name, as in `state`. None: there is no such question.
    ///
    /// # Errors
    /// As for [`Viewed::page`]; a question that this machine has no answer to.
    pub fn answer(&self, question: &str, request: &str) -> Option<Result<String, Refused>> {
        self.0.answer(question, request.as_bytes())
    }
}
