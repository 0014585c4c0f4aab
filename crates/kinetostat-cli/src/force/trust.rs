//! Reliability of a force: law, source, band, factors, and assumptions.

use kinetostat_machining::Warning;

use crate::force::answer::{ForceAnswer, MaterialAnswer};
use crate::ui::layout::item;
use crate::ui::numbers::number;
use crate::ui::warnings;

/// Reliability of a milling force.
pub(crate) fn trust(a: &ForceAnswer) -> String {
    let across = a.mean.across_tool_n;
    let spread = 0.01 * a.material.spread_percent;
    let band = format!(
        "{} to {} N across the tool in the mean, up to {} N at the peak",
        number((1.0 - spread) * across, 3),
        number((1.0 + spread) * across, 3),
        number(a.peak.across_tool_high_n, 3)
    );
    section(&a.material, &band, &a.assumed, &a.warnings)
}

/// The section of any cut, with a band in words and its warnings.
pub(crate) fn section(
    m: &MaterialAnswer,
    band: &str,
    assumed: &[String],
    warned: &[Warning],
) -> String {
    let items = trust_in(m, band, assumed);
    let mut out = "\nHow far to trust it\n".to_owned();
    out.extend(items.iter().map(|text| item(text)));
    out.push_str(&warnings::warnings(warned));
    out
}

fn trust_in(m: &MaterialAnswer, band: &str, assumed: &[String]) -> Vec<String> {
    let mut list = vec![
        format!(
            "{}: {}. Source: {}.",
            m.name,
            m.law,
            m.source.trim_end_matches('.')
        ),
        format!(
            "Another batch, tool or table may give {} % more or less: {band}.",
            number(m.spread_percent, 2)
        ),
    ];
    if m.factors.is_empty() {
        list.push("No correction: the coefficients hold as they were measured.".to_owned());
    }
    for factor in &m.factors {
        list.push(format!(
            "{} = {}: {}.",
            factor.symbol,
            number(factor.value, 4),
            factor.reason
        ));
    }
    list.extend(assumed.iter().cloned());
    list
}
