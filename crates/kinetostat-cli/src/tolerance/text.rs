//! The answer in words.

use std::fmt::Write;

use kinetostat_analysis::tolerance::{MOST_MISSING, NOTHING};
use kinetostat_machining::number::plus_minus;

use crate::tolerance::answer::{ColumnResult, ToleranceAnswer};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{given, number, short, triple};

fn row(result: &ColumnResult) -> Vec<String> {
    let (draws, linear) = (&result.answer.draws, &result.answer.linear);
    let spread = draws.standard_deviation.value;
    let is_at_zero = linear.nominal.abs() <= NOTHING && linear.standard_deviation <= 0.01 * spread;
    vec![
        result.name.to_owned(),
        plus_minus(draws.mean.value, spread),
        number(draws.quantile(0.025), 3),
        number(draws.quantile(0.975), 3),
        match is_at_zero {
            true => "0".to_owned(),
            false => plus_minus(linear.nominal, linear.standard_deviation),
        },
        match (result.answer.verdict.linear_is_enough, is_at_zero) {
            (true, _) => "yes".to_owned(),
            // A length has a kink at zero, and no slope there.
            (false, true) => "NO (a length at 0)".to_owned(),
            (false, false) => format!(
                "NO ({} %)",
                number(100.0 * result.answer.verdict.nonlinearity, 2)
            ),
        },
    ]
}

pub(crate) fn answer_text(a: &ToleranceAnswer) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}): {} machines, {} uncertain numbers{}, seed {}",
            a.model,
            a.model_source,
            a.machines,
            a.uncertain.len(),
            if a.correlated {
                ", some correlated"
            } else {
                ""
            },
            a.seed
        ),
        0,
    );
    for u in &a.uncertain {
        let spread = format!(
            "{}: {} {}, {} {}",
            u.name,
            given(u.value),
            u.unit,
            u.distribution,
            given(u.spread)
        );
        out.push_str(&item(&spread));
    }
    for place in &a.places {
        let _ = write!(out, "\nAt {} mm\n", triple(place.position_mm, short));
        let head = [
            "",
            "mean +- deviation",
            "2.5 %",
            "97.5 %",
            "linear",
            "enough?",
        ];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(place.results.iter().map(row));
        out.push_str(&columns(&rows, 2));
        for result in place.results.iter().filter(|r| r.sobol.is_some()) {
            let own = result.sobol.iter().flatten().zip(&a.uncertain);
            let mut rows = vec![vec![
                format!("{} comes from", result.name),
                "alone".into(),
                "with others".into(),
            ]];
            rows.extend(own.map(|(index, u)| {
                vec![
                    u.name.clone(),
                    plus_minus(index.first.value, index.first.plus_minus),
                    plus_minus(index.total.value, index.total.plus_minus),
                ]
            }));
            out.push('\n');
            out.push_str(&columns(&rows, 2));
        }
    }
    out.push('\n');
    let failed = [
        (a.failures.no_machine, "make no machine"),
        (a.failures.no_answer, "have no answer at a place or more"),
        (
            a.failures.unstable,
            "are NOT STABLE under the load at a place or more",
        ),
    ];
    for (count, what) in failed.into_iter().filter(|(count, _)| *count > 0) {
        out.push_str(&item(&format!("{count} of {} machines {what}", a.machines)));
    }
    if let Some(example) = &a.failures.example {
        out.push_str(&item(&format!("the first of them: {example}")));
    }
    if let Some(failed) = &a.sobol_failures {
        let missing = failed.no_machine + failed.no_answer;
        if missing > 0 {
            out.push_str(&item(&format!(
                "{missing} of the machines for Sobol indices have no whole answer: what is said of the others holds for these alone, and nothing is said where more than {} % of the draws are missing",
                short(100.0 * MOST_MISSING)
            )));
        }
    }
    for warning in &a.warnings {
        out.push_str(&item(&warning.message));
    }
    out.push_str(&wrapped(
        "Deviations are standard deviations. Linear is enough where it is off by at most a tenth of one (root mean square over all machines).",
        0,
    ));
    out
}
