//! The answer in words.

use std::fmt::Write;

use kinetostat::number::larger;
use kinetostat_identification::{ErrorAtWork, IdentifiedNumber, Knowledge};

use crate::identify::answer::IdentifyAnswer;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, number, triple};

pub(crate) fn answer_text(a: &IdentifyAnswer) -> String {
    let found = &a.found;
    let mut out = String::new();
    for sentence in sentences(a) {
        out.push_str(&wrapped(&sentence, 0));
    }
    if !a.work.is_empty() {
        out.push_str(&wrapped(&of_work(a), 0));
    }
    out.push('\n');
    let (geometry, others): (Vec<_>, Vec<_>) = found.numbers.iter().partition(|n| n.is_geometry());
    if !others.is_empty() {
        out.push_str(&columns(&rows(others.into_iter()), 2));
    }
    if !geometry.is_empty() {
        let largest = |unit: &str| {
            let own = geometry.iter().filter(|n| n.unit == unit);
            let sizes = own.filter_map(|n| Some((n.identified? - n.before).abs()));
            number(sizes.fold(0.0, larger), 2)
        };
        out.push_str(&item(&format!(
            "{} numbers of the geometry are changed by up to {} mm and {} deg; --json and --report list them",
            geometry.len(),
            largest("mm"),
            largest("deg")
        )));
    }
    if !found.findings.is_empty() {
        out.push('\n');
    }
    for finding in &found.findings {
        out.push_str(&item(&finding.to_string()));
    }
    out
}

/// Sentences on the question and on the fit.
pub(crate) fn sentences(a: &IdentifyAnswer) -> Vec<String> {
    let found = &a.found;
    let left_out = match found.rms_left_out_mm {
        Some(rms) => format!(
            "; {} mm in a posture that is not among those fitted",
            fixed(rms, 4)
        ),
        None => String::new(),
    };
    let mut said = vec![
        format!(
            "{} ({}): {} from {} in {} ({}{}{})",
            a.model,
            a.model_source,
            counted(found.numbers.len(), "number"),
            counted(found.readings, "reading"),
            counted(found.postures, "posture"),
            a.measurements,
            if a.small_loads { ", small loads" } else { "" },
            if a.robust { ", robust" } else { "" },
        ),
        format!(
            "Of displacements of {} mm (root mean square) the model as it was leaves {} mm, the identified one {} mm{left_out}.",
            fixed(found.rms_reading_mm, 4),
            fixed(found.rms_before_mm, 4),
            fixed(found.rms_after_mm, 4),
        ),
    ];
    said.extend(a.instrument.as_ref().map(|i| {
        format!(
            "The instrument stands at {} mm, turned by the rotation vector {} deg; its {} places without a load are {} mm from those of the model.",
            triple(i.position_mm, |x| fixed(x, 1)),
            triple(i.rotation_vector_deg, |x| fixed(x, 3)),
            i.places,
            fixed(i.left_mm, 2)
        )
    }));
    if found.resamples > 0 {
        said.push(format!(
            "The intervals are those of {} fits to postures drawn from the measured ones.",
            found.resamples
        ));
    }
    said
}

/// Sentence on the errors along the program of a job.
pub(crate) fn of_work(a: &IdentifyAnswer) -> String {
    let largest = |of: &dyn Fn(&ErrorAtWork) -> f64| {
        let each = a.work.iter().map(|w| of(&w.error));
        fixed(each.fold(0.0, larger), 4)
    };
    let misfit = match a.found.rms_left_out_mm {
        Some(rms) => format!(
            " What no numbers of this model describe comes on top: {} mm in a posture that was not fitted.",
            fixed(rms, 4)
        ),
        None => String::new(),
    };
    let open = a.work.iter().filter(|w| w.error.after_mm.is_none()).count();
    let after = match open {
        0 => format!(
            "less than {} mm with a confidence of 95 %.{misfit}",
            largest(&|e| e.after_mm.unwrap_or(0.0))
        ),
        open => format!(
            "nobody knows how much: at {open} of {} places the error depends on numbers that no reading shows.",
            a.work.len()
        ),
    };
    format!(
        "Along the program the tool is up to {} mm off; compensated with the model as it was, up to {} mm are left, with the identified one {after}",
        largest(&|e| e.displacement_mm),
        largest(&|e| e.before_mm),
    )
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

pub(crate) fn rows<'a>(numbers: impl Iterator<Item = &'a IdentifiedNumber>) -> Vec<Vec<String>> {
    let head = [
        "number",
        "unit",
        "before",
        "identified",
        "+-",
        "95 % between",
        "and",
        "",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(numbers.map(|n| {
        let bound = |k: usize| {
            let bounds = n.interval.map(|b| b[k]);
            bounds.map_or_else(String::new, |b| {
                b.map_or_else(|| "rigid".to_owned(), |x| number(x, 4))
            })
        };
        let mut percent = String::new();
        if let Some(deviation) = n.deviation_percent {
            let _ = write!(percent, "{} %", number(deviation, 2));
        }
        vec![
            n.number.clone(),
            n.unit.clone(),
            number(n.before, 4),
            n.identified
                .map_or_else(|| "-".to_owned(), |x| number(x, 4)),
            percent,
            bound(0),
            bound(1),
            match n.knowledge {
                Knowledge::Identified => "",
                Knowledge::Weak => "weak",
                _ => "not seen",
            }
            .to_owned(),
        ]
    }));
    rows
}
