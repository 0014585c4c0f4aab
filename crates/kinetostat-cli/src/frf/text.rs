//! The answer of `frf` for a person, as a table and as a drawing.

use kinetostat::number::larger;
use kinetostat_chatter::MeasuredResponse;
use kinetostat_dynamics::Receptance;
use kinetostat_report::{DrawnMotion, ReceptanceCurve, receptance_svg};

use crate::frf::answer::FrfAnswer;
use crate::frf::arguments::{AXES, QuantityWord};
use crate::frf::fit_text::fit_text;
use crate::place::query::PlaceQuery;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{load_triple, number};
use crate::ui::warnings;

pub(crate) fn answer_text(query: &PlaceQuery, a: &FrfAnswer, not_drawn: Option<String>) -> String {
    let mut out = query.heading();
    let (low, high) = (
        a.frequencies_hz[0],
        a.frequencies_hz[a.frequencies_hz.len() - 1],
    );
    out.push_str(&wrapped(
        &format!(
            "Frequency response of the tool's tip ({}), {} frequencies from {} to {} Hz, about the equilibrium under the force {} N and the moment {} N m; damping: {}; solved {}.",
            a.quantity,
            a.frequencies_hz.len(),
            number(low, 5),
            number(high, 5),
            load_triple(a.force_n),
            load_triple(a.moment_n_m),
            a.damping,
            match a.solution {
                "direct" => "directly",
                _ => "by modes",
            }
        ),
        0,
    ));
    out.push('\n');
    let mut rows = vec![
        [
            "motion",
            "by",
            "largest",
            "unit",
            "at Hz",
            "in dB",
            "at the lowest frequency",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for c in &a.curves {
        let alike = a.curves.iter().filter(|other| other.unit == c.unit);
        let most = alike.map(|other| other.peak).fold(0.0, larger);
        if c.peak <= NOTHING * most {
            // Rounding of the arithmetic: the machine does not move so.
            let mut row = vec![c.to.to_owned(), c.from.to_owned(), "0".to_owned()];
            row.push(c.unit.clone());
            row.resize(7, String::new());
            rows.push(row);
            continue;
        }
        rows.push(vec![
            c.to.to_owned(),
            c.from.to_owned(),
            number(c.peak, 4),
            c.unit.clone(),
            number(c.peak_hz, 5),
            number(20.0 * c.peak.log10(), 4),
            number(c.real[0].hypot(c.imaginary[0]), 4),
        ]);
    }
    out.push_str(&columns(&rows, 0));
    out.push_str(&wrapped(
        "dB: 20 log10 of the magnitude by 1 of its unit.",
        0,
    ));
    out.push_str(&wrapped(&natural_frequencies(a, high), 0));
    if let Some(words) = not_drawn {
        out.push_str(&wrapped(&words, 0));
    }
    if let Some(fit) = &a.fit {
        out.push_str(&fit_text(fit));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

/// Natural frequencies up to one; of complex pairs with their growth.
fn natural_frequencies(a: &FrfAnswer, high: f64) -> String {
    let growth = |k: usize| a.natural_growth_per_s.as_ref().map_or(0.0, |all| all[k]);
    let list: Vec<String> = (a.natural_frequencies_hz.iter().enumerate())
        .filter(|(_, f)| **f <= high)
        .map(|(k, f)| match growth(k) {
            0.0 => number(*f, 5),
            rate if rate > 0.0 => format!("{} (GROWS by {} 1/s)", number(*f, 5), number(rate, 3)),
            rate => format!("{} (dies away by {} 1/s)", number(*f, 5), number(-rate, 3)),
        })
        .collect();
    let of = match a.natural_growth_per_s {
        Some(_) => " of the complex pairs without damping",
        None => "",
    };
    format!(
        "Natural frequencies up to there{of}, Hz: {}",
        list.join(", ")
    )
}

/// One row for each frequency; real part, imaginary part, magnitude and phase of each entry.
pub(crate) fn table(a: &FrfAnswer) -> Answer<Vec<u8>> {
    let mut head = vec!["frequency_hz".to_owned()];
    for c in &a.curves {
        let unit = c
            .unit
            .replace("(N m)", "n_m")
            .replace('N', "n")
            .replace("^2", "2")
            .replace('/', "_per_");
        let name = format!("{}_by_{}", c.to, c.from);
        head.extend(["real", "imaginary", "magnitude"].map(|p| format!("{name}_{p}_{unit}")));
        head.push(format!("{name}_phase_deg"));
    }
    let mut rows = vec![head];
    for (i, f) in a.frequencies_hz.iter().enumerate() {
        let mut row = vec![cell(*f)];
        for c in &a.curves {
            let (re, im) = (c.real[i], c.imaginary[i]);
            row.extend([re, im, re.hypot(im), im.atan2(re).to_degrees()].map(cell));
        }
        rows.push(row);
    }
    written(&rows)
}

/// A curve below this share of the highest one is the rounding of its arithmetic.
const NOTHING: f64 = 1e-12;

/// Motions along axes by forces along axes that are more than rounding: those that are drawn.
fn drawable(entries: &[(usize, usize)], receptance: &[Receptance]) -> Vec<(usize, usize)> {
    let along: Vec<(usize, usize)> = (entries.iter().copied())
        .filter(|(to, from)| *to < 3 && *from < 3)
        .collect();
    let size = |entry: &(usize, usize)| {
        let all = receptance.iter().map(|m| m[*entry].norm());
        all.fold(0.0, larger)
    };
    let most = along.iter().map(size).fold(0.0, larger);
    let shown = along.into_iter().filter(|e| size(e) > NOTHING * most);
    shown.collect()
}

/// True if the tool moves along any of the axes that would be drawn.
pub(crate) fn moves(entries: &[(usize, usize)], receptance: &[Receptance]) -> bool {
    !drawable(entries, receptance).is_empty()
}

/// Lists the requested entries that are not drawn.
pub(crate) fn not_drawn(entries: &[(usize, usize)], receptance: &[Receptance]) -> Option<String> {
    let shown = drawable(entries, receptance);
    let left = entries.iter().filter(|entry| !shown.contains(entry));
    let names: Vec<String> = left
        .map(|&(to, from)| format!("{} by {}", AXES[to], AXES[from]))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "The picture has motions along axes by forces along axes, as far as there is one; not in it: {}.",
            names.join(", ")
        )
    })
}

/// Responses to forces along axes, and what was measured, dashed.
pub(crate) fn drawn(
    a: &FrfAnswer,
    quantity: QuantityWord,
    entries: &[(usize, usize)],
    receptance: &[Receptance],
    measured: &[MeasuredResponse],
) -> String {
    let own = drawable(entries, receptance).into_iter();
    let mut curves: Vec<ReceptanceCurve> = own
        .map(|(to, from)| ReceptanceCurve {
            name: format!("{} by force along {}", AXES[to], AXES[from]),
            dashed: false,
            frequencies_hz: a.frequencies_hz.clone(),
            receptance: receptance.iter().map(|m| m[(to, from)]).collect(),
        })
        .collect();
    for response in measured {
        let (frequencies_hz, values) = response.receptance().into_iter().unzip();
        curves.push(ReceptanceCurve {
            name: format!("measured: {}", response.name),
            dashed: true,
            frequencies_hz,
            receptance: values,
        });
    }
    let motion = match quantity {
        QuantityWord::Receptance => DrawnMotion::Receptance,
        QuantityWord::Mobility => DrawnMotion::Mobility,
        QuantityWord::Accelerance => DrawnMotion::Accelerance,
    };
    receptance_svg(
        &curves,
        motion,
        &format!("{}: {} of the tool's tip", a.head.model, quantity.word()),
    )
}
