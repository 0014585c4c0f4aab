//! Errors as the classes of `kinetostat.errors`.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyType;

/// Classes of `kinetostat.errors`.
#[derive(Clone, Copy)]
pub enum Class {
    /// A model that is none.
    Model,
    /// An argument of the wrong shape or value.
    Argument,
    /// A question without an answer: out of reach, not converged.
    Unanswered,
}

impl Class {
    fn name(self) -> &'static str {
        match self {
            Self::Model => "ModelError",
            Self::Argument => "ArgumentError",
            Self::Unanswered => "UnansweredError",
        }
    }
}

/// An error of a class with its message.
pub fn error(class: Class, message: impl Into<String>) -> PyErr {
    let message = message.into();
    Python::attach(|py| {
        let found = py
            .import("kinetostat.errors")
            .and_then(|module| module.getattr(class.name()))
            .and_then(|class| Ok(class.cast_into::<PyType>()?));
        match found {
            Ok(class) => PyErr::from_type(class, message),
            Err(_) => PyRuntimeError::new_err(message),
        }
    })
}

/// An error of the core.
pub fn of_core(found: &kinetostat::Error) -> PyErr {
    let class = match found.is_unanswered() {
        true => Class::Unanswered,
        false => Class::Argument,
    };
    error(class, found.to_string())
}

/// An error of a model file.
pub fn of_model(found: &kinetostat_model::ModelError) -> PyErr {
    let text = found.rendered(kinetostat_model::TextStyle::Plain);
    error(
        Class::Model,
        text.strip_prefix("error: ").unwrap_or(&text).trim_end(),
    )
}

/// A machine in which nothing gives way has no deflections and no stiffness.
pub fn require_stiffness(mechanism: &kinetostat::Mechanism) -> PyResult<()> {
    kinetostat_model::require_stiffness(mechanism, "the machine").map_err(|e| of_model(&e))
}
