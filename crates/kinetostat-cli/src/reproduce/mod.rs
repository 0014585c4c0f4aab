//! `kinetostat reproduce`: the numbers of the report beside their print.
//!
//! It takes the name of a table, an equation or a figure, or none, and gives the printed and the computed figures.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::{counted, without_zeros};
use kinetostat_machining::{RunError, Watch};
use kinetostat_reproduce::{Entry, IDS, Item, ReproduceError, Status, all, html, one};

use crate::files::outputs::{Existing, Outputs};
use crate::options::EXIT_CODES;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::json;
use crate::ui::layout::{self, listed, wrapped};
use crate::ui::numbers::number;
use crate::ui::progress::Progress;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<Vec<Entry>>("numbers of the report")];

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
        let text = html(&entries).map_err(|error| ErrorCode::NoAnswer.failure(error))?;
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
        error => ErrorCode::NoAnswer.failure(error),
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
    ErrorCode::UnknownName.failure(format!(
        "there is no entry '{id}'{nearest}\nThere are:\n{}",
        list.trim_end()
    ))
}

/// Words of a status, as in the legend of the summary.
fn word(status: Status) -> &'static str {
    match status {
        Status::Agrees => "agrees",
        Status::Erratum => "ERRATUM",
        Status::NotReproduced => "NOT REPRODUCED",
        Status::NoPrint => "",
    }
}

/// Longest print that stands in its column; formulas get a line of their own.
const PRINT: usize = 10;

fn computed_text(item: &Item) -> String {
    let Some(value) = item.computed else {
        return String::new();
    };
    without_zeros(&number(value, 10)).to_owned()
}

/// One entry as a table. Numbers without print are many (they are points of figures): with all
/// entries they are only counted.
fn entry_text(out: &mut String, entry: &Entry, everything: bool) {
    out.push_str(&wrapped(&format!("{}: {}", entry.id, entry.title), 0));
    let shown: Vec<&Item> = entry
        .items
        .iter()
        .filter(|item| everything || item.status != Status::NoPrint)
        .collect();
    let mut notes: Vec<&str> = Vec::new();
    // Print, computed number, unit and status of every row; the formula below it if one is printed.
    let mut cells: Vec<[String; 4]> = Vec::new();
    let mut formulas: Vec<Option<&str>> = Vec::new();
    for item in &shown {
        let mut status = word(item.status).to_owned();
        if !item.note.is_empty() {
            let known = notes.iter().position(|note| *note == item.note);
            let index = known.unwrap_or_else(|| {
                notes.push(&item.note);
                notes.len() - 1
            });
            status = format!("{status} [{}]", index + 1).trim_start().to_owned();
        }
        let (print, formula) = match item.printed.as_deref() {
            Some(text) if text.chars().count() > PRINT => ("", Some(text)),
            Some(text) => (text, None),
            None => ("", None),
        };
        let print = print.to_owned();
        cells.push([print, computed_text(item), item.unit.clone(), status]);
        formulas.push(formula);
    }
    const HEADINGS: [&str; 4] = ["printed", "computed", "unit", "status"];
    let width = |column: usize| {
        let widths = cells.iter().map(|row| row[column].chars().count());
        widths.max().unwrap_or(0).max(HEADINGS[column].len())
    };
    // Names that find no room in the row stand above it.
    let taken: usize = (0..4).map(|column| width(column) + 2).sum();
    let room = layout::WIDTH.saturating_sub(2 + taken);
    let fits = |item: &Item| item.name.chars().count() <= room;
    let table: Vec<Vec<String>> = shown
        .iter()
        .zip(&cells)
        .map(|(item, [print, computed, unit, status])| {
            vec![
                if fits(item) {
                    item.name.clone()
                } else {
                    String::new()
                },
                format!("{print:>width$}", width = width(0)),
                format!("{computed:>width$}", width = width(1)),
                unit.clone(),
                status.clone(),
            ]
        })
        .collect();
    let [printed, computed, unit, status] = HEADINGS;
    let heading = vec![
        "number".to_owned(),
        format!("{printed:>width$}", width = width(0)),
        format!("{computed:>width$}", width = width(1)),
        unit.to_owned(),
        status.to_owned(),
    ];
    let table = listed(&[vec![heading], table].concat(), 2);
    let mut lines = table.lines();
    if let Some(heading) = lines.next().filter(|_| !shown.is_empty()) {
        out.push_str(&format!("{heading}\n"));
    }
    for ((item, formula), line) in shown.iter().zip(&formulas).zip(lines) {
        if !fits(item) {
            out.push_str(&wrapped(&item.name, 2));
        }
        out.push_str(line);
        out.push('\n');
        if let Some(formula) = formula {
            out.push_str(&wrapped(&format!("printed: {formula}"), 6));
        }
    }
    let left = entry.items.len() - shown.len();
    if left > 0 {
        let words = format!(
            "{} without print: kinetostat reproduce {}",
            counted(left, "number"),
            entry.id
        );
        out.push_str(&wrapped(&words, 2));
    }
    for (index, note) in notes.iter().enumerate() {
        out.push_str(&wrapped(&format!("[{}] {note}", index + 1), 4));
    }
    out.push('\n');
}

fn summary(out: &mut String, entries: &[Entry], one: bool) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for item in entries.iter().flat_map(|entry| &entry.items) {
        let kind = match item.status {
            Status::Agrees => "agree",
            Status::Erratum => "errata",
            Status::NotReproduced => "not reproduced",
            Status::NoPrint => "without print",
        };
        *counts.entry(kind).or_default() += 1;
    }
    let count = |kind: &str| counts.get(kind).copied().unwrap_or(0);
    let all: usize = counts.values().sum();
    let place = if one {
        String::new()
    } else {
        format!(" in {} entries", entries.len())
    };
    out.push_str(&format!(
        "{}{place}: {} agree, {}, {} not reproduced, {} without print\n",
        counted(all, "number"),
        count("agree"),
        match count("errata") {
            1 => "1 erratum".to_owned(),
            n => format!("{n} errata"),
        },
        count("not reproduced"),
        count("without print")
    ));
}

/// The numbers of the COROUSSO report L1.1, computed again and set beside their print
///
/// Each table, each equation with a number in it and each figure of chapters 2 to 7: what is printed,
/// what comes out, and whether they agree; where they do not, why.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ReproduceArgs {
    /// Which one, as in table-5.2, eq-3.34 or fig-5.7; all without it
    #[arg(value_name = "ID")]
    pub(crate) id: Option<String>,
    /// Print the numbers as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Write a page with all numbers and the figures drawn
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) html: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}
