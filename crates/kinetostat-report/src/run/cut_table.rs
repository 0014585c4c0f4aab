//! Section on the cut besides its charts: a sentence and the lines with the largest forces.

use kinetostat_machining::{CutPlace, CuttingResult};
use minijinja::{Value, context};

use crate::number::{self, MISSING, Rounding};
use crate::run::cutting::{percent, spread};
use crate::run::shown::Shown;

/// The section's content; nothing where no force was computed from the cut or nothing is cut.
pub(crate) fn cutting(result: &Shown<'_>, figure: Value) -> Value {
    let Some(cut) = result.cutting.as_ref().filter(|_| figure.is_true()) else {
        return Value::from(());
    };
    let limited = cut.nearest_to_spindle.is_some();
    let rows: Vec<Value> = cut.worst_lines.iter().map(row).collect();
    let reduced = (cut.places.len() >= CuttingResult::MAX_PLACES / 2
        && cut.stations > cut.places.len())
    .then(|| {
        format!(
            "Drawn from {} of {} places: of every stretch those with the largest and the smallest values.",
            number::count(cut.places.len()),
            number::count(cut.stations)
        )
    });
    context! { sentence => sentence(cut), figure, rows, limited, reduced }
}

fn sentence(cut: &CuttingResult) -> String {
    let band = match cut.spread_percent > 0.0 {
        true => format!(
            "Coefficients of tables fit another batch or tool to {}: the band shows it.",
            spread(cut)
        ),
        false => String::new(),
    };
    let spindle = match cut
        .nearest_to_spindle
        .as_ref()
        .and_then(CutPlace::share_of_spindle)
    {
        Some(share) if share > 1.0 => {
            " The spindle has not the torque that is needed: see the warnings."
        }
        _ => "",
    };
    format!(
        "{band}{spindle} The lines with the largest forces stand below; what was assumed, at the end of the report."
    )
}

fn row(p: &CutPlace) -> Value {
    let digits = |value: f64| number::significant(value, 3, Rounding::Nearest);
    let parts = [p.force_along_feed_n, p.force_left_n, p.force_up_n];
    context! {
        line => number::count(p.line),
        force => number::fixed(p.force_n(), 1),
        parts => parts.map(|n| number::fixed(n, 1)).to_vec(),
        torque => digits(p.torque_n_m),
        share => p.share_of_spindle().map_or_else(|| MISSING.to_owned(), percent),
        power => digits(p.power_w),
        depth => number::fixed(p.depth_mm, 2),
        arc => number::fixed(p.arc_deg, 0),
        chip => digits(p.chip_mm),
    }
}
