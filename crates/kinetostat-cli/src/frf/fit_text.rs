//! Measured modes for a person.

use kinetostat::number::larger;

use crate::frf::fit::FitAnswer;
use crate::frf::scaling::ScaledAnswer;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::number;

/// Modal assurance below which two shapes are hardly the same mode.
const ALIKE: f64 = 0.8;
/// A fit that leaves more of a curve does not follow it.
const LEFT: f64 = 0.1;

pub(crate) fn fit_text(fit: &FitAnswer) -> String {
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
