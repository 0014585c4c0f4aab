//! The answer of `frf` for a person, as a table and as a drawing.

use kinetostat::number::larger;
use kinetostat_chatter::MeasuredResponse;
use kinetostat_dynamics::Receptance;
use kinetostat_report::{DrawnMotion, ReceptanceCurve, receptance_svg};

use crate::frf::answer::FrfAnswer;
use crate::frf::arguments::{AXES, QuantityWord};
use crate::frf::fit::FitAnswer;
use crate::frf::scaling::ScaledAnswer;
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
            row.push(shown_unit(&c.unit).0.to_owned());
            row.resize(7, String::new());
            rows.push(row);
            continue;
        }
        let (unit, factor) = shown_unit(&c.unit);
        rows.push(vec![
            c.to.to_owned(),
            c.from.to_owned(),
            number(factor * c.peak, 4),
            unit.to_owned(),
            number(c.peak_hz, 5),
            number(20.0 * c.peak.log10(), 4),
            number(factor * c.real[0].hypot(c.imaginary[0]), 4),
        ]);
    }
    out.push_str(&columns(&rows, 0));
    out.push_str(&wrapped(
        "dB: 20 log10 of the magnitude by 1 of its unit in SI, as files have it.",
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

/// Unit of a response for a person, that of the picture, and its factor from SI.
fn shown_unit(unit: &str) -> (&str, f64) {
    match unit {
        "m/N" => ("um/N", 1e6),
        "m/(s N)" => ("mm/(s N)", 1e3),
        _ => (unit, 1.0),
    }
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

/// Modal assurance below which two shapes are hardly the same mode.
const ALIKE: f64 = 0.8;
/// A fit that leaves more of a curve does not follow it.
const LEFT: f64 = 0.1;

fn fit_text(fit: &FitAnswer) -> String {
    let mut out = String::from("\nMeasured modes\n");
    let heads = [
        "measured, Hz",
        "damping",
        "model's mode",
        "Hz",
        "apart",
        "damping",
        "MAC",
        "amplitude",
    ];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    let some = |x: Option<f64>, digits| x.map_or_else(String::new, |x| number(x, digits));
    for mode in &fit.modes {
        let apart = mode
            .model_frequency_hz
            .map(|hz| 100.0 * (hz / mode.frequency_hz - 1.0));
        rows.push(vec![
            number(mode.frequency_hz, 5),
            number(mode.damping_ratio, 3),
            mode.model_mode
                .map_or_else(|| "none".to_owned(), |n| n.to_string()),
            some(mode.model_frequency_hz, 5),
            apart.map_or_else(String::new, |percent| format!("{percent:+.1} %")),
            some(mode.model_damping_ratio, 3),
            some(mode.modal_assurance, 3),
            some(mode.amplitude_by_model, 3),
        ]);
    }
    out.push_str(&columns(&rows, 0));
    let worst = fit.misfit.iter().copied().fold(0.0, larger);
    let mut say = |text: String| out.push_str(&wrapped(&text, 0));
    say(format!(
        "Fit: rational fractions with one set of poles for {} curve{}; {} % of the worst curve is left.",
        fit.curves.len(),
        if fit.curves.len() == 1 { "" } else { "s" },
        number(100.0 * worst, 3)
    ));
    if fit.modes.iter().any(|m| m.amplitude_by_model.is_some()) {
        say("Amplitude: how many times as large as the model's the measured response of the mode is; 1 where masses and units are right.".to_owned());
    }
    if !fit.left_out_hz.is_empty() {
        let list: Vec<String> = fit.left_out_hz.iter().map(|hz| number(*hz, 4)).collect();
        say(format!(
            "Left out: poles at {} Hz, which are no vibrations in the band or hardly excited by this force.",
            list.join(", ")
        ));
    }
    if worst > LEFT {
        say("The fit does not follow the curves: ask for more modes, or for a narrower band (--frequencies).".to_owned());
    }
    if !fit.shapes_compared {
        say("One curve tells nothing of shapes: modes are paired by their frequencies alone. Measure along two or three axes.".to_owned());
    } else if fit
        .modes
        .iter()
        .any(|m| m.modal_assurance.is_some_and(|mac| mac < ALIKE))
    {
        say("Where MAC is below 0.8 the two modes hardly are the same: their frequencies are not to be compared.".to_owned());
    }
    if let Some(scaled) = &fit.scaled {
        out.push_str(&scaled_text(fit, scaled));
    }
    out
}

fn scaled_text(fit: &FitAnswer, scaled: &ScaledAnswer) -> String {
    let mut out = String::from("\nScaled to the measured frequencies\n");
    let heads = [
        "number of the model",
        "before",
        "scaled",
        "unit",
        "known to",
    ];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for p in &scaled.parameters {
        rows.push(vec![
            p.path.clone(),
            number(p.before, 4),
            number(p.value, 4),
            p.unit.to_owned(),
            match (p.deviation, p.at_bound) {
                (_, true) => "at its bound".to_owned(),
                (Some(share), _) => format!("{} %", number(100.0 * share, 2)),
                (None, _) => "not told".to_owned(),
            },
        ]);
    }
    out.push_str(&columns(&rows, 0));
    let apart = (scaled.frequencies_hz.iter().zip(&fit.modes))
        .map(|(hz, mode)| (hz / mode.frequency_hz - 1.0).abs())
        .fold(0.0, larger);
    out.push_str(&wrapped(
        &format!(
            "Frequencies are within {} % of the measured ones then.",
            number(larger(100.0 * apart, 1e-3), 2)
        ),
        0,
    ));
    if let Some(ratios) = &scaled.damping_ratios {
        let apart = (ratios.iter().zip(&fit.modes))
            .map(|(ratio, mode)| (ratio / mode.damping_ratio - 1.0).abs())
            .fold(0.0, larger);
        out.push_str(&wrapped(
            &format!(
                "Damping ratios are within {} % of the measured ones.",
                number(larger(100.0 * apart, 1e-3), 2)
            ),
            0,
        ));
    }
    for words in &scaled.not_told {
        let text = format!(
            "The measurement does not tell: {words}, by a factor of e, changes them by less than they are known."
        );
        out.push_str(&wrapped(&text, 0));
    }
    out
}
