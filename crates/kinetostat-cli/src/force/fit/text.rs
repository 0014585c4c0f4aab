//! The answer of `force --fit` for a person.

use std::path::Path;

use kinetostat::number::largest_size;

use crate::force::fit::answer::FitAnswer;
use crate::force::text::{cut_text, tool_text};
use crate::ui::layout::{columns, item, named, wrapped};
use crate::ui::numbers::{fixed, given, number};
use crate::ui::safe_text::safe;
use crate::ui::warnings::warnings;

/// Rows of measured and fitted forces that are listed.
const MOST_ROWS: usize = 12;

pub(super) fn answer_text(a: &FitAnswer, written: Option<&Path>) -> String {
    let mut out = wrapped(&a.question, 0);
    for (name, text) in what_was_cut(a) {
        out.push_str(&named(name, 5, &text));
    }
    out.push_str("\nCoefficients, with the ends of their 95 % intervals\n");
    out.push_str(&coefficients(a));
    out.push_str(&wrapped(
        "K_c grow with the chip, K_e are those of the edge; t along the way of the tooth, r outward, a along the tool.",
        2,
    ));
    out.push_str("\nMeasured forces on the tool, N, and by how much they differ from the fit\n");
    out.push_str(&rows(a));
    out.push_str(&fits(a));
    out.push_str("\nMaterial\n");
    out.push_str(&material(a, written));
    out.push_str("\nHow far to trust it\n");
    out.extend(a.assumed.iter().map(|text| item(text)));
    out.push_str(&warnings(&a.warnings));
    out
}

fn what_was_cut(a: &FitAnswer) -> Vec<(&'static str, String)> {
    let c = &a.cut;
    let cut = cut_text(
        c.width_mm,
        c.depth_mm,
        c.part,
        c.counter_clockwise,
        a.tool.diameter_mm,
    );
    let mut list = vec![
        ("tool", tool_text(&a.tool)),
        ("cut", cut),
        ("means", format!("{}, forces on the {}", a.file, a.acts_on)),
        (
            "chips",
            format!(
                "{} mm (mean, smallest feed) to {} mm (thickest, largest feed)",
                number(c.chip_from_mm, 3),
                number(c.chip_to_mm, 3)
            ),
        ),
    ];
    if let (Some(speed), Some(rpm)) = (c.cutting_speed_m_per_min, c.rpm) {
        let (speed, rpm) = (number(speed, 4), given(rpm));
        list.push(("speed", format!("{speed} m/min at {rpm} turns per minute")));
    }
    list
}

fn coefficients(a: &FitAnswer) -> String {
    let head = ["", "value", "from", "to", "unit"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for c in &a.coefficients {
        let known = |end: Option<f64>| end.map_or_else(|| "-".to_owned(), |n| number(n, 4));
        rows.push(vec![
            c.symbol.to_owned(),
            number(c.value, 4),
            known(c.low_95),
            known(c.high_95),
            c.unit.to_owned(),
        ]);
    }
    columns(&rows, 2)
}

fn rows(a: &FitAnswer) -> String {
    let head = ["mm per tooth", "x", "", "y", "", "z", ""];
    let mut rows = vec![head.map(String::from).to_vec()];
    let most = a.rows.iter().map(|row| largest_size(row.force_n));
    let decimals = match largest_size(most) {
        size if size >= 1000.0 => 0,
        size if size >= 10.0 => 1,
        _ => 3,
    };
    for of in a.rows.iter().take(MOST_ROWS) {
        let mut row = vec![given(of.feed_mm_per_tooth)];
        for (force, residual) in of.force_n.iter().zip(of.residual_n) {
            row.push(fixed(*force, decimals));
            row.push(signed(residual, decimals));
        }
        rows.push(row);
    }
    let mut out = columns(&rows, 2);
    if a.rows.len() > MOST_ROWS {
        let more = a.rows.len() - MOST_ROWS;
        out.push_str(&format!("  and {more} more (--csv has them all)\n"));
    }
    out
}

/// Formats with the sign, except for zero.
fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    match text.chars().any(|sign| ('1'..='9').contains(&sign)) && value > 0.0 {
        true => format!("+{text}"),
        false => text,
    }
}

/// Share explained and scatter of each component.
fn fits(a: &FitAnswer) -> String {
    let mut rows = vec![
        ["", "R2", "scatter, N", "largest, N", "at mm per tooth"]
            .map(String::from)
            .to_vec(),
    ];
    let sizes = a.rows.iter().map(|row| largest_size(row.force_n));
    let size = largest_size(sizes);
    // Residuals at rounding level are shown as zero.
    let of_size = |residual: f64| match residual < 1e-9 * size {
        true => "0".to_owned(),
        false => number(residual, 3),
    };
    for c in &a.components {
        let share = c.r_squared.map_or_else(|| "-".to_owned(), |r| fixed(r, 5));
        rows.push(vec![
            format!("along {}", c.axis),
            share,
            of_size(c.residual_rms_n),
            of_size(c.largest_residual_n),
            given(c.largest_residual_at_feed_mm_per_tooth),
        ]);
    }
    format!("\n{}", columns(&rows, 2))
}

fn material(a: &FitAnswer, written: Option<&Path>) -> String {
    let Some(toml) = &a.material_toml else {
        let reason = a.no_material.as_deref().unwrap_or("none");
        return wrapped(&format!("None: {reason}"), 2);
    };
    let spread = a.spread_percent.map_or_else(String::new, |p| number(p, 2));
    let band = match a.spread_from {
        Some("given") => format!("A band of {spread} % was stated for it."),
        _ => format!(
            "It carries a band of {spread} %: the widest that the intervals make of the force at the feeds measured. It goes through to the band of `compensate`."
        ),
    };
    let mut out = wrapped(&band, 2);
    match written {
        Some(path) => out.push_str(&wrapped(
            &format!(
                "Take it with --materials {0}, and in a job with [material] file = \"{0}\".",
                path.display()
            ),
            2,
        )),
        None => {
            out.push_str(&wrapped(
                "As a file for --materials and for jobs (--out-material FILE writes it):",
                2,
            ));
            out.push('\n');
            // Lines that can be copied.
            for line in toml.lines() {
                out.push_str(&format!("{}\n", safe(line)));
            }
        }
    }
    out
}
