//! Shares for a person, as a table and as bars.

use kinetostat_report::{Bar, Bars};

use crate::place::query::PlaceQuery;
use crate::shares::answer::{SensitivitiesAnswer, SharesAnswer, StiffeningAnswer};
use crate::ui::csv_cell::text as safe_cell;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, load_triple, number};
use crate::ui::warnings;

/// Upper limit of the numbers of the file shown to a person; JSON has all.
const SHOWN: usize = 25;

pub(crate) fn answer_text(query: &PlaceQuery, a: &SharesAnswer) -> String {
    let mut out = query.heading();
    let state = match a.loaded {
        true => format!(
            "Shares of what a further small load meets, {}, under the force {} N and the moment {} N m on the tool, with weights, preloads and deviations.",
            a.direction,
            load_triple(a.force_n),
            load_triple(a.moment_n_m)
        ),
        false => format!(
            "Shares of the deflection under {}, of the unloaded machine as drawn (give --force for the loaded one).",
            a.direction
        ),
    };
    out.push_str(&wrapped(&state, 0));
    if !a.stable {
        out.push_str(&wrapped("The machine is NOT stable there.", 0));
    }
    let turns = a.direction_components[..3].iter().all(|x| *x == 0.0);
    let unit = if turns { "urad per N m" } else { "um per N" };
    out.push_str(&wrapped(
        &format!(
            "Compliance in that direction: {} {unit}.",
            number(1e6 * a.compliance_m_or_rad_per_n_or_n_m, 5)
        ),
        0,
    ));
    out.push('\n');
    let several = a.limbs.iter().filter(|l| l.name.is_some()).count() > 1;
    let mut rows = vec![
        ["part", "kind", "share, %", unit]
            .map(str::to_owned)
            .to_vec(),
    ];
    for part in &a.parts {
        rows.push(vec![
            part.full_name(several),
            part.kind.word().to_owned(),
            fixed(100.0 * part.share, 2),
            number(1e6 * part.compliance_m_or_rad_per_n_or_n_m, 4),
        ]);
    }
    rows.push(vec![
        "all".into(),
        String::new(),
        "100.00".into(),
        number(1e6 * a.compliance_m_or_rad_per_n_or_n_m, 4),
    ]);
    out.push_str(&columns(&rows, 1));
    if several {
        out.push_str("\nLimbs\n");
        for limb in &a.limbs {
            let name = limb.name.as_deref().unwrap_or("what acts on platforms");
            out.push_str(&item(&format!(
                "{name}: {} %",
                fixed(100.0 * limb.share, 2)
            )));
        }
    }
    if let Some(stiffening) = &a.stiffening {
        out.push_str(&stiffening_text(stiffening, several));
    }
    if let Some(sensitivities) = &a.sensitivities {
        out.push_str(&sensitivities_text(sensitivities));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn stiffening_text(s: &StiffeningAnswer, several: bool) -> String {
    let mut out = String::from("\n");
    let less = fixed(100.0 * (1.0 - s.target), 1);
    if !s.possible {
        out.push_str(&wrapped(
            &format!("No stiffening of springs lowers the deflection by {less} %."),
            0,
        ));
        return out;
    }
    out.push_str(&wrapped(
        &format!(
            "Cheapest stiffening for {less} % less deflection ({}):",
            s.assumption
        ),
        0,
    ));
    for part in &s.parts {
        let name = match (&part.limb, several) {
            (Some(limb), true) => format!("{limb}: {}", part.name),
            _ => part.name.clone(),
        };
        out.push_str(&item(&format!(
            "{name}: {} times as stiff",
            number(part.factor, 4)
        )));
    }
    out
}

fn sensitivities_text(s: &SensitivitiesAnswer) -> String {
    let mut out = String::from("\n");
    let without_load = s.deflection_m_or_rad == 0.0;
    out.push_str(&wrapped(
        "What 1 % more of a number of the model file changes, the tool commanded for the same place:",
        0,
    ));
    out.push('\n');
    let mut rows = vec![
        ["number", "value", "deflection, %", "stiffness, %"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for n in s.numbers.iter().take(SHOWN) {
        let relative = 100.0 * n.deflection_by_percent_m_or_rad / s.deflection_m_or_rad;
        rows.push(vec![
            n.path.clone(),
            format!("{} {}", number(n.value, 4), n.unit),
            if without_load {
                "-".into()
            } else {
                fixed(relative, 4)
            },
            fixed(100.0 * n.stiffness_by_percent_relative, 4),
        ]);
    }
    out.push_str(&columns(&rows, 1));
    if s.numbers.len() > SHOWN {
        out.push_str(&wrapped(
            &format!("and {} more: see --json", s.numbers.len() - SHOWN),
            1,
        ));
    }
    if !s.not_differentiated.is_empty() {
        let count = s.not_differentiated.len();
        out.push_str(&wrapped(
            &format!("Not differentiated: {count} numbers, with the reasons in --json."),
            0,
        ));
    }
    out
}

pub(crate) fn table(a: &SharesAnswer) -> Answer<Vec<u8>> {
    let header = [
        "limb",
        "part",
        "kind",
        "share",
        "compliance_m_or_rad_per_n_or_n_m",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for part in &a.parts {
        rows.push(vec![
            safe_cell(part.limb.as_deref().unwrap_or_default()),
            safe_cell(&part.name),
            part.kind.word().to_owned(),
            cell(part.share),
            cell(part.compliance_m_or_rad_per_n_or_n_m),
        ]);
    }
    written(&rows)
}

pub(crate) fn bars(a: &SharesAnswer) -> Bars {
    let several = a.limbs.iter().filter(|l| l.name.is_some()).count() > 1;
    let bars = a.parts.iter().map(|part| Bar {
        name: part.full_name(several),
        value: part.share,
        figure: format!("{} %", fixed(100.0 * part.share, 1)),
    });
    Bars {
        title: format!(
            "{}: shares of the deflection under {}",
            a.head.model, a.direction
        ),
        bars: bars.collect(),
    }
}
