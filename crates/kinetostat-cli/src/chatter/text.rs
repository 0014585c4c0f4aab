//! The answer of `chatter` for a person, and as a table.

use kinetostat_chatter::Instability;
use kinetostat_machining::ChatterResult;

use crate::chatter::answer::{ChatterAnswer, Stretch, Vibration};
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::number;
use crate::ui::warnings;
use crate::vibration::stability::instability;

/// Upper limit of the stretches shown to a person; JSON has all.
const SHOWN: usize = 20;

/// Legend of the last column of the stretches.
const SPEEDS: &str = "Other speeds are tried from half to one and a half times that of the program in steps of 5 %, with the depths and feeds per tooth of the program (F is the feed with that speed). The nearest whose neighbours are stable, too, is stated; where there is none, the one with the largest limit, which is narrow: 5 % away the cut chatters.";

pub(crate) fn answer_text(a: &ChatterAnswer, found: &ChatterResult) -> String {
    let mut out = wrapped(
        &format!(
            "{} on {}, {}; damping: {}{}. {} places of the program are in the cut; {} stand for them.",
            a.program,
            a.model,
            a.material,
            a.damping,
            a.modes_up_to_hz.map_or_else(String::new, |hz| format!(
                "; modes up to {} Hz",
                number(hz, 4)
            )),
            a.places_in_cut,
            a.places.len()
        ),
        0,
    );
    out.push('\n');
    if a.chatters {
        out.push_str("Lines that chatter\n");
        out.push_str(&stretches(a));
        out.push_str(&wrapped(SPEEDS, 0));
    }
    if !a.chatters || a.places.iter().any(|p| p.within_spread) {
        out.push_str(&wrapped(&found.verdict_text(), 0));
    }
    for text in [found.nearest_text(), found.vibration_text()] {
        out.push_str(&text.map_or_else(String::new, |text| wrapped(&text, 0)));
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
        "limit",
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
            match s.kind {
                Instability::Flip => "half tooth passing",
                _ => "own frequency",
            }
            .to_owned(),
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
        (Some(rpm), _) => {
            let feed = match s.stable_feed_mm_per_min {
                Some(feed) => format!("F{}", number(feed, 4)),
                None => format!("F x {}", number(rpm / s.rpm, 3)),
            };
            let narrow = if s.stable_speed_is_narrow {
                ", narrow"
            } else {
                ""
            };
            format!("{} ({feed}){narrow}", number(rpm, 4))
        }
        (None, true) => "none".to_owned(),
        (None, false) => "not tried".to_owned(),
    }
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
