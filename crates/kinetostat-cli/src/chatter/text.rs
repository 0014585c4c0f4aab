//! The answer of `chatter` for a person, and as a table.

use crate::chatter::answer::{ChatterAnswer, Place, Stretch, Vibration};
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::number;
use crate::ui::warnings;
use crate::vibration::stability::instability;

/// Most stretches that are shown to a person; JSON has all.
const SHOWN: usize = 20;

pub(crate) fn answer_text(a: &ChatterAnswer) -> String {
    let mut out = wrapped(
        &format!(
            "{} on {}, {}; damping: {}. {} places of the program are in the cut; {} stand for them.",
            a.program,
            a.model,
            a.material,
            a.damping,
            a.places_in_cut,
            a.places.len()
        ),
        0,
    );
    out.push('\n');
    match (a.chatters, a.places_judged) {
        (_, 0) => out.push_str("No place is judged.\n"),
        (false, _) => out.push_str("No judged place chatters.\n"),
        (true, _) => {
            out.push_str("Lines that chatter\n");
            out.push_str(&stretches(a));
        }
    }
    if let Some(nearest) = &a.nearest {
        out.push_str(&wrapped(&nearest_words(nearest), 0));
    }
    if let Some(words) = vibration_words(a) {
        out.push_str(&wrapped(&words, 0));
    }
    out.push_str(&wrapped(
        "Limits are as true as masses, stiffness and damping of the model; modes of spindle, tool and part are in them only if the model has them.",
        0,
    ));
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn stretches(a: &ChatterAnswer) -> String {
    let heads = [
        "lines",
        "rpm",
        "depth, mm",
        "stable to, mm",
        "chatter, Hz",
        "then",
        "stable at, rpm",
    ];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for s in a.stretches.iter().take(SHOWN) {
        rows.push(vec![
            match s.first_line == s.last_line {
                true => s.first_line.to_string(),
                false => format!("{}-{}", s.first_line, s.last_line),
            },
            number(s.rpm, 5),
            number(s.depth_mm, 4),
            number(s.stable_depth_mm, 4),
            number(s.chatter_hz, 4),
            instability(Some(s.kind)).to_owned(),
            stable_at(s),
        ]);
    }
    let mut out = columns(&rows, 0);
    if a.stretches.len() > SHOWN {
        out.push_str(&format!(
            "{} stretches are shown of {}; --json has all.\n",
            SHOWN,
            a.stretches.len()
        ));
    }
    out
}

fn stable_at(s: &Stretch) -> String {
    match (s.stable_rpm, s.speeds_tried) {
        (Some(rpm), _) => number(rpm, 4),
        (None, true) => "none near".to_owned(),
        (None, false) => "not tried".to_owned(),
    }
}

fn nearest_words(p: &Place) -> String {
    let limit = p.limit_mm.map_or_else(String::new, |x| number(x, 4));
    format!(
        "Least limit: {limit} mm on line {} where the program cuts {} mm deep at {} rpm; lowest frequency of the machine there {} Hz.",
        p.line,
        number(p.depth_mm, 4),
        number(p.rpm, 5),
        p.first_hz.map_or_else(String::new, |x| number(x, 4))
    )
}

/// Where the teeth shake most, and where that leaves most on a wall.
fn vibration_words(a: &ChatterAnswer) -> Option<String> {
    let shaken = || a.places.iter().filter_map(|p| Some((p, p.vibration?)));
    let (place, most) = shaken().max_by(|a, b| a.1.rms_um.total_cmp(&b.1.rms_um))?;
    let mut words = format!(
        "Where it does not chatter, teeth that pass shake the tip by up to {} um (rms) about its mean place, on line {}: {} Hz, {} of the teeth, beside a mode at {} Hz.",
        number(most.rms_um, 3),
        place.line,
        number(most.strongest_hz, 4),
        match (most.strongest_hz / most.tooth_passing_hz).round() {
            1.0 => "the frequency".to_owned(),
            times if times > 1.0 => format!("{times} times the frequency"),
            _ => "below the frequency".to_owned(),
        },
        number(most.nearest_mode_hz, 4),
    );
    let walls = shaken().filter_map(|(place, v)| Some((place, v.wall_um()?)));
    if let Some((place, wall)) = walls.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
        words.push_str(&format!(
            " On a wall that leaves at most {} um (line {}, {}), beside what a compensation takes away.",
            number(wall.abs(), 3),
            place.line,
            if wall > 0.0 { "too deep" } else { "left standing" }
        ));
    }
    Some(words)
}

/// One row for each place.
pub(crate) fn table(a: &ChatterAnswer) -> Answer<Vec<u8>> {
    let head = [
        "line",
        "path_mm",
        "x_mm",
        "y_mm",
        "z_mm",
        "rpm",
        "depth_mm",
        "entry_deg",
        "exit_deg",
        "feed_per_tooth_mm",
        "verdict",
        "limit_mm",
        "kind",
        "chatter_hz",
        "first_hz",
        "places",
        "tooth_passing_hz",
        "vibration_rms_um",
        "strongest_hz",
        "nearest_mode_hz",
        "wall_least_um",
        "wall_most_um",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for p in &a.places {
        let of = |value: &dyn Fn(&Vibration) -> Option<f64>| {
            cell_if_any(p.vibration.as_ref().and_then(value))
        };
        rows.push(vec![
            p.line.to_string(),
            cell(p.path_mm),
            cell(p.position_mm[0]),
            cell(p.position_mm[1]),
            cell(p.position_mm[2]),
            cell(p.rpm),
            cell(p.depth_mm),
            cell_if_any(p.entry_deg),
            cell_if_any(p.exit_deg),
            cell(p.feed_per_tooth_mm),
            p.verdict.to_owned(),
            cell_if_any(p.limit_mm),
            instability(p.kind).to_lowercase(),
            cell_if_any(p.chatter_hz),
            cell_if_any(p.first_hz),
            p.places.to_string(),
            of(&|v| Some(v.tooth_passing_hz)),
            of(&|v| Some(v.rms_um)),
            of(&|v| Some(v.strongest_hz)),
            of(&|v| Some(v.nearest_mode_hz)),
            of(&|v| v.wall_least_um),
            of(&|v| v.wall_most_um),
        ]);
    }
    written(&rows)
}
