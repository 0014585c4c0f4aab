//! Error of modal data, a cut or a measured file: quantity, value found, value expected.

/// Result of this crate.
pub type Result<T> = std::result::Result<T, ChatterError>;

/// Subject of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ChatterErrorKind {
    /// Modal data that no tool can have, or that do not say what is asked.
    Response,
    /// A cut that cannot be made.
    Cut,
    /// A spindle speed, a depth or another setting of a calculation.
    Setting,
    /// A calculation that did not reach its accuracy.
    NotConverged,
    /// A file, or a line of it, that says nothing that belongs there.
    File,
    /// Measurements that do not determine what is asked.
    Measurement,
}

/// A quantity, what was found and what was expected, with the line of a file where there is one.
///
/// ```
/// use kinetostat_chatter::{ChatterErrorKind, Mode};
///
/// let error = Mode::along([1.0, 0.0, 0.0].into(), 0.04, 900.0, 1.2).unwrap_err();
/// assert_eq!(error.kind, ChatterErrorKind::Response);
/// assert_eq!(error.quantity, "damping ratio");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{quantity}: {found}; expected {expected}", place(.line))]
#[non_exhaustive]
pub struct ChatterError {
    /// Subject of the error.
    pub kind: ChatterErrorKind,
    /// Line of the text that was read, from 1, where the quantity stands in one.
    pub line: Option<usize>,
    /// Name of the quantity.
    pub quantity: String,
    /// Value found.
    pub found: String,
    /// Expected value, or the remedy.
    pub expected: String,
}

impl ChatterError {
    /// An error of a quantity that stands in no file.
    #[must_use]
    pub fn new(
        kind: ChatterErrorKind,
        quantity: impl Into<String>,
        found: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            kind,
            line: None,
            quantity: quantity.into(),
            found: found.to_string(),
            expected: expected.into(),
        }
    }

    /// Adds the line of a text (from 1).
    #[must_use]
    pub fn at_line(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }
}

fn place(line: &Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

/// A number that is finite and not below a bound (or above it, where `open`), or the error that names it.
pub(crate) fn above(
    kind: ChatterErrorKind,
    quantity: &str,
    value: f64,
    bound: f64,
    open: bool,
    unit: &str,
) -> Result<f64> {
    let holds = value.is_finite() && (value > bound || (!open && value >= bound));
    match holds {
        true => Ok(value),
        false => Err(ChatterError::new(
            kind,
            quantity,
            format!("{value} {unit}").trim_end(),
            match open {
                true => format!("a finite number above {bound} {unit}"),
                false => format!("a finite number of at least {bound} {unit}"),
            }
            .trim_end(),
        )),
    }
}
