//! Reasons why a problem has no answer.

use thiserror::Error;

/// Reason why a problem has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConeError {
    /// No row, or no unknown.
    #[error("the matrix has {rows} rows and {columns} columns; at least one of each is required")]
    Empty {
        /// Rows of the matrix.
        rows: usize,
        /// Columns of the matrix.
        columns: usize,
    },
    /// Sizes that do not fit together.
    #[error("{what} has {found} entries; {expected} are required")]
    Size {
        /// Name of the vector or matrix.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries required.
        expected: usize,
    },
    /// An infinite number or NaN.
    #[error("{0} contains a number that is not finite")]
    NotFinite(&'static str),
    /// A nominal size that is not positive.
    #[error("the nominal size of column {column} is {size}; it must be positive")]
    NominalSize {
        /// Column of the unknown.
        column: usize,
        /// Size found.
        size: f64,
    },
    /// A prior precision that is not symmetric and positive semi-definite.
    #[error("the prior precision is not symmetric and positive semi-definite")]
    Precision,
    /// A constraint on a column that does not exist.
    #[error("a constraint names column {column}; the matrix has {columns} columns")]
    ColumnOutOfRange {
        /// Column named.
        column: usize,
        /// Columns of the matrix.
        columns: usize,
    },
    /// Two constraints on the same column.
    #[error("column {0} occurs twice in the constraints")]
    ColumnTwice(usize),
    /// A number of columns that is no triangle of a matrix.
    #[error("a symmetric matrix has n(n+1)/2 columns (1, 3, 6, 10, 15, 21, ...), not {0}")]
    Triangle(usize),
    /// A duality gap that did not become small enough.
    #[error(
        "the duality gap is {gap:.1e} of the objective after {steps} Newton steps; scale the columns by nominal sizes"
    )]
    NotConverged {
        /// Newton steps made.
        steps: usize,
        /// Smallest gap reached, relative to the objective.
        gap: f64,
    },
}
