//! Messages about errors in a table of tools, with their lines.

use std::ops::RangeInclusive;

use serde_spanned::Spanned;

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::names;
use crate::source::{Source, described, found_and_expected};

impl Source<'_> {
    /// A message of the TOML reader; for a key that is not known, with the nearest one.
    pub(crate) fn syntax(&self, error: &toml::de::Error) -> CutError {
        let (byte, message) = described(error);
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        let (quantity, found, expected) = match quoted.as_slice() {
            [given, known @ ..] if message.starts_with("unknown ") => {
                let expected = match nearest(given, known) {
                    Some(near) => format!("a known key, perhaps `{near}`"),
                    None => format!("one of {}", known.join(", ")),
                };
                (
                    "key of a tool",
                    format!("`{given}` is not known here"),
                    expected,
                )
            }
            [key] if message.starts_with("missing field") => (
                "tool",
                format!("no `{key}`"),
                format!("a line `{key} = ...` under this [[tool]]"),
            ),
            _ => {
                let whole = || {
                    let expected = "[[tool]] with number, shape, diameter_mm, teeth, each on a line of its own";
                    (message.clone(), expected.to_owned())
                };
                let (found, expected) = found_and_expected(&message).unwrap_or_else(whole);
                ("table of tools", found, expected)
            }
        };
        self.error(byte, quantity, found, expected)
    }

    /// A number of a key within bounds; the error names the key and its line.
    pub(crate) fn number(
        &self,
        key: &str,
        value: Option<&Spanned<f64>>,
        bounds: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<f64>> {
        let Some(value) = value else { return Ok(None) };
        within(CutErrorKind::Tool, key, *value.get_ref(), bounds, unit)
            .map(Some)
            .map_err(self.placed(value))
    }
}

/// The nearest of some keys, if it is close enough to be a typing mistake; a key without its unit is meant to be the one
/// with it.
fn nearest<'k>(given: &str, known: &[&'k str]) -> Option<&'k str> {
    let stem = format!("{given}_");
    let with_unit = known.iter().copied().find(|key| key.starts_with(&stem));
    with_unit.or_else(|| names::nearest(given, known.iter().copied(), 1).pop())
}
