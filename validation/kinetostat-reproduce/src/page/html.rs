//! All entries as one page: no network, no script, right on light and dark screens and on paper.

use kinetostat_report::Plot;
use minijinja::{Environment, Value, context};

use crate::page::{formula, mathml};
use crate::{Entry, Item, ReproduceError, Status};

/// The name ends in `.html`, which switches automatic escaping on.
const PAGE: &str = "reproduce.html";

/// The page of some entries: each number beside its print, each figure drawn. The same entries give
/// the same bytes.
///
/// # Errors
///
/// [`ReproduceError::Page`] if the template cannot be filled.
pub fn html(entries: &[Entry]) -> Result<String, ReproduceError> {
    let mut environment = Environment::new();
    environment.add_template(PAGE, include_str!("../template/reproduce.html"))?;
    let style = [Plot::style(), include_str!("../template/reproduce.css")].concat();
    let count = |status: Status| {
        let items = entries.iter().flat_map(|entry| &entry.items);
        items.filter(|item| item.status == status).count()
    };
    let page = environment.get_template(PAGE)?.render(context! {
        style => Value::from_safe_string(style),
        version => env!("CARGO_PKG_VERSION"),
        agree => count(Status::Agrees),
        errata => count(Status::Erratum),
        not_reproduced => count(Status::NotReproduced),
        no_print => count(Status::NoPrint),
        entries => entries.iter().map(entry).collect::<Vec<_>>(),
    })?;
    Ok(page)
}

fn entry(entry: &Entry) -> Value {
    let mut notes: Vec<&str> = Vec::new();
    let mut rows = Vec::new();
    // Numbers without print are points of figures: folded away where there are many.
    let mut points = Vec::new();
    for item in &entry.items {
        let row = row(item, &mut notes);
        if item.status == Status::NoPrint {
            points.push(row);
        } else {
            rows.push(row);
        }
    }
    let plots: Vec<Value> = entry
        .plots
        .iter()
        .map(|plot| Value::from_safe_string(plot.element()))
        .collect();
    let few = points.len() <= 12;
    context! {
        id => entry.id,
        title => &entry.title,
        few,
        rows,
        points,
        plots,
        notes => notes.iter().map(|note| (*note).to_owned()).collect::<Vec<String>>(),
    }
}

fn row<'i>(item: &'i Item, notes: &mut Vec<&'i str>) -> Value {
    let note = (!item.note.is_empty()).then(|| {
        let known = notes.iter().position(|note| *note == item.note);
        1 + known.unwrap_or_else(|| {
            notes.push(&item.note);
            notes.len() - 1
        })
    });
    let (class, word) = match item.status {
        Status::Agrees => ("agrees", "agrees"),
        Status::Erratum => ("erratum", "erratum"),
        Status::NotReproduced => ("missed", "not reproduced"),
        Status::NoPrint => ("point", ""),
    };
    context! {
        name => Value::from_safe_string(formula::html(&item.name)),
        printed => item.printed.as_ref().map(|text| Value::from_safe_string(printed(text))),
        formula => item.printed.as_ref().is_some_and(|p| p.chars().count() > 12),
        computed => item.computed.map(shown),
        unit => Value::from_safe_string(formula::html(&item.unit)),
        class,
        word,
        note,
    }
}

fn is_greek(word: &str) -> bool {
    formula::GREEK.iter().any(|(name, _)| *name == word)
}

/// Printed text of the report: formulas as such, numbers with true minus signs.
fn printed(text: &str) -> String {
    let letters = text.contains(|c: char| c.is_ascii_alphabetic());
    let greek = text.split(|c: char| !c.is_ascii_alphabetic()).any(is_greek);
    let formula = letters && (greek || text.contains(['/', '^', '(', '_']));
    let set = formula.then(|| mathml::math(text)).flatten();
    set.unwrap_or_else(|| formula::html(&text.replace('-', "\u{2212}")))
}

/// Ten significant digits, plain where that is readable.
fn shown(value: f64) -> String {
    if value.is_nan() {
        return "not available".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { "infinite" } else { "-infinite" }.into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if (-5..8).contains(&magnitude) {
        let decimals = (9 - magnitude).clamp(0, 12) as usize;
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        return text.replace('-', "\u{2212}");
    }
    format!("{value:.3e}").replace('-', "\u{2212}")
}
