//! Fitted coefficients as a file of materials, which `--materials` and jobs read.

use std::ffi::OsStr;
use std::path::Path;

use kinetostat::number::{larger, smaller};
use kinetostat_cutting::{CoefficientFit, Materials};

use crate::force::arguments::ForceArgs;
use crate::force::fit::answer::{CoefficientAnswer, FitAnswer};
use crate::force::fit::findings::exchanged_axes;
use crate::force::fit_arguments::GroupWord;
use crate::ui::numbers::{given, number};

/// Widest band that a material may have, percent.
const WIDEST: f64 = 200.0;

/// The coefficients as the law calls them, in their order.
const QUANTITIES: [&str; 6] = [
    "tangential cutting coefficient",
    "radial cutting coefficient",
    "axial cutting coefficient",
    "tangential edge coefficient",
    "radial edge coefficient",
    "axial edge coefficient",
];

/// The file, or why there is none.
pub(super) fn material_file(
    a: &FitAnswer,
    fit: &CoefficientFit,
    args: &ForceArgs,
) -> Result<String, String> {
    fit.law().map_err(|error| {
        let place = QUANTITIES.iter().position(|name| *name == error.quantity);
        let found = place.and_then(|i| a.coefficients.get(i));
        let found = found.map_or(error.found, |c| {
            format!("{} = {} {}", c.symbol, number(c.value, 3), c.unit)
        });
        format!(
            "no material has these coefficients: {found}; expected {}",
            error.expected
        )
    })?;
    if let Some(wrong) = exchanged_axes(&a.coefficients) {
        return Err(wrong);
    }
    let spread = match a.spread_percent {
        Some(percent) if percent <= WIDEST => percent,
        Some(percent) => {
            return Err(format!(
                "the interval of the fit is {} % of the force; measure more, or state the band of the material with --spread-percent",
                number(percent, 3)
            ));
        }
        None => {
            return Err(
                "two feeds leave no interval, and so no band; measure more feeds, or state it with --spread-percent"
                    .to_owned(),
            );
        }
    };
    let text = written(a, args, spread);
    // The written text is parsed once before it is returned.
    match Materials::read("material", &text) {
        Ok(_) => Ok(text),
        Err(error) => Err(format!("{}: {}", error.quantity, error.found)),
    }
}

fn written(a: &FitAnswer, args: &ForceArgs, spread: f64) -> String {
    let c = &a.cut;
    // The directory is omitted: a material may be passed on.
    let file = Path::new(&a.file).file_name();
    let file = file.map_or_else(|| a.file.clone().into(), OsStr::to_string_lossy);
    let source = format!(
        "kinetostat force --fit: {} mean forces in {}; flat cutter of {} mm, {} teeth, {} mm wide, {} mm deep, {}, {} to {} mm per tooth",
        a.rows.len(),
        file,
        given(a.tool.diameter_mm),
        a.tool.teeth,
        given(c.width_mm),
        given(c.depth_mm),
        match c.milling {
            "slot" => "a slot".to_owned(),
            way => format!("{way} milling"),
        },
        given(end(a, smaller)),
        given(end(a, larger)),
    );
    let assumption = match a.spread_from {
        Some("given") => "The spread was stated by hand.",
        _ => {
            "The spread is the 95 % interval of the fit alone: another batch, a worn edge or another tool is not in it."
        }
    };
    let mut measured_in = "process = \"milling\"".to_owned();
    if let Some(rake) = args.material.rake_deg {
        measured_in.push_str(&format!(", rake_deg = {}", figures(rake)));
    }
    if let Some(speed) = c.cutting_speed_m_per_min
        && (1.0..=1e4).contains(&speed)
    {
        measured_in.push_str(&format!(", speed_m_per_min = {}", figures(speed)));
    }
    let [tc, rc, ac, te, re, ae] = &a.coefficients[..] else {
        return String::new();
    };
    let list = |all: [&CoefficientAnswer; 3]| all.map(|c| figures(c.value)).join(", ");
    let widths = |all: [&CoefficientAnswer; 3]| {
        let half = |c: &CoefficientAnswer| Some(number(c.high_95? - c.value, 2));
        let halves: Option<Vec<String>> = all.into_iter().map(half).collect();
        halves.map_or_else(String::new, |halves| {
            format!("   # +- {} (95 %)", halves.join(", "))
        })
    };
    let (cutting, edge) = ([tc, rc, ac], [te, re, ae]);
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    [
        "[[material]]".to_owned(),
        format!("name = {}", quoted(&a.name)),
        format!(
            "group = \"{}\"",
            group_word(args.fit.group.unwrap_or_default())
        ),
        format!("spread_percent = {}", figures(spread)),
        format!("source = {}", quoted(&source)),
        format!("assumptions = [{}]", quoted(assumption)),
        format!("measured_in = {{ {measured_in} }}"),
        format!(
            "chip_mm = [{}, {}]",
            figures(c.chip_from_mm),
            figures(c.chip_to_mm)
        ),
        "[material.law.linear]             # tangential, radial, axial".to_owned(),
        format!("cutting_n_per_mm2 = [{}]{}", list(cutting), widths(cutting)),
        format!("edge_n_per_mm = [{}]{}", list(edge), widths(edge)),
        String::new(),
    ]
    .join("\n")
}

fn end(a: &FitAnswer, of: fn(f64, f64) -> f64) -> f64 {
    let feeds = a.rows.iter().map(|row| row.feed_mm_per_tooth);
    feeds.reduce(of).unwrap_or(f64::NAN)
}

/// A number with six digits after the first, in plain notation: nobody measures more.
fn figures(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    rounded.to_string()
}

fn group_word(group: GroupWord) -> &'static str {
    match group {
        GroupWord::Aluminium => "aluminium",
        GroupWord::Magnesium => "magnesium",
        GroupWord::Copper => "copper",
        GroupWord::Steel => "steel",
        GroupWord::Stainless => "stainless",
        GroupWord::CastIron => "cast_iron",
        GroupWord::Titanium => "titanium",
        GroupWord::Nickel => "nickel",
        GroupWord::Plastic => "plastic",
        GroupWord::Wood => "wood",
        GroupWord::Other => "other",
    }
}
