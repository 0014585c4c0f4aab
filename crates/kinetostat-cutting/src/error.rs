//! Error of a tool, a material, a cut or a stock: quantity, value found, value expected.

use crate::number::plain;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, CutError>;

/// Subject of an error.
///
/// ```
/// use kinetostat_cutting::{CutErrorKind, Shape, Tool};
///
/// let error = Tool::new(Shape::Flat, -6.0, 2).unwrap_err();
/// assert_eq!(error.kind, CutErrorKind::Tool);
/// assert_eq!(error.quantity, "diameter");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CutErrorKind {
    /// A tool that nobody could make or hold.
    Tool,
    /// A material or law with coefficients that no material has, or that is not known.
    Material,
    /// A cut that cannot be made with this tool.
    Cut,
    /// A stock that has no volume or needs more memory than is given.
    Stock,
    /// A spindle that nobody builds.
    Machine,
    /// A file that cannot be read, or a line of it that says nothing that belongs there.
    File,
    /// Measurements that do not determine what is asked.
    Measurement,
}

/// A quantity, what was found and what was expected, with the place in a file where there is one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{quantity}: {found}; {}", place(.file, .line), advice(.expected, *.is_suggestion))]
#[non_exhaustive]
pub struct CutError {
    /// Subject of the error.
    pub kind: CutErrorKind,
    /// File, where the quantity stands in one.
    pub file: Option<String>,
    /// Line of the file, from 1.
    pub line: Option<usize>,
    /// Name of the quantity.
    pub quantity: String,
    /// Value found.
    pub found: String,
    /// Expected value, or the remedy.
    pub expected: String,
    /// True if `expected` is a question after the nearest known name.
    pub is_suggestion: bool,
}

impl CutError {
    /// An error of a quantity that stands in no file.
    #[must_use]
    pub fn new(
        kind: CutErrorKind,
        quantity: impl Into<String>,
        found: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            kind,
            file: None,
            line: None,
            quantity: quantity.into(),
            found: found.to_string(),
            expected: expected.into(),
            is_suggestion: false,
        }
    }

    /// An error of a name that is not known; the nearest known ones are suggested.
    #[must_use]
    pub fn suggesting(
        kind: CutErrorKind,
        quantity: impl Into<String>,
        found: impl ToString,
        near: &[&str],
    ) -> Self {
        let names = near.join(" or ");
        Self {
            is_suggestion: true,
            ..Self::new(kind, quantity, found, format!("did you mean {names}?"))
        }
    }

    /// The expected value or the suggested names, as a clause.
    #[must_use]
    pub fn advice(&self) -> String {
        advice(&self.expected, self.is_suggestion)
    }

    /// Adds the file and its line (from 1).
    #[must_use]
    pub fn at(mut self, file: impl Into<String>, line: Option<usize>) -> Self {
        self.file = Some(file.into());
        self.line = line;
        self
    }
}

/// Phrase with the expected value; a suggested name is used as it is.
fn advice(expected: &str, is_suggestion: bool) -> String {
    match is_suggestion {
        true => expected.to_owned(),
        false => format!("expected {expected}"),
    }
}

fn place(file: &Option<String>, line: &Option<usize>) -> String {
    match (file, line) {
        (Some(file), Some(line)) => format!("{file}:{line}: "),
        (Some(file), None) => format!("{file}: "),
        _ => String::new(),
    }
}

/// A number within bounds that hold for any machine shop, or the error that names it.
pub(crate) fn within(
    kind: CutErrorKind,
    quantity: &str,
    value: f64,
    bounds: std::ops::RangeInclusive<f64>,
    unit: &str,
) -> Result<f64> {
    match bounds.contains(&value) {
        true => Ok(value),
        false => Err(CutError::new(
            kind,
            quantity,
            format!("{} {unit}", plain(value)).trim_end(),
            format!(
                "{} to {} {unit}",
                plain(*bounds.start()),
                plain(*bounds.end())
            )
            .trim_end(),
        )),
    }
}
