//! The answer of `modes` for a person, and as a table.

use kinetostat::number::larger;
use kinetostat_dynamics::{DirectionCounts, EnergyShare, ModeKind, Verdict};

use crate::modes::fields::{Circulatory, ModeAnswer, ModesAnswer};
use crate::place::query::PlaceQuery;
use crate::ui::csv_cell::text as safe_cell;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, load_triple, number, triple};
use crate::ui::warnings;

/// Shares of energy below this are not shown to a person; JSON and table have all.
const SHOWN: f64 = 0.05;

pub(crate) fn answer_text(query: &PlaceQuery, a: &ModesAnswer) -> String {
    let mut out = query.heading();
    let hold = match &a.hold {
        Some(list) => format!("held in {list}"),
        None => "free".to_owned(),
    };
    out.push_str(&wrapped(
        &format!(
            "Small vibrations about the equilibrium under the force {} N and the moment {} N m on the tool, with weights and preloads; the tool is {hold}; damping: {}; mass of the model {} kg.",
            load_triple(a.force_n),
            load_triple(a.moment_n_m),
            a.damping,
            number(a.total_mass_kg, 5)
        ),
        0,
    ));
    match &a.circulatory {
        Some(found) => {
            out.push_str(&wrapped(&of_circulatory(a, found), 0));
            out.push_str(&wrapped("Modes are the complex pairs under these loads.", 0));
            if a.structural {
                out.push_str(&wrapped(
                    "Structural damping is not in the pairs: it is defined for a steady vibration, and says nothing of what grows or dies away. `kinetostat frf` has it.",
                    0,
                ));
            }
        }
        None if a.stable == Some(false) => out.push_str(&wrapped(
            "The equilibrium is NOT stable: what has a negative frequency (square below zero) runs away.",
            0,
        )),
        None => {}
    }
    out.push('\n');
    let mut head = vec!["mode", "Hz"];
    if a.circulatory.is_some() {
        head.push("growth, 1/s");
    }
    head.extend(["damping, %", "the tool moves along", "turns"]);
    let mut rows = vec![head.into_iter().map(str::to_owned).collect()];
    rows.extend(a.modes.iter().map(row));
    out.push_str(&columns(&rows, 0));
    out.push_str(&wrapped(
        "Along: motion of the tip, base axes, its largest part 1. Turns: rad for 1 m of that largest part; where it turns in place, their largest part is 1.",
        0,
    ));
    if a.circulatory.is_some() {
        out.push_str(&wrapped(
            "Growth: the real part of lambda in e^(lambda t). Where parts of a pair swing out of step, the motion is that of the instant at which the tool moves farthest.",
            0,
        ));
    }
    out.push_str("\nWhat moves, and what is strained\n");
    for mode in &a.modes {
        let strained = match largest(&mode.elastic_energy) {
            words if words.is_empty() => "no spring".to_owned(),
            words => words,
        };
        out.push_str(&item(&format!(
            "mode {}, {} Hz: kinetic energy {}; elastic energy {strained}",
            mode.number,
            number(mode.frequency_hz, 4),
            largest(&mode.kinetic_energy),
        )));
    }
    out.push_str("\nDirections\n");
    for line in directions(&a.directions, a.circulatory.is_some()) {
        out.push_str(&item(&line));
    }
    if !a.neutral.is_empty() {
        out.push_str(&item(&format!(
            "in neutral directions take part: {}",
            a.neutral.join(", ")
        )));
    }
    if a.mode_count > a.modes.len() {
        out.push_str(&item(&format!(
            "{} higher modes are not shown (--modes)",
            a.mode_count - a.modes.len()
        )));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

/// Describes the stability under loads without a potential.
fn of_circulatory(a: &ModesAnswer, found: &Circulatory) -> String {
    let how = a.fastest_growing.as_ref().map_or_else(String::new, |mode| {
        format!(
            " (at {} Hz, by {} 1/s)",
            number(mode.frequency_hz, 4),
            number(mode.growth_per_s, 3)
        )
    });
    match &found.verdict {
        Verdict::Stable => {
            "Loads have no potential; the equilibrium is stable under them: no pair of modes grows."
                .to_owned()
        }
        Verdict::Flutter => format!(
            "The equilibrium is NOT stable: it FLUTTERS, a pair of modes swings with growing amplitude{how}."
        ),
        Verdict::Divergence => format!(
            "The equilibrium is NOT stable: it goes away without swinging (divergence){how}."
        ),
        Verdict::NotJudged { links } => format!(
            "Loads have no potential, and whether the machine flutters is not judged: links of one segment are too coarse for it ({}). Give them two segments and more; until then the growth of the pairs below says nothing.",
            links.join(", ")
        ),
        _ => "Loads have no potential.".to_owned(),
    }
}

/// Share of the largest part (of a turn: metres for a radian) below which a number is rounding.
const NOTHING: f64 = 1e-9;

fn largest_of(parts: [f64; 3]) -> f64 {
    parts.into_iter().map(f64::abs).fold(0.0, larger)
}

/// A part beside the largest one, 0 where it is rounding.
fn clean(part: f64, largest: f64) -> f64 {
    match part.abs() > NOTHING * largest {
        true => part,
        false => 0.0,
    }
}

fn row(mode: &ModeAnswer) -> Vec<String> {
    let word = match (mode.kind, mode.growth_per_s) {
        (ModeKind::Free, _) => " free",
        (ModeKind::Unstable, _) => " unstable",
        (_, Some(growth)) if growth < 0.0 && mode.frequency_hz == 0.0 => " creeps back",
        _ => "",
    };
    let along = mode.tool_translation_per_sqrt_kg;
    let turns = mode.tool_rotation_rad_per_m_sqrt_kg;
    let (most, most_turned) = (largest_of(along), largest_of(turns));
    // A turn of so little for a metre of motion is rounding, too.
    let largest = larger(most, most_turned);
    let shown_turns = |by: f64| triple(turns.map(|x| clean(x, largest) / by), |x| number(x, 2));
    let (along, turns) = match (most > NOTHING * most_turned, most_turned > 0.0) {
        (true, _) => (
            triple(along.map(|x| clean(x, most) / most), |x| fixed(x, 2)),
            shown_turns(most),
        ),
        (false, true) => ("it turns in place".to_owned(), shown_turns(most_turned)),
        (false, false) => ("does not move".to_owned(), String::new()),
    };
    let mut row = vec![
        format!("{}{word}", mode.number),
        number(mode.frequency_hz, 5),
    ];
    row.extend(mode.growth_per_s.map(|growth| number(growth, 3)));
    let damping = mode.damping_ratio;
    row.extend([
        damping.map_or_else(|| "-".to_owned(), |z| fixed(100.0 * z, 2)),
        along,
        turns,
    ]);
    row
}

/// The largest shares in words.
fn largest(shares: &[EnergyShare]) -> String {
    let shown = shares.iter().filter(|s| s.share >= SHOWN);
    let each = shown.map(|s| format!("{} {} %", s.name, fixed(100.0 * s.share, 0)));
    each.collect::<Vec<_>>().join(", ")
}

fn directions(c: &DirectionCounts, pairs: bool) -> Vec<String> {
    let (quiet, unstable) = match pairs {
        false => ("vibrate", "are UNSTABLE: negative stiffness"),
        true => ("pairs do not grow", "pairs GROW"),
    };
    let lines = [
        (c.vibrating, quiet),
        (c.free, "are free: mass without stiffness, frequency 0"),
        (c.unstable, unstable),
        (
            c.massless,
            "are massless: they follow at once and have no mode",
        ),
        (
            c.massless_unstable,
            "are massless and UNSTABLE: no frequency tells of them",
        ),
        (c.neutral, "are neutral: neither mass nor stiffness"),
        (
            c.rigid,
            "of the tool are rigid: the machine cannot move that way",
        ),
    ];
    let some = lines.into_iter().filter(|(count, _)| *count > 0);
    some.map(|(count, words)| format!("{count} {words}"))
        .collect()
}

/// One row for each mode and part; the shares of a part in one row.
pub(crate) fn table(a: &ModesAnswer) -> Answer<Vec<u8>> {
    let head = [
        "mode",
        "kind",
        "frequency_hz",
        "growth_per_s",
        "squared_rad_per_s_2",
        "damping_ratio",
        "x_per_sqrt_kg",
        "y_per_sqrt_kg",
        "z_per_sqrt_kg",
        "rx_rad_per_m_sqrt_kg",
        "ry_rad_per_m_sqrt_kg",
        "rz_rad_per_m_sqrt_kg",
        "energy",
        "part",
        "share",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for mode in &a.modes {
        let kind = match mode.kind {
            ModeKind::Free => "free",
            ModeKind::Unstable => "unstable",
            _ => "vibration",
        };
        let mut own = vec![
            mode.number.to_string(),
            kind.to_owned(),
            cell(mode.frequency_hz),
            cell_if_any(mode.growth_per_s),
            cell(mode.squared_rad_per_s_2),
            cell_if_any(mode.damping_ratio),
        ];
        own.extend(mode.tool_translation_per_sqrt_kg.map(cell));
        own.extend(mode.tool_rotation_rad_per_m_sqrt_kg.map(cell));
        let energies = [
            ("kinetic", &mode.kinetic_energy),
            ("elastic", &mode.elastic_energy),
        ];
        for (energy, shares) in energies {
            for share in shares {
                let mut row = own.clone();
                row.extend([energy.to_owned(), safe_cell(&share.name), cell(share.share)]);
                rows.push(row);
            }
        }
    }
    written(&rows)
}
