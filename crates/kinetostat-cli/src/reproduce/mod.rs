//! `kinetostat reproduce`: the numbers of the report beside their print.
//!
//! It takes the name of a table, an equation or a figure, or none, and gives the printed and the computed figures.

pub(crate) mod arguments;
mod text;

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_machining::{RunError, Watch};
use kinetostat_reproduce::{Entry, IDS, ReproduceError, all, html, one};

use crate::files::outputs::{Existing, Outputs};
use crate::reproduce::arguments::ReproduceArgs;
use crate::reproduce::text::{entry_text, summary};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;
use crate::ui::layout::wrapped;
use crate::ui::progress::Progress;

pub(crate) fn run(args: &ReproduceArgs) -> Answer<()> {
    if let Some(id) = &args.id
        && !IDS.contains(&id.as_str())
    {
        return Err(unknown(id));
    }
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, Vec::new());
    let page = match &args.html {
        Some(path) => Some(outputs.claim("page", path)?),
        None => None,
    };
    let entries = computed(args.id.as_deref())?;
    if let Some(page) = page {
        let text = html(&entries).map_err(Failure::unanswered)?;
        outputs.fill(page, text.as_bytes())?;
    }
    let written = outputs.commit()?;
    let mut text = String::new();
    for entry in &entries {
        entry_text(&mut text, entry, args.id.is_some());
    }
    summary(&mut text, &entries, args.id.is_some());
    for path in &written {
        text.push_str(&format!("\nPage with the figures: {}\n", path.display()));
    }
    json::print_answer(&text, &entries, args.json)
}

pub(crate) fn computed(id: Option<&str>) -> Answer<Vec<Entry>> {
    let failure_of = |error: ReproduceError| match error {
        ReproduceError::Unknown(id) => unknown(&id),
        error => Failure::unanswered(error),
    };
    if let Some(id) = id {
        return Ok(vec![one(id).map_err(failure_of)?]);
    }
    let progress = Progress::new();
    let done = AtomicUsize::new(0);
    progress.stage("numbers of the report", IDS.len());
    let entries = all(|_| {
        progress.advance(done.fetch_add(1, Ordering::Relaxed) + 1);
    });
    progress.finish();
    if Watch::cancelled(&progress) {
        return Err(RunError::Cancelled.into());
    }
    entries.map_err(failure_of)
}

fn unknown(id: &str) -> Failure {
    let nearest = IDS
        .iter()
        .map(|known| (strsim::damerau_levenshtein(id, known), *known))
        .min()
        .filter(|(away, _)| *away <= 4)
        .map_or_else(String::new, |(_, known)| {
            format!("; did you mean '{known}'?")
        });
    let list = wrapped(&IDS.join(" "), 2);
    Failure::input(format!(
        "there is no entry '{id}'{nearest}\nThere are:\n{}",
        list.trim_end()
    ))
}
