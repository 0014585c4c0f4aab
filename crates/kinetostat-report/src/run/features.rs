//! The table of features: what is allowed on each, and whether it is kept.

use kinetostat_machining::FeatureResult;
use minijinja::{Value, context};

use crate::number::{MISSING, typeset};
use crate::run::shown::Shown;
use crate::text;

/// Maximum number of features shown; more are in the result file.
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
    let [name, lines, before, after, allowed, verdict] = feature.cells();
    let length = |cell: String| match cell.is_empty() {
        true => MISSING.to_owned(),
        false => typeset(&cell),
    };
    let [before, after, allowed] = [before, after, allowed].map(length);
    let name = text::clean(&name);
    context! { name, lines, before, after, allowed, verdict, missed => feature.held == Some(false) }
}
