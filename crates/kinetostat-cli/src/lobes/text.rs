//! The answer of `lobes` for a person, and as a table.

use crate::lobes::answer::{Best, LobesAnswer};
use crate::place::query::PlaceQuery;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{number, short, triple};
use crate::ui::warnings;
use crate::vibration::stability::instability;

/// Upper limit of the speeds shown to a person; JSON, table and drawing have all.
const SHOWN: usize = 25;

pub(crate) fn answer_text(query: &PlaceQuery, a: &LobesAnswer) -> String {
    let mut out = query.heading();
    out.push_str(&wrapped(
        &format!(
            "{}-milling, {} teeth, immersion {}, feed along {}, tool axis {}, {} N/mm^2{}; damping: {}; {} modes up to {} Hz.",
            a.milled,
            a.teeth,
            a.immersion,
            triple(a.feed_direction, |x| number(x, 3)),
            triple(a.tool_axis, |x| number(x, 3)),
            a.coefficients_n_per_mm2
                .iter()
                .map(|x| short(*x))
                .collect::<Vec<_>>()
                .join(" "),
            a.material.as_ref().zip(a.chip_mm).map_or_else(String::new, |(name, chip_mm)| format!(
                " ({name}, chips of {} mm)",
                number(chip_mm, 3)
            )),
            a.damping,
            a.modes_hz.len(),
            number(a.modes_hz.last().copied().unwrap_or(f64::NAN), 4)
        ),
        0,
    ));
    out.push('\n');
    let mut rows = vec![
        [
            "rpm",
            "stable to, mm",
            "then",
            "chatter, Hz",
            "zeroth order, mm",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let every = a.points.len().div_ceil(SHOWN);
    for p in a.points.iter().step_by(every) {
        rows.push(vec![
            number(p.speed_rpm, 5),
            p.limit_mm.map_or_else(
                || format!("all {}", short(a.depth_limit_mm)),
                |x| number(x, 4),
            ),
            instability(p.kind).to_owned(),
            p.chatter_hz.map_or_else(String::new, |x| number(x, 4)),
            p.zeroth_order_mm.map_or_else(String::new, |x| number(x, 4)),
        ]);
    }
    out.push_str(&columns(&rows, 0));
    if every > 1 {
        out.push_str(&wrapped(
            &format!(
                "One speed in {every} is shown of {}; files have all.",
                a.points.len()
            ),
            0,
        ));
    }
    if let Some(best) = &a.best {
        out.push_str(&wrapped(&deepest(best, a.points.len()), 0));
    }
    out.push_str(&wrapped(
        "The limits are as true as masses, stiffness and damping of the model; modes of spindle and tool are in them only if the model has them. The limit of zeroth order is no bound.",
        0,
    ));
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn deepest(best: &Best, speeds: usize) -> String {
    let (depth, rpm) = (number(best.depth_mm, 4), number(best.speed_rpm, 5));
    match (best.no_limit_found, best.speeds_without_limit) {
        (false, _) => format!("Deepest stable cut of these speeds: {depth} mm at {rpm} rpm."),
        (true, without) if without == speeds => format!(
            "No limit was found: all speeds are stable up to {} mm, the largest depth that was looked at (--depth-mm).",
            short(best.depth_mm)
        ),
        (true, without) => format!(
            "Deepest stable cut of these speeds: {} mm or more at {without} of {speeds} speeds, the slowest {rpm} rpm; that is the largest depth that was looked at (--depth-mm), and no limit.",
            short(best.depth_mm)
        ),
    }
}

/// One row for each speed.
pub(crate) fn table(a: &LobesAnswer) -> Answer<Vec<u8>> {
    let head = [
        "speed_rpm",
        "limit_mm",
        "kind",
        "chatter_hz",
        "stable_mm",
        "zeroth_order_mm",
        "modes_up_to_hz",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for p in &a.points {
        let stretches = p
            .stable_mm
            .iter()
            .map(|(low, high)| format!("{low}-{high}"));
        rows.push(vec![
            cell(p.speed_rpm),
            cell_if_any(p.limit_mm),
            instability(p.kind).to_lowercase(),
            cell_if_any(p.chatter_hz),
            stretches.collect::<Vec<_>>().join(" "),
            cell_if_any(p.zeroth_order_mm),
            cell(p.modes_up_to_hz),
        ]);
    }
    written(&rows)
}
