//! Many faults of one file in one message.

use std::collections::BTreeMap;
use std::fmt::Display;

/// Faults of one reason that are listed; further ones are counted.
const FAULTS_OF_A_REASON: usize = 3;

/// Places that are named for each reason beside those.
const PLACES_NAMED: usize = 500;

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
    let mut lines = vec![format!("{} {places} are refused:", all.len())];
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut shown = 0;
    // Reasons in the order in which they come, each with the line where the places stand that are not shown in full: that of the first
    // of them.
    let mut further: Vec<(&str, usize, Vec<String>)> = Vec::new();
    let mut of_reason: BTreeMap<&str, usize> = BTreeMap::new();
    for fault in all {
        let reason = reason(fault);
        let count = counts.entry(reason).or_default();
        *count += 1;
        if *count <= FAULTS_OF_A_REASON && shown < FAULTS_SHOWN {
            shown += 1;
            lines.push(format!("  {fault}"));
            continue;
        }
        let index = *of_reason.entry(reason).or_insert_with(|| {
            further.push((reason, lines.len(), Vec::new()));
            lines.push(String::new());
            further.len() - 1
        });
        further[index].2.push(place_of(&fault.to_string(), reason));
    }
    for (reason, line, mut places) in further {
        let more = places.len().saturating_sub(PLACES_NAMED);
        places.truncate(PLACES_NAMED);
        let more = match more {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        lines[line] = format!("  {}{more}: {reason}", places.join(", "));
    }
    lines.join("\n")
}

/// Returns the place of a fault: the text before its reason.
fn place_of(fault: &str, reason: &str) -> String {
    let before = fault.split_once(reason).map_or(fault, |(before, _)| before);
    before.trim_end().trim_end_matches(':').to_owned()
}
