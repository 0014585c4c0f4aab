//! Entries of the reproduction: a table, an equation or a figure of the report, as numbers beside their print.

use kinetostat_report::Plot;
use schemars::JsonSchema;
use serde::Serialize;

/// A table, numbered equation or figure of the report.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Entry {
    /// Identifier, as in `table-5.2`, `eq-3.34`, `fig-5.7`.
    pub id: &'static str,
    /// Title in words.
    pub title: String,
    /// Numbers of the entry.
    pub items: Vec<Item>,
    /// The figure, drawn from the computed points.
    #[serde(skip)]
    pub plots: Vec<Plot>,
}

/// Number of an entry, printed and computed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Item {
    /// Name of the number, in words.
    pub name: String,
    /// Printed text, digit by digit; `None` if the report prints no number here.
    pub printed: Option<String>,
    /// Value computed by this run; `None` if there is nothing to compute.
    pub computed: Option<f64>,
    /// Unit of both; empty for a pure number.
    pub unit: String,
    /// Agreement of the two, or the reason for a difference.
    pub status: Status,
    /// Explanation in words: the erratum, attempts, or remarks.
    pub note: String,
}

/// Agreement between print and computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The printed digits are the rounding of the computed number.
    Agrees,
    /// The print is wrong and it is known how; the note names the entry of the errata.
    Erratum,
    /// The print could not be obtained; the note says what was tried.
    NotReproduced,
    /// The report prints no number here.
    NoPrint,
}

impl Item {
    /// A printed number. It agrees if its digits are the rounding of `computed`; otherwise it is not
    /// reproduced, for the reason in `note`.
    #[must_use]
    pub fn compared(
        name: impl Into<String>,
        printed: &str,
        computed: f64,
        unit: &str,
        note: &str,
    ) -> Self {
        Self {
            name: name.into(),
            printed: Some(printed.to_owned()),
            computed: Some(computed),
            unit: unit.to_owned(),
            status: if is_rounding(printed, computed) {
                Status::Agrees
            } else {
                Status::NotReproduced
            },
            note: note.to_owned(),
        }
    }

    /// A printed number that is known to be wrong: an erratum, unless the computed number rounds to it
    /// after all. The note names the entry of the errata first, as in `erratum 3.26: ...`.
    #[must_use]
    pub fn erratum(
        name: impl Into<String>,
        printed: &str,
        computed: f64,
        unit: &str,
        note: &str,
    ) -> Self {
        let mut item = Self::compared(name, printed, computed, unit, note);
        if item.status == Status::NotReproduced {
            item.status = Status::Erratum;
        }
        item
    }

    /// A number that the report does not print.
    #[must_use]
    pub fn unprinted(name: impl Into<String>, computed: f64, unit: &str, note: &str) -> Self {
        Self {
            name: name.into(),
            printed: None,
            computed: Some(computed),
            unit: unit.to_owned(),
            status: Status::NoPrint,
            note: note.to_owned(),
        }
    }
}

impl Item {
    /// A printed formula with its value at the inputs of the computation. It agrees if the value is
    /// the computed one to nine digits.
    #[must_use]
    pub fn formula(
        name: impl Into<String>,
        printed: &str,
        value: f64,
        computed: f64,
        unit: &str,
        note: &str,
    ) -> Self {
        let agrees = (value - computed).abs() <= 1e-9 * computed.abs().max(1.0);
        Self {
            name: name.into(),
            printed: Some(printed.to_owned()),
            computed: Some(computed),
            unit: unit.to_owned(),
            status: if agrees {
                Status::Agrees
            } else {
                Status::NotReproduced
            },
            note: note.to_owned(),
        }
    }

    /// A printed formula that is known to be wrong: an erratum, unless it holds after all. The note
    /// begins as that of [`Item::erratum`].
    #[must_use]
    pub fn wrong_formula(
        name: impl Into<String>,
        printed: &str,
        value: f64,
        computed: f64,
        unit: &str,
        note: &str,
    ) -> Self {
        let mut item = Self::formula(name, printed, value, computed, unit, note);
        if item.status == Status::NotReproduced {
            item.status = Status::Erratum;
        }
        item
    }
}

/// True if a printed decimal number is the rounding of `computed` to the same number of digits after the point. A
/// number that lies half way may be rounded either way.
#[must_use]
pub fn is_rounding(printed: &str, computed: f64) -> bool {
    let text = printed.trim().replace('\u{2212}', "-");
    let Ok(value) = text.parse::<f64>() else {
        return false;
    };
    let decimals = text.split_once('.').map_or(0, |(_, digits)| digits.len());
    let half = 0.5 * 10f64.powi(-i32::try_from(decimals).unwrap_or(i32::MAX));
    (value - computed).abs() <= half * (1.0 + 1e-9) + 1e-12 * computed.abs()
}
