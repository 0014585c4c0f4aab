//! The table of features: what is allowed on each, and whether it is kept.

use kinetostat_machining::FeatureResult;
use minijinja::{Value, context};

use crate::number::MISSING;
use crate::run::shown::Shown;
use crate::text;

/// Most features shown; more are in the result file.
const MOST: usize = 200;

/// Rows of features; nothing where the job names none.
pub(crate) fn table(result: &Shown<'_>) -> Value {
    if result.features.is_empty() {
        return Value::from(());
    }
    let rows: Vec<Value> = result.features.iter().take(MOST).map(row).collect();
    context! { left_out => result.features.len() - rows.len(), rows }
}

fn row(feature: &FeatureResult) -> Value {
    let cells = feature.cells().map(|cell| match cell.is_empty() {
        true => MISSING.to_owned(),
        false => text::clean(&cell),
    });
    let [name, lines, before, after, allowed, verdict] = cells;
    context! { name, lines, before, after, allowed, verdict, missed => feature.held == Some(false) }
}
