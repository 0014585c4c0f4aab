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

    /// A state.
    ///
    /// # Errors
    /// As for [`Viewed::page`].
    pub fn state(&self, request: &str) -> Result<String, Refused> {
        Answers::state(&self.0, request.as_bytes())
    }

    /// Vibrations about a state.
    ///
    /// # Errors
    /// As for [`Viewed::page`]; a machine without masses.
    pub fn modes(&self, request: &str) -> Result<String, Refused> {
        Answers::modes(&self.0, request.as_bytes())
    }

    /// Equilibria while the load of a state grows.
    ///
    /// # Errors
    /// As for [`Viewed::page`]; a state without a load.
    pub fn curve(&self, request: &str) -> Result<String, Refused> {
        Answers::curve(&self.0, request.as_bytes())
    }
}
