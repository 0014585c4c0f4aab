//! Units of length by their word.

use serde::Deserialize;

/// Units of a program that does not name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum UnitsWord {
    /// Millimetres, as after G21
    Mm,
    /// Inches, as after G20
    Inch,
}
