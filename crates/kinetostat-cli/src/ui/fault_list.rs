//! Many faults of one file in one message.

use std::collections::BTreeMap;
use std::fmt::Display;

/// Faults of one reason that are listed; further ones are counted.
const FAULTS_OF_A_REASON: usize = 3;

/// Faults listed in all.
const FAULTS_SHOWN: usize = 40;

/// All faults of a file in the order of its lines, or the only one.
pub(crate) fn fault_list_text<'f, F: Display>(
    places: &str,
    first: &F,
    all: &'f [F],
    reason: impl Fn(&'f F) -> &'f str,
) -> String {
    if all.len() < 2 {
        return first.to_string();
    }
    let mut text = format!("{} {places} are refused:", all.len());
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut shown = 0;
    for fault in all {
        let count = counts.entry(reason(fault)).or_default();
        *count += 1;
        if *count <= FAULTS_OF_A_REASON && shown < FAULTS_SHOWN {
            shown += 1;
            text.push_str(&format!("\n  {fault}"));
        }
    }
    if shown < all.len() {
        text.push_str(&format!(
            "\n  and {} more, most for the same reasons as above",
            all.len() - shown
        ));
    }
    text
}
