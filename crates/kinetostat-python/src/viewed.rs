//! A machine in three dimensions, as notebooks show it.

use std::sync::Arc;

use kinetostat_cli::Refused;
use pyo3::prelude::*;

use crate::errors::{Class, error};
use crate::machine::Machine;

/// A machine whose states a page shows; requests and answers are the JSON of the page.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Viewed(kinetostat_cli::Viewed);

#[pymethods]
impl Viewed {
    #[new]
    fn new(machine: &Machine, named: &str) -> Self {
        let mut model = Arc::unwrap_or_clone(machine.model.clone());
        model.mechanism = machine.mechanism.clone();
        Self(kinetostat_cli::Viewed::of(model, named))
    }

    /// The page with a state in it; a live one asks what is around it for further ones.
    fn page(&self, py: Python<'_>, request: &str, live: bool) -> PyResult<String> {
        py.detach(|| self.0.page(request, live)).map_err(of_refused)
    }

    /// The answer to a question of the page; none if there is no such question.
    fn answer(&self, py: Python<'_>, question: &str, request: &str) -> PyResult<Option<String>> {
        py.detach(|| self.0.answer(question, request).transpose())
            .map_err(of_refused)
    }
}

fn of_refused(refused: Refused) -> PyErr {
    let class = match refused.code.as_str() {
        "unreachable" | "no_answer" => Class::Unanswered,
        _ => Class::Argument,
    };
    error(class, refused.message)
}
